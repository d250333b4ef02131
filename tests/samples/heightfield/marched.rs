//! The rays of a view, the result of each rung for them, and a row of the page's table.

use std::fmt;

use common::app::Picture;
use common::gpu::ShaderEnum;
use common::scene::Camera;
use glam::DVec3;
use reference::Ray;
use serde_json::{Value, json};

use super::chapter;
use super::ground::Landscape;
use super::judged::{Exact, Verdict};
use super::scenes::{Preset, PresetName};
use run::primary_hits::rays;

pub const RUNGS: [&str; 5] = ["relaxed", "secant", "lipschitz", "over-relaxed", "bisected"];

/// Two triangles, much smaller than their distance: no ray here hits them, so that only the ground is
/// visible. They load faster than the pieces.
pub struct Alone(tempfile::TempDir);

impl Alone {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.obj");
        let far = "v 1 0 0\nv 1 0 1e-12\nv 1 1e-12 0\n";
        let text = format!("v 0 0 0\nv 1e-12 0 0\nv 0 0 1e-12\n{far}f 1 2 3\nf 4 5 6\n");
        std::fs::write(file, text).unwrap();
        Self(folder)
    }

    pub fn shown(&self, size: &str, sets: &[&str]) -> Picture {
        chapter(size).sets(sets).scene(self.0.path().join("a.obj")).picture()
    }

    /// The camera's rays, as written by the GPU.
    pub fn rays(&self, size: &str, sets: &[&str]) -> Vec<Ray> {
        let directions = self.shown(size, &[sets, &["show=ray direction"]].concat());
        rays(&camera(sets), &directions).collect()
    }
}

/// The camera for these settings: that of a setting, or else of the preset.
pub fn camera(sets: &[&str]) -> Camera {
    let said = |control: &str| {
        let mut said = sets.iter().filter_map(|set| set.split_once('='));
        said.find_map(|(name, value)| (name == control).then_some(value))
    };
    let names = PresetName::LAYOUT.words;
    let preset = said("preset").unwrap_or(names[0]);
    let number = names.iter().position(|name| *name == preset).unwrap();
    let mut camera = Preset::new(PresetName::ALL[number]).camera;
    if let Some(eye) = said("camera eye") {
        let eye: Vec<f64> = eye.split(',').map(|number| number.parse().unwrap()).collect();
        camera.eye = DVec3::from_slice(&eye);
    }
    camera
}

/// The march of a ray by a rung.
pub struct March {
    pub ray: Ray,
    /// The distance of the hit.
    pub found: Option<f64>,
    /// The number of heights evaluated.
    pub steps: f64,
    pub verdict: Verdict,
    /// The distance of the exact hit.
    pub exact: Option<f64>,
    /// The angle between the ray and the ground at the exact hit, in degrees.
    pub angle: Option<f64>,
}

/// All rays of a view, marched by one rung.
pub struct Marched(pub Vec<March>);

impl Marched {
    pub fn new(
        alone: &Alone,
        size: &str,
        sets: &[&str],
        landscape: Landscape,
    ) -> [Self; RUNGS.len()] {
        let rays = alone.rays(size, sets);
        let exact = Exact::new(landscape, rays[0].origin);
        let truth: Vec<_> = rays.iter().map(|ray| exact.hit(ray)).collect();
        RUNGS.map(|rung| {
            let rung = format!("rung={rung}");
            let pixels = alone.shown(size, &[sets, &["show=march", &rung]].concat()).pixels;
            let marches = rays.iter().zip(&truth).zip(pixels);
            let marches = marches.map(|((ray, truth), [t, steps, ..])| {
                let found = (t >= 0.0).then_some(f64::from(t));
                March {
                    ray: *ray,
                    found,
                    steps: steps.into(),
                    verdict: exact.judge(ray, found, truth.as_ref()),
                    exact: truth.as_ref().map(|hit| hit.t),
                    angle: truth.as_ref().map(|hit| {
                        let sine = -hit.normal.dot(ray.direction) / ray.direction.length();
                        sine.asin().to_degrees()
                    }),
                }
            });
            Self(marches.collect())
        })
    }

    pub fn count(&self, verdict: Verdict) -> usize {
        self.0.iter().filter(|march| march.verdict == verdict).count()
    }

    /// The number of right answers. Rays on the edge of a hill may hit or miss.
    pub fn right(&self) -> usize {
        self.count(Verdict::Right) + self.count(Verdict::Grazes)
    }

    pub fn hits(&self) -> usize {
        self.0.iter().filter(|march| march.exact.is_some()).count()
    }

    pub fn steps(&self) -> f64 {
        self.0.iter().map(|march| march.steps).sum::<f64>() / self.0.len() as f64
    }

