//! Requirements and promises of every module, read from its SPIR-V: a device may rely on a promise that the
//! software driver ignores.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::process::{Command, Stdio};
use std::sync::LazyLock;

use common::gpu::shader::Shader;
use common::gpu::{ADDRESS_ALIGNMENT, DriverShim, Reflection};
use instruments::arithmetic::Arithmetic;
use rspirv::dr::{Instruction, Module, Operand};
use rspirv::spirv::{Capability, Decoration, ExecutionModel, Op, StorageClass};

use crate::files;

/// The guaranteed minimum in Vulkan (table "Required Limits", `maxPushConstantsSize`).
const PUSH_CONSTANTS: u32 = 128;

/// The capabilities that modules may declare, and the feature each requires: `None` if ray tracing pipelines
/// or Vulkan 1.3 include it.
const CAPABILITIES: [(Capability, Option<&str>); 13] = [
    (Capability::Shader, None),
    (Capability::RayTracingKHR, None),
    (Capability::ImageQuery, None),
    (Capability::VariablePointers, None),
    (Capability::PhysicalStorageBufferAddresses, Some("bufferDeviceAddress")),
    (Capability::RuntimeDescriptorArray, Some("runtimeDescriptorArray")),
    (Capability::ShaderNonUniform, Some("shaderSampledImageArrayNonUniformIndexing")),
    (
        Capability::SampledImageArrayNonUniformIndexing,
        Some("shaderSampledImageArrayNonUniformIndexing"),
    ),
    (Capability::RayTracingPositionFetchKHR, Some("rayTracingPositionFetch")),
    (Capability::RayQueryKHR, Some("rayQuery")),
    (Capability::Float64, Some("shaderFloat64")),
    (Capability::SignedZeroInfNanPreserve, Some("shaderSignedZeroInfNanPreserveFloat32")),
    (Capability::RoundingModeRTE, Some("shaderRoundingModeRTEFloat32")),
];

/// The requirements of a chapter, with the implied capabilities: the common baseline, and its own.
fn asked_for(chapter: &str) -> Vec<&'static str> {
    let textures = ["runtimeDescriptorArray", "shaderSampledImageArrayNonUniformIndexing"];
    // Optional features of chapter 24, which also runs without them.
    let wishes = [
        "shaderFloat64",
        "shaderSignedZeroInfNanPreserveFloat32",
        "shaderRoundingModeRTEFloat32",
        "rayTracingPositionFetch",
    ];
    let own: &[&str] = match chapter {
        // Only the host uses its addresses.
        "01_foundation" => return Vec::new(),
        "24_accuracy" => &wishes,
        // The shaders shared by all chapters accumulate pictures.
        "common" => &[],
        "10_position_fetch" => &[textures[0], textures[1], "rayTracingPositionFetch"],
        "16_ray_query" | "17_ray_query_raster" => &[textures[0], textures[1], "rayQuery"],
        // It binds the scene's textures but samples none.
        "20_wireframe" => &["rayTracingPositionFetch"],
        _ => &textures,
    };
    [&["bufferDeviceAddress"], own].concat()
}

/// A compiled stage with one set of macros.
struct Form {
    /// The shader's path, and the defined macros.
    name: String,
    chapter: String,
    shader: Shader,
    module: Module,
}

/// Every stage with every macro that a program defines, compiled once.
fn forms() -> &'static [Form] {
    static FORMS: LazyLock<Vec<Form>> = LazyLock::new(compiled);
    &FORMS
}

fn compiled() -> Vec<Form> {
    let effects = effects();
    let mut forms = Vec::new();
    for path in files().into_iter().filter(|file| !file.ends_with("glsl")) {
        let chapter = path.split('/').next().expect("a folder").to_owned();
        let mut variants: Vec<Vec<(&str, String)>> = vec![Vec::new()];
        if chapter == "24_accuracy" {
            variants = (0..14).map(|number| vec![("PRIMITIVE", number.to_string())]).collect();
        }
        if chapter == "25_scene_effects" {
            let specialised = |effects: &[&'static str]| {
                let names = ["SPECIALISED"].iter().chain(effects);
                names.map(|name| (*name, "1".to_owned())).collect::<Vec<_>>()
            };
            variants.extend([specialised(&[]), specialised(&effects)]);
            variants.extend(effects.iter().map(|effect| specialised(&[effect])));
        }
        for defines in variants {
            // Some stages of chapter 24 do not exist for every primitive.
            let Ok(shader) = Shader::of(&path, &defines, |stage| stage.words()) else {
                assert_ne!(defines, [], "{path} does not compile");
                continue;
            };
            let defined: Vec<String> =
                defines.iter().map(|(name, value)| format!("{name}={value}")).collect();
            let module = rspirv::dr::load_words(&shader.spirv).expect("SPIR-V");
            let name = format!("{path} {}", defined.join(" "));
            forms.push(Form { name, chapter: chapter.clone(), shader, module });
        }
    }
    assert!(forms.len() > 100, "{} forms", forms.len());
    forms
}

