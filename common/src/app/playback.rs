//! The frame of an animation, and its playback.
//!
//! The picture depends only on the number of the frame, never on a clock: in a window, a clock decides which frame
//! comes next. So frame 600 is the same picture whether it was played, stepped or jumped to.

use std::time::Instant;

/// The frame of an animation, at 60 per second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Playback {
    /// The current frame.
    pub frame: u32,
    /// The last frame; playback stops there.
    pub last: u32,
    /// True while playing: by one frame per rendered frame without a window, in real time with one.
    pub playing: bool,
}

impl Playback {
    /// Frames per second.
    pub const RATE: u32 = 60;

    /// An animation that plays from its first frame.
    pub fn new(last: u32) -> Self {
        Self { frame: 0, last, playing: true }
    }

    /// Advances by so many frames if it plays; returns true if the frame has changed.
    pub fn advance(&mut self, frames: u32) -> bool {
        if !self.playing {
            return false;
        }
        let before = self.frame;
        self.frame = self.frame.saturating_add(frames).min(self.last);
        self.playing = self.frame < self.last;
        self.frame != before
    }

    /// Starts playback, from the first frame if the last is shown; or pauses it.
    pub fn toggle(&mut self) {
        self.playing = !self.playing;
        if self.playing && self.frame >= self.last {
            self.frame = 0;
        }
    }

    /// Pauses, and steps forward by a number of frames, or back if it is negative.
    pub fn step(&mut self, frames: i32) {
        self.playing = false;
        self.frame = self.frame.saturating_add_signed(frames).min(self.last);
    }
}

/// Counts the frames that pass in real time.
#[derive(Default)]
pub struct Clock {
    since: Option<Instant>,
    counted: u64,
}

impl Clock {
    /// The most frames at once, a quarter of a second: a window that was hidden continues where it was.
    const MOST: u64 = 15;

    /// Number of frames since the last call.
    pub fn frames(&mut self, now: Instant) -> u32 {
        let since = *self.since.get_or_insert(now);
        let passed = (now.duration_since(since).as_secs_f64() * f64::from(Playback::RATE)) as u64;
        let frames = passed.saturating_sub(self.counted).min(Self::MOST);
        self.counted = passed;
        frames as u32
    }

    /// Advances a playing animation in real time; returns true if the frame has changed.
    pub fn advance(&mut self, playback: Option<&mut Playback>, now: Instant) -> bool {
        let Some(playback) = playback.filter(|playback| playback.playing) else {
            self.stop();
            return false;
        };
        playback.advance(self.frames(now))
    }

    /// Stops the clock until the next call.
    pub fn stop(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn it_plays_to_its_end_and_then_from_the_start() {
        let mut playback = Playback::new(10);
        assert!(playback.advance(7) && playback.frame == 7 && playback.playing);
        assert!(playback.advance(u32::MAX) && playback.frame == 10 && !playback.playing);
        assert!(!playback.advance(1));
        playback.toggle();
        assert_eq!(playback, Playback::new(10));
    }

    #[test]
    fn a_step_pauses_and_stays_within() {
        let mut playback = Playback::new(10);
        playback.step(-1);
        assert_eq!(playback, Playback { frame: 0, last: 10, playing: false });
        playback.step(99);
        assert_eq!(playback.frame, 10);
        assert!(!playback.advance(1), "it is paused");
    }

    #[test]
    fn a_clock_counts_every_frame_once_and_no_long_break() {
        let (mut clock, start) = (Clock::default(), Instant::now());
        let times = (0..=100).map(|i| start + Duration::from_millis(7 * i));
        let counted: u32 = times.map(|now| clock.frames(now)).sum();
        assert_eq!(counted, 42, "0.7 seconds");
        assert_eq!(clock.frames(start + Duration::from_secs(60)), 15);
        clock.stop();
        assert_eq!(clock.frames(start + Duration::from_secs(99)), 0);
    }
}
