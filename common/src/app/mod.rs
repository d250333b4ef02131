//! A program around a sample: arguments, controls, a headless run or a window, picture and report.

mod args;
mod bands;
pub mod chart;
pub mod compare;
pub mod compile_for;
pub mod controls;
mod gather;
mod headless;
mod interrupt;
mod last_words;
mod lighting;
mod picture;
mod playback;
mod progress;
mod report;
mod samples;
pub mod sums;
mod window;

use std::cell::Cell;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Result;
use ash::vk;

pub use crate::output;
pub use args::Args;
pub use controls::Controls;
pub use headless::{check_files, check_validation, headless};
pub use interrupt::watch;
pub use lighting::Lighting;
pub use picture::{Format, Picture};
pub use playback::Playback;
pub use progress::Progress;
pub use report::{Milliseconds, Report};
pub use samples::{Samples, range};

/// Compiles a shader below `shaders/` to SPIR-V; for 01, which may use nothing of `gpu`.
pub use crate::gpu::shader::compile as compile_shader;

use self::interrupt::Stopped;
use crate::gpu::shader::{apart, are_others};
use crate::gpu::{self, Gpu, Image, Requirements};
use crate::scene::text::shown;
use crate::scene::{Scene, SceneOptions};
use crate::usage::Usage;

/// One chapter's program. The order of the items is the order of every chapter's `main.rs`.
pub trait Sample: Sized {
    /// Features and extensions to ask for: the baseline, unless a chapter needs more.
    fn requirements() -> Requirements {
        Requirements::ray_tracing()
    }

    /// Makes everything that lasts: scene, pipeline, shader binding table.
    ///
    /// # Errors
    /// If the device or a file is not up to it.
    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self>;

    /// Declares the controls. One that brings values of others, as a preset does, sets those; all else that
    /// a change causes belongs in [`Sample::changed`].
    fn controls(&mut self, controls: &mut Controls);

    /// Builds what the controls ask for: called once before the first frame, when all settings are made,
    /// and once before each frame that shows other values.
    ///
    /// # Errors
    /// If it cannot be built.
    fn changed(&mut self, _: &Gpu) -> Result<()> {
        Ok(())
    }

    /// Records one band of a frame into `frame.cmd`, writing `frame.area` of `frame.image`.
    ///
    /// A frame is as many bands as the device needs to answer in time: what all of them share is to be
    /// made once.
    ///
    /// # Errors
    /// If something is missing and cannot be made.
    fn render(&mut self, frame: &Frame) -> Result<()>;

    /// Whether further frames of an unchanged view improve the picture, as with accumulation.
    ///
    /// Without it, a window at rest renders nothing.
    fn accumulates(&self) -> bool {
        false
    }

    /// Whether a frame whose [`Frame::accumulated`] is 0 shows one sample, found from [`Frame::index`]
    /// alone: then `--samples` gathers them.
    fn gathers(&self) -> bool {
        self.accumulates()
    }

    /// The frame that an animation shows. Time goes on between two pictures: `render` then records what
    /// moves, and [`Sample::changed`] is not called.
    fn playback(&mut self) -> Option<&mut Playback> {
        None
    }

    /// What the chapter itself has to tell after the last frame; part of `--report`.
    ///
    /// # Errors
    /// If it cannot be read back.
    fn report(&self) -> Result<serde_json::Value> {
        Ok(serde_json::Value::Null)
    }
}

/// What a sample is made with.
pub struct Setup {
    /// How acceleration structures are built: in spatial order, unless `--unordered` says otherwise.
    pub options: SceneOptions,
    scene: Option<PathBuf>,
    scene_taken: Cell<bool>,
}

impl Setup {
    /// The setup that arguments ask for.
    pub fn new(args: &Args) -> Self {
        let options = SceneOptions { ordering: !args.unordered, ..SceneOptions::default() };
        Self { options, scene: args.scene.clone(), scene_taken: Cell::new(false) }
    }

    /// The file that `--scene` names, for a sample that takes more than models.
    pub fn scene(&self) -> Option<&Path> {
        self.scene_taken.set(true);
        self.scene.as_deref()
    }

