//! What has been made on a device, in numbers.

use std::sync::Arc;
use std::time::Duration;

use super::blueprint::Blueprint;
use super::executable::Executable;

/// What has been made on a device.
#[derive(Clone, Debug, Default)]
pub struct Statistics {
    /// Host time of acceleration structure builds.
    pub build_time: Duration,
    /// Bytes of all acceleration structures that are there.
    pub acceleration_structure_bytes: u64,
    /// Host time of compiling shaders and making pipelines.
    pub pipeline_time: Duration,
    /// Shader stages compiled, by path below `shaders/`.
    pub stages: Vec<String>,
    /// Shader groups in all pipelines.
    pub groups: usize,
    /// What every pipeline was made from, in the order in which they were made.
    pub blueprints: Vec<Arc<Blueprint>>,
    /// What the driver's compiler says of the last pipeline, where it was wished for and does.
    pub executables: Vec<Executable>,
}
