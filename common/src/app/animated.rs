//! An animated PNG of a run's frames, each stored as its difference from the one before.
//!
//! A viewer without animation support shows the first frame (PNG specification, third edition, *APNG*).

use std::cell::RefCell;
use std::io::{self, Write};
use std::path::Path;
use std::rc::Rc;

use anyhow::{Context, Result, ensure};
use png::{BlendOp, ColorType, Compression, Encoder, Writer};

use super::{Args, Format, Picture, Playback, Run};
use crate::UsageError;
use crate::files::write_whole;
use crate::{output, paths};

/// The most frames, a minute's worth: all are held in memory until the last one arrives.
const MOST: u32 = 60 * Playback::RATE;

/// An animated PNG under construction. The same frames give the same bytes.
pub struct Animated {
    writer: Writer<Sink>,
    sink: Sink,
    /// Width, height and pixels of the last frame; none before the first.
    last: Option<(u32, u32, Vec<[u8; 3]>)>,
    /// True if a frame differs from the one before.
    moves: bool,
}

/// The encoder's output. The bytes outlive the encoder.
#[derive(Clone, Default)]
struct Sink(Rc<RefCell<Vec<u8>>>);

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Refuses `--animate` where the options would produce no file of frames.
///
/// # Errors
/// [`UsageError`], with what would be right.
pub fn check(args: &Args) -> Result<(), UsageError> {
    let wrong = |what: String| Err(UsageError(what));
    if !args.animate {
        return Ok(());
    }
    let Some(out) = &args.out else {
        return wrong("--animate writes a file: name it, --out FILE.png".to_owned());
    };
    if Format::of(out)? != Format::Png {
        return wrong(format!("'{}' does not move: --animate writes a .png", out.display()));
    }
    if !args.frames_given {
        return wrong(
            "--animate shows one frame after the other: say how many, --frames N".to_owned(),
        );
    }
    if args.frames < 2 {
        return wrong("--animate needs two frames or more: --frames N; not 1".to_owned());
    }
    if args.frames > MOST {
        let frames = args.frames;
        return wrong(format!("--animate takes at most {MOST} frames, a minute; not {frames}"));
    }
    Ok(())
}

impl Animated {
    /// Begins the animation that a run is to write.
    ///
    /// # Errors
    /// [`UsageError`] if the sample has nothing that moves.
    pub fn begin(run: &mut Run) -> Result<Self> {
        let converges = run.sample.accumulates();
        match run.sample.playback() {
            Some(playback) if playback.playing => {}
            Some(_) => {
                let what = "--animate shows what is played, and play=off stops it: leave that out";
                return Err(UsageError(what.to_owned()).into());
            }
            // A program of another crate may move things by the frame's number; `save` tells if it does not.
            None if paths::folder().is_some() => {}
            // Its frames differ: they converge, or move by the frame's number.
            None if converges => {}
            None => {
                let what = "--animate is for chapters that play frames, as 14 does, or converge, as 11 does";
                let line = format!("{} shows nothing that moves: {what}", run.name);
                return Err(UsageError(line).into());
            }
        }
        Self::new(run.args.size.width, run.args.size.height, run.args.frames)
    }

    fn new(width: u32, height: u32, count: u32) -> Result<Self> {
        let sink = Sink::default();
        let mut encoder = Encoder::new(sink.clone(), width, height);
        encoder.set_color(ColorType::Rgba);
        encoder.set_compression(Compression::High);
        // Zero plays: repeat for ever.
        encoder.set_animated(count, 0)?;
        encoder.set_frame_delay(1, Playback::RATE as u16)?;
        encoder.set_blend_op(BlendOp::Over)?;
        encoder.validate_sequence(true);
        Ok(Self { writer: encoder.write_header()?, sink, last: None, moves: false })
    }

