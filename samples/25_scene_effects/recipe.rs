//! From effects to a pipeline: which stages, which groups, and what they are told at compile time.

use anyhow::Result;
use ash::vk;
use common::gpu::{Binding, Gpu, HitGroup, RayTracingPipeline, TextureTable};
use common::scene::Effect::*;
use common::scene::{Composition, Effect, Effects, MAX_LIGHTS};

use crate::Push;

/// A kind of geometry: each has a hit group and a bit of the cull mask of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Triangles.
    Mesh,
    /// Spheres.
    Sphere,
    /// Boxes.
    Box,
    /// A heightfield.
    Ground,
    /// Convex solids.
    Solid,
}

impl Kind {
    /// All kinds, in the order of hit records and mask bits, each with the effect that calls for it.
    pub const ALL: [(Self, Effect); 5] = [
        (Self::Mesh, Triangles),
        (Self::Sphere, Spheres),
        (Self::Box, Boxes),
        (Self::Ground, Heightfield),
        (Self::Solid, Solids),
    ];

    /// Its bit of the cull mask.
    pub fn mask(self) -> u32 {
        1 << self as u32
    }
}

/// What a pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recipe {
    /// What it can do.
    pub effects: Effects,
    /// Which kinds of light it knows: bit 0 directional, bit 1 point.
    pub light_kinds: u32,
    /// How many lights at most.
    pub lights: u32,
}

impl Recipe {
    // ANCHOR: constants
    /// For a scene, and no other.
    pub fn specialised(scene: &Composition, effects: Effects) -> Self {
        let kinds = scene.lights.iter().fold(0, |kinds, light| kinds | 1 << light.light.kind);
        Self { effects, light_kinds: kinds, lights: scene.lights.len() as u32 }
    }

    /// For any scene.
    pub fn everything() -> Self {
        Self { effects: Effects::everything(), light_kinds: 3, lights: MAX_LIGHTS as u32 }
    }
    // ANCHOR_END: constants

    /// The kinds of geometry that it has hit groups for, in the order of the hit records.
    pub fn kinds(&self) -> Vec<Kind> {
        let kinds = Kind::ALL.into_iter().filter(|&(_, effect)| self.effects.has(effect));
        kinds.map(|(kind, _)| kind).collect()
    }

    /// The hit record of a kind; 0 where rays do not look at it.
    pub fn record(&self, kind: Kind) -> u32 {
        self.kinds().iter().position(|&known| known == kind).unwrap_or(0) as u32
    }

    /// The cull mask of its rays.
    pub fn mask(&self) -> u32 {
        self.kinds().into_iter().fold(0, |mask, kind| mask | kind.mask())
    }

    fn has_shadows(&self) -> bool {
        self.effects.has_any(&[PointShadows, DirectionalShadows])
    }

    /// How deep its rays nest: mirrors are a loop in the raygen shader, a shadow ray comes from a hit.
    pub fn recursion(&self) -> u32 {
        if self.has_shadows() { 2 } else { 1 }
    }

    // ANCHOR: groups
    fn hit_group(&self, kind: Kind) -> HitGroup<'static> {
        match kind {
            // Geometry without holes is opaque: the device calls no any-hit shader for it.
            Kind::Mesh if self.effects.has(CutOut) => {
                HitGroup::triangles().closest_hit("mesh.rchit").any_hit("cut_out.rahit")
            }
            Kind::Mesh => HitGroup::triangles().closest_hit("mesh.rchit"),
            Kind::Sphere => HitGroup::procedural("sphere.rint").closest_hit("shape.rchit"),
            Kind::Box => HitGroup::procedural("box.rint").closest_hit("shape.rchit"),
            Kind::Ground => HitGroup::procedural("ground.rint").closest_hit("ground.rchit"),
            Kind::Solid => HitGroup::procedural("solid.rint").closest_hit("solid.rchit"),
        }
    }
    // ANCHOR_END: groups

    // ANCHOR: build
    /// The pipeline. Miss shaders and hit groups stand without gaps, so each has the number of its place.
    ///
    /// # Errors
    /// If a shader does not compile.
    pub fn build(&self, gpu: &Gpu, textures: &TextureTable) -> Result<RayTracingPipeline> {
        let has = |effect| self.effects.has(effect);
        let defines: Vec<String> =
            Effect::ALL.into_iter().filter(|&e| has(e)).map(|e| e.define()).collect();
        let mut builder = RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
            .define("SPECIALISED", 1)
            .exact()
            .constant(0, self.light_kinds)
            .constant(1, self.lights)
            .constant(2, self.mask())
            .recursion(self.recursion())
            .binding(Binding::AccelerationStructure)
            .binding(Binding::StorageImage)
            .push_constants::<Push>()
            .raygen("camera.rgen")
            .miss("sky.rmiss");
        for define in &defines {
            builder = builder.define(define, 1);
        }
        let mut misses = 1;
        if self.has_shadows() {
            builder = builder.miss("shadow.rmiss").define("MISS_SHADOW", misses);
            misses += 1;
        }
        if has(Plane) {
            builder = builder.miss("plane.rmiss").define("MISS_PLANE", misses);
        }
        for kind in self.kinds() {
            builder = builder.hit(self.hit_group(kind));
        }
        if self.effects.has_any(&[Textures, CutOut]) {
            builder = builder.textures(textures);
        }
        builder.skip(self.skipped(gpu)).build(gpu)
    }

    /// What the device need not look for, where it can be told.
    fn skipped(&self, gpu: &Gpu) -> vk::PipelineCreateFlags {
        let kinds = self.kinds();
        let meshes = kinds.contains(&Kind::Mesh);
        let shapes = kinds.iter().any(|&kind| kind != Kind::Mesh);
        match (gpu.limits.primitive_culling, meshes, shapes) {
            (true, true, false) => vk::PipelineCreateFlags::RAY_TRACING_SKIP_AABBS_KHR,
            (true, false, true) => vk::PipelineCreateFlags::RAY_TRACING_SKIP_TRIANGLES_KHR,
            _ => vk::PipelineCreateFlags::empty(),
        }
    }
    // ANCHOR_END: build
}
