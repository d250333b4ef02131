//! A shader binding table in words: the shaders selected by a record, and the instances that use it.

use std::sync::Arc;

use ash::vk;

use crate::gpu::Asked;
use crate::gpu::pipeline::desc::{Group, PipelineDesc};

/// A shader binding table: its pipeline, and what its records are.
#[derive(Clone, Debug)]
pub struct Table {
    /// The pipeline.
    pub desc: Arc<PipelineDesc>,
    /// Number of groups of each kind: raygen, miss, hit, callable.
    pub groups: [usize; 4],
    /// The hit group of each hit record.
    pub hit: Vec<usize>,
}

impl Table {
    /// One line per record: pipeline, record, shaders; a hit record also has the kind of geometry, and a bottom
    /// level that asks for it.
    pub fn lines(&self, asked: &Asked) -> Vec<String> {
        let PipelineDesc { name, groups, .. } = &*self.desc;
        let [raygens, misses, hits, callables] = self.groups;
        let shaders = |group: &Group| {
            let stages = [group.general, group.intersection, group.any_hit, group.closest_hit];
            let stages = stages.iter().filter_map(|stage| self.desc.stages.get(*stage as usize));
            let paths: Vec<_> = stages.map(|stage| stage.path.as_str()).collect();
            if paths.is_empty() { "no shader".to_owned() } else { paths.join(", ") }
        };
        let general = |kind: &str, first: usize, count: usize| -> Vec<String> {
            let records = groups.iter().skip(first).take(count).enumerate();
            records
                .map(|(record, group)| format!("{name}\t{kind} {record}\t{}", shaders(group)))
                .collect()
        };
        let hit = self.hit.iter().enumerate().map(|(record, group)| {
            let group = &groups[raygens + misses + group];
            let boxes = vk::RayTracingShaderGroupTypeKHR::PROCEDURAL_HIT_GROUP.as_raw();
            let of = if group.kind == boxes { "boxes" } else { "triangles" };
            let users = asked.iter().filter(|(asked, _)| asked.record as usize == record);
            let users: Vec<_> = users.map(|(_, user)| format!("'{user}'")).collect();
            // A ray may add to the record of an instance, and so use this one.
            let users = if users.is_empty() { "no instance".to_owned() } else { users.join(", ") };
            format!("{name}\thit {record}\t{}\tfor {of}, asked for by {users}", shaders(group))
        });
        let mut lines = general("raygen", 0, raygens);
        lines.extend(general("miss", raygens, misses));
        lines.extend(hit);
        lines.extend(general("callable", raygens + misses + hits, callables));
        lines
    }
}
