//! From effects to a pipeline: its stages, its groups, and their compile-time settings.

use anyhow::Result;
use ash::vk;
use common::gpu::{Binding, Gpu, HitGroup, RayTracingPipeline, TextureTable};
use effects::Effect::*;
use effects::{Composition, Effect, Effects, Finish, MAX_LIGHTS};

use crate::{Push, history, world};

/// A kind of geometry: each has a hit group and a bit of the cull mask of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GeometryKind {
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
    /// Swept spheres.
    Strand,
    /// Tori.
    Torus,
}

impl GeometryKind {
    /// The kind in words, for a reason.
    fn words(self) -> &'static str {
        match self {
            Self::Mesh => "meshes",
            Self::Sphere => "spheres",
            Self::Box => "boxes",
            Self::Ground => "a heightfield",
            Self::Solid => "solids",
            Self::Strand => "strands",
            Self::Torus => "tori",
        }
    }

    /// All kinds, in the order of hit records and mask bits, each with the effect that triggers it.
    pub const ALL: [(Self, Effect); 7] = [
        (Self::Mesh, Triangles),
        (Self::Sphere, Spheres),
        (Self::Box, Boxes),
        (Self::Ground, Heightfield),
        (Self::Solid, Solids),
        (Self::Strand, SweptSpheres),
        (Self::Torus, Tori),
    ];

    /// Its bit of the cull mask.
    pub fn mask(self) -> u32 {
        1 << self as u32
    }
}

/// The effects with which surfaces send rays on, as PATHS in effects.glsl.
const PATHS: [Effect; 4] = [Mirror, RoughMetal, Bounces, Glass];

/// The features a pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recipe {
    /// Effects it supports.
    pub effects: Effects,
    /// Kinds of light it supports: bit 0 directional, bit 1 point.
    pub light_kinds: u32,
    /// Maximum number of lights.
    pub lights: u32,
    /// Patterns it supports, one bit each.
    pub patterns: u32,
    /// True to show the time that each pixel takes instead of its colour.
    pub timed: bool,
}

impl Recipe {
    /// For a scene, and no other.
    pub fn specialised(scene: &Composition, effects: Effects) -> Self {
        let kinds = scene
            .lights
            .iter()
            .fold(0, |kinds, light| kinds | 1 << u32::from(light.disk.light.kind));
        let patterns = scene.finishes.iter().filter_map(Finish::pattern);
        Self {
            effects,
            light_kinds: kinds,
            lights: scene.lights.len() as u32,
            patterns: patterns.fold(0, |bits, pattern| bits | 1 << pattern as u32),
            timed: false,
        }
    }

    /// For any scene.
    pub fn everything() -> Self {
        Self {
            effects: Effects::everything(),
            light_kinds: 3,
            lights: MAX_LIGHTS as u32,
            patterns: 0b1110,
            timed: false,
        }
    }

    /// The kinds of geometry that it has hit groups for, in the order of the hit records.
    pub fn kinds(&self) -> Vec<GeometryKind> {
        let kinds = GeometryKind::ALL.into_iter().filter(|&(_, effect)| self.effects.has(effect));
        kinds.map(|(kind, _)| kind).collect()
    }

    /// The hit record of a kind; 0 where rays do not look at it.
    pub fn record(&self, kind: GeometryKind) -> u32 {
        self.kinds().iter().position(|&known| known == kind).unwrap_or(0) as u32
    }

    /// The cull mask of its rays.
    pub fn mask(&self) -> u32 {
        self.kinds().into_iter().fold(0, |mask, kind| mask | kind.mask())
    }

