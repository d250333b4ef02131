//! The acceleration structures of a frame: all that is there while the shutter is open, by one of two methods.

use anyhow::Result;
use ash::vk;
use bytemuck::Zeroable;
use common::gpu::{AccelerationStructure, Buffer, BuildOptions, Geometry, Gpu, margin, order};
use common::scene::{input_usage, instance_bytes, instance_on_gpu};
use glam::{Affine3A, Vec3, Vec4};

use super::shutter::{Between, between};
use super::sweep::Sweep;
use super::world::{Shown, World};

common::shader_enum! {
    /// The representation of moving pieces in the top level.
    pub enum Method: METHOD {
        /// Once for each of a few moments, seen by the rays of that moment alone.
        Moments,
        /// Once, as a box around the way of each of its triangles.
        Swept,
    }
}

common::shader_struct! {
    /// A piece that is under way: its poses when the shutter opens and when it closes.
    pub struct Mover {
        open_rotation: Vec4,
        close_rotation: Vec4,
        open_place: Vec3,
        close_place: Vec3,
        /// Index of its record in the scene.
        record: u32,
        /// Number of triangles.
        triangles: u32,
    }
}

common::shader_struct! {
    /// Number of calls of the intersection shader.
    pub struct Calls {
        count: u32,
    }
}

/// Parameters of a frame's levels.
#[derive(Clone, Copy, PartialEq)]
pub struct Plan {
    pub method: Method,
    pub moments: u32,
    pub between: Between,
    /// In frames.
    pub shutter: f32,
    pub turns: u32,
}

/// The bit of the custom index that marks a moving piece; shaders have the same number.
const UNDER_WAY: usize = 1 << 23;
/// Bound on the distance from a ray's origin to a triangle, for the margin of its box: eyes farther away see no
/// detail of it.
const REACH: f32 = 64.0;

/// The levels, and the frame that they show.
pub struct Levels {
    /// The top level.
    pub tlas: AccelerationStructure,
    pub movers: Buffer,
    /// Number of calls of the intersection shader.
    pub calls: Buffer,
    /// True if a piece is under way.
    pub moves: bool,
    /// The bottom levels of what is under way, for the method `swept`.
    swept: Vec<AccelerationStructure>,
    sweep: Sweep,
    instances: Buffer,
    scratch: Buffer,
    /// The plan that they were made for.
    room_for: Plan,
    shown: Option<(u32, Plan)>,
    /// Instances and boxes that are not there only to fill the room.
    used: [u32; 2],
    gpu: Gpu,
}

impl Levels {
    /// Room for the frame with the most pieces under way.
    pub fn new(gpu: &Gpu, world: &World, plan: Plan) -> Result<Self> {
        let most = world.motion.most_under_way(plan.shutter).max(1);
        let sweep = Sweep::new(gpu, world.most_triangles(), most as u32)?;
        let options = BuildOptions::default();
        let (swept, copies) = match plan.method {
            Method::Moments => (Vec::new(), most * (plan.moments as usize - 1)),
            Method::Swept => {
                let geometry: Vec<_> = (0..most as u32).map(|at| [sweep.geometry(at)]).collect();
                let inputs: Vec<_> = geometry.iter().map(|one| ("swept", &one[..])).collect();
                (AccelerationStructure::build(gpu, &inputs, options)?, 0)
            }
        };
        // The recorded copy needs its target to allow one. All other instances name no bottom level: they are inactive.
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let count = world.count() + copies;
        let instances = Buffer::with_data(gpu, "instances", &vec![[0u8; 64]; count], usage)?;
        let tlas = AccelerationStructure::top(gpu, "top level", &instances, count as u32, options)?;
        let movers = vec![Mover::zeroed(); most];
        let movers = Buffer::with_data(gpu, "movers", &movers, usage)?;
        let calls =
            Buffer::with_data(gpu, "calls", &[0u32], usage | vk::BufferUsageFlags::TRANSFER_SRC)?;
        let widest = swept.iter().map(AccelerationStructure::build_scratch).max().unwrap_or(0);
        let scratch =
            if widest > tlas.build_scratch() { swept[0].scratch()? } else { tlas.scratch()? };
        Ok(Self {
            tlas,
            movers,
            calls,
            moves: false,
            swept,
            sweep,
            instances,
            scratch,
            room_for: plan,
            shown: None,
            used: [0; 2],
            gpu: gpu.clone(),
        })
    }

    /// Tests whether they have room for another plan.
    pub fn fit(&self, plan: Plan) -> bool {
        let of = |plan: Plan| (plan.method, plan.moments, plan.shutter);
        of(self.room_for) == of(plan)
    }

