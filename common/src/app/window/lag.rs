//! The delay between an input and the frame that shows its effect.

use std::time::{Duration, Instant};

/// Waits, measured.
///
/// Input that came while a frame was drawn is seen after it, so it is taken to have come right after
/// the frame before: an upper bound while input keeps coming. A single key that comes while a slow frame
/// is drawn is counted from the end of that frame, which is too short.
#[derive(Default)]
pub struct Lag {
    /// The longest wait so far.
    pub longest: Duration,
    awake: Option<Instant>,
    asleep: Option<Instant>,
    pending: bool,
}

impl Lag {
    /// The event loop has nothing left to do.
    pub fn sleep(&mut self) {
        self.asleep = Some(Instant::now());
    }

    /// It goes on.
    pub fn wake(&mut self) {
        let now = Instant::now();
        let slept = self.asleep.take().is_some_and(|at| now - at > Duration::from_millis(2));
        if slept && !self.pending {
            self.awake = Some(now);
        }
    }

    /// Input has come.
    pub fn input(&mut self) {
        self.pending = true;
    }

    /// A frame is shown; returns how long the last one stood, less the time asleep.
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
