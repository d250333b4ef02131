//! GLSL to SPIR-V: includes spliced in, compiled by glslang, cached by content.
//!
//! Shaders are compiled when a sample starts, from the folder `shaders/`, so that an edit shows at
//! once and an error names its file and line. The result is kept under `target/spirv`, keyed by a
//! hash of the whole text, includes and all.

pub mod apart;
mod source;

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use ash::vk;
use glslang::{
    Compiler, CompilerOptions, ShaderInput, ShaderMessage, ShaderSource, ShaderStage,
    SourceLanguage, SpirvVersion, Target, VulkanVersion, error::GlslangError,
};

use self::source::Source;
use super::arithmetic::Arithmetic;
use crate::files;

/// A compiled shader.
pub struct Shader {
    /// Its path below `shaders/`, such as `02_basic/camera.rgen`.
    pub path: String,
    /// The stage, from the file's extension.
    pub stage: vk::ShaderStageFlags,
    /// The module's words.
    pub spirv: Vec<u32>,
    /// Every file that it is made of: itself, then its includes, below `shaders/`.
    pub files: Vec<String>,
    /// The lines `const uint NAME = 1;` of those files.
    pub constants: Vec<UintConstant>,
}

/// A number that a shader has a name for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UintConstant {
    /// The name.
    pub name: String,
    /// The number.
    pub value: u32,
    /// Where it is: file and line.
    pub place: String,
}

/// Whether shaders are another's than the project's.
pub fn are_others() -> bool {
    std::env::var_os("SHADERS").is_some()
}

/// The folder that holds every shader: `SHADERS` in the environment, else the project's own.
pub fn folder() -> PathBuf {
    match std::env::var_os("SHADERS") {
        Some(folder) => folder.into(),
        None => concat!(env!("CARGO_MANIFEST_DIR"), "/../shaders").into(),
    }
}

/// Compiles `path` (below [`folder`]) to SPIR-V 1.6 for Vulkan 1.3, a compute shader to 1.5, or takes it from
/// the cache.
///
/// # Errors
/// If a file is missing, or does not compile: the first message, as `file:line: what`.
pub fn compile(path: &str) -> Result<Shader> {
    compile_with(path, &[], Arithmetic::Driver)
}

/// As [`compile`], with these macros defined, names and values, and with what the arithmetic calls.
///
/// # Errors
/// As [`compile`].
pub fn compile_with(
    path: &str,
    defines: &[(&str, String)],
    arithmetic: Arithmetic,
) -> Result<Shader> {
    let (stage, glslang_stage) = stage(path)?;
    let mut source = Source::default();
    source.splice(path, 0)?;
    let mut spirv = cached(path, &source.text, glslang_stage, defines)?;
    if arithmetic.is_worst() {
        let text = Arithmetic::prepared(&source.text, &spirv)
            .with_context(|| format!("shader '{path}' is not for the worst arithmetic"))?;
        spirv = cached(path, &text, glslang_stage, defines)?;
    }
    let Source { files, constants, .. } = source;
    Ok(Shader { path: path.to_owned(), stage, spirv, files, constants })
}

/// The words of a text, from the cache if they are there.
fn cached(
    path: &str,
    text: &str,
    stage: ShaderStage,
    defines: &[(&str, String)],
) -> Result<Vec<u32>> {
    let cached = cache_file(path, text, defines);
    if let Some(words) = files::read_cached(&cached).and_then(|bytes| unsealed(&bytes)) {
        return Ok(words);
    }
    let words = match apart::is_wanted() {
        true => apart::compile(path, text, defines)?,
        false => to_spirv(path, text, stage, defines)?,
    };
    // A cache that cannot be written costs time at the next start, nothing else.
    let _ = cached.parent().map(fs::create_dir_all);
    let _ = files::write_whole(&cached, &sealed(&words));
    Ok(words)
}

fn stage(path: &str) -> Result<(vk::ShaderStageFlags, ShaderStage)> {
    use vk::ShaderStageFlags as Flags;
    let extension = Path::new(path).extension().and_then(|e| e.to_str()).unwrap_or_default();
    Ok(match extension {
        "rgen" => (Flags::RAYGEN_KHR, ShaderStage::RayGeneration),
        "rmiss" => (Flags::MISS_KHR, ShaderStage::Miss),
        "rchit" => (Flags::CLOSEST_HIT_KHR, ShaderStage::ClosestHit),
        "rahit" => (Flags::ANY_HIT_KHR, ShaderStage::AnyHit),
        "rint" => (Flags::INTERSECTION_KHR, ShaderStage::Intersect),
        "rcall" => (Flags::CALLABLE_KHR, ShaderStage::Callable),
        "comp" => (Flags::COMPUTE, ShaderStage::Compute),
        "vert" => (Flags::VERTEX, ShaderStage::Vertex),
        "frag" => (Flags::FRAGMENT, ShaderStage::Fragment),
        _ => bail!(
            "shader '{path}': unknown stage '.{extension}'; known are rgen, rmiss, rchit, rahit, rint, \
             rcall, comp, vert, frag"
        ),
    })
}

