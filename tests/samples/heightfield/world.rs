//! The ground among other things, as the reference sees them.

use common::scene::Scene;
use glam::{DVec3, Vec3A};
use reference::Ray;
use reference::plane::Plane;
use reference::scene::Scene as ExactScene;

use super::ground::{Landscape, MIDDLE};
use super::judged::Exact;
use super::{GROUND, HILLS, LAKE, PLANE, land, shown};
use run::exact::reference;

/// What a ray meets first, as `show=hit` says it.
pub struct World {
    scene: ExactScene,
    standing: Vec<f32>,
    pub ground: Exact,
    lake: Plane,
}

impl World {
    pub fn new() -> Self {
        let (scene, standing) = pieces(HILLS);
        let (low, high) = HILLS.bounds(0.0);
        let ground = Exact::new(HILLS, low.abs().max(high.abs()).as_dvec3());
        Self { scene, standing, ground, lake: Plane { normal: DVec3::Y, distance: LAKE.into() } }
    }

    /// Every surface that the ray meets, with its t.
    fn met(&self, ray: &Ray, on_lake: bool) -> Vec<(f32, f64)> {
        let piece = self.scene.closest_hit(ray, |_| true);
        let piece = piece.map(|hit| (self.standing[hit.instance as usize], hit.t));
        let ground = self.ground.hit(ray).map(|hit| (GROUND, hit.t));
        let lake = self.lake.intersect(ray).filter(|_| !on_lake).map(|hit| (PLANE, hit.t));
        [piece, ground, lake].into_iter().flatten().collect()
    }

    pub fn first(&self, ray: &Ray, on_lake: bool) -> (f32, f64) {
        let met = self.met(ray, on_lake).into_iter().min_by(|a, b| a.1.total_cmp(&b.1));
        met.unwrap_or((-1.0, 0.0))
    }

    /// Whether it is a matter of rounding what the ray meets, or what is near `t`: an outline of a piece
    /// or of a hill, or two surfaces in one place.
    pub fn is_close(&self, ray: &Ray, on_lake: bool) -> bool {
        let near = self.scene.near_candidates(ray);
        if near.iter().any(|near| near.may_hit(ray) && !near.must_hit(ray)) {
            return true;
        }
        let mut met: Vec<f64> = self.met(ray, on_lake).into_iter().map(|(_, t)| t).collect();
        met.sort_by(f64::total_cmp);
        let bound = |t| self.ground.bound(ray, t) / 1e-3;
        let first = met.first().copied().unwrap_or(0.0);
        met.iter().skip(1).any(|t| (t - first).abs() <= bound(*t))
            || self.ground.stays_near(ray, 0.0, 1e-3)
    }
}

/// The chess set without its board, before it is put on the ground.
pub fn chess() -> Scene {
    let mut scene = Scene::chess_of_metal().unwrap();
    let Scene { model, instances, .. } = &mut scene;
    instances.retain(|instance| {
        let name = &model.meshes[instance.mesh].name;
        !name.starts_with("board") && !name.starts_with("screen")
    });
    for instance in instances {
        instance.transform.translation += Vec3A::from(MIDDLE);
    }
    scene
}

/// The chess set on the ground, as the reference sees it, and which of the pieces stand.
fn pieces(landscape: Landscape) -> (ExactScene, Vec<f32>) {
    let mut scene = chess();
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

/// Rays of a bounce as the GPU wrote them, with what they hit.
pub fn traced(size: &str, sets: &[&str], bounce: u32) -> Vec<(Ray, [f32; 4])> {
    let bounce = format!("bounce={bounce}");
    let show =
        |view| shown(size, &[sets, &[&bounce, "minimum contribution=0", view]].concat(), &[]);
    let [origins, directions, hits] =
        ["show=ray origin", "show=ray direction", "show=hit"].map(show);
    let rays = origins.pixels.iter().zip(&directions.pixels).zip(hits.pixels);
    let rays = rays.map(|((&[ox, oy, oz, tmin], &[x, y, z, _]), hit)| {
        (Ray::from_f32([ox, oy, oz], [x, y, z], tmin, 1e30), hit)
    });
    // A path that has ended left nothing behind.
    rays.filter(|(ray, _)| ray.direction != DVec3::ZERO).collect()
}
