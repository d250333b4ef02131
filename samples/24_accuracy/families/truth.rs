//! The true answers of random rays, from the reference.

use glam::Vec3;
use reference::{ExactSurface, scene::Scene};
use reference::{
    aabb::Aabb, capsule::Capsule, cone, heightfield, instance::Ellipsoid, patch, plane, quadric,
    scene, sphere, transform,
};

use super::{algebraic, grid};
use crate::judge::{Expected, ExpectedHit};
use crate::query::Ray;
use crate::shape::{Cone, Heightfield, Leaving, Pattern, Shape, Sum, parts};

/// The shapes as the reference knows them.
pub struct Truth<'a> {
    shapes: &'a [Shape],
    meshes: Vec<Option<Scene>>,
}

impl<'a> Truth<'a> {
    pub fn new(shapes: &'a [Shape]) -> Self {
        let mesh = |shape: &Shape| {
            let Shape::Triangles(mesh) = shape else { return None };
            let transform = transform::Transform::identity();
            let triangles = mesh.iter().map(|triangle| triangle.map(|v| v.to_array())).collect();
            Some(Scene::new([scene::Instance { transform, triangles }]))
        };
        Self { shapes, meshes: shapes.iter().map(mesh).collect() }
    }

    pub fn of(&self, number: usize, ray: &Ray) -> Expected {
        let exact = ray.exact();
        let surface = |hit: Option<ExactSurface>| hit.map(|hit| hit.to_f64().t);
        let mut count = None;
        let mut first = |hits: Vec<f64>| {
            count = Some(hits.len() as u32);
            hits.first().copied()
        };
        let t = match &self.shapes[number] {
            Shape::Sphere { center, radius } => {
                let (center, radius) = (center.as_dvec3(), (*radius).into());
                surface(sphere::Sphere { center, radius }.intersect_exact(&exact))
            }
            Shape::Box { low, high } => {
                let (low, high) = (low.as_dvec3(), high.as_dvec3());
                let hit = Aabb { low, high }.intersect_exact(&exact);
                hit.map(|hit| reference::rational::to_f64(&hit.t))
            }
            Shape::Plane { normal, distance } => {
                let (normal, distance) = (normal.as_dvec3(), (*distance).into());
                surface(plane::Plane { normal, distance }.intersect_exact(&exact))
            }
            Shape::PointPlane { point, normal } => {
                let (point, normal) = (point.as_dvec3(), normal.as_dvec3());
                surface(plane::PointPlane { point, normal }.intersect_exact(&exact))
            }
            Shape::Capsule { a, b, radius } => {
                let (a, b, radius) = (a.as_dvec3(), b.as_dvec3(), (*radius).into());
                Capsule { a, b, radius }.intersect(&exact).map(|hit| hit.t)
            }
            Shape::Instance(rows) => {
                let (linear, translation) = parts(rows);
                Ellipsoid { linear, translation }.intersect(&exact).map(|hit| hit.t)
            }
            Shape::Heightfield(h) => reference(h).intersect(&exact).map(|hit| hit.t),
            Shape::Triangles(_) => {
                let mesh = self.meshes[number].as_ref().expect("made for every mesh");
                mesh.closest_hit(&exact, |_| true).map(|hit| hit.t)
            }
            // A ray that leaves a convex shape does not hit it again; it hits the shape above.
            Shape::Leaving(Leaving { gap: None, .. }) => None,
            Shape::Leaving(leaving) => {
                let gap = leaving.gap.expect("matched above");
                let rise = f64::from(gap.occluder_y) - f64::from(gap.point.y);
                Some(rise / f64::from(leaving.direction.y))
            }
            Shape::Sum(sum) => Some(mean(sum)),
            Shape::Cone(cone) => first(exact_cone(cone).hits(&exact)),
            Shape::Quadric(numbers) => first(quadric::Quadric(numbers.map(f64::from)).hits(&exact)),
            Shape::Patch(corners) => first(patch::Patch(corners.map(Vec3::as_dvec3)).hits(&exact)),
            Shape::Voxel(voxel) => first(grid::exact(voxel).hits(&exact)),
            Shape::Algebraic(surface) => first(algebraic::exact(surface).hits(&exact)),
        };
        let hit = if t.is_some() { ExpectedHit::Yes } else { ExpectedHit::No };
        Expected { hit, t, normal: None, faces: Vec::new(), surface: None, count }
    }
}

fn exact_cone(&Cone { a, b, radii, is_closed }: &Cone) -> cone::Cone {
    cone::Cone { a: a.as_dvec3(), b: b.as_dvec3(), radii: radii.map(f64::from), is_closed }
}

fn reference(h: &Heightfield) -> heightfield::Heightfield {
    heightfield::Heightfield {
        k: h.k.into(),
        a: h.a.into(),
        fx: h.f[0].into(),
        fz: h.f[1].into(),
        b: h.b.into(),
        gx: h.g[0].into(),
        gz: h.g[1].into(),
        lipschitz: h.lipschitz.into(),
    }
}

/// In f64: products of two f32 and their few sums are exact, or as good as.
fn mean(sum: &Sum) -> f64 {
    let (value, n) = (f64::from(sum.value), f64::from(sum.n));
    match sum.pattern {
        Pattern::Constant => value,
        Pattern::Firefly { spike, every } => {
            let spikes = f64::from(sum.n / every);
            (spikes * f64::from(spike) + (n - spikes) * value) / n
        }
        Pattern::Head(head) => (f64::from(head) + (n - 1.0) * value) / n,
    }
}
