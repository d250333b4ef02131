//! The heightfield, prepared for the shaders; chapter 21 derives it.

use common::gpu::order::Bounds;
use effects::Heightfield;
use glam::{Vec3, Vec3Swizzles};

use crate::shape::HeightfieldShape;

common::shader_struct! {
    /// The ground as shaders get it.
    pub struct Ground {
        /// Its height.
        pub shape: HeightfieldShape,
        /// Corners of its bounding box.
        pub low: Vec3,
        /// The other corner.
        pub high: Vec3,
        /// The error bound of a height above the ground that is computed inside the box.
        pub error: f32,
        /// Colour of the light fields, linear RGB.
        pub light: Vec3,
        /// Colour of the dark ones.
        pub dark: Vec3,
        /// Colour where it is steep.
        pub rock: Vec3,
        /// Length of a field's side.
        pub square: f32,
    }
}

impl Ground {
    /// No ground: nothing has its number of instances.
    pub fn none() -> Self {
        bytemuck::Zeroable::zeroed()
    }

    /// The ground of a scene.
    pub fn new(field: &Heightfield) -> Self {
        let (low, high) = bounds(field);
        let shape = shape(field);
        let reach = low.abs().max(high.abs()).as_dvec3();
        let error = (shape.error(reach, reach) as f32).next_up();
        let &Heightfield { light, dark, rock, square, .. } = field;
        Self { shape, low, high, error, light, dark, rock, square }
    }
}

/// Corners of the box around it: a little higher than the hills, so that none touches it.
pub fn bounds(field: &Heightfield) -> Bounds {
    let height = 1.01 * (field.hills + field.ridges);
    (field.low.extend(-height).xzy(), field.high.extend(height).xzy())
}

fn shape(field: &Heightfield) -> HeightfieldShape {
    let (f, g) = (field.hill.recip(), field.ridge.recip());
    HeightfieldShape::new(1.0, [field.hills, f.x, f.y], [field.ridges, g.x, g.y])
}
