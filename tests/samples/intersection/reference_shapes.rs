//! The shapes in the reference's form.

use common::model::Model;
use common::scene::{Instance, Scene};
use glam::DVec3;
use reference::Ray;
use reference::aabb::Aabb;
use reference::sphere::Sphere;

use super::shapes::{self, Shapes};

/// A scene's shapes in the reference's form, by the ids that the shaders write.
pub struct ReferenceShapes {
    pub spheres: Vec<Sphere>,
    pub boxes: Vec<Aabb>,
    /// The custom index of the spheres' instance; that of the boxes is the next.
    pub first: u32,
}

/// A shape by instance and id.
pub type Id = (u32, u32);

impl ReferenceShapes {
    /// The shapes of a chapter's scene, made from the chess set's model and pieces.
    pub fn new(make: impl FnOnce(&Model, &[Instance]) -> Shapes) -> Self {
        let mut chess = Scene::chess().unwrap();
        chess.model.materials.extend(shapes::materials());
        let shapes = make(&chess.model, &chess.instances);
        let sphere =
            |s: &shapes::Sphere| Sphere { center: s.center.as_dvec3(), radius: s.radius.into() };
        let aabb = |b: &shapes::Box| Aabb { low: b.low.as_dvec3(), high: b.high.as_dvec3() };
        Self {
            spheres: shapes.spheres.iter().map(sphere).collect(),
            boxes: shapes.boxes.iter().map(aabb).collect(),
            first: chess.instances.len() as u32,
        }
    }

    /// The t of the hit with one shape, exact and then rounded to f64.
    pub fn hit(&self, ray: &Ray, (instance, id): Id) -> Option<f64> {
        if instance == self.first {
            self.spheres[id as usize].intersect_exact(ray).map(|hit| hit.to_f64().t)
        } else {
            let hit = self.boxes[id as usize].intersect_exact(ray)?;
            Some(reference::rational::to_f64(&hit.t))
        }
    }

    /// The shapes a ray hits or passes within a hundredth of their size.
    pub fn near(&self, ray: &Ray) -> Vec<Id> {
        let unit = ray.direction.normalize();
        let passes = |center: DVec3, radius: f64| {
            (center - ray.origin).cross(unit).length_squared() <= (1.01 * radius).powi(2)
        };
        let spheres = (0..).zip(&self.spheres);
        let spheres = spheres.filter(|(_, s)| passes(s.center, s.radius));
        let boxes = (0..).zip(&self.boxes);
        let boxes =
            boxes.filter(|(_, b)| passes((b.low + b.high) / 2.0, (b.high - b.low).length() / 2.0));
        let spheres = spheres.map(|(id, _)| (self.first, id));
        spheres.chain(boxes.map(|(id, _)| (self.first + 1, id))).collect()
    }

    /// The nearest hit.
    pub fn closest(&self, ray: &Ray) -> Option<(Id, f64)> {
        let hits = self.near(ray).into_iter().filter_map(|id| Some((id, self.hit(ray, id)?)));
        hits.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// A shape enlarged by `by` on every side (or reduced, if negative).
    pub fn grown(&self, ray: &Ray, (instance, id): Id, by: f64) -> Option<f64> {
        if instance == self.first {
            let Sphere { center, radius } = self.spheres[id as usize];
            Sphere { center, radius: radius + by }.intersect(ray).map(|hit| hit.t)
        } else {
            let Aabb { low, high } = self.boxes[id as usize];
            Aabb { low: low - by, high: high + by }.intersect(ray).map(|hit| hit.t)
        }
    }
}
