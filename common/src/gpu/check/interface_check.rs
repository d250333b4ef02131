//! Compares structures, enumerations and bindings between shaders and Rust, and payloads, hit attributes and
//! launch indices between shaders.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};

use anyhow::{Result, bail, ensure};
use ash::vk;
use serde::{Deserialize, Serialize};

use crate::files::{self, cache};
use crate::gpu::Image;
use crate::gpu::check::image_format;
use crate::gpu::check::reflection::{Passed, Payloads, Reflection};
use crate::gpu::pipeline::RayRecord;
use crate::gpu::pipeline::desc::{Binding, Group, PipelineDesc};
use crate::gpu::pipeline::enumeration;
use crate::gpu::pipeline::layout::Known;
use crate::gpu::pipeline::shader::Shader;

/// The outcome of a check.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Agreed {
    /// Warnings about likely mistakes.
    pub warnings: Vec<String>,
    /// The rays whose part of a hit record's number is constant, to be compared with a table.
    pub rays: Vec<RayRecord>,
    /// The formats of images, to be compared with those that are bound.
    formats: Vec<Declared>,
}

/// The format that a shader declares for an image of set 0.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Declared {
    shader: String,
    binding: u32,
    format: String,
}

impl Agreed {
    /// Checks that the image for a binding has the format that shaders declare for it; any other is undefined
    /// behaviour.
    ///
    /// # Errors
    /// Names the shader, and both formats.
    pub fn check_format(&self, number: u32, image: &Image) -> Result<()> {
        let of = self.formats.iter().filter(|declared| declared.binding == number);
        for Declared { shader, format, .. } in of {
            let Some(right) = image_format::layout_of(image.format) else { continue };
            ensure!(
                right == format,
                "{shader}: set 0, binding {number} is an image of layout({format}), and the program binds one of \
                 {:?}: layout({right}) is right",
                image.format
            );
        }
        Ok(())
    }
}

/// Compares the shaders of a pipeline with the declarations in Rust, with the bindings and with each other.
/// `groups` is the number of shader groups of each kind: raygen, miss, hit, callable.
///
/// A successful check is recorded beside the shaders' SPIR-V, under a hash of its whole input and of the checking
/// code, and is not repeated.
///
/// # Errors
/// On the first difference, with its place and the correct value.
pub fn check(
    desc: &PipelineDesc,
    groups: [usize; 4],
    shaders: &[Shader],
    known: &Known,
) -> Result<Agreed> {
    let PipelineDesc { name, bindings, textures, .. } = desc;
    let [raygens, misses, ..] = groups;
    let mut hasher = DefaultHasher::new();
    let ways = [
        include_str!("interface_check.rs"),
        include_str!("reflection.rs"),
        include_str!("reflection/memory.rs"),
        include_str!("reflection/rays.rs"),
        include_str!("image_format.rs"),
    ];
    (ways, include_str!("../pipeline/enumeration.rs"), known).hash(&mut hasher);
    (shaders, bindings, textures.is_some(), groups, &desc.groups).hash(&mut hasher);
    let file = format!("{:016x}.agreed", hasher.finish());
    let note = cache::folder("spirv").map(|folder| folder.join(file));
    let known_before = note.as_ref().and_then(|note| fs::read_to_string(note).ok());
    if let Some(agreed) = known_before.and_then(|text| serde_json::from_str(&text).ok()) {
        return Ok(agreed);
    }
    let mut constants = Vec::new();
    let mut reflections = Vec::new();
    for Shader { path, spirv, text, .. } in shaders {
        let reflection = Reflection::of(spirv)?;
        reflection.check_memory(path)?;
        ensure!(
            desc.push_size > 0 || !reflection.has_push_constants(),
            "{path}: the shader has push constants, and the pipeline none: the line .push_constants::<Push>() \
             declares them"
        );
        reflection.check(path, &known.structs)?;
        reflection.check_addresses(path, &known.structs)?;
        reflection.check_bindings(path, bindings, textures.is_some())?;
        constants.extend(enumeration::constants(path, text));
        reflections.push((&**path, reflection));
    }
    for layout in &known.enums {
        layout.check(name, &constants)?;
    }
    if raygens > 0 && bindings.contains(&Binding::StorageImage) {
        reflections.iter().try_for_each(|(path, shader)| shader.check_launch(path))?;
    }
    reflections.iter().try_for_each(|(path, shader)| shader.check_misses(path, misses))?;
    // Groups are sorted by kind: raygen, then miss.
    let miss_groups = desc.groups.iter().skip(raygens).take(misses);
    let miss_shaders: Vec<_> = miss_groups.map(|group| group.general as usize).collect();
    check_payloads(&reflections, &miss_shaders)?;
    check_stages(desc, groups, shaders, &reflections)?;
    check_hit_attributes(&reflections, &desc.groups)?;
    let agreed = Agreed {
        warnings: warnings(desc, groups, shaders, &reflections),
        rays: reflections.iter().flat_map(|(path, shader)| shader.ray_records(path)).collect(),
        formats: reflections.iter().flat_map(|(path, shader)| formats(path, shader)).collect(),
    };
    // Failing to write the record only makes the next start slower.
    let _ = note.map(|note| files::write_whole(&note, serde_json::to_string(&agreed)?.as_bytes()));
    Ok(agreed)
}

