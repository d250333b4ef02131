//! A scene: a model's meshes, placed in the world, and a camera that looks at them.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use glam::{Affine3A, DVec3, Vec3};

use super::top_level::check_transform;
use super::{Camera, Mesh};
use crate::model::{Model, gltf, obj};

/// Meshes, materials and textures with their placements.
#[derive(Clone)]
pub struct Scene {
    /// The model whose meshes are placed.
    pub model: Model,
    /// The placed meshes. Several instances of a mesh share its memory.
    pub instances: Vec<Instance>,
    /// A view of the scene.
    pub camera: Camera,
}

/// One placement of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Instance {
    /// The mesh, by position in the model.
    pub mesh: usize,
    /// From the mesh's space to the world.
    pub transform: Affine3A,
    /// The material, by position in the model.
    pub material: usize,
    /// Its first hit record in the shader binding table, below 2^24: `instanceShaderBindingTableRecordOffset`.
    pub record_offset: u32,
}

impl Scene {
    /// Opens a model. Of an OBJ file, each mesh is at its place in the file, with a camera that shows all of it; a glTF
    /// file places its own meshes and may have a camera. A model that is far from the origin is moved there.
    ///
    /// # Errors
    /// As [`obj::load`] or [`gltf::load`].
    pub fn open(path: &Path) -> Result<Self> {
        if gltf::is_gltf(path) {
            return gltf::load(path);
        }
        let model = obj::load_centered(path)?;
        let instances = (0..model.meshes.len())
            .map(|mesh| Instance {
                mesh,
                transform: Affine3A::IDENTITY,
                material: model.meshes[mesh].material,
                record_offset: 0,
            })
            .collect();
        let mut scene = Self { model, instances, camera: Camera::default() };
        scene.camera = scene.camera_on_all();
        Ok(scene)
    }

    /// Checks that all indices lie within the model, and all numbers are finite. Returns warnings about likely
    /// mistakes.
    ///
    /// # Errors
    /// Names the instance, mesh or material that is wrong, and what there is.
    pub fn check(&self) -> Result<Vec<String>> {
        let Model { meshes, materials, textures, .. } = &self.model;
        let mut warnings = Vec::new();
        for mesh in meshes {
            warnings.extend(mesh.check()?);
            if mesh.material >= materials.len() {
                warnings.push(format!(
                    "mesh '{}' has the material {}, and there are {}, counted from 0; the material of its \
                     instances counts",
                    mesh.name,
                    mesh.material,
                    materials.len()
                ));
            }
        }
        for (number, material) in materials.iter().enumerate() {
            let named = [material.base_texture, material.opacity_texture].into_iter().flatten();
            for texture in named {
                ensure!(
                    texture < textures.len(),
                    "material {number} has the texture {texture}, and there are {}, counted from 0",
                    textures.len()
                );
            }
        }
        for (number, instance) in self.instances.iter().enumerate() {
            let Instance { mesh, material, transform, .. } = instance;
            ensure!(
                *mesh < meshes.len(),
                "instance {number} has the mesh {mesh}, and there are {}, counted from 0",
                meshes.len()
            );
            ensure!(
                *material < materials.len(),
                "instance {number} has the material {material}, and there are {}, counted from 0",
                materials.len()
            );
            let columns = [0, 1, 2].map(|i| transform.matrix3.col(i).as_dvec3());
            check_transform(columns, transform.translation.as_dvec3())
                .with_context(|| format!("instance {number}, of '{}'", meshes[*mesh].name))?;
        }
        Ok(warnings)
    }

    /// Corners of the box around everything, in world space.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let boxes = self.bounds_of_instances().into_iter();
        boxes.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), (l, h)| {
            (low.min(l), high.max(h))
        })
    }

    /// Corners of the box around each instance, in world space, in the order of `instances`; inverted for an
    /// instance of a missing mesh, which [`Scene::check`] reports. Each mesh is examined once, however many
    /// instances it has.
    pub fn bounds_of_instances(&self) -> Vec<(Vec3, Vec3)> {
        let meshes: Vec<_> = self.model.meshes.iter().map(Mesh::bounds).collect();
        let nothing = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let around = |Instance { mesh, transform, .. }: &Instance| {
            meshes.get(*mesh).map_or(nothing, |bounds| moved_bounds(*bounds, transform))
        };
        self.instances.iter().map(around).collect()
    }

    /// Corners of the box around one instance, in world space.
    pub fn instance_bounds(&self, instance: &Instance) -> (Vec3, Vec3) {
        moved_bounds(self.model.meshes[instance.mesh].bounds(), &instance.transform)
    }

    /// A camera that shows all of the scene.
    pub(crate) fn camera_on_all(&self) -> Camera {
        let (low, high) = self.bounds();
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let (middle, radius) = ((low + high) * 0.5, (high - low).length() * 0.5);
        let fov_y: f64 = 40.0;
        let distance = radius.max(1e-30) / (fov_y.to_radians() / 2.0).sin();
        let from = DVec3::new(0.5, 0.45, 1.0).normalize();
        Camera::new(middle + from * distance, middle, fov_y)
    }
}

/// Corners of the box around a transformed box.
pub fn moved_bounds((low, high): (Vec3, Vec3), transform: &Affine3A) -> (Vec3, Vec3) {
    let middle = transform.transform_point3a(((low + high) * 0.5).into());
    let half = (high - low) * 0.5;
    let matrix = transform.matrix3;
    let reach =
        matrix.x_axis.abs() * half.x + matrix.y_axis.abs() * half.y + matrix.z_axis.abs() * half.z;
    ((middle - reach).into(), (middle + reach).into())
}
