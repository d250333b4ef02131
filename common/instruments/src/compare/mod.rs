//! `--compare`: the cost of a choice. Several values of one control, timed in turn within one run.
//!
//! Times of separate runs vary with the state of the machine. Here every round renders one frame for each value,
//! in an order that changes from round to round, and only times of the same round are divided by each other. The
//! first value is timed twice per round: the ratio of these two times is the noise floor, below which no
//! difference is significant.
//!
//! A small launch keeps a GPU busy for less time than it takes to start one, and its clocks stay low. So values
//! are rendered until their times stop falling, and while one takes less than [`LEAST`], the picture is doubled in
//! width and height, and timed again: more rays of the same kind. The time is not extrapolated from the small
//! picture: that leaves most of the GPU idle, so 64 times the rays may take 12 times as long.

mod comparison;
mod error;

use std::collections::HashMap;
use std::path::PathBuf;

use anyhow::Result;
use ash::vk;
use common::UsageError;
use common::app::{Bands, Progress, Run, controls};
use common::gpu::Image;
use common::output;

pub use comparison::{Comparison, Measured, Ratio};
pub use error::{PictureError, Reference};

/// The shortest launch worth timing, in milliseconds; the picture is enlarged until it takes as long.
const LEAST: f64 = 5.0;
/// The largest factor by which width and height of a picture are enlarged for that.
const WIDEST: u32 = 16;
/// The most pixels of a picture enlarged for that: a gigabyte of four 32-bit floats.
const MOST_PIXELS: u64 = 1 << 26;
/// The most warm-up frames of a value, and the ratio to the shortest time so far below which times still fall.
const WARMING: u32 = 20;
const FALLING: f64 = 0.97;

/// The options of `--compare`.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub struct Options {
    /// Time a control's values in turn for --frames rounds, and print a table
    #[arg(long, value_name = "NAME=A|B|…", conflicts_with_all = ["list_controls", "list_records", "animate", "then"])]
    pub compare: Option<String>,

    /// With --compare: the error of each value's picture after --frames frames, against this one
    #[arg(long, value_name = "FILE.exr", requires = "compare")]
    pub against: Option<PathBuf>,
}

/// Splits `NAME=A|B|C`.
///
/// # Errors
/// If there is no name or fewer than two values.
pub fn parse(text: &str) -> Result<(String, Vec<String>), UsageError> {
    let parts = text.split_once('=');
    let values = |list: &str| list.split('|').map(|value| value.trim().to_owned()).collect();
    match parts.map(|(name, list)| (name.trim().to_owned(), values(list))) {
        Some((name, values)) if !name.is_empty() && Vec::len(&values) > 1 => Ok((name, values)),
        _ => Err(UsageError(format!(
            "--compare needs a control and its values, as NAME=A|B, not '{text}'"
        ))),
    }
}

