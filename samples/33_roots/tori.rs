//! Tori: their boxes, a chain of them, and their colours.

use common::gpu::order::Bounds;
use common::model::Model;
use common::scene::Material;
use glam::{DVec3, Vec3};

common::shader_struct! {
    /// All points at the distance `minor` from a circle of radius `major`.
    pub struct Torus {
        /// Its middle, in the hole.
        pub center: Vec3,
        /// Perpendicular to the circle, of any length but 0.
        pub axis: Vec3,
        /// The circle's radius.
        pub major: f32,
        /// The tube's radius: at most `major`.
        pub minor: f32,
        /// The material, by position in the model.
        pub material: u32,
    }
}

impl Torus {
    /// Corners of the box around it, never inside it by rounding.
    ///
    /// Along a coordinate axis e the circle reaches `major·√(1 - (e·n)²)` from the centre, and the tube `minor`
    /// farther.
    pub fn bounds(&self) -> Bounds {
        let normal = self.axis.as_dvec3().normalize();
        let flat = (DVec3::ONE - normal * normal).max(DVec3::ZERO).map(f64::sqrt);
        // f64 rounds a few of these by 2^-53; f32 has gaps of 2^-24.
        let reach = (f64::from(self.major) * flat + f64::from(self.minor)) * (1.0 + 1e-12)
            + DVec3::splat(1e-12 * f64::from(self.major));
        let center = self.center.as_dvec3();
        let low = (center - reach).to_array().map(|x| (x as f32).next_down());
        let high = (center + reach).to_array().map(|x| (x as f32).next_up());
        (low.into(), high.into())
    }
}

/// Links of a closed chain that lies on a plane: each leans against it by 45 degrees, to one side and the other by
/// turns.
///
/// `around` is the middle of the circle on which the links lie, on the plane.
pub fn chain(around: Vec3, radius: f32, [major, minor]: [f32; 2], material: u32) -> Vec<Torus> {
    // The tubes of neighbours nearly touch where each passes through the other's hole.
    let spacing = 2.0 * f64::from(major) - 2.5 * f64::from(minor);
    let circle = std::f64::consts::TAU * f64::from(radius);
    let count = 2 * (circle / spacing / 2.0).ceil() as u32;
    let height = f64::from(major) * 0.5f64.sqrt() + f64::from(minor);
    let link = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        let outward = DVec3::new(angle.cos(), 0.0, angle.sin());
        let side = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let center = around.as_dvec3() + f64::from(radius) * outward + height * DVec3::Y;
        let axis = (DVec3::Y + side * outward).normalize();
        Torus { center: center.as_vec3(), axis: axis.as_vec3(), major, minor, material }
    };
    (0..count).map(link).collect()
}

/// Colours of the tori: gold, blue, red.
const MATERIALS: [([f32; 3], [f32; 3]); 3] = [
    ([0.46, 0.26, 0.05], [0.70, 0.50, 0.20]),
    ([0.04, 0.13, 0.42], [0.04, 0.04, 0.04]),
    ([0.55, 0.06, 0.035], [0.04, 0.04, 0.04]),
];

/// Number of the tori's first material in a model to which [`materials`] were added.
pub fn first_material(model: &Model) -> u32 {
    (model.materials.len() - MATERIALS.len()) as u32
}

/// The tori's materials, to be added to a model's.
pub fn materials() -> impl Iterator<Item = Material> {
    MATERIALS.into_iter().map(|(color, specular)| Material {
        name: "torus".to_owned(),
        base_color: color.into(),
        specular: specular.into(),
        shininess: 90.0,
        ..Material::default()
    })
}
