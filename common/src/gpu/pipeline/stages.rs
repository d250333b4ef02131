//! The stages of a pipeline and the groups that they make.

use anyhow::Result;
use ash::vk;

use crate::gpu::blueprint::Group;
use crate::gpu::shader::{self, Shader};
use crate::gpu::{Arithmetic, contraction};

/// A hit group: what happens where a ray meets one kind of geometry.
#[derive(Clone, Copy, Default, Hash)]
pub struct HitGroup<'a> {
    intersection: Option<&'a str>,
    any_hit: Option<&'a str>,
    closest_hit: Option<&'a str>,
}

impl<'a> HitGroup<'a> {
    /// A group for triangles, which the device intersects itself.
    pub fn triangles() -> Self {
        Self::default()
    }

    /// A group for boxes, inside which `shader` reports hits.
    pub fn procedural(shader: &'a str) -> Self {
        Self { intersection: Some(shader), ..Self::default() }
    }

    /// Adds the shader that runs once, at the hit nearest to the ray's origin.
    pub fn closest_hit(self, shader: &'a str) -> Self {
        Self { closest_hit: Some(shader), ..self }
    }

    /// Adds the shader that runs at each hit of non-opaque geometry and may ignore it.
    pub fn any_hit(self, shader: &'a str) -> Self {
        Self { any_hit: Some(shader), ..self }
    }
}

/// The shaders of a pipeline, each compiled once however many groups use it.
pub(super) struct Stages<'a> {
    pub folder: &'a str,
    pub defines: &'a [(&'a str, String)],
    pub as_written: bool,
    pub arithmetic: Arithmetic,
    /// The pipeline's own number.
    pub pipeline: u64,
    pub shaders: Vec<Shader>,
}

impl Stages<'_> {
    /// The number of a stage, compiled if it is new.
    pub fn add(&mut self, file: &str) -> Result<u32> {
        let path = format!("{}/{file}", self.folder);
        let known = self.shaders.iter().position(|shader| shader.path == path);
        let index = match known {
            Some(index) => index,
            None => {
                let mut shader = shader::compile_with(&path, self.defines, self.arithmetic)?;
                if self.as_written {
                    shader.spirv = contraction::without(&shader.spirv)?;
                }
                shader.spirv = self.arithmetic.applied(&path, self.pipeline, shader.spirv)?;
                self.shaders.push(shader);
                self.shaders.len() - 1
            }
        };
        Ok(index as u32)
    }

    /// A hit group and its stages.
    pub fn hit_group(&mut self, hit: &HitGroup) -> Result<Group> {
        let kind = match hit.intersection {
            Some(_) => vk::RayTracingShaderGroupTypeKHR::PROCEDURAL_HIT_GROUP,
            None => vk::RayTracingShaderGroupTypeKHR::TRIANGLES_HIT_GROUP,
        };
        let mut stage =
            |path: Option<&str>| path.map_or(Ok(vk::SHADER_UNUSED_KHR), |p| self.add(p));
        Ok(Group {
            kind: kind.as_raw(),
            general: vk::SHADER_UNUSED_KHR,
            intersection: stage(hit.intersection)?,
            any_hit: stage(hit.any_hit)?,
            closest_hit: stage(hit.closest_hit)?,
        })
    }
}

/// A group of one raygen, miss or callable shader.
pub(super) fn general(stage: u32) -> Group {
    Group {
        kind: vk::RayTracingShaderGroupTypeKHR::GENERAL.as_raw(),
        general: stage,
        intersection: vk::SHADER_UNUSED_KHR,
        any_hit: vk::SHADER_UNUSED_KHR,
        closest_hit: vk::SHADER_UNUSED_KHR,
    }
}