/// The macros with which chapter 25 leaves out the effects a scene does not have.
fn effects() -> Vec<&'static str> {
    let file = run::root().join("shaders/25_scene_effects/effects.glsl");
    let text: &'static str = std::fs::read_to_string(file).expect("the effects").leak();
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    let names: BTreeSet<_> = words.filter(|word| word.starts_with("EFFECT_")).collect();
    let names: Vec<_> = names.into_iter().filter(|name| *name != "EFFECT_").collect();
    assert!(names.len() > 5, "{names:?}");
    names
}

/// The instruction that defines `id`.
fn made(module: &Module, id: u32) -> &Instruction {
    let functions = module.functions.iter().flat_map(|function| {
        let body = function.blocks.iter().flat_map(|block| &block.instructions);
        function.parameters.iter().chain(body)
    });
    let mut all = module.types_global_values.iter().chain(functions);
    all.find(|i| i.result_id == Some(id)).expect("every id is made")
}

fn operand(instruction: &Instruction, at: usize) -> u32 {
    match instruction.operands[at] {
        Operand::IdRef(id) => id,
        Operand::LiteralBit32(number) => number,
        ref other => panic!("{other:?} is no number"),
    }
}

fn decorated(module: &Module, id: u32, member: Option<u32>, wanted: Decoration) -> Option<u32> {
    module.annotations.iter().find_map(|i| {
        let expected: Vec<Operand> = std::iter::once(Operand::IdRef(id))
            .chain(member.map(Operand::LiteralBit32))
            .chain([Operand::Decoration(wanted)])
            .collect();
        let rest = i.operands.strip_prefix(&expected[..])?;
        Some(match rest {
            [Operand::LiteralBit32(value), ..] => *value,
            _ => 0,
        })
    })
}

/// The size of a type in memory, in bytes.
fn size(module: &Module, id: u32) -> u32 {
    let kind = made(module, id);
    match kind.class.opcode {
        Op::TypeInt | Op::TypeFloat => operand(kind, 0) / 8,
        Op::TypePointer => 8,
        Op::TypeVector | Op::TypeMatrix => size(module, operand(kind, 0)) * operand(kind, 1),
        Op::TypeArray => {
            let count = operand(made(module, operand(kind, 1)), 0);
            let stride = decorated(module, id, None, Decoration::ArrayStride);
            stride.expect("an array in memory has a stride") * count
        }
        Op::TypeStruct => {
            let members = 0..kind.operands.len() as u32;
            let ends = members.map(|member| {
                let offset = decorated(module, id, Some(member), Decoration::Offset);
                let size = size(module, operand(kind, member as usize));
                offset.expect("a member in memory has an offset") + size
            });
            ends.max().unwrap_or_default()
        }
        other => panic!("no size of {other:?}"),
    }
}

