//! The acceleration structures of what moves: the flag's bottom level, and the top level of all instances. At each
//! frame they are built again or updated.

use anyhow::Result;
use ash::vk;
use common::gpu::{AccelerationStructure, Buffer, BuildOptions, Geometry, Gpu};
use common::scene::{input_usage, instance_bytes};

use super::costs::Costs;
use super::flag::Flag;
use super::world::World;

common::shader_enum! {
    /// The way a level follows its frame.
    pub enum Policy {
        /// It is built again.
        Rebuilt,
        /// Its tree stays, and its boxes follow.
        Updated,
    }
}

/// The policy of each level.
#[derive(Clone, Copy, PartialEq)]
pub struct Plan {
    pub flag: Policy,
    pub top: Policy,
    /// Interval in frames at which levels that are updated are also rebuilt.
    pub every: u32,
}

/// The levels, and the frame that they show.
pub struct Levels {
    /// The top level.
    pub tlas: AccelerationStructure,
    flag: AccelerationStructure,
    instances: Buffer,
    scratch: [Buffer; 2],
    /// The instance of each primitive of the build.
    order: Vec<u32>,
    shown: Option<(u32, Plan)>,
    /// The frame of the last build of both.
    built: Option<u32>,
    costs: Costs,
    gpu: Gpu,
}

impl Levels {
    pub fn new(gpu: &Gpu, world: &World, flag: &Flag) -> Result<Self> {
        let options = BuildOptions { updatable: true, ..BuildOptions::default() };
        let bottom = AccelerationStructure::bottom(gpu, "flag", &[flag.geometry()], options)?;
        let order = world.order(gpu, 0);
        let bytes = world.instances(0, &order, &bottom);
        let bytes: Vec<u8> = bytes.iter().flat_map(instance_bytes).collect();
        // The copy that is recorded needs its target to allow one.
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let instances = Buffer::with_data(gpu, "instances", &bytes, usage)?;
        let count = order.len() as u32;
        let tlas = AccelerationStructure::top(gpu, "top level", &instances, count, options)?;
        let scratch = [bottom.scratch()?, tlas.scratch()?];
        let (costs, gpu) = (Costs::new(gpu)?, gpu.clone());
        let (shown, built) = (None, None);
        Ok(Self { tlas, flag: bottom, instances, scratch, order, shown, built, costs, gpu })
    }

    /// Tests whether they are at a frame, by this plan.
    pub fn are_at(&self, frame: u32, plan: Plan) -> bool {
        self.shown == Some((frame, plan))
    }

    /// Records what takes the levels to a frame. What they are there follows from the frame and the plan alone: built
    /// at the last frame that `every` divides, and updated once from there.
    pub fn reach(
        &mut self,
        cmd: vk::CommandBuffer,
        (world, flag): (&World, &Flag),
        (frame, plan): (u32, Plan),
    ) -> Result<()> {
        if self.are_at(frame, plan) {
            return Ok(());
        }
        self.costs.settle()?;
        let due = frame - frame % plan.every;
        let same_plan = self.shown.is_some_and(|(_, before)| before == plan);
        if self.built != Some(due) || !same_plan {
            self.show(cmd, (world, flag), (due, plan), true)?;
            self.built = Some(due);
        }
        if frame != due {
            self.show(cmd, (world, flag), (frame, plan), false)?;
        }
        self.shown = Some((frame, plan));
        Ok(())
    }

    /// Moves everything to a frame: vertices, the flag's bottom level, instances, the top level, in this order.
    fn show(
        &mut self,
        cmd: vk::CommandBuffer,
        (world, flag): (&World, &Flag),
        (frame, plan): (u32, Plan),
        anew: bool,
    ) -> Result<()> {
        flag.deform(cmd, frame)?;
        let is_built = |policy| anew || policy == Policy::Rebuilt;
        let (geometry, [for_flag, for_top]) = ([flag.geometry()], &self.scratch);
        self.costs.time(cmd, 0, is_built(plan.flag), || {
            if is_built(plan.flag) {
                self.flag.rebuild(cmd, &geometry, for_flag)
            } else {
                self.flag.update(cmd, &geometry, for_flag)
            }
        })?;

        // An update keeps the order of the build: instance i of both is the same piece.
        if is_built(plan.top) {
            self.order = world.order(&self.gpu, frame);
        }
        let instances = world.instances(frame, &self.order, &self.flag);
        let bytes: Vec<u8> = instances.iter().flat_map(instance_bytes).collect();
        self.instances.update(cmd, &bytes)?;
        let count = instances.len() as u32;
        let input = [Geometry::Instances { instances: self.instances.address, count }];
        self.costs.time(cmd, 1, is_built(plan.top), || {
            if is_built(plan.top) {
                self.tlas.rebuild(cmd, &input, for_top)
            } else {
                self.tlas.update(cmd, &input, for_top)
            }
        })
    }

    /// Bytes and milliseconds of both levels, built and updated.
    pub fn report(&self) -> Result<serde_json::Value> {
        self.costs.settle()?;
        let level = |level: &AccelerationStructure, number: usize| {
            serde_json::json!({
                "bytes": level.size,
                "build_scratch_bytes": level.build_scratch(),
                "update_scratch_bytes": level.update_scratch(),
                "build_milliseconds": self.costs.median(number, true),
                "update_milliseconds": self.costs.median(number, false),
            })
        };
        Ok(serde_json::json!({ "flag": level(&self.flag, 0), "top": level(&self.tlas, 1) }))
    }
}
