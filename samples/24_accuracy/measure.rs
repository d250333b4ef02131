//! Price of accuracy: every rung on seeded random families, errors and time in one run.

use std::time::SystemTime;

use anyhow::Result;
use common::app::Progress;
use common::gpu::Gpu;
use instruments::compare;
use reference::ulp::ulp_error;

use crate::batch::Batch;
use crate::compiled;
use crate::families::{Draw, Family};
use crate::geometry;
use crate::judge::ExpectedHit;
use crate::ladder::{Code, Primitive, Rung};
use crate::measurement::{Errors, FAR_OFF, March, MeasuredRung, Measurement, Time};
use crate::probe::{Instrument, Load, Probe, Way};
use crate::query::Answer;

/// Least time of a launch that is worth timing, in milliseconds; a software driver begins at once.
const LEAST: f64 = 5.0;
const LEAST_ON_SOFTWARE: f64 = 2.0;
/// And how many the dearest rung may take: a system takes a device that is silent for two seconds for lost.
const MOST: f64 = 500.0;
/// The largest number of queries per invocation, enough to make the launch cost negligible.
const MOST_REPEATS: u32 = 256;
const MOST_REPEATS_ON_A_GPU: u32 = 16;
/// The most invocations for each query, and in all.
const MOST_COPIES: u32 = 1024;
const MOST_ASKED: u32 = 1 << 24;

/// The measurements to make.
pub struct Plan<'a> {
    /// Rungs of these primitives; of all if there are none.
    pub only: &'a [Primitive],
    /// Those alone that must be right.
    pub tops: bool,
    /// Neither a GPU compiler's estimates nor the sphere's meshes.
    pub rungs_alone: bool,
    pub draw: Draw,
    /// Rounds of timing.
    pub rounds: u32,
}

/// Measures what is planned: errors of every rung, then times.
///
/// # Errors
/// If the device fails.
pub fn measure(gpu: &Gpu, plan: &Plan) -> Result<Measurement> {
    let &Plan { only, tops, rungs_alone, draw, rounds } = plan;
    let probe = Probe::new(gpu)?;
    let mut rungs = Vec::new();
    let chosen: Vec<Primitive> = Primitive::ALL
        .into_iter()
        .filter(|primitive| only.is_empty() || only.contains(primitive))
        .collect();
    let steps: usize = chosen.iter().map(|p| p.ladder().len()).sum();
    let families = if rungs_alone { 0 } else { compiled::FAMILIES.len() };
    let mut progress = Progress::new((2 * steps + families) as u64, "steps");
    for primitive in chosen {
        let families = Family::of(primitive, draw);
        let batches = families
            .iter()
            .map(|family| Batch::new(gpu, &family.shapes, &family.rays, family.is_traced));
        let batches = batches.collect::<Result<Vec<_>>>()?;
        let mut measured = Vec::new();
        let ladder = primitive.ladder().iter().filter(|rung| !tops || rung.is_held(gpu));
        let ladder: Vec<&Rung> = ladder.collect();
        for rung in &ladder {
            measured.push(errors(gpu, &probe, primitive, rung, &families, &batches)?);
            progress.step();
        }
        if rounds > 0 {
            let known = |family: &Family| family.name;
            for (family, batch) in families.iter().map(known).zip(&batches) {
                let times = times(&probe, primitive, &ladder, batch, rounds, &measured)?;
                for (row, time) in measured.iter_mut().zip(times) {
                    row.time = row.time.or(time);
                    let march = time.map(|time| March { family, ratio: time.ratio });
                    row.marches.extend(march.filter(|_| primitive == Primitive::Heightfield));
                }
                if primitive != Primitive::Heightfield {
                    break;
                }
            }
            primitive.ladder().iter().for_each(|_| progress.step());
        }
        rungs.extend(measured);
    }
    let no_compiler = if rungs_alone {
        Some(String::from("not asked for"))
    } else if gpu.driver_shim.name() != "driver" {
        Some(String::from("no GPU computes as badly as it may"))
    } else {
        compiled::compile(&mut rungs, &mut progress).err().map(|why| format!("{why:#}"))
    };
    let compiler = rungs.iter().find_map(|row| row.compiled_for.first());
    let compiler = compiler.map(|compiled| compiled.program.compiler.clone());
    let has_spheres = only.is_empty() || only.contains(&Primitive::Sphere);
    let forms = if has_spheres && !tops && !rungs_alone {
        geometry::measure(gpu, rounds)?
    } else {
        Vec::new()
    };
    Ok(Measurement {
        device: gpu.name.clone(),
        driver: gpu.driver.clone(),
        arithmetic: gpu.driver_shim.name().to_owned(),
        date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string()[..10].to_owned(),
        fused: probe.fused,
        rays: draw.rays,
        seed: draw.seed,
        rounds,
        compiler,
        no_compiler,
        rungs,
        forms,
        stages: gpu.statistics().stages().into_iter().collect(),
        validation_messages: gpu.validation().all(),
    })
}

