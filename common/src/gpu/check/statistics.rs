//! What has been made on a device, in numbers.

use std::sync::Arc;
use std::time::Duration;

use crate::gpu::check::executable::Executable;
use crate::gpu::pipeline::desc::PipelineDesc;

/// What has been made on a device.
#[derive(Clone, Debug, Default)]
pub struct Statistics {
    /// Host time of acceleration structure builds.
    pub build_time: Duration,
    /// Bytes of all acceleration structures that are there.
    pub acceleration_structure_bytes: u64,
    /// Host time of compiling shaders and making pipelines.
    pub pipeline_time: Duration,
    /// What every pipeline was made from, in the order in which they were made.
    pub descs: Vec<Arc<PipelineDesc>>,
    /// What is no error and seldom meant, each with the name of the pipeline or the structure that it is of.
    pub warnings: Vec<(String, String)>,
    /// What the driver's compiler says of the last pipeline, where it was wished for and does.
    pub executables: Vec<Executable>,
}

impl Statistics {
    /// The stages of all pipelines, by path below `shaders/`.
    pub fn stages(&self) -> Vec<String> {
        let stages = self.descs.iter().flat_map(|desc| &desc.stages);
        stages.map(|stage| stage.path.clone()).collect()
    }

    /// How many shader groups there are in all pipelines.
    pub fn groups(&self) -> usize {
        self.descs.iter().map(|desc| desc.groups.len()).sum()
    }
}
