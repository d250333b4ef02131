//! A driver's statistics of a compiled pipeline: `VK_KHR_pipeline_executable_properties`.

use std::ffi::CStr;

use anyhow::Result;
use ash::{khr, vk};
use serde::{Deserialize, Serialize};

/// One program of a pipeline, as its driver's compiler describes it.
///
/// Their number and names depend on the driver: it may merge all stages into one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Executable {
    /// The driver's name for it.
    pub name: String,
    /// `VkShaderStageFlags`: the stages it contains.
    pub stages: u32,
    /// Invocations per subgroup.
    pub subgroup_size: u32,
    /// The driver's own names and values; other drivers may have different ones.
    pub statistics: Vec<(String, f64)>,
}

impl Executable {
    /// The programs of a pipeline created with `CAPTURE_STATISTICS_KHR`.
    ///
    /// # Errors
    /// If the driver does not report them.
    pub fn all(
        device: &khr::pipeline_executable_properties::Device,
        pipeline: vk::Pipeline,
    ) -> Result<Vec<Self>> {
        let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
        // SAFETY: the pipeline is alive and was created with statistics enabled.
        let programs = unsafe { device.get_pipeline_executable_properties(&info)? };
        let mut all = Vec::new();
        for (index, program) in programs.iter().enumerate() {
            let info = vk::PipelineExecutableInfoKHR::default()
                .pipeline(pipeline)
                .executable_index(index as u32);
            // SAFETY: as above.
            let statistics = unsafe { device.get_pipeline_executable_statistics(&info)? };
            all.push(Self {
                name: text(program.name_as_c_str()),
                stages: program.stages.as_raw(),
                subgroup_size: program.subgroup_size,
                statistics: statistics
                    .iter()
                    .map(|statistic| (text(statistic.name_as_c_str()), value(statistic)))
                    .collect(),
            });
        }
        Ok(all)
    }

    /// The statistic of this name, if the driver has one.
    pub fn figure(&self, name: &str) -> Option<f64> {
        self.statistics.iter().find(|(known, _)| known == name).map(|&(_, value)| value)
    }
}

fn text<E>(name: Result<&CStr, E>) -> String {
    name.map_or_else(|_| String::new(), |name| name.to_string_lossy().into_owned())
}

fn value(statistic: &vk::PipelineExecutableStatisticKHR) -> f64 {
    // SAFETY: the format says which member of the union the driver wrote.
    unsafe {
        match statistic.format {
            vk::PipelineExecutableStatisticFormatKHR::BOOL32 => f64::from(statistic.value.b32),
            vk::PipelineExecutableStatisticFormatKHR::INT64 => statistic.value.i64 as f64,
            vk::PipelineExecutableStatisticFormatKHR::UINT64 => statistic.value.u64 as f64,
            _ => statistic.value.f64,
        }
    }
}
