//! A scene on the device: buffers that shaders read by address, acceleration structures, textures.

use std::mem;
use std::sync::Arc;

use anyhow::{Result, bail, ensure};
use ash::vk;
use bytemuck::cast_slice;
use glam::Vec3;

use super::meshes::{MeshBuffers, MeshesOnGpu};
use super::top_level::build_top;
use super::{InstanceRecord, MaterialRecord, Scene, SceneAddresses};
use crate::gpu::{AccelerationStructure, Buffer, Gpu, Texels, TextureTable, order};
use crate::model::Model;

/// A scene in device memory, ready to be traced.
///
/// ```no_run
/// use raybook::prelude::*;
///
/// fn load(gpu: &Gpu, setup: &Setup) -> Result<(SceneOnGpu, Camera)> {
///     let scene = setup.scene_or(|| Scene::open("model.obj".as_ref()))?;
///     Ok((SceneOnGpu::new(gpu, &scene, setup.options)?, scene.camera))
/// }
/// ```
pub struct SceneOnGpu {
    /// The top level, with all instances.
    pub tlas: AccelerationStructure,
    /// One bottom level per mesh, in the model's order.
    pub blas: Vec<AccelerationStructure>,
    /// The addresses of each mesh, in the model's order: the record of an instance, still without its material.
    pub meshes: Vec<InstanceRecord>,
    /// Every texture of the model.
    pub textures: Arc<TextureTable>,
    /// The addresses of the scene's arrays, for shaders.
    pub addresses: SceneAddresses,
    /// The options it was built with.
    pub options: SceneOptions,
    _buffers: Vec<Buffer>,
}

/// Options for uploading a scene and building its acceleration structures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneOptions {
    /// Sort primitives and instances in space before the build.
    pub ordering: bool,
    /// Guarantee that an any-hit shader runs at most once per triangle and ray.
    pub no_duplicate_any_hit: bool,
    /// Keep positions only in the bottom levels: hit shaders fetch corners from there, and vertices are freed
    /// after the build.
    pub position_fetch: bool,
    /// Make all mip levels of the textures.
    pub mipmaps: bool,
}

impl Default for SceneOptions {
    fn default() -> Self {
        let (no_duplicate_any_hit, position_fetch, mipmaps) = (false, false, false);
        Self { ordering: true, no_duplicate_any_hit, position_fetch, mipmaps }
    }
}

/// Usage of buffers that shaders read by address and that are input of builds: for samples that require ray tracing.
pub fn input_usage() -> vk::BufferUsageFlags {
    Buffer::ADDRESSED | vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR
}

impl SceneOnGpu {
    /// Uploads a scene and builds its acceleration structures.
    ///
    /// # Errors
    /// If the scene contains an index or a number that is wrong ([`Scene::check`]), memory is short, or an
    /// instance's index or record offset needs more than 24 bits.
    pub fn new(gpu: &Gpu, scene: &Scene, options: SceneOptions) -> Result<Self> {
        let textures = textures(gpu, &scene.model, options.mipmaps)?;
        Self::build(gpu, scene, options, textures)
    }

    /// As [`SceneOnGpu::new`], with textures already on the device.
    ///
    /// # Errors
    /// As [`SceneOnGpu::new`].
    pub fn with_textures(
        gpu: &Gpu,
        scene: &Scene,
        options: SceneOptions,
        textures: Option<Arc<TextureTable>>,
    ) -> Result<Self> {
        match textures {
            Some(textures) => Self::build(gpu, scene, options, textures),
            None => Self::new(gpu, scene, options),
        }
    }

    /// Builds everything but the textures again, with other options; pipelines stay valid.
    ///
    /// # Errors
    /// As [`SceneOnGpu::new`].
    pub fn rebuild(&mut self, gpu: &Gpu, scene: &Scene, options: SceneOptions) -> Result<()> {
        *self = Self::build(gpu, scene, options, self.textures.clone())?;
        Ok(())
    }

