//! The directional albedo of microfacets: the part of the light from all sides that goes to the eye, in a table.
//!
//! The facets reflect all light (F = 1) or Schlick's fifth power of the grazing angle; other reflectances are
//! mixtures of these. The integral is over directions as the visible normals choose them, where what is left of
//! the BRDF is smooth and below 1 (Heitz 2018; Dupuy and Benyoub 2023).

use std::f64::consts::PI;

common::shader_struct! {
    /// The albedo in a direction, as its difference from a mirror's.
    pub struct Albedo {
        /// The part of the light that facets lose which reflect everything.
        pub lost: f32,
        /// The reflection of facets that reflect the fifth power, above a mirror's.
        pub more: f32,
    }
}

/// Number of rows and of columns, as `ALBEDO_STEPS` in `albedo.glsl`.
pub const STEPS: usize = 32;

/// Nodes across a half turn, and nodes from the middle of the cap of directions to its edge. A finer rule changes
/// no entry by more than 0.0007 (a test of the chapter compares them).
const NODES: [usize; 2] = [40, 16];

/// Roughness of the first row: below it, the albedo depends on cosine / alpha alone.
const SMOOTHEST: f64 = 0.01;

/// The table that shaders read: a row for each roughness, evenly from 0 to 1.
pub struct AlbedoTable {
    /// The columns of each row are even in cosine · (1 + alpha) / (cosine + alpha).
    pub albedos: Vec<Albedo>,
    /// The mean of each row over all directions, weighted by their cosine. What is lost is divided by alpha, so that
    /// it changes little from row to row.
    pub means: Vec<Albedo>,
}

impl AlbedoTable {
    /// Computes the table.
    pub fn new() -> Self {
        let rule = DirectionRule::new(NODES);
        let last = (STEPS - 1) as f64;
        let (mut albedos, mut means) = (Vec::new(), Vec::new());
        for row in 0..STEPS {
            let alpha = (row as f64 / last).max(SMOOTHEST).powi(2);
            let cosine = |column: usize| cosine_at(column as f64 / last, alpha);
            let entries: Vec<[f64; 2]> =
                (0..STEPS).map(|column| rule.differences(alpha, cosine(column))).collect();
            let [lost, more] = mean(&entries, alpha);
            means.push(Albedo::from([lost / alpha, more]));
            albedos.extend(entries.into_iter().map(Albedo::from));
        }
        Self { albedos, means }
    }
}

impl From<[f64; 2]> for Albedo {
    fn from([lost, more]: [f64; 2]) -> Self {
        Self { lost: lost as f32, more: more as f32 }
    }
}

/// The cosine at a place of a row, from 0 to 1.
fn cosine_at(place: f64, alpha: f64) -> f64 {
    (place * alpha / (1.0 + alpha - place)).clamp(1e-9, 1.0)
}

/// The mean of a row as shaders read it, linear between its entries.
fn mean(entries: &[[f64; 2]], alpha: f64) -> [f64; 2] {
    let rule = gauss(8);
    let last = (entries.len() - 1) as f64;
    let mut sum = [0.0; 2];
    for (i, pair) in entries.windows(2).enumerate() {
        let [low, high] = [i, i + 1].map(|column| cosine_at(column as f64 / last, alpha));
        for &(node, weight) in &rule {
            let cosine = low + (high - low) * node;
            let place = cosine * (1.0 + alpha) / (cosine + alpha) * last - i as f64;
            for (k, sum) in sum.iter_mut().enumerate() {
                let value = pair[0][k] + (pair[1][k] - pair[0][k]) * place;
                *sum += value * 2.0 * cosine * (high - low) * weight;
            }
        }
    }
    sum
}

/// Nodes for the integral over the directions that visible facets mirror the view to.
pub struct DirectionRule {
    /// Cosine and sine of the angle around, and the weight.
    around: Vec<[f64; 3]>,
    /// The place from the middle to the edge, and the weight: denser near both, where a root begins.
    outward: Vec<(f64, f64)>,
}

impl DirectionRule {
    /// A rule of so many nodes across a half turn (the other half is its mirror image) and outward.
    pub fn new([around, outward]: [usize; 2]) -> Self {
        let around = gauss(around).into_iter().map(|(node, weight)| {
            let (sine, cosine) = (PI * node).sin_cos();
            [cosine, sine, weight]
        });
        let outward = gauss(outward).into_iter().map(|(node, weight)| {
            let place = (0.5 * PI * node).sin().powi(2);
            (place, weight * 0.5 * PI * (PI * node).sin())
        });
        Self { around: around.collect(), outward: outward.collect() }
    }

    /// The loss of facets that reflect everything, and the surplus over a mirror of those that reflect the fifth power.
    pub fn differences(&self, alpha: f64, cosine: f64) -> [f64; 2] {
        let [all, fifth] = self.albedos(alpha, cosine);
        [1.0 - all, fifth - (1.0 - cosine).powi(5)]
    }

    /// The albedo of facets that reflect everything, and of those that reflect the fifth power.
    pub fn albedos(&self, alpha: f64, cosine: f64) -> [f64; 2] {
        let view = [(1.0 - cosine * cosine).sqrt(), cosine];
        // The view after stretching, by which the facets become those of a hemisphere.
        let length = (alpha * view[0]).hypot(view[1]);
        let stretched = [alpha * view[0] / length, view[1] / length];
        let whole = 1.0 + stretched[1];
        let mut sum = [0.0; 2];
        for &[cos, sin, around] in &self.around {
            // The cosines of view and light to a facet and to the normal.
            let mirrored = |down: f64| {
                let radius = (down * (2.0 - down)).max(0.0).sqrt();
                let x = alpha * (stretched[0] + radius * cos);
                let y = alpha * radius * sin;
                let z = stretched[1] + 1.0 - down;
                let length = (x * x + y * y + z * z).sqrt();
                let facet = (view[0] * x + view[1] * z) / length;
                (facet, 2.0 * facet * z / length - view[1])
            };
            // Beyond this edge the light would come from below.
            let (mut edge, mut below) = (0.0, whole);
            for _ in 0..30 {
                let middle = 0.5 * (edge + below);
                if mirrored(middle).1 > 0.0 { edge = middle } else { below = middle }
            }
            for &(place, weight) in &self.outward {
                let (facet, light) = mirrored(edge * place);
                let light = light.max(0.0);
                let part = around * weight * edge / whole * shown(alpha, cosine, light);
                sum[0] += part;
                sum[1] += part * (1.0 - facet.clamp(0.0, 1.0)).powi(5);
            }
        }
        sum
    }
}

/// The part of the visible facets that the light also sees: Smith's G2 / G1, with heights correlated.
fn shown(alpha: f64, view: f64, light: f64) -> f64 {
    let stretched =
        |cosine: f64| (cosine * cosine + alpha * alpha * (1.0 - cosine * cosine)).sqrt();
    light * (view + stretched(view)) / (light * stretched(view) + view * stretched(light))
}

/// Nodes and weights of Gauss and Legendre between 0 and 1.
fn gauss(count: usize) -> Vec<(f64, f64)> {
    let node = |i: usize| {
        let mut x = (PI * (i as f64 + 0.75) / (count as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut before, mut value) = (1.0, x);
            for k in 2..=count {
                let k = k as f64;
                (before, value) = (value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            }
            slope = count as f64 * (before - x * value) / (1.0 - x * x);
            x -= value / slope;
        }
        (0.5 + 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}