    /// Adds a frame.
    ///
    /// # Errors
    /// If there are more frames than announced, or one differs in size.
    pub fn add(&mut self, picture: &Picture) -> Result<()> {
        let (width, height) = (picture.width, picture.height);
        let pixels: Vec<[u8; 3]> = picture.srgb().as_chunks().0.to_vec();
        let [left, top, right, bottom] = match &self.last {
            None => [0, 0, width, height],
            Some((w, h, before)) => {
                ensure!((*w, *h) == (width, height), "the frames of an animation differ in size");
                self.moves |= *before != pixels;
                changed(before, &pixels, width)
            }
        };
        let mut bytes = Vec::new();
        for at in (top..bottom).flat_map(|y| (left..right).map(move |x| (y * width + x) as usize)) {
            let same = self.last.as_ref().is_some_and(|(.., before)| before[at] == pixels[at]);
            // Unchanged pixels are transparent; zeros compress best.
            bytes.extend(if same {
                [0; 4]
            } else {
                [pixels[at][0], pixels[at][1], pixels[at][2], 255]
            });
        }
        self.writer.reset_frame_position()?;
        self.writer.set_frame_dimension(right - left, bottom - top)?;
        self.writer.set_frame_position(left, top)?;
        self.writer.write_image_data(&bytes)?;
        self.last = Some((width, height, pixels));
        Ok(())
    }

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// If frames are missing, or the file cannot be written.
    pub fn save(self, path: &Path) -> Result<()> {
        if !self.moves {
            let still = "all frames are the same; what moves follows frame.index or a Playback";
            output::warn(&[format!("'{}': {still}", path.display())]);
        }
        let bytes = self.bytes().with_context(|| format!("cannot encode '{}'", path.display()))?;
        write_whole(path, &bytes)
    }

    fn bytes(self) -> Result<Vec<u8>> {
        self.writer.finish()?;
        Ok(self.sink.0.take())
    }
}

/// Left, top, right and bottom of the region that differs between two frames; one pixel if nothing does, because a
/// frame cannot be empty.
fn changed(before: &[[u8; 3]], now: &[[u8; 3]], width: u32) -> [u32; 4] {
    let places = (0u32..).zip(before.iter().zip(now)).filter(|(_, (before, now))| before != now);
    let places = places.map(|(at, _)| (at % width, at / width));
    let around = places.fold(None, |around: Option<[u32; 4]>, (x, y)| {
        let [left, top, right, bottom] = around.unwrap_or([x, y, x + 1, y + 1]);
        Some([left.min(x), top, right.max(x + 1), bottom.max(y + 1)])
    });
    around.unwrap_or([0, 0, 1, 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grey square that moves to the right, and stays where it is in the third frame.
    fn frame(at: u32) -> Picture {
        let pixel = |(x, y): (u32, u32)| {
            let inside = (at..at + 3).contains(&x) && (2..5).contains(&y);
            [if inside { 0.5 } else { 0.0 }, 0.1 * y as f32, 0.2, 1.0]
        };
        let places = (0..8).flat_map(|y| (0..16).map(move |x| (x, y)));
        Picture { width: 16, height: 8, pixels: places.map(pixel).collect() }
    }

    fn encoded() -> Vec<u8> {
        let mut animated = Animated::new(16, 8, 3).unwrap();
        [1, 4, 4].into_iter().for_each(|at| animated.add(&frame(at)).unwrap());
        animated.bytes().unwrap()
    }

    /// As a viewer shows it, each frame is the whole picture; only what changed is stored of it.
    #[test]
    fn a_viewer_sees_each_frame() {
        let mut reader = png::Decoder::new(std::io::Cursor::new(encoded())).read_info().unwrap();
        assert_eq!(reader.info().animation_control().unwrap().num_frames, 3);
        let mut shown = vec![0u8; 16 * 8 * 3];
        for (at, area) in [(1, [0, 0, 16, 8]), (4, [1, 2, 6, 3]), (4, [0, 0, 1, 1])] {
            let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
            let size = reader.next_frame(&mut pixels).unwrap();
            let of = *reader.info().frame_control().unwrap();
            assert_eq!([of.x_offset, of.y_offset, of.width, of.height], area);
            assert_eq!((of.delay_num, u32::from(of.delay_den)), (1, Playback::RATE));
            let rows = (0..size.height).flat_map(|y| (0..size.width).map(move |x| (x, y)));
            for ((x, y), pixel) in rows.zip(pixels.as_chunks::<4>().0) {
                let to = 3 * ((y + of.y_offset) * 16 + x + of.x_offset) as usize;
                if pixel[3] == 255 {
                    shown[to..to + 3].copy_from_slice(&pixel[..3]);
                }
            }
            assert_eq!(shown, frame(at).srgb());
        }
    }

    #[test]
    fn the_same_frames_give_the_same_bytes() {
        assert_eq!(encoded(), encoded());
    }

    #[test]
    fn a_frame_too_few_or_of_another_size_is_refused() {
        let mut animated = Animated::new(16, 8, 2).unwrap();
        animated.add(&frame(1)).unwrap();
        let small = Picture { width: 8, height: 16, ..frame(1) };
        assert!(animated.add(&small).unwrap_err().to_string().contains("differ in size"));
        assert!(animated.bytes().is_err(), "its second frame is missing");
    }
}