#[track_caller]
fn validate(name: &str, words: &[u32]) {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let mut child = Command::new("spirv-val")
        .args(["--target-env", "vulkan1.3", "--scalar-block-layout", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap_or_else(|error| panic!("cannot run spirv-val ({error}): run ./setup --tests"));
    child.stdin.take().expect("piped").write_all(&bytes).expect("it reads the module");
    let output = child.wait_with_output().expect("it ends");
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said);
    // The version in Debian 12, 2023.1, is older than SPV_KHR_ray_tracing_position_fetch and
    // SPV_EXT_shader_invocation_reorder.
    let newer = [
        ("10_position_fetch/shade.rchit", 5336),
        ("20_wireframe/shade.rchit", 5336),
        ("20_wireframe/line.rahit", 5336),
        ("24_accuracy/atlas_corners.rchit", 5336),
        ("25_scene_effects/camera.rgen", 5388),
    ];
    let is_too_old = newer.iter().any(|(stage, capability)| {
        name.starts_with(stage)
            && said.contains(&format!("Invalid capability operand: {capability}"))
    });
    assert!(output.status.success() || is_too_old, "{name}: {said}");
}

#[test]
fn every_module_is_valid() {
    for form in forms() {
        validate(&form.name, &form.shader.spirv);
    }
}

/// No device of this project reorders threads, so only checks without a device are possible.
#[test]
fn reordering_makes_a_valid_module_of_three_steps() {
    let path = "25_scene_effects/camera.rgen";
    let of = |defines: &[(&str, String)]| Shader::of(path, defines, |stage| stage.words());
    let shader = of(&[("REORDERING", "1".to_owned())]).expect("it compiles");
    let module = rspirv::dr::load_words(&shader.spirv).expect("SPIR-V");
    let reorders = Operand::Capability(Capability::ShaderInvocationReorderEXT);
    let declares = |module: &Module| {
        module.capabilities.iter().any(|declared| declared.operands[0] == reorders)
    };
    assert!(declares(&module));
    let functions = module.functions.iter().flat_map(|function| &function.blocks);
    let codes = functions.flat_map(|block| &block.instructions).map(|i| i.class.opcode);
    let steps = [
        Op::HitObjectTraceRayEXT,
        Op::ReorderThreadWithHitObjectEXT,
        Op::HitObjectExecuteShaderEXT,
    ];
    let found: Vec<Op> = codes.filter(|code| steps.contains(code)).collect();
    assert_eq!(found, steps);
    validate(path, &shader.spirv);
    // The framework treats the hit object's payload as a passed payload, next to that of the shadow ray.
    let passed = Reflection::of(&shader.spirv).expect("SPIR-V").payloads().passed;
    let misses: Vec<_> = passed.iter().map(|passed| passed.miss).collect();
    assert!(misses.contains(&Some(0)) && misses.contains(&Some(1)), "{misses:?}");
    let without = rspirv::dr::load_words(&of(&[]).expect("it compiles").spirv).expect("SPIR-V");
    assert!(!declares(&without));
}

/// The rewriter knows every operation of every shader, and its results are valid SPIR-V.
#[test]
fn every_module_is_valid_in_the_worst_arithmetic() {
    let worst = Arithmetic::WorstByPlace;
    // 01 makes its pipeline itself; 24 has a form for each primitive, all of which run in its tests.
    let apart = |file: &str| file.starts_with("01_") || file.starts_with("24_");
    let stages = files().into_iter().filter(|file| !file.ends_with("glsl"));
    for path in stages.filter(|file| !apart(file)) {
        let shader = Shader::of(&path, &[], |stage| worst.words(&stage));
        validate(&path, &shader.expect("it can be rewritten").spirv);
    }
}

#[test]
fn no_block_of_push_constants_is_larger_than_every_device_takes() {
    let mut found = 0;
    for Form { name, module, .. } in forms() {
        let variables = module.types_global_values.iter().filter(|i| {
            i.class.opcode == Op::Variable
                && i.operands[0] == Operand::StorageClass(StorageClass::PushConstant)
        });
        for variable in variables {
            let pointer = made(module, variable.result_type.expect("a variable has a type"));
            let bytes = size(module, operand(pointer, 1));
            assert!(bytes <= PUSH_CONSTANTS, "{name}: {bytes} bytes of push constants");
            found += 1;
        }
    }
    assert!(found > 50, "{found} blocks");
}

/// A driver may use instructions that fault at a smaller alignment than a module promises.
#[test]
fn no_module_promises_more_alignment_than_addressed_buffers_have() {
    let mut largest = 0;
    for Form { name, module, .. } in forms() {
        for i in module.all_inst_iter() {
            let Some(at) = i.operands.iter().position(
                |operand| matches!(operand, Operand::MemoryAccess(access) if access.bits() & 2 != 0),
            ) else {
                continue;
            };
            let alignment = operand(i, at + 1);
            assert!(
                u64::from(alignment) <= ADDRESS_ALIGNMENT,
                "{name}: an access is promised to be aligned to {alignment} bytes, \
                 and addressed buffers to {ADDRESS_ALIGNMENT}"
            );
            largest = largest.max(alignment);
        }
    }
    assert!(largest >= 8, "{largest}: nothing was found");
}

#[test]
fn modules_declare_what_their_chapter_asks_for_and_no_more() {
    let mut asked_in_vain: BTreeMap<String, BTreeSet<&str>> = BTreeMap::new();
    for Form { name, chapter, module, .. } in forms() {
        let asked = asked_for(chapter);
        let left =
            asked_in_vain.entry(chapter.clone()).or_insert_with(|| asked.iter().copied().collect());
        for i in &module.capabilities {
            let Operand::Capability(capability) = i.operands[0] else { continue };
            let known = CAPABILITIES.iter().find(|(known, _)| *known == capability);
            let (_, feature) = known.unwrap_or_else(|| panic!("{name} declares {capability:?}"));
            if let Some(feature) = feature {
                assert!(asked.contains(feature), "{name} declares {capability:?}: no {feature}");
                left.remove(feature);
            }
        }
    }
    // Every requirement of a chapter is used by some shader.
    asked_in_vain.retain(|_, left| !left.is_empty());
    assert_eq!(asked_in_vain, BTreeMap::new());
}

/// The block and the member that a pointer into addressed memory refers to, for a store or a load.
fn block(module: &Module, mut pointer: u32) -> Option<(u32, u32)> {
    let mut member = None;
    loop {
        let made_by = made(module, pointer);
        let kind = made(module, made_by.result_type?);
        let addressed = Operand::StorageClass(StorageClass::PhysicalStorageBuffer);
        if kind.class.opcode != Op::TypePointer || kind.operands[0] != addressed {
            return None;
        }
        if !matches!(made_by.class.opcode, Op::AccessChain | Op::InBoundsAccessChain) {
            return member.map(|member| (operand(kind, 1), member));
        }
        let index = made(module, operand(made_by, 1));
        member = Some(match index.class.opcode {
            Op::Constant => operand(index, 0),
            _ => 0,
        });
        pointer = operand(made_by, 0);
    }
}

/// Memory written by one shader of a trace and read by another must be coherent (GLSL_EXT_ray_tracing,
/// "shadercallcoherent"; Vulkan specification, "Shader Call Order"). In the memory model of these modules,
/// that requires the decoration `Coherent`, for which GLSL only has `coherent`.
#[test]
fn what_a_trace_writes_in_one_stage_and_another_reads_is_coherent() {
    // By chapter and block: the stages that write, those that read or write, and the forms that lack the
    // decoration.
    let mut blocks: BTreeMap<(String, String), [BTreeSet<String>; 3]> = BTreeMap::new();
    for Form { name, chapter, module, .. } in forms() {
        let Operand::ExecutionModel(model) = module.entry_points[0].operands[0] else { continue };
        // No other stage runs together with a compute shader.
        if model == ExecutionModel::GLCompute {
            continue;
        }
        for i in module.all_inst_iter() {
            let writes = i.class.opcode == Op::Store;
            if !writes && i.class.opcode != Op::Load {
                continue;
            }
            let Some((id, member)) = block(module, operand(i, 0)) else { continue };
            let block = module.debug_names.iter().find_map(|i| match &i.operands[..] {
                [Operand::IdRef(of), Operand::LiteralString(name)] if *of == id => {
                    Some(name.clone())
                }
                _ => None,
            });
            let key = (chapter.clone(), block.expect("a block has a name"));
            let [written, used, incoherent] = blocks.entry(key).or_default();
            if writes {
                written.insert(format!("{model:?}"));
            }
            used.insert(format!("{model:?}"));
            if decorated(module, id, Some(member), Decoration::Coherent).is_none() {
                incoherent.insert(name.clone());
            }
        }
    }
    let shared: Vec<_> = blocks
        .iter()
        .filter(|(_, [written, used, _])| !written.is_empty() && used.len() > 1)
        .map(|((chapter, block), [.., incoherent])| (chapter.as_str(), block.as_str(), incoherent))
        .collect();
    let names: Vec<_> = shared.iter().map(|(chapter, block, _)| (*chapter, *block)).collect();
    assert_eq!(names, [("03_any_hit", "Hits"), ("24_accuracy", "Answers")]);
    for (chapter, block, incoherent) in shared {
        assert!(incoherent.is_empty(), "{chapter}: {block} is not coherent in {incoherent:?}");
    }
}
