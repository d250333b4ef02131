//! The delay between an input and the frame that shows its effect.

use std::time::{Duration, Instant};

/// Measures these delays.
///
/// Input that arrives while a frame is drawn is seen only after it, so it is assumed to have arrived right after
/// the frame before: an upper bound while input keeps arriving. A single key pressed while a slow frame is drawn
/// is counted from the end of that frame, which is too short.
#[derive(Default)]
pub struct Lag {
    /// The longest delay so far.
    pub longest: Duration,
    awake: Option<Instant>,
    asleep: Option<Instant>,
    pending: bool,
}

impl Lag {
    /// The event loop goes to sleep.
    pub fn sleep(&mut self) {
        self.asleep = Some(Instant::now());
    }

    /// The event loop wakes up.
    pub fn wake(&mut self) {
        let now = Instant::now();
        let slept = self.asleep.take().is_some_and(|at| now - at > Duration::from_millis(2));
        if slept && !self.pending {
            self.awake = Some(now);
        }
    }

    /// Input has arrived.
    pub fn input(&mut self) {
        self.pending = true;
    }

    /// A frame is shown; returns how long the last one was visible, minus the time asleep.
    pub fn present(&mut self) -> Duration {
        let now = Instant::now();
        let waited = self.awake.map_or(Duration::ZERO, |awake| now - awake);
        if self.pending {
            self.longest = self.longest.max(waited);
        }
        (self.awake, self.pending) = (Some(now), false);
        waited
    }
}
