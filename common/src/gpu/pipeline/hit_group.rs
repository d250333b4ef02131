//! Hit groups: the shaders of one kind of geometry.

use ash::vk;

use crate::gpu::pipeline::desc::Group;

/// A hit group: the shaders called when a ray hits one kind of geometry.
#[derive(Clone, Copy, Default)]
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

impl HitGroup<'_> {
    /// The group, with stage numbers from `number`.
    pub(super) fn of_stages(self, mut number: impl FnMut(&str) -> u32) -> Group {
        let mut stage = |file: Option<&str>| file.map_or(vk::SHADER_UNUSED_KHR, &mut number);
        let kind = match self.intersection {
            Some(_) => vk::RayTracingShaderGroupTypeKHR::PROCEDURAL_HIT_GROUP,
            None => vk::RayTracingShaderGroupTypeKHR::TRIANGLES_HIT_GROUP,
        };
        Group {
            kind: kind.as_raw(),
            intersection: stage(self.intersection),
            any_hit: stage(self.any_hit),
            closest_hit: stage(self.closest_hit),
            ..Group::default()
        }
    }
}