/// The formats that a shader declares for images of set 0.
fn formats(path: &str, shader: &Reflection) -> Vec<Declared> {
    let declared = shader.image_formats().into_iter();
    let declared = declared.filter_map(|(binding, format)| {
        let format = image_format::layout(format)?.to_owned();
        Some(Declared { shader: path.to_owned(), binding, format })
    });
    declared.collect()
}

/// Checks that each incoming payload matches an outgoing one of the pipeline, and a miss shader's matches that of
/// every ray that names it. `misses` has the miss shaders in order.
fn check_payloads(shaders: &[(&str, Reflection)], misses: &[usize]) -> Result<()> {
    let payloads: Vec<_> = shaders.iter().map(|(_, shader)| shader.payloads()).collect();
    let passed = || {
        payloads
            .iter()
            .zip(shaders)
            .flat_map(|(of, (by, _))| of.passed.iter().map(move |passed| (*by, passed)))
    };
    for (number, (Payloads { taken, .. }, (path, _))) in payloads.iter().zip(shaders).enumerate() {
        let [taken] = &taken[..] else { continue };
        match misses.iter().position(|miss| *miss == number) {
            Some(index) => {
                for (by, Passed { miss, shape }) in passed() {
                    ensure!(
                        *miss != Some(index as u32) || shape == taken,
                        "{by}: a ray has the missIndex {index}, which is {path}, and passes a payload of another \
                         type than that takes by rayPayloadInEXT"
                    );
                }
            }
            None => ensure!(
                passed().next().is_none() || passed().any(|(_, passed)| passed.shape == *taken),
                "{path}: no traceRayEXT of the pipeline passes a payload of the type that this shader takes by \
                 rayPayloadInEXT; its last argument is the location of the rayPayloadEXT that it passes"
            ),
        }
    }
    Ok(())
}

