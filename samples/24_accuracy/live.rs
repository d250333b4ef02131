//! Costs and errors of the rungs looked at so far, on the specimen in the window.

use anyhow::{Context, Result};
use common::app::chart::{Chart, Dot};
use common::gpu::Gpu;
use glam::DVec3;
use reference::Ray;
use reference::sphere::Sphere;
use serde::Serialize;

use crate::batch::Batch;
use crate::families::{Draw, Family};
use crate::ladder::{Primitive, Rung};
use crate::measure::tally;
use crate::measurement::Errors;
use crate::probe::{Load, Probe, Way};
use crate::specimen::{SUN, Specimen};

/// Rays across the view, and down.
const SIDE: u32 = 48;
/// Load of one timed launch, and the number of launches.
const LOAD: Load = Load { repeat: 16, copies: 1 };
const TIMES: u32 = 5;

/// One specimen, and the rungs that it was seen by.
pub struct Live {
    specimen: Specimen,
    family: Family,
    batch: Batch,
    found: Vec<LiveFigures>,
}

/// Results of one rung, on rays through the view.
#[derive(Serialize)]
pub struct LiveFigures {
    pub rung: &'static str,
    /// The best of five.
    pub nanoseconds_a_ray: f64,
    pub errors: Errors,
}

impl Live {
    /// Rays to the specimen, and their true answers.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, specimen: Specimen) -> Result<Self> {
        let camera = specimen.camera();
        let [right, up, forward] = camera.axes();
        let scale = (camera.fov_y.to_radians() / 2.0).tan();
        let at = |i: u32| (2.0 * (f64::from(i) + 0.5) / f64::from(SIDE) - 1.0) * scale;
        let direction =
            |i: u32| -> DVec3 { (forward + at(i % SIDE) * right - at(i / SIDE) * up).normalize() };
        let mut directions: Vec<DVec3> = (0..SIDE * SIDE).map(direction).collect();
        if specimen.primitive() == Primitive::SecondaryOrigin {
            directions.retain(|direction| leaves(camera.eye, *direction));
        }
        let make = &mut |_: &mut _, number: usize| (0, camera.eye, directions[number]);
        let draw = Draw { rays: directions.len(), seed: 0 };
        let family = Family::new("the view", vec![specimen.shape()], draw, make);
        let batch = Batch::new(gpu, &family.shapes, &family.rays, false)?;
        Ok(Self { specimen, family, batch, found: Vec::new() })
    }

    /// The specimen that it is about.
    pub fn specimen(&self) -> Specimen {
        self.specimen
    }

    /// Runs a rung, unless it has been run.
    ///
    /// # Errors
    /// If the device fails.
    pub fn ask(&mut self, probe: &Probe, primitive: Primitive, rung: &Rung) -> Result<()> {
        if self.found.iter().any(|found| found.rung == rung.label) {
            return Ok(());
        }
        let instrument = probe.instrument(primitive, rung, Way::Direct)?;
        let answers = probe.ask(&instrument, &self.batch)?;
        let times = (0..TIMES).map(|_| probe.time(&instrument, &self.batch, LOAD));
        let times = times.collect::<Result<Vec<_>>>()?;
        let best = times.into_iter().min_by(f64::total_cmp).context("a time was taken")?;
        self.found.push(LiveFigures {
            rung: rung.label,
            nanoseconds_a_ray: 1e6 * best / f64::from(LOAD.times() * self.batch.count()),
            errors: tally(&self.family, Way::Direct, &answers),
        });
        Ok(())
    }

    /// All that was found, for a report.
    pub fn found(&self) -> &[LiveFigures] {
        &self.found
    }

    /// Time against error; `shown` is the rung of the picture.
    pub fn chart(&self, shown: &str) -> Chart {
        let dots = self.found.iter().filter(|found| found.nanoseconds_a_ray > 0.0).map(|found| {
            let LiveFigures { rung, nanoseconds_a_ray, errors } = found;
            // A false hit or miss among a hundred rays is worse than any error.
            let is_wrong = 100 * errors.wrong() > errors.rays;
            let y = if is_wrong { 1e9 } else { errors.p99.clamp(0.1, 1e8) };
            Dot { label: rung, at: [*nanoseconds_a_ray, y], is_shown: *rung == shown }
        });
        Chart {
            name: "cost",
            x: "nanoseconds a ray",
            y: "p99 error, ULP; 1e9: wrong",
            span: [[10.0, 100.0], [0.1, 1e9]],
            dots: dots.collect(),
        }
    }
}

/// Returns whether a ray hits the unit sphere at a point that faces the sun.
fn leaves(origin: DVec3, direction: DVec3) -> bool {
    let ray = Ray { origin, direction, tmin: 0.0, tmax: f64::INFINITY };
    let hit = Sphere { center: DVec3::ZERO, radius: 1.0 }.intersect(&ray);
    hit.is_some_and(|hit| hit.normal.dot(SUN.as_dvec3()) > 0.0)
}
