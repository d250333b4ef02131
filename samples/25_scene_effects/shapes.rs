//! Shapes without triangles, as shaders get them: spheres, boxes, convex solids.

use glam::Vec3;

common::shader_struct! {
    /// A sphere as shaders get it.
    #[derive(PartialEq)]
    pub struct Sphere {
        /// Its middle.
        pub center: Vec3,
        /// Above 0.
        pub radius: f32,
        /// The material, by position in the model.
        pub material: u32,
        /// Its motion while the shutter is open.
        pub moves: Vec3,
    }
}

common::shader_struct! {
    /// A box with sides along the axes, as shaders get it.
    #[derive(PartialEq)]
    pub struct Box {
        /// The corner with the lowest coordinates.
        pub low: Vec3,
        /// The corner with the highest.
        pub high: Vec3,
        /// The material, by position in the model.
        pub material: u32,
    }
}

common::shader_struct! {
    /// A convex solid as shaders get it: what is inside all of its faces.
    #[derive(PartialEq)]
    pub struct Solid {
        /// The origin of the faces' distances.
        pub center: Vec3,
        /// Its first face, by position among [`crate::Composition::faces`].
        pub first: u32,
        /// Number of faces.
        pub count: u32,
        /// The material, by position in the model.
        pub material: u32,
    }
}

common::shader_struct! {
    /// A half-space: `normal · (p - center) <= distance`.
    #[derive(PartialEq)]
    pub struct Face {
        /// Unit vector, out of the solid.
        pub normal: Vec3,
        /// From the solid's centre.
        pub distance: f32,
    }
}
