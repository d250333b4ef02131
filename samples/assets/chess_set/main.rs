//! Makes the one world of this book: writes `chess.obj`, `chess.mtl` and `fretwork.png` next to
//! this directory, and the same as glTF, `chess.gltf` and `chess.bin`, with the normal maps `hammered.png` and
//! `bevelled.png`, the same bytes on every run.
//!
//! `chess_set --check` writes nothing and fails if a file differs from what it would write.

mod board;
mod cross;
mod cut;
mod dents;
mod fretwork;
mod gltf;
mod knight;
mod lathe;
mod mesh;
mod nets;
mod obj;
mod pieces;

use std::io::Cursor;
use std::path::Path;
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};
use common::UsageError;
use common::exit::finish;
use common::files::write_whole;
use common::output;
use image::ImageFormat;

use crate::mesh::Mesh;
use crate::obj::Object;

/// Directory of the files.
const DIRECTORY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/samples/assets");

const USAGE: &str = "usage: chess_set           write the files\n       \
                     chess_set --check   only say whether they are as they would be written\n";

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    finish(|| match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => make(false),
        ["--check"] => make(true),
        ["--help" | "-h"] => output::print(USAGE),
        _ => {
            let all = arguments.join(" ");
            Err(UsageError(format!("chess_set takes --check, or nothing, and not '{all}'")).into())
        }
    })
}

/// Writes the files, or only compares them.
fn make(check: bool) -> Result<()> {
    let objects = objects();
    check_meshes(&objects)?;
    for object in &objects {
        println!("{:<13} {:>5} triangles", object.name, object.mesh.triangles.len());
    }
    let pictures = [
        ("fretwork.png", fretwork::image()),
        ("hammered.png", dents::hammered()),
        ("bevelled.png", dents::bevelled()),
    ];

    let directory = Path::new(DIRECTORY);
    let gltf::Files { json, buffer } =
        gltf::write(&objects, "chess.bin", ["fretwork.png", "bevelled.png"]);
    let mut files = vec![
        ("chess.obj", obj::write(&objects, "chess.mtl").into_bytes()),
        ("chess.mtl", obj::materials("fretwork.png").into_bytes()),
        ("chess.gltf", json.into_bytes()),
        ("chess.bin", buffer),
    ];
    for (name, picture) in &pictures {
        let mut png = Cursor::new(Vec::new());
        picture.write_to(&mut png, ImageFormat::Png)?;
        files.push((name, png.into_inner()));
    }
    for (name, bytes) in files {
        let path = directory.join(name);
        if !check {
            write_whole(&path, &bytes)?;
            println!("{name:<13} {:>7} bytes", bytes.len());
            continue;
        }
        let found = std::fs::read(&path).with_context(|| format!("reading {}", path.display()))?;
        // A newer encoder may pack the same picture into other bytes, which does not count as a difference.
        let same = match pictures.iter().find(|(of, _)| *of == name) {
            Some((_, picture)) => {
                image::load_from_memory(&found).is_ok_and(|found| found.to_rgba8() == *picture)
            }
            None => found == bytes,
        };
        ensure!(same, "{} is out of date: run chess_set", path.display());
    }
    Ok(())
}

/// All objects in the order of the file.
fn objects() -> Vec<Object> {
    let object = |name, material, mesh| Object { name, material, mesh };
    vec![
        object("pawn", "white", pieces::pawn()),
        object("rook", "white", pieces::rook()),
        object("bishop", "white", pieces::bishop()),
        object("knight", "white", knight::knight()),
        object("queen", "white", pieces::queen()),
        object("king", "white", pieces::king()),
        object("board_light", "board_light", board::squares(true)),
        object("board_dark", "board_dark", board::squares(false)),
        object("board_frame", "frame", board::frame()),
        object("screen", "fretwork", board::screen()),
        object("screen_frame", "frame", board::screen_frame()),
    ]
}

/// Fails unless each piece is a closed solid and the three parts of the board are one together.
fn check_meshes(objects: &[Object]) -> Result<()> {
    let mut board = Mesh::default();
    for Object { name, mesh, .. } in objects {
        mesh.check(name)?;
        match *name {
            name if name.starts_with("board") => board.triangles.extend(&mesh.triangles),
            // A sheet has no inside.
            "screen" => {}
            name => mesh.check_closed(name)?,
        }
    }
    board.check_closed("board")
}
