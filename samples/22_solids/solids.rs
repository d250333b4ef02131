//! The solids on the device: their programs in buffers, a box around each, and the top level with them.

use anyhow::Result;
use common::bytemuck::cast_slice;
use common::gpu::{AccelerationStructure, Address, Buffer, Gpu, order};
use common::scene::plane::Plane;
use common::scene::{
    Moved, Placement, Scene, SceneOnGpu, Size, build_top, input_usage, instance_on_gpu,
    moved_bounds,
};
use glam::{Affine3A, DAffine3, DVec3, Mat3A, Vec3, Vec4};

use crate::boxes;
use crate::modifiers::Modifiers;
use crate::program::{Face, Part, Programs};
use crate::scenes::{self, PresetName, SolidInstance};
use crate::solid::{Ball, Bound, REACH, Solid, block};

/// Parameters of the solids; a change rebuilds them.
#[derive(Clone, Copy, PartialEq)]
pub struct Build {
    /// The scene of the preset.
    pub preset: PresetName,
    /// The size of everything.
    pub size: Size,
    /// The distance of everything from the origin.
    pub moved: Moved,
    /// The options of all solids.
    pub modifiers: Modifiers,
}

impl Default for Build {
    fn default() -> Self {
        let (size, moved) = (Size::Usual, Moved::Not);
        Self { preset: PresetName::Board, size, moved, modifiers: Modifiers::default() }
    }
}

impl Build {
    /// The placement of everything.
    pub fn placement(&self) -> Placement {
        Placement::new(self.size, self.moved)
    }

    /// Returns whether the pieces also differ, or are in other places.
    pub fn places_otherwise(&self, other: &Self) -> bool {
        Self { modifiers: other.modifiers, ..*self } != *other
    }
}

common::shader_struct! {
    /// Addresses of the solids, and their custom indices.
    pub struct Solids {
        pub planes: Address<Plane>,
        pub balls: Address<Ball>,
        pub faces: Address<Face>,
        pub parts: Address<Part>,
        pub steps: Address,
        pub at: Address<SolidRecord>,
        /// Custom index of the first solid; the others follow.
        pub first: u32,
        pub count: u32,
    }
}

common::shader_struct! {
    /// A solid, as shaders get it.
    pub struct SolidRecord {
        pub first_part: u32,
        pub part_count: u32,
        pub first_step: u32,
        pub step_count: u32,
        /// The part outside of which the surface is left out; [`NO_CLIP`] for none.
        pub clip: u32,
        /// Rows of the matrix from the world to the solid's space.
        pub to_object: [Vec4; 3],
    }
}

const NO_CLIP: u32 = u32::MAX;

impl SolidRecord {
    fn new(numbers: [u32; 5], to_object: &DAffine3) -> Self {
        let [first_part, part_count, first_step, step_count, clip] = numbers;
        let rows = to_object.matrix3.transpose();
        let shift = to_object.translation;
        let to_object = [
            rows.x_axis.extend(shift.x).as_vec4(),
            rows.y_axis.extend(shift.y).as_vec4(),
            rows.z_axis.extend(shift.z).as_vec4(),
        ];
        Self { first_part, part_count, first_step, step_count, clip, to_object }
    }
}

/// Solids in device memory, and the top level that holds them beside the meshes.
pub struct SolidsOnGpu {
    /// Everything.
    pub tlas: AccelerationStructure,
    /// The buffer with the addresses of the solids: a [`Solids`].
    pub addresses: Buffer,
    /// The parameters they were built from.
    pub build: Build,
    /// Each solid, its clips, and the matrix from the world to its space.
    inside: Vec<(Solid, Vec<Bound>, DAffine3)>,
    _levels: Vec<AccelerationStructure>,
    _buffers: Vec<Buffer>,
}

