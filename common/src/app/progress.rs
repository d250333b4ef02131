//! A progress bar on standard error for long runs.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Delay before the progress bar appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// A bar that appears after a delay, if standard error is a terminal.
pub struct Progress {
    steps: u64,
    done: u64,
    /// Name of the steps.
    what: &'static str,
    start: Instant,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// A bar of so many steps, none of them done.
    pub fn new(steps: u64, what: &'static str) -> Self {
        Self { steps, done: 0, what, start: Instant::now(), bar: None }
    }

    /// Marks one step as done.
    pub fn step(&mut self) {
        self.done += 1;
        if self.bar.is_none() && self.start.elapsed() > PATIENCE && std::io::stderr().is_terminal()
        {
            self.bar = Some(self.shown());
        }
        self.bar.iter().for_each(|bar| bar.set_position(self.done));
    }

    fn shown(&self) -> ProgressBar {
        let bar = ProgressBar::with_draw_target(Some(self.steps), ProgressDrawTarget::stderr());
        let template = format!("{{bar:40}} {{pos}}/{{len}} {}, {{eta}} left", self.what);
        let style = ProgressStyle::with_template(&template);
        let bar = style.map_or(bar.clone(), |style| bar.with_style(style));
        // Estimate the remaining time from all steps, not only from those since the bar appeared.
        bar.with_elapsed(self.start.elapsed())
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.iter().for_each(ProgressBar::finish_and_clear);
    }
}
