//! What each effect costs: the picture's time with it, less the time without.

use anyhow::Result;
use common::gpu::{Gpu, Timer, barrier};
use common::scene::{Effect, Effects};

/// Rounds of a measurement, after one that warms up.
const ROUNDS: usize = 5;

/// What an effect costs.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// Which.
    pub effect: Effect,
    /// Milliseconds: the median of the rounds' differences.
    pub milliseconds: f64,
    /// The time without it over the time with it.
    pub ratio: f64,
}

// ANCHOR: measure
/// Times the picture with all of `effects` and without each of them, in turns. `trace` records it.
///
/// # Errors
/// If a pipeline cannot be made, or the device fails.
pub fn measure(
    gpu: &Gpu,
    effects: Effects,
    mut trace: impl FnMut(ash::vk::CommandBuffer, Effects) -> Result<()>,
) -> Result<Vec<Cost>> {
    let timer = Timer::new(gpu)?;
    let mut time = |effects| -> Result<f64> {
        gpu.submit(|cmd| {
            timer.start(cmd);
            trace(cmd, effects)?;
            timer.stop(cmd);
            barrier::trace_to_trace(gpu, cmd);
            Ok(())
        })?;
        timer.milliseconds()
    };
    let left_out: Vec<Effect> = Effect::ALL.into_iter().filter(|&e| effects.has(e)).collect();
    let mut rounds = vec![Vec::new(); left_out.len()];
    for round in 0..=ROUNDS {
        let all = time(effects)?;
        for (effect, times) in left_out.iter().zip(&mut rounds) {
            let without = time(effects.without(*effect))?;
            if round > 0 {
                times.push((all - without, without / all));
            }
        }
    }
    let median = |mut values: Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let costs = left_out.into_iter().zip(rounds).map(|(effect, times)| Cost {
        effect,
        milliseconds: median(times.iter().map(|time| time.0).collect()),
        ratio: median(times.iter().map(|time| time.1).collect()),
    });
    Ok(costs.collect())
}
// ANCHOR_END: measure