/// Checks that each shader of a hit group has the right stage, that only shaders trace for which the recursion depth
/// suffices, and that none confuses its own payload with its caller's.
fn check_stages(
    desc: &PipelineDesc,
    groups: [usize; 4],
    shaders: &[Shader],
    reflections: &[(&str, Reflection)],
) -> Result<()> {
    use vk::ShaderStageFlags as Flags;
    let kinds = [
        (Flags::RAYGEN_KHR, ".raygen", ".rgen"),
        (Flags::MISS_KHR, ".miss", ".rmiss"),
        (Flags::empty(), ".hit", ""),
        (Flags::CALLABLE_KHR, ".callable", ".rcall"),
    ];
    let kinds = kinds.into_iter().zip(groups);
    let kinds = kinds.flat_map(|(kind, count)| std::iter::repeat_n(kind, count));
    for (group, (right, line, extension)) in desc.groups.iter().zip(kinds) {
        if let Some(Shader { path, .. }) =
            shaders.get(group.general as usize).filter(|shader| shader.stage != right)
        {
            bail!("{path}: the line {line} names it; a shader of that kind ends in {extension}");
        }
    }
    for group in &desc.groups {
        for (number, stage, kind) in [
            (group.intersection, Flags::INTERSECTION_KHR, "an intersection shader, .rint"),
            (group.any_hit, Flags::ANY_HIT_KHR, "an any-hit shader, .rahit"),
            (group.closest_hit, Flags::CLOSEST_HIT_KHR, "a closest hit shader, .rchit"),
        ] {
            if let Some(Shader { path, .. }) =
                shaders.get(number as usize).filter(|shader| shader.stage != stage)
            {
                bail!("{path}: it stands in a hit group where {kind}, belongs");
            }
        }
    }
    for (Shader { path, stage, .. }, (_, shader)) in shaders.iter().zip(reflections) {
        let is_called = (Flags::CLOSEST_HIT_KHR | Flags::MISS_KHR).contains(*stage);
        ensure!(
            !is_called || !shader.traces_rays() || desc.recursion > 1,
            "{path}: a ray from this shader takes .recursion(2) at least, and the pipeline '{}' has {}; a loop in \
             the raygen shader needs 1",
            desc.name,
            desc.recursion
        );
        ensure!(
            !(is_called || *stage == Flags::ANY_HIT_KHR)
                || shader.traces_rays()
                || !shader.has_own_payload(),
            "{path}: it traces no ray, and has a rayPayloadEXT; that of the ray that has called it is \
             rayPayloadInEXT"
        );
    }
    Ok(())
}

/// The type of a triangle's hit attribute: a vec2.
const WEIGHTS: &str = "TypeVector(TypeFloat(32) 2)";

/// Checks the hit attribute declared by the shaders of a hit group against that of its intersection shader or, for
/// triangles, the barycentrics.
fn check_hit_attributes(shaders: &[(&str, Reflection)], groups: &[Group]) -> Result<()> {
    for group in groups {
        let shader = |stage: u32| shaders.get(stage as usize);
        for &(path, ref taker) in [group.any_hit, group.closest_hit].into_iter().filter_map(shader)
        {
            let Some(taken) = taker.hit_attribute() else { continue };
            match shader(group.intersection) {
                Some((of, intersection)) => match intersection.hit_attribute() {
                    Some(given) => ensure!(
                        given == taken,
                        "{path}: its hitAttributeEXT is not of the type of that of {of}, which writes it; \
                         declare the same type in both"
                    ),
                    None => bail!(
                        "{path}: it reads a hitAttributeEXT, and {of} writes none before it reports a hit"
                    ),
                },
                None => ensure!(
                    taken == WEIGHTS,
                    "{path}: its hitAttributeEXT is no vec2, and a triangle's are two weights, those of its \
                     second and third corner"
                ),
            }
        }
    }
    Ok(())
}

/// Likely mistakes in the shaders (warnings).
fn warnings(
    desc: &PipelineDesc,
    [raygens, misses, hits, _]: [usize; 4],
    shaders: &[Shader],
    reflections: &[(&str, Reflection)],
) -> Vec<String> {
    let of_each = reflections.iter().flat_map(|(path, shader)| shader.warnings(path));
    let mut found: Vec<String> = of_each.collect();
    let any_hit = shaders.iter().find(|shader| shader.stage == vk::ShaderStageFlags::ANY_HIT_KHR);
    let never_asked = reflections.iter().all(|(_, shader)| shader.traces_opaque_alone());
    let hit_groups = desc.groups.iter().skip(raygens + misses).take(hits).enumerate();
    let silent = hit_groups.filter(|(_, group)| {
        [group.closest_hit, group.any_hit].iter().all(|stage| *stage == vk::SHADER_UNUSED_KHR)
    });
    found.extend(silent.map(|(number, _)| {
        format!(
            "hit group {number} of '{}' has neither a closest hit nor an any-hit shader: a ray that hits leaves \
             its payload as it was",
            desc.name
        )
    }));
    found.extend(any_hit.filter(|_| never_asked).map(|Shader { path, .. }| {
        format!("{path} is never asked: every ray has the flag gl_RayFlagsOpaqueEXT")
    }));
    found
}