    /// Uploads a scene without acceleration structures, for a sample that finds hits by itself. Returns the
    /// addresses for shaders, the textures, and the buffers, which the caller must keep.
    ///
    /// Primitive `i` of mesh `m`, in the sample's numbering, is triangle `orders[m][i]` of the model: shaders find
    /// it in the record's `original`. `kept` textures are not uploaded again, and pipelines stay valid.
    ///
    /// # Errors
    /// If memory is short.
    pub fn without_levels(
        gpu: &Gpu,
        scene: &Scene,
        orders: &[Vec<u32>],
        kept: Option<Arc<TextureTable>>,
    ) -> Result<(SceneAddresses, Arc<TextureTable>, Vec<Buffer>)> {
        gpu.warn("scene", scene.check()?);
        let textures = kept.map_or_else(|| textures(gpu, &scene.model, false), Ok)?;
        let MeshBuffers { records: meshes, mut buffers } =
            MeshBuffers::new(gpu, &scene.model.meshes, orders, Buffer::ADDRESSED)?;
        let (records, addresses) = records(gpu, scene, &meshes, Buffer::ADDRESSED)?;
        buffers.push(records);
        Ok((addresses, textures, buffers))
    }

    fn build(
        gpu: &Gpu,
        scene: &Scene,
        options: SceneOptions,
        textures: Arc<TextureTable>,
    ) -> Result<Self> {
        gpu.warn("scene", scene.check()?);
        let instances = &scene.instances;
        ensure!(instances.len() < 1 << 24, "{} instances are too many", instances.len());
        let offset = instances.iter().map(|instance| instance.record_offset).max().unwrap_or(0);
        ensure!(offset < 1 << 24, "a record offset of {offset} takes more than 24 bits");
        let MeshesOnGpu { blas, records: meshes, mut buffers } =
            MeshesOnGpu::new(gpu, scene, options)?;
        let (records, addresses) = records(gpu, scene, &meshes, input_usage())?;
        buffers.push(records);

        let tlas = Self::top_level(gpu, scene, options, |index| &blas[instances[index].mesh])?;
        Ok(Self { tlas, blas, meshes, textures, addresses, options, _buffers: buffers })
    }

    /// Builds a top level of a scene's instances; `blas` returns the bottom level for each instance's index.
    ///
    /// # Errors
    /// If memory is short.
    pub fn top_level<'a>(
        gpu: &Gpu,
        scene: &Scene,
        options: SceneOptions,
        blas: impl Fn(usize) -> &'a AccelerationStructure,
    ) -> Result<AccelerationStructure> {
        let order = order::for_build(gpu, &scene.bounds_of_instances(), options.ordering);
        let placed = order.into_iter().map(|index| {
            let (index, instance) = (index as usize, &scene.instances[index as usize]);
            // The custom index is the scene's, whatever the order of the build.
            instance_on_gpu(&instance.transform, index, instance.record_offset, blas(index))
        });
        build_top(gpu, &placed.collect::<Vec<_>>())
    }
}

/// The textures of a model, in its order.
fn textures(gpu: &Gpu, model: &Model, mipmaps: bool) -> Result<Arc<TextureTable>> {
    let textures = model.textures.iter().map(|texture| Texels {
        name: &texture.name,
        extent: vk::Extent2D { width: texture.width, height: texture.height },
        rgba: &texture.rgba,
        srgb: texture.srgb,
        halves: texture.slopes,
        sampling: texture.sampling,
    });
    Ok(Arc::new(TextureTable::new(gpu, &textures.collect::<Vec<_>>(), mipmaps)?))
}

/// The records of instances and materials in one buffer, and the address of each array.
fn records(
    gpu: &Gpu,
    Scene { model, instances, .. }: &Scene,
    meshes: &[InstanceRecord],
    usage: vk::BufferUsageFlags,
) -> Result<(Buffer, SceneAddresses)> {
    let records = instances.iter().map(|instance| InstanceRecord {
        material: instance.material as u32,
        ..meshes[instance.mesh]
    });
    let records: Vec<_> = records.collect();
    let materials: Vec<_> = model.materials.iter().map(MaterialRecord::from).collect();
    let records = [cast_slice::<_, u8>(&records), cast_slice(&materials)];
    let (records, at) = Buffer::with_arrays(gpu, "records", records, usage)?;
    let addresses = SceneAddresses { instances: at[0].into(), materials: at[1].into() };
    Ok((records, addresses))
}

