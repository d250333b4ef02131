//! The steps of a survey: what is run, in which order, and how far it has come.

use std::time::{Duration, Instant};

use anyhow::Result;
use common::output::print;
use indicatif::{ProgressBar, ProgressStyle};
use manuscript::project::Chapter;
use time_limit::Limit;

/// One step, which is one line of the progress.
pub enum Step<'a> {
    /// A run of chapter 24: its name in the progress lines, and its arguments.
    Laboratory(&'static str, Vec<String>),
    Chapter(&'a Chapter),
    /// The rows of `docs/prices.md` that come from one stored measurement.
    Price(String),
}

impl Step<'_> {
    /// Its name in the progress lines and on the card.
    pub fn name(&self) -> String {
        match self {
            Self::Laboratory(what, _) => (*what).to_owned(),
            Self::Chapter(chapter) => chapter.name.clone(),
            Self::Price(record) => format!("price {record}"),
        }
    }
}

/// The time that a survey may take, from its beginning.
#[derive(Clone, Copy)]
pub struct Allowance {
    start: Instant,
    /// `None` for as long as it takes.
    time: Option<Duration>,
}

impl Allowance {
    /// An allowance that begins now.
    pub fn new(time: Option<Duration>) -> Self {
        Self { start: Instant::now(), time }
    }

    /// True once the time is over.
    pub fn is_over(&self) -> bool {
        self.time.is_some_and(|time| self.start.elapsed() >= time)
    }

    /// The limit of a program that must not outlast the survey.
    pub fn within(&self, limit: Limit) -> Limit {
        let left =
            self.time.map_or(Duration::MAX, |time| time.saturating_sub(self.start.elapsed()));
        Limit { clock: limit.clock.min(left), ..limit }
    }
}

/// The progress: a line per step on standard output, and below them a bar on standard error if that is a terminal.
pub struct Progress {
    bar: ProgressBar,
    all: usize,
    done: usize,
}

impl Progress {
    /// No step of so many is done.
    ///
    /// # Errors
    /// If the form of the bar is invalid.
    pub fn new(all: usize) -> Result<Self> {
        let bar = ProgressBar::new(all as u64);
        let form = "{bar:30} {pos}/{len} {msg}, {elapsed} so far, about {eta} more";
        bar.set_style(ProgressStyle::with_template(form)?);
        bar.enable_steady_tick(Duration::from_secs(1));
        Ok(Self { bar, all, done: 0 })
    }

    /// The name of the step that runs now.
    pub fn begin(&self, name: &str) {
        self.bar.set_message(name.to_owned());
    }

    /// Prints the result of a step.
    ///
    /// # Errors
    /// If standard output is closed.
    pub fn end(&mut self, name: &str, result: &str) -> Result<()> {
        self.done += 1;
        let line = format!("[{}/{}] {name}: {result}\n", self.done, self.all);
        self.bar.suspend(|| print(&line))?;
        self.bar.inc(1);
        Ok(())
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_program_outlasts_the_survey() {
        let limit = Limit::waited(Duration::from_secs(60));
        assert_eq!(Allowance::new(None).within(limit), limit);
        assert!(!Allowance::new(None).is_over());
        let over = Allowance::new(Some(Duration::ZERO));
        assert!(over.is_over() && over.within(limit).clock == Duration::ZERO);
        let long = Allowance::new(Some(Duration::from_secs(3600)));
        assert!(!long.is_over() && long.within(limit) == limit);
    }
}
