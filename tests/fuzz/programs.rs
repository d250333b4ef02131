//! Processes that read an input.

use std::fs;
use std::path::Path;
use std::process::Command;

use fuzz::format::Format;
use fuzz::formats::{cases, game, legs, nothing, object, scene, settings, shader, sums, texture};
use fuzz::program::{Program, lines};
use fuzz::session::Session;

use crate::{SEED, tried};

/// A program, and the number of inputs tried by `cargo test`.
#[derive(Clone, Copy)]
pub struct Tried {
    pub name: &'static str,
    format: Format,
    beside: fn(&Path),
    command: fn(&Path, &[u8]) -> Command,
    writes: &'static [&'static str],
    count: usize,
}

/// A chapter, small and headless.
fn sample(name: &str) -> Command {
    let mut command = run::command(name);
    command.args(["--headless", "--size", "8x8"]);
    command
}

pub const ALL: [Tried; 10] = [
    Tried {
        name: "02_model",
        format: object::FORMAT,
        beside: object::FUNCTION.beside,
        command: |_, _| {
            let mut command = sample("02_basic");
            command.args(["--scene", "m.obj", "--out", "o.png", "--report", "r.json"]);
            command
        },
        writes: &["o.png", "r.json"],
        count: 12,
    },
    Tried {
        name: "02_texture",
        format: texture::FORMAT,
        beside: texture::FUNCTION.beside,
        command: |_, _| {
            let mut command = sample("02_basic");
            command.args(["--scene", "m.obj"]);
            command
        },
        writes: &[],
        count: 8,
    },
    Tried {
        name: "02_settings",
        format: settings::FORMAT,
        beside: nothing,
        command: |_, input| {
            let mut command = sample("02_basic");
            command.arg("--list-controls");
            for line in lines(input) {
                command.arg("--set").arg(line);
            }
            command
        },
        writes: &[],
        count: 12,
    },
    Tried {
        name: "02_arguments",
        format: settings::FORMAT,
        beside: nothing,
        command: |_, input| {
            // Each option with a text in turn; accepted values are only listed.
            let options = ["--set", "--compare", "--samples", "--size", "--device", "--scene"];
            let mut command = sample("02_basic");
            for (line, option) in lines(input).into_iter().zip(options.into_iter().cycle()) {
                command.arg(option).arg(line);
            }
            command.arg("--list-controls");
            command
        },
        writes: &[],
        count: 20,
    },
    Tried {
        name: "04_resume",
        format: sums::FORMAT,
        beside: nothing,
        command: |_, _| {
            let mut command = run::command("04_jitter_camera");
            command.args(["--size", "2x1", "--samples", "0..2", "--resume", "a.sums"]);
            command.args(["--out", "o.exr"]);
            command
        },
        writes: &["o.exr"],
        count: 12,
    },
    Tried {
        name: "14_legs",
        format: legs::FORMAT,
        beside: nothing,
        command: |_, _| {
            let mut command = sample("14_animation");
            command.args(["--scene", "g.legs"]);
            command
        },
        writes: &[],
        count: 6,
    },
    Tried {
        name: "chess_game",
        format: game::FORMAT,
        beside: nothing,
        command: |_, _| {
            let mut command = run::command("chess_game");
            command.arg("g.txt");
            command
        },
        writes: &["g.legs"],
        count: 12,
    },
    Tried {
        name: "24_cases",
        format: cases::FORMAT,
        beside: nothing,
        command: |_, _| {
            let mut command = run::command("24_accuracy");
            command.args(["--cases", "c.json", "--tops", "--report", "r.json"]);
            command
        },
        writes: &["r.json"],
        count: 12,
    },
    Tried {
        name: "25_scene",
        format: scene::FORMAT,
        beside: scene::beside,
        command: |_, _| {
            let mut command = sample("25_scene_effects");
            command.args(["--scene", "s.toml"]);
            command
        },
        writes: &[],
        count: 12,
    },
    Tried {
        name: "merge",
        format: sums::FORMAT,
        beside: |folder| {
            fs::write(folder.join("b.sums"), sums::right(64)).expect("a file can be written");
        },
        command: |_, _| {
            let mut command = run::command("chapters");
            command.args(["merge", "all.sums", "a.sums", "b.sums"]);
            command
        },
        writes: &["all.sums"],
        count: 40,
    },
];

/// The shader compiler, in its own process, because its code is not ours.
pub const SHADERS: Tried = Tried {
    name: "shaders",
    format: shader::FORMAT,
    beside: shader::beside,
    command: |folder, _| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_compile_shader"));
        command.arg("s.rmiss").env("SHADERS", folder);
        command
    },
    writes: &[],
    count: 80,
};

/// The program, ready to read.
pub fn reader(tried: Tried) -> Program {
    Program::new(tried.format, tried.beside, tried.command, tried.writes)
}

/// The session of a program.
pub fn session(tried: Tried, seed: u64) -> Session<Program> {
    Session::new(tried.name, tried.format, reader(tried), seed)
}

macro_rules! tests {
    ($($name:ident: $tried:expr,)*) => {$(
        #[test]
        fn $name() {
            tried(session($tried, SEED), $tried.count);
        }
    )*};
}

tests! {
    a_chapter_opens_models: ALL[0],
    a_chapter_opens_textures: ALL[1],
    a_chapter_is_given_settings: ALL[2],
    a_chapter_is_given_arguments: ALL[3],
    a_render_is_resumed: ALL[4],
    legs_are_opened: ALL[5],
    a_game_is_opened: ALL[6],
    cases_are_run: ALL[7],
    a_scene_is_opened: ALL[8],
    sums_are_merged: ALL[9],
    shaders_are_compiled: SHADERS,
}