fn errors(
    gpu: &Gpu,
    probe: &Probe,
    primitive: Primitive,
    rung: &Rung,
    families: &[Family],
    batches: &[Batch],
) -> Result<MeasuredRung> {
    let mut measured = MeasuredRung {
        primitive: primitive.name(),
        rung: rung.label,
        name: rung.name,
        unavailable: rung.unavailable(gpu),
        errors: Vec::new(),
        time: None,
        marches: Vec::new(),
        compiled_for: Vec::new(),
        desc: None,
    };
    if measured.unavailable.is_some() {
        return Ok(measured);
    }
    for way in [Way::Direct, Way::Traced] {
        let has_way = match way {
            Way::Direct => rung.code != Code::Device,
            Way::Traced => families.iter().any(|family| family.is_traced),
        };
        if !has_way {
            continue;
        }
        let instrument = probe.instrument(primitive, rung, way)?;
        if way == Way::Direct {
            measured.desc = Some(instrument.desc());
        }
        for (family, batch) in families.iter().zip(batches) {
            if way == Way::Direct || family.is_traced {
                let answers = probe.ask(&instrument, batch)?;
                measured.errors.push(tally(family, way, &answers));
            }
        }
    }
    Ok(measured)
}

/// Compares a family's answers with the truth.
pub fn tally(family: &Family, way: Way, answers: &[Answer]) -> Errors {
    let way_name = if way == Way::Direct { "direct" } else { "traced" };
    let mut errors =
        Errors { family: family.name, way: way_name, rays: answers.len(), ..Errors::default() };
    let mut ulps = Vec::new();
    for (answer, expected) in answers.iter().zip(&family.expected) {
        let finite = answer.t.is_finite() && answer.normal.is_finite() && answer.point.is_finite();
        errors.not_finite += usize::from(!finite);
        // A sum has no hits, but always a result.
        let hit = answer.hit != 0 || family.shapes[0].primitive() == Primitive::Accumulation;
        match (expected.hit == ExpectedHit::Yes, hit) {
            (true, true) => {
                let t = expected.t.expect("a hit has its t");
                ulps.push(ulp_error(answer.t, t));
                let is_known = expected.count.filter(|_| way == Way::Direct);
                errors.miscounted += usize::from(is_known.is_some_and(|n| n != answer.count));
            }
            (true, false) if way == Way::Traced && answer.offered == 0 => errors.never_offered += 1,
            (true, false) => errors.false_misses += 1,
            (false, true) => errors.false_hits += 1,
            (false, false) => {}
        }
    }
    ulps.sort_by(f64::total_cmp);
    let at = |part: f64| {
        let last = ulps.len().saturating_sub(1) as f64;
        ulps.get((part * last).round() as usize).copied().unwrap_or_default()
    };
    let far_off = ulps.iter().filter(|&&ulp| ulp > FAR_OFF).count();
    Errors { p50: at(0.5), p99: at(0.99), max: at(1.0), far_off, ..errors }
}