    /// The scene that `--scene` names, else the chapter's own. What is wrong with a file, and not so wrong
    /// that it cannot be shown, goes to standard error.
    ///
    /// # Errors
    /// If a file is missing or wrong; on a scene file of chapter 25, [`Usage`].
    pub fn scene_or(&self, own: impl FnOnce() -> Result<Scene>) -> Result<Scene> {
        self.scene_taken.set(true);
        let Some(path) = &self.scene else { return own() };
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
            let what =
                "a scene file, which 25_scene_effects alone reads; this chapter takes an OBJ file";
            return Err(Usage(format!("{}: {what}", shown(path))).into());
        }
        let scene = Scene::open(path)?;
        output::warn(&scene.model.warnings);
        Ok(scene)
    }

    /// Fails if a scene was given to a sample that takes none.
    fn check(&self) -> Result<(), Usage> {
        if self.scene.is_some() && !self.scene_taken.get() {
            return Err(Usage("this chapter brings its own scene and takes no --scene".to_owned()));
        }
        Ok(())
    }
}

/// What a frame is rendered with.
pub struct Frame<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// Where commands are recorded.
    pub cmd: vk::CommandBuffer,
    /// Where the picture goes: linear RGBA, four 32-bit floats, layout `GENERAL`.
    pub image: &'a Image,
    /// The band of it that is to be traced: whole rows.
    pub area: vk::Rect2D,
    /// Frames since anything changed: 0 is the first after a start, a resize or a moved control. With
    /// `--samples`, the number of a sample.
    pub index: u32,
    /// How many of the frames before belong to the same picture: all of them, or with `--samples` none, as
    /// each sample is a picture alone.
    pub accumulated: u32,
}

impl Frame<'_> {
    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.image.extent.width) / f64::from(self.image.extent.height)
    }

    /// The number of the frame that the picture begins with: 0, or with `--samples` this one's.
    pub fn first(&self) -> u32 {
        self.index - self.accumulated
    }

    /// Whether no band of this frame was traced yet.
    pub fn is_first_band(&self) -> bool {
        self.area.offset.y == 0
    }
}

/// Runs a sample as a program: reads the arguments, renders, and turns errors into one line.
///
/// Exit codes: 0 done, 1 failed, 2 wrong arguments, 3 asked to stop, and what was gathered is saved.
pub fn run<S: Sample>(name: &'static str) -> ExitCode {
    finish(|| start::<S>(name, &Args::parse_for(name)?))
}

/// Runs a program and returns its exit code; whatever ends it is printed as one line, and a signal leaves no
/// half-written file. Shaders of a folder that is not the project's are compiled in a process of their own.
pub fn finish(program: impl FnOnce() -> Result<()>) -> ExitCode {
    interrupt::watch();
    exit_code(|| {
        if apart::is_asked() {
            return apart::answer();
        }
        if are_others() {
            apart::want();
        }
        program()
    })
}

/// As [`finish`], for a program that heeds signals itself.
pub fn exit_code(program: impl FnOnce() -> Result<()>) -> ExitCode {
    last_words::for_panics();
    // Of the compiler's child, its parent tells, which can name the shader.
    if !apart::is_asked() {
        last_words::for_crashes();
    }
    let Err(error) = program() else { return ExitCode::SUCCESS };
    let line = format!("{error:#}").replace('\n', " ");
    if error.is::<Stopped>() {
        last_words::say(&line);
        return ExitCode::from(3);
    }
    last_words::say(&format!("error: {line}"));
    if error.is::<Usage>() { ExitCode::from(2) } else { ExitCode::FAILURE }
}

/// Does what the arguments ask of a sample; the part of [`run`] after they are read.
///
/// # Errors
/// Whatever went wrong.
pub fn start<S: Sample>(name: &str, args: &Args) -> Result<()> {
    if args.list_devices {
        return list_devices(&S::requirements());
    }
    if args.answer_compile_for {
        return compile_for::answer(&S::requirements());
    }
    if args.is_headless() {
        return headless::<S>(name, args);
    }
    window::open::<S>(name, args)
}

/// Prints every device with its driver, and what it lacks.
///
/// # Errors
/// If there is no Vulkan.
pub fn list_devices(requirements: &Requirements) -> Result<()> {
    for line in gpu::device_lines(requirements)? {
        output::print(&format!("{line}\n"))?;
    }
    Ok(())
}
