//! The reference's copy of the ground and the pieces on it.

use common::scene::Scene;
use reference::Ray;
use reference::scene::Scene as ExactScene;

use super::ground::Landscape;
use super::judged::Exact;
use super::{GROUND, HILLS, land, scenes};
use run::primary_hits::reference;

/// The first surface on a ray, in the form of `show=hit`.
pub struct World {
    scene: ExactScene,
    standing: Vec<f32>,
    pub ground: Exact,
}

impl World {
    pub fn new() -> Self {
        let (scene, standing) = pieces(HILLS);
        let (low, high) = HILLS.bounds(0.0);
        let ground = Exact::new(HILLS, low.abs().max(high.abs()).as_dvec3());
        Self { scene, standing, ground }
    }

    /// All surfaces on the ray, with their t.
    fn met(&self, ray: &Ray) -> Vec<(f32, f64)> {
        let piece = self.scene.closest_hit(ray, |_| true);
        let piece = piece.map(|hit| (self.standing[hit.instance as usize], hit.t));
        let ground = self.ground.hit(ray).map(|hit| (GROUND, hit.t));
        [piece, ground].into_iter().flatten().collect()
    }

    pub fn first(&self, ray: &Ray) -> (f32, f64) {
        let met = self.met(ray).into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
        met.unwrap_or((-1.0, 0.0))
    }

    /// Returns whether rounding decides which surface the ray hits first: at the outline of a piece or of a
    /// hill, or where two surfaces coincide.
    pub fn is_close(&self, ray: &Ray) -> bool {
        let near = self.scene.near_candidates(ray);
        if near.iter().any(|near| near.may_hit(ray) && !near.must_hit(ray)) {
            return true;
        }
        let mut met: Vec<f64> = self.met(ray).into_iter().map(|(_, t)| t).collect();
        met.sort_by(f64::total_cmp);
        let bound = |t| self.ground.bound(ray, t) / 1e-3;
        let first = met.first().copied().unwrap_or(0.0);
        met.iter().skip(1).any(|t| (t - first).abs() <= bound(*t))
            || self.ground.stays_near(ray, 0.0, 1e-3)
    }
}

/// The reference's copy of the chess set on the ground, and the pieces that stand.
fn pieces(landscape: Landscape) -> (ExactScene, Vec<f32>) {
    let mut scene = scenes::chess().unwrap();
    let Scene { model, instances, .. } = &mut scene;
    let mut number = 0.0;
    let mut standing = Vec::new();
    instances.retain_mut(|instance| {
        let stands = land::stand(landscape, instance, &model.meshes[instance.mesh]);
        if let Some(stands) = stands {
            *instance = stands;
            standing.push(number);
        }
        number += 1.0;
        stands.is_some()
    });
    (reference(&scene), standing)
}