/// Times the values of a control, with as many rounds as the run has frames, and compares their pictures with the
/// reference, if there is one.
///
/// # Errors
/// If the control does not have a value, or the sample or the device fails.
pub fn of_run(
    run: &mut Run,
    control: &str,
    values: &[String],
    reference: Option<&Reference>,
) -> Result<Comparison> {
    output::warn(&controls::without_effect(std::iter::once(control), |c| run.sample.controls(c)));
    let rounds = run.args.frames;
    let turns = u64::from(rounds) * (values.len() as u64 + 1);
    let mut progress = Progress::new(turns, "frames");
    // The cost per pixel is known for each value.
    let mut bands = HashMap::<_, Bands>::new();
    let mut frames = 0;
    let mut frame = |run: &mut Run, value: &str| {
        frames += 1;
        controls::set_beside(&run.args.sets, control, value, |c| run.sample.controls(c))?;
        let bands = bands.entry(value.to_owned()).or_default();
        if run.sample.forget() {
            // The frame that is timed has a history, and it is that of this value.
            run.time(bands, 0)?;
        }
        run.time(bands, 0)
    };
    // A software driver starts at once, and its clock does not rise: any picture is wide enough.
    let mut asked = None;
    while !run.gpu.software && has_room(run, asked.as_ref()) {
        let mut quickest = LEAST;
        for value in values {
            quickest = quickest.min(warm_up(|| frame(run, value))?);
        }
        if quickest >= LEAST {
            break;
        }
        let [width, height] = twice(run.image.extent);
        let extent = vk::Extent2D { width, height };
        let Ok(wide) = Image::storage(&run.gpu, "wide picture", extent) else { break };
        let before = std::mem::replace(&mut run.image, wide);
        // A chapter may lack memory for so many pixels.
        if values.iter().any(|value| frame(run, value).is_err()) {
            run.image = before;
            break;
        }
        asked.get_or_insert(before);
    }
    let size = asked.as_ref().map(|_| [run.image.extent.width, run.image.extent.height]);
    let mut comparison = compare(control, values, rounds, |value| {
        progress.step();
        frame(run, value)
    })?;
    // Later frames have the requested size again.
    if let Some(asked) = asked {
        run.image = asked;
    }
    (comparison.frames, comparison.widened) = (frames, size);
    if let Some(reference) = reference {
        reference.compare(run, &mut comparison)?;
    }
    // The picture of the run is that of the first value, whichever was timed last.
    controls::set_beside(&run.args.sets, control, &values[0], |c| run.sample.controls(c))?;
    run.sample.forget();
    Ok(comparison)
}

/// True if a picture may be doubled again in width and height; `asked` is the first one, if it was enlarged.
fn has_room(run: &Run, asked: Option<&Image>) -> bool {
    let [width, height] = twice(run.image.extent);
    let first = asked.map_or(run.image.extent, |image| image.extent);
    let side = run.gpu.limits.core.max_image_dimension2_d;
    width.max(height) <= side
        && u64::from(width) * u64::from(height) <= MOST_PIXELS
        && width / first.width <= WIDEST
}

fn twice(extent: vk::Extent2D) -> [u32; 2] {
    [extent.width, extent.height].map(|pixels| pixels.saturating_mul(2))
}

/// Renders frames until their times stop falling; returns the shortest.
fn warm_up(mut frame: impl FnMut() -> Result<f64>) -> Result<f64> {
    let mut least = frame()?;
    for _ in 1..WARMING {
        let took = frame()?;
        let falls = took < FALLING * least;
        least = least.min(took);
        if !falls {
            break;
        }
    }
    Ok(least)
}

/// Times `rounds` rounds; `frame` renders one frame with the value set and returns milliseconds.
///
/// # Errors
/// The first error of `frame`.
pub fn compare(
    control: &str,
    values: &[String],
    rounds: u32,
    mut frame: impl FnMut(&str) -> Result<f64>,
) -> Result<Comparison> {
    // The first value is repeated at the end, for the noise.
    let turns: Vec<&str> = values.iter().chain(&values[..1]).map(String::as_str).collect();
    for value in values {
        warm_up(|| frame(value))?;
    }
    let mut times = vec![Vec::new(); turns.len()];
    for round in 0..rounds as usize {
        for position in 0..turns.len() {
            // Rotated from round to round, and every other round backwards.
            let turn = (position + round) % turns.len();
            let turn = if round % 2 == 0 { turn } else { turns.len() - 1 - turn };
            times[turn].push(frame(turns[turn])?);
        }
    }
    let ratio = |turn: usize| {
        Ratio::of(times[turn].iter().zip(&times[0]).map(|(time, first)| time / first).collect())
    };
    let measured = |(turn, value): (usize, &String)| {
        let mut sorted = times[turn].clone();
        sorted.sort_by(f64::total_cmp);
        let milliseconds = sorted.get(sorted.len() / 2).copied().unwrap_or_default();
        Measured { value: value.clone(), milliseconds, ratio: ratio(turn), ..Measured::default() }
    };
    Ok(Comparison {
        control: control.to_owned(),
        rounds,
        noise: ratio(turns.len() - 1),
        values: values.iter().enumerate().map(measured).collect(),
        ..Comparison::default()
    })
}

#[cfg(test)]
mod tests;
