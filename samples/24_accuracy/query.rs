//! The device's queries and answers: a ray and a shape, and their intersection.

use glam::Vec3;

/// A ray `origin + t·direction`, `tmin < t <= tmax`, in f32 as the device gets it.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: Vec3,
    pub direction: Vec3,
    pub tmin: f32,
    pub tmax: f32,
}

impl Ray {
    /// The same ray for the reference.
    pub fn exact(&self) -> reference::Ray {
        let Self { origin, direction, tmin, tmax } = *self;
        reference::Ray::from_f32(origin.to_array(), direction.to_array(), tmin, tmax)
    }
}

common::shader_struct! {
    /// A query: a ray, and the place of its shape's numbers.
    pub struct Query {
        pub origin: Vec3,
        pub tmin: f32,
        pub direction: Vec3,
        pub tmax: f32,
        pub first: u32,
        pub count: u32,
        pub shape: u32,
    }
}

common::shader_struct! {
    /// The device's answer.
    pub struct Answer {
        pub offered: u32,
        pub hit: u32,
        pub t: f32,
        pub normal: Vec3,
        pub point: Vec3,
        pub count: u32,
    }
}