    /// The median of the angles.
    pub fn angle(&self) -> f64 {
        let mut angles: Vec<f64> = self.0.iter().filter_map(|march| march.angle).collect();
        angles.sort_by(f64::total_cmp);
        angles[angles.len() / 2]
    }

    pub fn steps_of_misses(&self) -> f64 {
        let misses = self.0.iter().filter(|march| march.exact.is_none());
        let (steps, count) = misses.fold((0.0, 0.0), |(s, n), march| (s + march.steps, n + 1.0));
        steps / f64::max(count, 1.0)
    }

    /// The number of hits that are false, missing, or off by more than a thousandth of t: visible errors.
    pub fn visible(&self) -> usize {
        let seen = |march: &&March| match march.verdict {
            Verdict::Right | Verdict::Grazes => false,
            Verdict::Through | Verdict::FalseHit | Verdict::FalseMiss => true,
            Verdict::TooNear | Verdict::TooFar => march
                .found
                .zip(march.exact)
                .is_some_and(|(t, exact)| (t / exact - 1.0).abs() > 1e-3),
        };
        self.0.iter().filter(seen).count()
    }

    /// The relative errors of t, where there is an exact hit and the rung has one: the median and the 99th
    /// percentile.
    pub fn errors(&self) -> [f64; 2] {
        let error = |march: &March| Some((march.found? / march.exact? - 1.0).abs());
        let mut errors: Vec<f64> = self.0.iter().filter_map(error).collect();
        errors.sort_by(f64::total_cmp);
        [0.5, 0.99]
            .map(|part| errors.get((errors.len() as f64 * part) as usize).copied().unwrap_or(0.0))
    }

    /// A row of the page's table.
    pub fn row(&self) -> Row {
        let count = |verdict| self.count(verdict);
        Row {
            steps: self.steps(),
            right: self.right(),
            visible: self.visible(),
            wrong: [
                ("too_near", count(Verdict::TooNear)),
                ("too_far", count(Verdict::TooFar)),
                ("through", count(Verdict::Through)),
                ("false", count(Verdict::FalseHit)),
                ("lost", count(Verdict::FalseMiss)),
            ],
            errors: self.errors(),
        }
    }

    /// A map of the errors, in the colours of `show=error`.
    pub fn map(&self, width: u32) -> Picture {
        let pixels: Vec<_> = self.0.iter().map(color).collect();
        Picture { width, height: pixels.len() as u32 / width, pixels }
    }
}

/// A row of the page's table.
pub struct Row {
    steps: f64,
    right: usize,
    visible: usize,
    wrong: [(&'static str, usize); 5],
    errors: [f64; 2],
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { steps, right, visible, wrong, errors: [half, most] } = self;
        let wrong = wrong.map(|(_, count)| count.to_string()).join(" | ");
        write!(f, "{steps:.1} | {right} | {visible} | {wrong} | {half:.1e} | {most:.1e}")
    }
}

impl Row {
    /// Its figures, each with the row's name as prefix.
    pub fn values(&self, row: &str) -> impl Iterator<Item = (String, Value)> {
        let Self { steps, right, visible, wrong, errors: [half, most] } = self;
        let first = [("steps", json!(steps)), ("right", json!(right)), ("visible", json!(visible))];
        let wrong = wrong.map(|(name, count)| (name, json!(count)));
        let last = [("p50", json!(half)), ("p99", json!(most))];
        let row = row.replace(' ', "-");
        let all = first.into_iter().chain(wrong).chain(last);
        all.map(move |(name, value)| (format!("{row}.{name}"), value))
    }
}

/// Grey if there is nothing, blue to white for a millionth to all, magenta for a false hit, cyan for a lost
/// one, green behind a hill.
fn color(march: &March) -> [f32; 4] {
    let error = match (march.found, march.exact) {
        (Some(found), Some(exact)) => (found / exact - 1.0).abs(),
        _ => 0.0,
    };
    let part = (error.max(1e-6) * 1e6).log(1e6).clamp(0.0, 1.0) as f32;
    let heat = |scale: f32, from: f32, base: f32| {
        (part * scale - from).clamp(0.0, 1.0) + base * (1.0 - 2.5 * part).max(0.0)
    };
    let [r, g, b] = match march.verdict {
        Verdict::FalseHit => [0.8, 0.0, 0.8],
        Verdict::FalseMiss => [0.0, 0.8, 0.8],
        Verdict::Through => [0.1, 0.4 + 0.5 * part, 0.1],
        _ if march.exact.is_none() => [0.5; 3],
        _ => [heat(2.2, 0.25, 0.02), heat(1.7, 0.7, 0.02), heat(4.0, 3.0, 0.3)],
    };
    [r, g, b, 1.0]
}
