//! Hooks into a run: instruments use them to observe and change it.

use anyhow::Result;
use clap::{ArgMatches, Command};

use super::{Args, Picture, Program, Run};
use crate::gpu::GpuOptions;

/// Hooks into a run, in the order in which they are called. `()` has none.
pub trait RunHooks {
    /// Adds options to the command line.
    fn options(&self, command: Command) -> Command {
        command
    }

    /// Reads these options, refuses mistakes before a device is opened, and may change the arguments, for example
    /// the output files. Returns `false` if nothing is left to do.
    ///
    /// # Errors
    /// States the mistake.
    fn asked(&mut self, _: &Program, _: &ArgMatches, _: &mut Args) -> Result<bool> {
        Ok(true)
    }

    /// Changes the options for opening the device: features, or the driver shim.
    fn device(&self, _: &mut GpuOptions) {}

    /// True if the run has another result than the picture, for example a report.
    fn has_result(&self) -> bool {
        false
    }

    /// Called with the sample created and its controls set; may still change which frames are rendered.
    ///
    /// # Errors
    /// Any failure of the hook, here and below.
    fn begin(&mut self, _: &mut Run) -> Result<()> {
        Ok(())
    }

    /// Called after each frame.
    ///
    /// # Errors
    /// As [`RunHooks::begin`].
    fn frame(&mut self, _: &Run, _index: u32) -> Result<()> {
        Ok(())
    }

    /// Called after the last frame; returns the picture of the run, if it is not that frame.
    ///
    /// # Errors
    /// As [`RunHooks::begin`].
    fn end(&mut self, _: &Run) -> Result<Option<Picture>> {
        Ok(None)
    }

    /// Called when a pixel in the window is clicked with Ctrl held. `trace` traces that pixel alone; returns the
    /// text to show.
    ///
    /// # Errors
    /// Any failure, here and in `trace`.
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
    /// The names of the passes after the first, which `--pixel` does not run.
    pub passes: Vec<&'static str>,
}
