//! Which frame of an animation is shown, and whether it goes on.
//!
//! What is shown follows from the number of the frame alone, never from a clock: a clock only decides, in a
//! window, which frame is next. So frame 600 is the same picture whether it was played, stepped or jumped to.

use std::time::Instant;

/// The frame of an animation: 60 are a second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Playback {
    /// The frame that is shown.
    pub frame: u32,
    /// The last there is; playing ends there.
    pub last: u32,
    /// Whether it goes on: with every frame that is rendered without a window, with time in one.
    pub playing: bool,
}

impl Playback {
    /// Frames a second.
    pub const RATE: u32 = 60;

    /// An animation that plays from its first frame.
    pub fn new(last: u32) -> Self {
        Self { frame: 0, last, playing: true }
    }

    /// Goes on by so many frames if it plays; whether another frame is shown now.
    pub fn advance(&mut self, frames: u32) -> bool {
        if !self.playing {
            return false;
        }
        let before = self.frame;
        self.frame = self.frame.saturating_add(frames).min(self.last);
        self.playing = self.frame < self.last;
        self.frame != before
    }

    /// Plays, from the first frame if the last is shown; or pauses.
    pub fn toggle(&mut self) {
        self.playing = !self.playing;
        if self.playing && self.frame >= self.last {
            self.frame = 0;
        }
    }

    /// Pauses, and goes forward by a number of frames, or back if it is negative.
    pub fn step(&mut self, frames: i32) {
        self.playing = false;
        self.frame = self.frame.saturating_add_signed(frames).min(self.last);
    }
}

/// Counts the frames that pass in a window.
#[derive(Default)]
pub struct Clock {
    since: Option<Instant>,
    counted: u64,
}

impl Clock {
    /// The most frames at once, a quarter of a second: a window that was hidden goes on where it was.
    const MOST: u64 = 15;

    /// How many frames have passed since it was last asked.
    pub fn frames(&mut self, now: Instant) -> u32 {
        let since = *self.since.get_or_insert(now);
        let passed = (now.duration_since(since).as_secs_f64() * f64::from(Playback::RATE)) as u64;
        let frames = passed.saturating_sub(self.counted).min(Self::MOST);
        self.counted = passed;
        frames as u32
    }

    /// Lets an animation that plays go on as time does; whether another frame is shown now.
    pub fn advance(&mut self, playback: Option<&mut Playback>, now: Instant) -> bool {
        let Some(playback) = playback.filter(|playback| playback.playing) else {
            self.stop();
            return false;
        };
        playback.advance(self.frames(now))
    }

    /// Time stands still until it is asked again.
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
