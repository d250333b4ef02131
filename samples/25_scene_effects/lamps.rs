//! Emitters of a composition, as in chapter 29, whose own files make the list.

use anyhow::{Result, ensure};
use common::model::Model;
use common::scene::{Material, Scene};
use glam::Vec3;

use crate::alias::MOST;
use crate::emitters::{self, Emitters};
use crate::{Composition, is_glass};

/// The emitters of a composition.
pub struct Lamps {
    /// Spheres first, then the triangles of meshes, and the table that chooses one.
    pub emitters: Emitters,
    /// The emitter of triangle 0 of each instance; [`NO_EMITTER`] if there is none.
    pub of_instances: Vec<u32>,
    /// The emitter of each sphere, or [`NO_EMITTER`].
    pub of_spheres: Vec<u32>,
}

/// The number of a surface that no shadow ray samples.
const NO_EMITTER: u32 = u32::MAX;

/// Tests whether shadow rays may sample a material's light. They end before it, so they cannot tell whether they
/// pass through one of its holes.
fn is_lamp(material: &Material) -> bool {
    material.emission.max_element() > 0.0 && !material.has_cutout()
}

impl Composition {
    /// The first material of a sphere or a placed mesh that shines.
    pub(crate) fn lamp(&self) -> Option<&Material> {
        let meshes = self.scene.instances.iter().map(|instance| instance.material);
        let spheres = self.spheres.iter().map(|sphere| sphere.material as usize);
        let lamps = meshes.chain(spheres).map(|number| &self.scene.model.materials[number]);
        lamps.into_iter().find(|material| is_lamp(material))
    }

    /// Tests whether anything scatters light: has a colour, and is not glass.
    pub(crate) fn scatters(&self) -> bool {
        let is_colored = |color: Vec3| color.max_element() > 0.0;
        let glass = |material: &Material| is_glass(material) && self.depth > 0;
        let plane = self.plane.is_some_and(|plane| is_colored(plane.light.max(plane.dark)));
        self.in_use().into_iter().any(|number| {
            let (material, finish) = (&self.scene.model.materials[number], &self.finishes[number]);
            let other = finish.second.max(finish.ink);
            !glass(material) && is_colored(material.base_color.max(other))
        }) || plane
            || self.heightfield.is_some()
    }

    /// The emitters that shadow rays may sample, if there are any.
    ///
    /// # Errors
    /// If there is too much of it.
    pub fn lamps(&self) -> Result<Option<Lamps>> {
        if self.lamp().is_none() {
            return Ok(None);
        }
        let Scene { model, instances, camera } = &self.scene;
        let materials = model.materials.clone();
        let model = Model { meshes: model.meshes.clone(), materials, ..Model::default() };
        let mut scene = Scene { model, instances: instances.clone(), camera: *camera };
        let materials = &mut scene.model.materials;
        for material in materials.iter_mut().filter(|material| !is_lamp(material)) {
            material.emission = Vec3::ZERO;
        }
        let shines = |material: usize| materials[material].emission != Vec3::ZERO;
        let triangles = scene.instances.iter().filter(|instance| shines(instance.material));
        let triangles = triangles.map(|instance| scene.model.meshes[instance.mesh].triangles.len());
        let shining = self.spheres.iter().filter(|sphere| shines(sphere.material as usize)).count();
        // Before the list of them is made: few lines place a large mesh many times.
        let count = triangles.fold(shining, usize::saturating_add);
        ensure!(count <= MOST, "{count} triangles and spheres shine, and at most {MOST} may");
        let mut spheres = Vec::new();
        let of_spheres =
            self.spheres.iter().map(|&crate::Sphere { center, radius, material, .. }| {
                let material = material as usize;
                if !shines(material) {
                    return NO_EMITTER;
                }
                spheres.push(emitters::Sphere { center, radius, material });
                spheres.len() as u32 - 1
            });
        let of_spheres = of_spheres.collect();
        let dull: Vec<bool> = scene.instances.iter().map(|i| !shines(i.material)).collect();
        let emitters = Emitters::new(&scene, &spheres)?;
        let first = emitters.first.iter().zip(dull);
        let of_instances =
            first.map(|(&first, dull)| if dull { NO_EMITTER } else { first }).collect();
        Ok(Some(Lamps { emitters, of_instances, of_spheres }))
    }
}