impl SolidsOnGpu {
    /// `scene` is placed already, the solids are not.
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        on_gpu: &SceneOnGpu,
        solids: &[SolidInstance],
        build: Build,
    ) -> Result<Self> {
        let Build { modifiers, .. } = build;
        let mut bounds = scene.bounds_of_instances();
        let pieces = scene.instances.iter().enumerate();
        let mut instances: Vec<_> = pieces
            .map(|(index, piece)| {
                instance_on_gpu(&piece.transform, index, 0, &on_gpu.blas[piece.mesh])
            })
            .collect();
        let first = instances.len();

        let mut programs = Programs::new(modifiers.shared);
        let (mut records, mut levels, mut inside) = (Vec::new(), Vec::new(), Vec::new());
        for solid_instance in solids {
            let (solid, mut clips) = modifiers.of(&solid_instance.solid, solid_instance.clip);
            let [first_part, part_count, first_step, step_count] =
                programs.add(&solid, &|name| scenes::material(&scene.model, name));
            // An unbounded solid is clipped by the largest box, as if the user had requested that.
            let (low, high) = solid.bounds()[1];
            if low.min_element() <= -f64::from(REACH) || high.max_element() >= f64::from(REACH) {
                clips.extend(block(Vec3::splat(-REACH), Vec3::splat(REACH)));
            }
            let clip = if clips.is_empty() { NO_CLIP } else { programs.add_part(&clips, 0) };
            let corners = box_around(low, high);
            // The margin is in the corners already.
            let level = boxes::bottom(gpu, "solid", [corners], 0.0)?;
            let to_world = place(&solid_instance.transform, &build.placement());
            instances.push(instance_on_gpu(&to_world, first + records.len(), 1, &level));
            bounds.push(moved_bounds(corners, &to_world));
            let to_object = to_world_f64(&to_world).inverse();
            let record = [first_part, part_count, first_step, step_count, clip];
            records.push(SolidRecord::new(record, &to_object));
            levels.push(level);
            inside.push((solid, clips, to_object));
        }
        let order = order::for_build(gpu, &bounds, true).into_iter();
        let tlas = build_top(gpu, &order.map(|i| instances[i as usize]).collect::<Vec<_>>())?;

        let list = |name, data: &[u8]| Buffer::with_data(gpu, name, filled(data), input_usage());
        let buffers = [
            list("planes", cast_slice(&programs.planes))?,
            list("balls", cast_slice(&programs.balls))?,
            list("faces", cast_slice(&programs.faces))?,
            list("parts", cast_slice(&programs.parts))?,
            list("steps", cast_slice(&programs.steps))?,
            list("solid records", cast_slice(&records))?,
        ];
        let [planes, balls, faces, parts, steps, at] =
            buffers.each_ref().map(|buffer| buffer.address);
        let addresses = [Solids {
            planes: planes.into(),
            balls: balls.into(),
            faces: faces.into(),
            parts: parts.into(),
            steps: steps.into(),
            at: at.into(),
            first: first as u32,
            count: records.len() as u32,
        }];
        Ok(Self {
            tlas,
            addresses: Buffer::with_data(gpu, "solids", &addresses, input_usage())?,
            build,
            inside,
            _levels: levels,
            _buffers: buffers.into(),
        })
    }

    /// Tests whether a point of the world lies in a solid that is closed all around. Light enters an open one
    /// without meeting a surface: that is left to the shaders.
    pub fn enclose(&self, point: DVec3) -> bool {
        self.inside.iter().any(|(solid, clips, to_object)| {
            clips.is_empty() && solid.contains(to_object.transform_point3(point))
        })
    }
}

/// The box for a solid whose surface has these corners.
///
/// A hundredth larger than the solid: room for what the device's box test rounds, 10u of the way (chapter
/// 42), for rays that come from as far as sixteen thousand times its size.
fn box_around(low: DVec3, high: DVec3) -> order::Bounds {
    let margin = 0.01 * (high - low).max_element();
    // An empty solid needs no particular box, because its shader finds nothing.
    if low.is_finite() && low.cmple(high).all() {
        ((low - margin).as_vec3(), (high + margin).as_vec3())
    } else {
        (Vec3::ZERO, Vec3::splat(1e-3))
    }
}

/// A buffer cannot be empty.
fn filled(data: &[u8]) -> &[u8] {
    if data.is_empty() { &[0; 16] } else { data }
}

/// The transform of an instance after a placement of the scene.
fn place(transform: &Affine3A, placement: &Placement) -> Affine3A {
    let axis = |axis: glam::Vec3A| (axis.as_dvec3() * placement.size).as_vec3a();
    let Affine3A { matrix3, translation } = *transform;
    let moved = translation.as_dvec3() * placement.size + placement.moved;
    Affine3A {
        matrix3: Mat3A::from_cols(axis(matrix3.x_axis), axis(matrix3.y_axis), axis(matrix3.z_axis)),
        translation: moved.as_vec3a(),
    }
}

fn to_world_f64(transform: &Affine3A) -> DAffine3 {
    DAffine3 {
        matrix3: glam::Mat3::from(transform.matrix3).as_dmat3(),
        translation: transform.translation.as_dvec3(),
    }
}
