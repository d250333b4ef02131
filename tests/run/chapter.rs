//! A run of a chapter, configured by chained calls: `Chapter::new("22_solids").set("view",
//! "inside").picture()`.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, LazyLock, Mutex, OnceLock, PoisonError};

use common::app::Picture;

use crate::{Run, bits, command, golden, render_by};

/// The arguments that set controls, each `name=value`.
pub fn set_arguments<'a>(settings: &[&'a str]) -> Vec<&'a str> {
    settings.iter().flat_map(|&setting| ["--set", setting]).collect()
}

/// A headless run under validation, at 96x60 pixels by default.
#[derive(Clone, Debug)]
#[must_use = "it runs at `picture` or `run`"]
pub struct Chapter {
    name: String,
    size: String,
    arguments: Vec<String>,
    shaders: Option<PathBuf>,
}

impl Chapter {
    /// The chapter of this name, with its default settings.
    pub fn new(name: impl Into<String>) -> Self {
        let (name, size) = (name.into(), "96x60".to_owned());
        Self { name, size, arguments: Vec::new(), shaders: None }
    }

    /// Width and height in pixels, such as `240x150`.
    pub fn size(mut self, size: impl Into<String>) -> Self {
        self.size = size.into();
        self
    }

    /// Sets a control.
    pub fn set(self, control: &str, value: impl ToString) -> Self {
        self.sets(&[format!("{control}={}", value.to_string())])
    }

    /// Sets controls, each as `name=value`.
    pub fn sets(self, settings: &[impl AsRef<str>]) -> Self {
        let settings: Vec<&str> = settings.iter().map(AsRef::as_ref).collect();
        self.with(&set_arguments(&settings))
    }

    /// The number of frames; the last one is the picture.
    pub fn frames(self, frames: u32) -> Self {
        self.with(&["--frames", &frames.to_string()])
    }

    /// A file instead of the chapter's own scene.
    pub fn scene(self, file: impl AsRef<Path>) -> Self {
        let file = file.as_ref().to_str().expect("a path of plain letters");
        self.with(&["--scene", file])
    }

    /// The arithmetic, as in `--arithmetic`.
    pub fn arithmetic(self, arithmetic: &str) -> Self {
        self.with(&["--arithmetic", arithmetic])
    }

    /// Shaders from a folder instead of the book's.
    pub fn shaders(mut self, folder: impl Into<PathBuf>) -> Self {
        self.shaders = Some(folder.into());
        self
    }

    /// Adds arguments.
    pub fn with(mut self, arguments: &[&str]) -> Self {
        self.arguments.extend(arguments.iter().map(|&argument| argument.to_owned()));
        self
    }

    /// The command, without size and output.
    fn command(&self) -> Command {
        let mut command = command(&self.name);
        if let Some(shaders) = &self.shaders {
            command.env("SHADERS", shaders);
        }
        command
    }

    /// Runs it; a failure or a message fails the test.
    #[track_caller]
    pub fn run(&self) -> Run {
        let arguments: Vec<&str> = self.arguments.iter().map(String::as_str).collect();
        render_by(&mut self.command(), &self.size, &arguments)
    }

    /// The picture of a run.
    #[track_caller]
    pub fn picture(&self) -> Picture {
        self.run().picture
    }

    /// The picture of a run, shared by tests of this program that request the same one: equal commands give
    /// equal bytes, which [`Chapter::repeats`] checks. Not for files and shaders of a test's own, whose
    /// contents may change under the same name.
    #[track_caller]
    pub fn shared_picture(&self) -> Arc<Picture> {
        /// Pictures, by the name, size and arguments of the run.
        type Shared = HashMap<(String, String, Vec<String>), Arc<OnceLock<Arc<Picture>>>>;
        static SHARED: LazyLock<Mutex<Shared>> = LazyLock::new(Mutex::default);
        assert!(self.shaders.is_none(), "shaders of a test's own are not shared");
        let key = (self.name.clone(), self.size.clone(), self.arguments.clone());
        let mut all = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = Arc::clone(all.entry(key).or_default());
        drop(all);
        Arc::clone(slot.get_or_init(|| Arc::new(self.picture())))
    }

    /// Runs it again, and checks that the picture has the same bits.
    #[track_caller]
    pub fn repeats(&self) {
        assert!(bits(&self.shared_picture()) == bits(&self.picture()), "another picture");
    }

    /// Runs it and compares its picture with the golden one, `tests/golden/NAME.png`.
    ///
    /// The tolerance is that of llvmpipe (Mesa 25.0.7), which made the golden pictures and reproduces them
    /// bit for bit.
    #[track_caller]
    pub fn is_golden(&self) {
        golden(&self.name, &self.shared_picture(), flip::TOLERANCE);
    }
}
