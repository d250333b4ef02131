//! A hit in a scene, and a candidate: what an f32 renderer may or must take for a hit.

use glam::DVec2;

use super::bound::Graze;
use super::crossing::Crossing;
use super::ray::Ray;

/// A ray and a triangle of the scene, at their intersection or close approach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Index of the instance in the scene's list: `gl_InstanceID`.
    pub instance: u32,
    /// Index of the triangle in the instance's list: `gl_PrimitiveID`.
    pub primitive: u32,
    /// Ray parameter, in lengths of the ray's direction.
    pub t: f64,
    /// Weights of the second and third vertex: GLSL's hit attributes.
    pub barycentrics: DVec2,
    /// True if the vertices turn counterclockwise as seen from the ray's origin, in the object's right-handed
    /// axes. Mesa's drivers call this the front, unless the instance flips it. A mirroring transform has no
    /// effect, because facing is determined in object space.
    pub counterclockwise: bool,
    /// The crossing in world space, with its margins.
    pub crossing: Crossing,
}

/// A triangle that an f32 renderer may find hit: a true hit or a near miss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Intersection of the ray with the plane of the triangle.
    pub hit: Hit,
    /// The edge that decides, with the bound on its margin.
    pub graze: Graze,
    /// Error bound of t.
    pub t_bound: f64,
}

impl Candidate {
    /// True if an f32 renderer may report it as a hit: near enough, and not outside the interval.
    pub fn may_hit(&self, ray: &Ray) -> bool {
        let (t, bound) = (self.hit.t, self.t_bound);
        // Edge-on t is not a number, and then nothing is known of it.
        let outside = t + bound <= ray.tmin || t - bound > ray.tmax;
        self.graze.may_hit() && !outside
    }

    /// True if an f32 renderer must report it as a hit.
    pub fn must_hit(&self, ray: &Ray) -> bool {
        let (t, bound) = (self.hit.t, self.t_bound);
        !self.graze.may_miss() && t - bound > ray.tmin && t + bound < ray.tmax
    }
}