/// The repetitions of each query for a launch that is worth timing, and the cheapest rung.
fn enough(
    probe: &Probe,
    instruments: &[(&Rung, Instrument)],
    batch: &Batch,
) -> Result<(Load, usize)> {
    // The first time goes to the driver's compiler. Of the others the best, as whatever disturbs a launch
    // makes it slower.
    let best = |load: Load| {
        let least = |(_, instrument): &(&Rung, Instrument)| {
            let times = (0..=20).map(|_| probe.time(instrument, batch, load));
            let times = times.collect::<Result<Vec<_>>>()?;
            Ok(times.into_iter().skip(1).fold(f64::INFINITY, f64::min))
        };
        instruments.iter().map(least).collect::<Result<Vec<_>>>()
    };
    let mut load = Load::ONCE;
    let mut times = best(load)?;
    let least = |times: &[f64]| times.iter().copied().fold(f64::INFINITY, f64::min);
    let times_more = |from: f64, to: f64| (to / from.max(1e-3)).ceil();
    if probe.is_software() {
        let more = times_more(least(&times), LEAST_ON_SOFTWARE);
        load.repeat = more.clamp(1.0, MOST_REPEATS.into()) as u32;
    } else if batch.samples == 1 {
        // A sum is long, and goes on from its last launch: it cannot be asked twice at once.
        load.repeat = MOST_REPEATS_ON_A_GPU;
        let most = (MOST_ASKED / batch.count()).min(MOST_COPIES);
        // A launch twice as wide takes as long while the device is not full: so it is tried.
        while 2 * load.copies <= most {
            times = best(load)?;
            let dearest = times.iter().copied().fold(0.0, f64::max);
            if least(&times) >= LEAST || 2.0 * dearest > MOST {
                break;
            }
            load.copies *= 2;
        }
    }
    let cheapest = (0..times.len()).min_by(|&a, &b| times[a].total_cmp(&times[b])).unwrap_or(0);
    Ok((load, cheapest))
}

// ANCHOR: times
/// The time of every rung, one after the other in every round; `None` for what cannot be timed.
fn times(
    probe: &Probe,
    primitive: Primitive,
    ladder: &[&Rung],
    batch: &Batch,
    rounds: u32,
    measured: &[MeasuredRung],
) -> Result<Vec<Option<Time>>> {
    let ladder = ladder.iter().copied().zip(measured);
    let timed = ladder.filter(|(rung, row)| row.unavailable.is_none() && rung.code != Code::Device);
    let mut instruments: Vec<(&Rung, Instrument)> = Vec::new();
    for (rung, _) in timed {
        instruments.push((rung, probe.instrument(primitive, rung, Way::Direct)?));
    }
    if instruments.is_empty() {
        return Ok(vec![None; measured.len()]);
    }
    let (load, cheapest) = enough(probe, &instruments, batch)?;
    instruments.swap(0, cheapest);
    let labels: Vec<String> = instruments.iter().map(|(rung, _)| rung.label.to_owned()).collect();
    let comparison = compare::compare("rung", &labels, rounds, |label| {
        let found = instruments.iter().find(|(rung, _)| rung.label == label);
        let (_, instrument) = found.expect("the labels are those of the instruments");
        probe.time(instrument, batch, load)
    })?;
    // ANCHOR_END: times
    let time = |row: &MeasuredRung| {
        let value = comparison.values.iter().find(|value| value.value == row.rung)?;
        Some(Time {
            millions_a_second: f64::from(batch.count()) * f64::from(load.times())
                / value.milliseconds
                / 1e3,
            ratio: value.ratio,
            noise: comparison.noise,
            copies: load.copies,
        })
    };
    Ok(measured.iter().map(time).collect())
}
