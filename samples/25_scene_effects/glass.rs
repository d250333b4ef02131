//! What light does within a material, from what an MTL file says of it, as chapter 27 reads it.

use common::scene::{Instance, Material};
use glam::{DVec3, Vec3};

use crate::Composition;

common::shader_enum! {
    /// What a material is for light that enters it.
    pub enum GlassKind: GLASS {
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
        /// What is left after a unit of length is exp(-absorption).
        pub absorption: Vec3,
        /// Index of refraction.
        pub index: f32,
        /// A [`GlassKind`].
        pub kind: u32,
    }
}

/// The medium where there is no body.
const AIR: u32 = u32::MAX;

impl GlassKind {
    /// Of the illumination models 6 and 7 say that light is refracted, 4 and 9 that it is not.
    pub fn of(material: &Material) -> Self {
        match material.illumination {
            6 | 7 => Self::Thick,
            4 | 9 => Self::Thin,
            _ => Self::None,
        }
    }
}

impl From<&Material> for Glass {
    fn from(material: &Material) -> Self {
        let through = material.transmission.clamp(Vec3::splat(1e-6), Vec3::ONE);
        Self {
            absorption: through.map(|part| 0.0 - part.ln()),
            index: material.refraction.clamp(0.1, 10.0),
            kind: GlassKind::of(material) as u32,
        }
    }
}

/// Whether light enters a material.
pub fn is_glass(material: &Material) -> bool {
    GlassKind::of(material) != GlassKind::None
}

impl Composition {
    /// What each material is for light that enters it, if any material in use is glass; shaders read no others.
    pub fn glasses_to_read(&self) -> Vec<Glass> {
        match self.materials_in_use().any(is_glass) {
            true => self.scene.model.materials.iter().map(Glass::from).collect(),
            false => Vec::new(),
        }
    }

    // ANCHOR: media
    /// The bodies of glass that a point is in: the lowest numbers of their materials first, and then air.
    pub fn media_at(&self, point: DVec3) -> [u32; 4] {
        let materials = &self.scene.model.materials;
        let is_body = |number: usize| GlassKind::of(&materials[number]) == GlassKind::Thick;
        let is_in = |(low, high): (Vec3, Vec3)| {
            point.cmpge(low.as_dvec3()).all() && point.cmple(high.as_dvec3()).all()
        };
        let spheres = self
            .spheres
            .iter()
            .filter(|sphere| point.distance(sphere.center.as_dvec3()) < f64::from(sphere.radius));
        let boxes = self.boxes.iter().filter(|b| is_in((b.low, b.high)));
        let solids = self.solids.iter().filter(|solid| {
            let from = point - solid.center.as_dvec3();
            let faces = &self.faces[solid.first as usize..][..solid.count as usize];
            faces.iter().all(|face| face.normal.as_dvec3().dot(from) <= face.distance.into())
        });
        let meshes = self.scene.instances.iter().filter(|instance| {
            is_body(instance.material)
                && is_in(self.scene.instance_bounds(instance))
                && self.turns(instance, point) > 0.5
        });
        let shapes = spheres.map(|s| s.material).chain(boxes.map(|b| b.material));
        let shapes = shapes.chain(solids.map(|s| s.material)).map(|number| number as usize);
        let all = shapes.chain(meshes.map(|instance| instance.material));
        let mut media: Vec<u32> = all.filter(|&n| is_body(n)).map(|n| n as u32).collect();
        media.sort_unstable();
        media.resize(4, AIR);
        [media[0], media[1], media[2], media[3]]
    }

    /// How often the surface of an instance goes around a point: the solid angle of its triangles, over that
    /// of a sphere (van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30:2, 1983). 1 inside, 0 outside.
    fn turns(&self, instance: &Instance, point: DVec3) -> f64 {
        let mesh = &self.scene.model.meshes[instance.mesh];
        let to = |corner: u32| {
            let position = mesh.vertices[corner as usize].position;
            instance.transform.transform_point3(position).as_dvec3() - point
        };
        let angle = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(to);
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let around = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            a.dot(b.cross(c)).atan2(around)
        };
        let angle: f64 = mesh.triangles.iter().map(angle).sum();
        // A mirrored instance has its triangles the other way around.
        angle.abs() / (2.0 * std::f64::consts::PI)
    }
    // ANCHOR_END: media
}