    /// The reason why rays of neighbouring pixels run different shaders: bounced rays that meet several kinds of
    /// surface. `Err` has the reason why they do not.
    pub fn divergence(&self) -> Result<String, &'static str> {
        if !self.effects.has_any(&PATHS) {
            return Err("no surface sends a ray on");
        }
        match &self.kinds()[..] {
            [] | [_] => Err("bounced rays meet one kind of surface"),
            kinds => {
                let words: Vec<&str> = kinds.iter().map(|kind| kind.words()).collect();
                Ok(format!("bounced rays meet {}", words.join(", ")))
            }
        }
    }

    fn hit_group(&self, kind: GeometryKind) -> HitGroup<'static> {
        match kind {
            // Geometry without holes is opaque: the device calls no any-hit shader for it.
            GeometryKind::Mesh if self.effects.has_any(&[CutOut, Blended]) => {
                HitGroup::triangles().closest_hit("mesh.rchit").any_hit("cut_out.rahit")
            }
            GeometryKind::Mesh => HitGroup::triangles().closest_hit("mesh.rchit"),
            GeometryKind::Sphere => HitGroup::procedural("sphere.rint").closest_hit("shape.rchit"),
            GeometryKind::Box => HitGroup::procedural("box.rint").closest_hit("shape.rchit"),
            GeometryKind::Ground => HitGroup::procedural("ground.rint").closest_hit("ground.rchit"),
            GeometryKind::Solid => HitGroup::procedural("solid.rint").closest_hit("solid.rchit"),
            GeometryKind::Strand => HitGroup::procedural("strand.rint").closest_hit("strand.rchit"),
            GeometryKind::Torus => HitGroup::procedural("torus.rint").closest_hit("torus.rchit"),
        }
    }

    /// Flags that let the device skip kinds of geometry, where it supports them.
    fn skipped(&self, gpu: &Gpu) -> vk::PipelineCreateFlags {
        let kinds = self.kinds();
        let meshes = kinds.contains(&GeometryKind::Mesh);
        let shapes = kinds.iter().any(|&kind| kind != GeometryKind::Mesh);
        let culling = gpu.features.ray_tracing_pipeline.ray_traversal_primitive_culling;
        match (culling == vk::TRUE, meshes, shapes) {
            (true, true, false) => vk::PipelineCreateFlags::RAY_TRACING_SKIP_AABBS_KHR,
            (true, false, true) => vk::PipelineCreateFlags::RAY_TRACING_SKIP_TRIANGLES_KHR,
            _ => vk::PipelineCreateFlags::empty(),
        }
    }
}

/// Returns whether the device lets threads change places between two rays.
pub fn can_reorder(gpu: &Gpu) -> bool {
    gpu.features.reorder.ray_tracing_invocation_reorder == vk::TRUE
}

/// The pipeline of a recipe. Its hit groups are numbered without gaps.
pub fn pipeline(gpu: &Gpu, textures: &TextureTable, recipe: Recipe) -> Result<RayTracingPipeline> {
    let mut builder = RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .define("SPECIALISED", 1)
        .as_written()
        .rounding_to_nearest_even(gpu)
        .constant(0, recipe.light_kinds)
        .constant(1, recipe.lights)
        .constant(2, recipe.mask())
        .constant(3, recipe.patterns)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .push_constants::<Push>()
        .structs(&world::LAYOUTS)
        .skip(recipe.skipped(gpu))
        .raygen("camera.rgen")
        .miss("sky.rmiss");
    if recipe.effects.has_any(&[PointShadows, DirectionalShadows, Emitters, Environment]) {
        builder = builder.miss("common/shadow.rmiss");
    }
    for kind in recipe.kinds() {
        builder = builder.hit(recipe.hit_group(kind));
    }
    if recipe.effects.has_any(&[Textures, NormalMaps, CutOut, Blended]) {
        builder = builder.textures(textures);
    }
    if recipe.effects.has(History) {
        builder = builder.binding(Binding::StorageBuffer).structs(&history::LAYOUTS);
    }
    if can_reorder(gpu) && recipe.divergence().is_ok() {
        builder = builder.define("REORDERING", 1);
    }
    if recipe.timed {
        builder = builder.define("TIMED", 1);
    }
    let defines: Vec<String> = recipe.effects.all().map(Effect::define).collect();
    defines.iter().fold(builder, |builder, define| builder.define(define, 1)).build(gpu)
}
