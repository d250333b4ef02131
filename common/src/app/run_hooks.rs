//! Hooks into a run: what instruments see of it, and may change.

use anyhow::Result;
use clap::{ArgMatches, Command};

use super::{Args, Picture, Program, Run};
use crate::gpu::GpuOptions;

/// Hooks into a run, called in the order in which they stand here. `()` has none.
pub trait RunHooks {
    /// Adds options to the command line.
    fn options(&self, command: Command) -> Command {
        command
    }

    /// Reads these options, refuses what is wrong before a device is opened, and changes what is asked for, such
    /// as the files that are written. `false` if nothing is left to do.
    ///
    /// # Errors
    /// With what is wrong.
    fn asked(&mut self, _: &Program, _: &ArgMatches, _: &mut Args) -> Result<bool> {
        Ok(true)
    }

    /// Changes what a device is opened with: features, or the driver's shim.
    fn device(&self, _: &mut GpuOptions) {}

    /// Sees a sample that is made and set; which frames are rendered may still be changed.
    ///
    /// # Errors
    /// Whatever went wrong, here and below.
    fn begin(&mut self, _: &mut Run) -> Result<()> {
        Ok(())
    }

    /// Sees a frame that is done.
    ///
    /// # Errors
    /// As [`RunHooks::begin`].
    fn frame(&mut self, _: &Run, _index: u32) -> Result<()> {
        Ok(())
    }

    /// Sees the end of the last frame; returns the picture of the run, where it is not that frame.
    ///
    /// # Errors
    /// As [`RunHooks::begin`].
    fn end(&mut self, _: &Run) -> Result<Option<Picture>> {
        Ok(None)
    }

    /// Sees a pixel of a window that was clicked with Ctrl held. `trace` traces it alone; the text says what
    /// became of it.
    ///
    /// # Errors
    /// Whatever went wrong, here and in `trace`.
    fn clicked(&self, _trace: &mut dyn FnMut() -> Result<Clicked>) -> Result<Option<String>> {
        Ok(None)
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