    /// Records what builds the levels of a frame.
    pub fn reach(
        &mut self,
        cmd: vk::CommandBuffer,
        world: &World,
        (frame, plan): (u32, Plan),
    ) -> Result<()> {
        if self.shown == Some((frame, plan)) {
            return Ok(());
        }
        let shown = world.shown(frame, plan.shutter, plan.turns);
        let movers = movers(world, &shown);
        self.movers.update(cmd, &movers)?;
        // ANCHOR: swept
        if plan.method == Method::Swept {
            let count = movers.len() as u32;
            let addresses = (self.movers.address.into(), world.addresses.instances);
            self.sweep.record(cmd, addresses, count, margin(REACH))?;
            for (at, level) in (0..).zip(&self.swept).take(movers.len()) {
                level.rebuild(cmd, &[self.sweep.geometry(at)], &self.scratch)?;
            }
        }
        // ANCHOR_END: swept
        let mut instances = self.instances(world, &shown, plan);
        self.moves = !movers.is_empty();
        self.used = [instances.len() as u32, movers.iter().map(|mover| mover.triangles).sum()];
        let room = self.instances.size as usize / 64;
        instances.resize(room, [0; 64]);
        self.instances.update(cmd, instances.as_flattened())?;
        let count = room as u32;
        let input = [Geometry::Instances { instances: self.instances.address, count }];
        self.tlas.rebuild(cmd, &input, &self.scratch)?;
        self.shown = Some((frame, plan));
        Ok(())
    }

    /// The instances, neighbours beside each other. What is under way is there once for each moment, or once swept.
    fn instances(&self, world: &World, shown: &[Shown], plan: Plan) -> Vec<[u8; 64]> {
        let (mut list, mut mover) = (Vec::new(), 0);
        for Shown { mesh, record, at, moved } in shown {
            let blas = &world.scene.blas[*mesh];
            match moved {
                None => {
                    list.push((world.around(*mesh, at), instance_on_gpu(at, *record, 0, blas)));
                }
                Some(poses) if plan.method == Method::Moments => {
                    for moment in 0..plan.moments {
                        let part = (moment as f32 + 0.5) / plan.moments as f32;
                        let at = between(*poses, part, plan.between);
                        let mut instance = instance_on_gpu(&at, UNDER_WAY | record, 0, blas);
                        // A ray of one moment has one bit, and fixed objects have all.
                        instance.instance_custom_index_and_mask =
                            vk::Packed24_8::new((UNDER_WAY | record) as u32, 1 << moment);
                        list.push((world.around(*mesh, &at), instance));
                    }
                }
                Some(poses) => {
                    let ends = poses
                        .map(|pose| world.around(*mesh, &between([pose; 2], 0.0, plan.between)));
                    let both = (ends[0].0.min(ends[1].0), ends[0].1.max(ends[1].1));
                    let (blas, index) = (&self.swept[mover], UNDER_WAY | mover);
                    // Its boxes are where they are in the world.
                    list.push((both, instance_on_gpu(&Affine3A::IDENTITY, index, 1, blas)));
                    mover += 1;
                }
            }
        }
        let bounds: Vec<_> = list.iter().map(|(bounds, _)| *bounds).collect();
        let ordering = world.scene.options.ordering;
        let order = order::for_build(&self.gpu, &bounds, ordering);
        order.iter().map(|&index| instance_bytes(&list[index as usize].1)).collect()
    }

    /// Bytes, what is in them, and how often the intersection shader was called.
    pub fn report(&self) -> Result<serde_json::Value> {
        let [instances, boxes] = self.used;
        let calls: Vec<u32> = self.calls.read()?;
        let is_swept = !self.swept.is_empty();
        Ok(serde_json::json!({
            "top_bytes": self.tlas.size,
            "bottom_bytes": self.swept.iter().map(|level| level.size).sum::<u64>(),
            "box_bytes": if is_swept { self.sweep.boxes.size } else { 0 },
            "instances": instances,
            "boxes": if is_swept { boxes } else { 0 },
            "calls": calls[0],
        }))
    }
}

/// Data for the shaders about all moving pieces.
fn movers(world: &World, shown: &[Shown]) -> Vec<Mover> {
    let mover = |Shown { mesh, record, moved, .. }: &Shown| {
        let [open, close] = (*moved)?;
        Some(Mover {
            open_rotation: open.rotation.into(),
            close_rotation: close.rotation.into(),
            open_place: open.place,
            close_place: close.place,
            record: *record as u32,
            triangles: world.triangles(*mesh),
        })
    };
    shown.iter().filter_map(mover).collect()
}
