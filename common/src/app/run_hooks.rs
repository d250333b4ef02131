//! What may watch a run: instruments, each with options of its own.

use std::path::Path;

use anyhow::Result;

use super::{Args, Picture, Run};
use crate::gpu::{Gpu, GpuOptions};

/// What sees each frame of a run, and its end. `()` watches nothing.
///
/// The methods are called in the order in which they stand here.
pub trait RunHooks {
    /// Whether a window would be of no use to what was asked for.
    fn needs_no_window(&self) -> bool {
        false
    }

    /// The files that are read and written besides those of [`Args`], each with its option.
    fn files(&self) -> Files<'_> {
        Files::default()
    }

    /// Changes what a device is opened with: features that are asked for, the driver that is emulated.
    fn device(&self, _: &mut GpuOptions) {}

    /// A device is opened, and nothing is made on it yet.
    ///
    /// # Errors
    /// Whatever went wrong.
    fn opened(&self, _: &Gpu) -> Result<()> {
        Ok(())
    }

    /// In a window, a pixel was clicked with Ctrl held: what may have `trace` trace it alone, and then says what
    /// became of it.
    ///
    /// # Errors
    /// Whatever went wrong, here and in `trace`.
    fn clicked(&self, _trace: &mut dyn FnMut() -> Result<Clicked>) -> Result<Option<String>> {
        Ok(None)
    }

    /// Refuses what is known to be wrong before a device is opened.
    ///
    /// # Errors
    /// With what is wrong.
    fn check(&mut self, _: &Args) -> Result<()> {
        Ok(())
    }

    /// The sample is made and set; which frames are rendered may still be changed.
    ///
    /// # Errors
    /// Whatever went wrong, here and below.
    fn begin(&mut self, _: &mut Run) -> Result<()> {
        Ok(())
    }

    /// A band of a frame is done, and perhaps not the last.
    ///
    /// # Errors
    /// As [`RunHooks::begin`]; then no further one is traced.
    fn band(&mut self) -> Result<()> {
        Ok(())
    }

    /// A frame is done.
    ///
    /// # Errors
    /// As [`RunHooks::begin`].
    fn frame(&mut self, _: &Run, _index: u32) -> Result<()> {
        Ok(())
    }

    /// The last frame is done; the picture of the run, where it is not that frame.
    ///
    /// # Errors
    /// As [`RunHooks::begin`].
    fn picture(&mut self, _: &Run) -> Result<Option<Picture>> {
        Ok(None)
    }

    /// The picture is written.
    ///
    /// # Errors
    /// As [`RunHooks::begin`].
    fn end(&mut self, _: &Run) -> Result<()> {
        Ok(())
    }
}

impl RunHooks for () {}

/// A pixel that was traced alone in a window.
pub struct Clicked {
    /// Its column and row.
    pub pixel: [u32; 2],
    /// Columns and rows of the picture.
    pub size: [u32; 2],
}

/// Files, each with the option that names it.
#[derive(Default)]
pub struct Files<'a> {
    /// What is read.
    pub inputs: Vec<(&'static str, &'a Path)>,
    /// What is written.
    pub outputs: Vec<(&'static str, &'a Path)>,
    /// The options of an input and an output that may be one file: it is brought up to date.
    pub updated: Option<(&'static str, &'static str)>,
}