fn to_spirv(
    path: &str,
    text: &str,
    stage: ShaderStage,
    defines: &[(&str, String)],
) -> Result<Vec<u32>> {
    let compiler = Compiler::acquire().context("glslang does not start")?;
    let source = ShaderSource::from(text);
    // In 1.6 a workgroup whose size is a specialization constant is `LocalSizeId`, for which a device would
    // have to be asked (maintenance4).
    let spirv_version = match stage {
        ShaderStage::Compute => SpirvVersion::SPIRV1_5,
        _ => SpirvVersion::SPIRV1_6,
    };
    let options = CompilerOptions {
        source_language: SourceLanguage::GLSL,
        target: Target::Vulkan { version: VulkanVersion::Vulkan1_3, spirv_version },
        version_profile: None,
        messages: ShaderMessage::DEFAULT,
    };
    let defines: Vec<_> =
        defines.iter().map(|(name, value)| (*name, Some(value.as_str()))).collect();
    let input = ShaderInput::new(&source, stage, &options, Some(&defines), None);
    let compiled = input.and_then(|input| {
        let shader = compiler.create_shader(input)?;
        let mut program = compiler.create_program();
        program.add_shader(&shader);
        program.compile(stage)
    });
    compiled.map_err(|error| anyhow!(first_message(path, &error)))
}

/// glslang's first error as one line, `file:line: what`.
fn first_message(path: &str, error: &GlslangError) -> String {
    let log = match error {
        GlslangError::PreprocessError(log)
        | GlslangError::ParseError(log)
        | GlslangError::MapIoError(log)
        | GlslangError::LinkError(log) => &log.log,
        other => return format!("shader '{path}': {other}"),
    };
    let Some(message) = log.lines().find_map(|line| line.strip_prefix("ERROR: ")) else {
        return format!("shader '{path}' does not compile: {}", log.trim().replace('\n', "; "));
    };
    let message = message.trim_end().replace("'' :  ", "");
    // Before the first `#line`, glslang calls the file 0; some messages have no place at all.
    let placed = match message.strip_prefix("0:") {
        Some(rest) => format!("{path}:{rest}"),
        None if has_place(&message) => message,
        None => format!("{path}: {message}"),
    };
    format!("shader does not compile: {placed}")
}

/// Whether a message begins with `file:line:`.
fn has_place(message: &str) -> bool {
    let mut parts = message.splitn(3, ':').skip(1);
    parts.next().is_some_and(|line| line.parse::<u32>().is_ok()) && parts.next().is_some()
}

fn cache_file(path: &str, text: &str, defines: &[(&str, String)]) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    (env!("CARGO_PKG_VERSION"), path, text, defines).hash(&mut hasher);
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../target/spirv"));
    folder.join(format!("{:016x}.words", hasher.finish()))
}

/// A module as the cache keeps it; sealed, for a driver may crash on damaged words.
fn sealed(words: &[u32]) -> Vec<u8> {
    files::sealed(bytemuck::cast_slice(words))
}

/// The words of a file of the cache; `None` if it is missing or damaged.
fn unsealed(bytes: &[u8]) -> Option<Vec<u32>> {
    let words = files::unsealed(bytes)?;
    words.len().is_multiple_of(4).then(|| bytemuck::pod_collect_to_vec(words))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cache_notices_damage() {
        let words = [0x0723_0203, 0x0001_0600, 0, 42, 0];
        let whole = sealed(&words);
        assert_eq!(unsealed(&whole).unwrap(), words);
        for length in 0..whole.len() {
            assert!(unsealed(&whole[..length]).is_none(), "cut off after {length} bytes");
        }
        for at in 0..whole.len() {
            let mut wrong = whole.clone();
            wrong[at] ^= 1;
            assert!(unsealed(&wrong).is_none(), "byte {at} is wrong");
        }
    }

    #[test]
    fn every_message_names_its_file() {
        let message = |text: &str| {
            let error = to_spirv("a/b.rmiss", text, ShaderStage::Miss, &[]).err().unwrap();
            let message = error.to_string();
            message.strip_prefix("shader does not compile: ").unwrap().to_owned()
        };
        let version = "#version 460\n#extension GL_EXT_ray_tracing : require\n";
        let google = "#extension GL_GOOGLE_include_directive : require\n#line 7 \"c.glsl\"\n";
        assert_eq!(
            message(&format!("{version}void main( {{\n")),
            "a/b.rmiss:3: syntax error, unexpected LEFT_BRACE, expecting RIGHT_PAREN"
        );
        assert!(message(&format!("{version}{google}\nx")).starts_with("c.glsl:8: syntax error"));
        assert!(message("").starts_with("a/b.rmiss: "));
        assert!(message(version).starts_with("a/b.rmiss: "));
    }
}