/// An instance in its device form, 64 bytes.
pub fn instance_bytes(instance: &vk::AccelerationStructureInstanceKHR) -> [u8; 64] {
    // SAFETY: it is 64 bytes without padding, as Vulkan lays it out, and any bytes are an array of bytes.
    unsafe { mem::transmute(*instance) }
}

/// An instance of a bottom level, visible to every ray, with its custom index and first hit record.
///
/// ```no_run
/// use raybook::prelude::*;
///
/// /// `gl_InstanceCustomIndexEXT` is 7, and hit record 0 is used.
/// fn lifted(blas: &AccelerationStructure) -> vk::AccelerationStructureInstanceKHR {
///     instance_on_gpu(&Affine3A::from_translation(Vec3::Y), 7, 0, blas)
/// }
/// ```
pub fn instance_on_gpu(
    placement: &glam::Affine3A,
    custom_index: usize,
    record: u32,
    blas: &AccelerationStructure,
) -> vk::AccelerationStructureInstanceKHR {
    vk::AccelerationStructureInstanceKHR {
        transform: transform(placement),
        instance_custom_index_and_mask: vk::Packed24_8::new(custom_index as u32, 0xff),
        instance_shader_binding_table_record_offset_and_flags: vk::Packed24_8::new(record, 0),
        acceleration_structure_reference: vk::AccelerationStructureReferenceKHR {
            device_handle: blas.address,
        },
    }
}

/// A transform in Vulkan's form: three rows of four.
pub fn transform(transform: &glam::Affine3A) -> vk::TransformMatrixKHR {
    let rows = transform.matrix3.transpose();
    let (x, y, z, t) = (rows.x_axis, rows.y_axis, rows.z_axis, transform.translation);
    vk::TransformMatrixKHR { matrix: [x.x, x.y, x.z, t.x, y.x, y.y, y.z, t.y, z.x, z.y, z.z, t.z] }
}

/// Boxes for an intersection shader, each as its low and high corner, in a buffer for a build.
///
/// A device may enlarge a box at will, and so call the shader for rays that pass far from it: "AABB primitive
/// bounds consist of all points within an implementation-defined bound which includes the specified box" (Vulkan
/// specification, Ray Intersection Candidate Determination).
///
/// ```no_run
/// use raybook::prelude::*;
///
/// /// A bottom level of one box, which only its build reads.
/// fn shape(gpu: &Gpu) -> Result<AccelerationStructure> {
///     let boxes = boxes_on_gpu(gpu, "shape", &[[Vec3::NEG_ONE, Vec3::ONE]])?;
///     let boxes = [Geometry::Aabbs { boxes: boxes.address, count: 1, opaque: true }];
///     AccelerationStructure::bottom(gpu, "shape", &boxes, BuildOptions::default())
/// }
/// ```
///
/// # Errors
/// If a box is not finite or its corners are exchanged, or memory is short.
pub fn boxes_on_gpu(gpu: &Gpu, name: &str, boxes: &[[Vec3; 2]]) -> Result<Buffer> {
    for (index, [low, high]) in boxes.iter().enumerate() {
        ensure!(
            low.is_finite() && high.is_finite(),
            "box {index} of '{name}' is not finite: its low corner is {low}, its high corner {high}"
        );
        if let Some(axis) = (0..3).find(|&axis| low[axis] > high[axis]) {
            let axis = ["x", "y", "z"][axis];
            bail!(
                "box {index} of '{name}': its low corner is above its high one in {axis}: {low}, {high}"
            );
        }
    }
    Buffer::with_data(gpu, name, &gpu.driver_shim.boxes(boxes.to_vec()), input_usage())
}

#[cfg(test)]
mod tests;
