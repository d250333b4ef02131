//! Light within a material, from the values in an MTL file.

use common::scene::{Material, Scene};
use glam::{DVec3, Vec3};

common::shader_enum! {
    /// The behaviour of a material for light that enters it.
    pub enum Kind: GLASS {
        /// Nothing: light does not enter.
        None,
        /// A body with an inside.
        Thick,
        /// A sheet without an inside.
        Thin,
    }
}

common::shader_struct! {
    /// A material as light finds it that enters.
    pub struct Glass {
        /// Absorption: exp(-absorption) is left after a unit of length.
        pub absorption: Vec3,
        /// Index of refraction.
        pub index: f32,
        /// A [`Kind`].
        pub kind: u32,
    }
}

/// The medium outside of all bodies.
pub const AIR: u32 = u32::MAX;

impl From<&Material> for Glass {
    /// Illumination models 6 and 7 refract light and are bodies; 4 and 9 do not and are thin sheets. `Tf` is the
    /// part of the light that comes through a sheet, or through one unit of a body.
    fn from(material: &Material) -> Self {
        let kind = match material.illumination {
            6 | 7 => Kind::Thick,
            4 | 9 => Kind::Thin,
            _ => Kind::None,
        };
        let through = material.transmission.clamp(Vec3::splat(1e-6), Vec3::ONE);
        Self {
            absorption: through.map(|part| 0.0 - part.ln()),
            index: material.refraction.clamp(0.1, 10.0),
            kind: kind as u32,
        }
    }
}

/// The bodies of glass that a point is in: the lowest numbers of their materials first, and then air.
pub fn media_at(scene: &Scene, point: DVec3) -> [u32; 4] {
    let is_body =
        |material: usize| Glass::from(&scene.model.materials[material]).kind == Kind::Thick as u32;
    let mut media = Vec::new();
    for instance in scene.instances.iter().filter(|instance| is_body(instance.material)) {
        let (low, high) = scene.instance_bounds(instance);
        let is_near = point.cmpge(low.as_dvec3()).all() && point.cmple(high.as_dvec3()).all();
        if is_near && turns(scene, instance, point) > 0.5 {
            media.push(instance.material as u32);
        }
    }
    media.sort_unstable();
    media.resize(4, AIR);
    [media[0], media[1], media[2], media[3]]
}

/// The number of times an instance's surface winds around a point: the solid angle of its triangles, over that of a
/// sphere (van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30:2, 1983). 1 inside, 0 outside.
fn turns(scene: &Scene, instance: &common::scene::Instance, point: DVec3) -> f64 {
    let mesh = &scene.model.meshes[instance.mesh];
    let to = |corner: u32| {
        let position = mesh.vertices[corner as usize].position;
        instance.transform.transform_point3(position).as_dvec3() - point
    };
    let mut angle = 0.0;
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(to);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let volume = a.dot(b.cross(c));
        angle += volume.atan2(la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    // A mirrored instance has its triangles the other way around.
    angle.abs() / (2.0 * std::f64::consts::PI)
}
