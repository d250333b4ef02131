//! Glass in a composition: its materials, and the bodies around a point. Chapter 27's own file reads an MTL file's
//! values, and knows meshes; here there are also shapes.

use common::scene::Material;
use glam::{DVec3, Vec3};

use crate::glass_of_27::{AIR, media_at};
pub use crate::glass_of_27::{Glass, Kind as GlassKind};
use crate::{Composition, Torus};

/// Tests whether light enters a material.
pub fn is_glass(material: &Material) -> bool {
    Glass::from(material).kind != GlassKind::None as u32
}

/// Tests whether a material is that of a body, which has an inside.
pub fn is_body(material: &Material) -> bool {
    Glass::from(material).kind == GlassKind::Thick as u32
}

impl Composition {
    /// The glass of each material, if any material in use is glass; shaders read no others.
    pub fn glasses_to_read(&self) -> Vec<Glass> {
        if self.materials_in_use().any(is_glass) {
            self.scene.model.materials.iter().map(Glass::from).collect()
        } else {
            Vec::new()
        }
    }

    /// The bodies of glass that a point is in: the lowest numbers of their materials first, and then air.
    pub fn media_at(&self, point: DVec3) -> [u32; 4] {
        let materials = &self.scene.model.materials;
        let is_body = |number: u32| is_body(&materials[number as usize]);
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
        let tori = self.tori.iter().filter(|torus| is_in_tube(torus, point));
        let shapes = spheres.map(|s| s.material).chain(boxes.map(|b| b.material));
        let shapes = shapes.chain(solids.map(|s| s.material)).chain(tori.map(|t| t.material));
        let shapes = shapes.filter(|&number| is_body(number));
        let mut media: Vec<u32> = shapes.chain(media_at(&self.scene, point)).collect();
        media.sort_unstable();
        media.resize(4, AIR);
        [media[0], media[1], media[2], media[3]]
    }
}

/// Tests whether a point is inside a torus.
fn is_in_tube(torus: &Torus, point: DVec3) -> bool {
    let from = point - torus.center.as_dvec3();
    let height = from.dot(torus.axis.as_dvec3().normalize());
    let across = (from.length_squared() - height * height).max(0.0).sqrt();
    (across - f64::from(torus.major)).hypot(height) < f64::from(torus.minor)
}
