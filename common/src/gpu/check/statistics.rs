//! Counts of the objects created on a device.

use std::sync::Arc;
use std::time::Duration;

use crate::gpu::Asked;
use crate::gpu::check::executable::Executable;
use crate::gpu::check::table::Table;
use crate::gpu::pipeline::desc::PipelineDesc;

/// Counts and descriptions of the objects created on a device.
#[derive(Clone, Debug, Default)]
pub struct Statistics {
    /// Host time of acceleration structure builds.
    pub build_time: Duration,
    /// Bytes of all existing acceleration structures.
    pub acceleration_structure_bytes: u64,
    /// Host time of compiling shaders and creating pipelines.
    pub pipeline_time: Duration,
    /// The description of every pipeline, in order of creation.
    pub descs: Vec<Arc<PipelineDesc>>,
    /// Every shader binding table, in order of creation.
    pub tables: Vec<Table>,
    /// The hit records of the instances of the last top level, as far as known.
    pub asked: Asked,
    /// Warnings about likely mistakes, each with the name of the pipeline or the structure.
    pub warnings: Vec<(String, String)>,
    /// The driver's compiler statistics for the last pipeline, if requested and supported.
    pub executables: Vec<Executable>,
}

impl Statistics {
    /// The stages of all pipelines, by path below `shaders/`.
    pub fn stages(&self) -> Vec<String> {
        let stages = self.descs.iter().flat_map(|desc| &desc.stages);
        stages.map(|stage| stage.path.clone()).collect()
    }

    /// Number of shader groups in all pipelines.
    pub fn groups(&self) -> usize {
        self.descs.iter().map(|desc| desc.groups.len()).sum()
    }
}
