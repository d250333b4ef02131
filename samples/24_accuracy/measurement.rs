//! The figures of a run, as its file has them.

use std::collections::BTreeSet;

use common::gpu::PipelineDesc;
use instruments::compare::Ratio;
use instruments::compile_for::CompiledFor;
use serde::Serialize;

use crate::geometry::Form;

/// All that a run measured.
#[derive(Serialize)]
pub struct Measurement {
    pub device: String,
    pub driver: String,
    /// The arithmetic of the shaders: the value of `--arithmetic`.
    pub arithmetic: String,
    /// The day, as 2026-11-21.
    pub date: String,
    /// True if `fma()` rounds once here.
    pub fused: bool,
    /// Rays of each family.
    pub rays: usize,
    /// The seed that they were drawn from; 0 for those of the stored figures.
    pub seed: u64,
    /// Rounds of each timing; 0 for errors alone.
    pub rounds: u32,
    /// The GPU compiler of the estimates, with its version.
    pub compiler: Option<String>,
    /// The reason why there are no estimates.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub no_compiler: Option<String>,
    pub rungs: Vec<MeasuredRung>,
    /// The sphere compared with its meshes, if all rungs of spheres were selected.
    pub forms: Vec<Form>,
    /// Shader stages that took part, by path below `shaders/`.
    pub stages: BTreeSet<String>,
    pub validation_messages: Vec<String>,
}

/// One rung.
#[derive(Serialize)]
pub struct MeasuredRung {
    pub primitive: &'static str,
    pub rung: &'static str,
    pub name: &'static str,
    /// The reason why the device lacks it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unavailable: Option<String>,
    pub errors: Vec<Errors>,
    /// The time on the primitive's first family, direct.
    pub time: Option<Time>,
    /// The times on every family, if a rung's number of steps depends on the ray.
    pub marches: Vec<March>,
    /// Estimates of a GPU's compiler, called directly: one program per family.
    pub compiled_for: Vec<Compiled>,
    /// Description of the direct pipeline.
    #[serde(skip)]
    pub desc: Option<PipelineDesc>,
}

/// An error in ULP that shows: a ten-thousandth of t is 839 to 1678 of them.
pub const FAR_OFF: f64 = 1000.0;

/// Errors of a rung on a family.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Errors {
    pub family: &'static str,
    pub way: &'static str,
    pub rays: usize,
    /// Error of t in ULP, where both see a hit: median, 99 of 100, largest.
    pub p50: f64,
    pub p99: f64,
    pub max: f64,
    /// Of these, errors of more than [`FAR_OFF`].
    pub far_off: usize,
    pub false_hits: usize,
    pub false_misses: usize,
    /// Hits that the device's box test kept from the shader; no false misses.
    pub never_offered: usize,
    pub not_finite: usize,
    /// Rays for which the number of hits is wrong, among those whose first hit is right; of direct rays alone.
    pub miscounted: usize,
}

/// Costs of a rung.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Time {
    /// Millions of intersections a second.
    pub millions_a_second: f64,
    /// Time over the cheapest rung's, of the same round.
    pub ratio: Ratio,
    /// The cheapest rung against itself: no smaller difference can be seen.
    pub noise: Ratio,
    /// Number of invocations that began with each ray, to fill the device.
    pub copies: u32,
}

/// Cost of a march on a family, relative to the cheapest rung there.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct March {
    pub family: &'static str,
    pub ratio: Ratio,
}

/// A rung's direct pipeline, which is one program, on one family.
#[derive(Clone, Debug, Serialize)]
pub struct Compiled {
    #[serde(flatten)]
    pub program: CompiledFor,
    /// Its inverse throughput over the least of the ladder, on the same family.
    pub ratio: f64,
}
