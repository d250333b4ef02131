//! A bar on standard error that shows how far a long run has come.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// How long a run may take before it shows its progress.
const PATIENCE: Duration = Duration::from_secs(1);

/// A bar that appears once the run has taken a while, if someone can see it.
pub struct Progress {
    bar: ProgressBar,
    start: Instant,
}

impl Progress {
    /// A bar of so many steps; `what` says of what.
    pub fn new(steps: u64, what: &str) -> Self {
        let bar = ProgressBar::hidden();
        bar.set_length(steps);
        let template = format!("{{bar:40}} {{pos}}/{{len}} {what}, {{eta}} left");
        let style = ProgressStyle::with_template(&template);
        let bar = style.map_or(bar.clone(), |style| bar.with_style(style));
        Self { bar, start: Instant::now() }
    }

    /// One step is done.
    pub fn step(&self) {
        let visible = self.start.elapsed() > PATIENCE && std::io::stderr().is_terminal();
        if self.bar.is_hidden() && visible {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        self.bar.inc(1);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
