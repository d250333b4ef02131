//! GLSL to SPIR-V: includes spliced in, compiled by glslang, cached by content.
//!
//! Shaders are compiled when a sample starts, from the folder `shaders/`, so that an edit shows at
//! once and an error names its file and line. The result is kept under `target/spirv`, keyed by a
//! hash of the whole text, includes and all.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::path::{Component, Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail, ensure};
use ash::vk;
use glslang::{
    Compiler, CompilerOptions, ShaderInput, ShaderMessage, ShaderSource, ShaderStage,
    SourceLanguage, SpirvVersion, Target, VulkanVersion, error::GlslangError,
};

/// How deep `#include` may nest; more is taken for a circle.
const MAX_INCLUDE_DEPTH: usize = 16;

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
}

/// The folder that holds every shader: `SHADERS` in the environment, else the project's own.
pub fn folder() -> PathBuf {
    match std::env::var_os("SHADERS") {
        Some(folder) => folder.into(),
        None => concat!(env!("CARGO_MANIFEST_DIR"), "/../shaders").into(),
    }
}

/// Compiles `path` (below [`folder`]) to SPIR-V 1.6 for Vulkan 1.3, or takes it from the cache.
///
/// # Errors
/// If a file is missing, or does not compile: the first message, as `file:line: what`.
pub fn compile(path: &str) -> Result<Shader> {
    let (stage, glslang_stage) = stage(path)?;
    let mut source = Source::default();
    source.splice(path, 0)?;
    let cached = cache_file(path, &source.text);
    let spirv = match read_words(&cached) {
        Some(words) => words,
        None => {
            let words = to_spirv(path, &source.text, glslang_stage)?;
            // A cache that cannot be written costs time at the next start, nothing else.
            let _ = cached.parent().map(fs::create_dir_all);
            let _ = crate::files::write_whole(&cached, bytemuck::cast_slice(&words));
            words
        }
    };
    Ok(Shader { path: path.to_owned(), stage, spirv, files: source.files })
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

/// A shader's text with its includes in place, each file once, `#line` telling which is which.
#[derive(Default)]
struct Source {
    text: String,
    files: Vec<String>,
}

impl Source {
    fn splice(&mut self, path: &str, depth: usize) -> Result<()> {
        if self.files.iter().any(|file| file == path) {
            return Ok(());
        }
        ensure!(depth <= MAX_INCLUDE_DEPTH, "shader '{path}': includes nest too deep");
        let inside = Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
        ensure!(inside, "shader '{path}' is not below {}", folder().display());
        let file = folder().join(path);
        let text = fs::read_to_string(&file)
            .with_context(|| format!("cannot read the shader '{}'", file.display()))?;
        self.files.push(path.to_owned());
        for (index, line) in text.lines().enumerate() {
            let number = index + 1;
            if let Some(rest) = line.trim_start().strip_prefix("#include") {
                let name = resolve(path, rest.trim().trim_matches(['"', '<', '>']));
                self.text.push_str(&format!("#line 1 \"{name}\"\n"));
                self.splice(&name, depth + 1)
                    .with_context(|| format!("{path}:{number}: #include \"{name}\""))?;
                self.text.push_str(&format!("#line {} \"{path}\"\n", number + 1));
            } else {
                self.text.push_str(line);
                self.text.push('\n');
                // The first `#line` must follow `#version` and the extension that allows file names.
                if depth == 0 && line.contains("GL_GOOGLE_include_directive") {
                    self.text.push_str(&format!("#line {} \"{path}\"\n", number + 1));
                }
            }
        }
        Ok(())
    }
}

/// An include's path below `shaders/`: beside the file that includes it, else from the top.
fn resolve(includer: &str, name: &str) -> String {
    let beside = includer.rsplit_once('/').map(|(folder, _)| format!("{folder}/{name}"));
    let exists = beside.filter(|path| folder().join(path).is_file());
    exists.unwrap_or_else(|| name.to_owned())
}

fn to_spirv(path: &str, text: &str, stage: ShaderStage) -> Result<Vec<u32>> {
    let compiler = Compiler::acquire().context("glslang does not start")?;
    let source = ShaderSource::from(text);
    let options = CompilerOptions {
        source_language: SourceLanguage::GLSL,
        target: Target::Vulkan {
            version: VulkanVersion::Vulkan1_3,
            spirv_version: SpirvVersion::SPIRV1_6,
        },
        version_profile: None,
        messages: ShaderMessage::DEFAULT,
    };
    let no_defines: Option<&[(&str, Option<&str>)]> = None;
    let input = ShaderInput::new(&source, stage, &options, no_defines, None)?;
    let compiled = compiler.create_shader(input).and_then(|shader| {
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
    format!("shader does not compile: {}", message.trim_end())
}

fn cache_file(path: &str, text: &str) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    (env!("CARGO_PKG_VERSION"), path, text).hash(&mut hasher);
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../target/spirv"));
    folder.join(format!("{:016x}.spv", hasher.finish()))
}

fn read_words(file: &Path) -> Option<Vec<u32>> {
    const MAGIC: u32 = 0x0723_0203;
    let bytes = fs::read(file).ok()?;
    let words: Vec<u32> = bytemuck::pod_collect_to_vec(bytes.get(..bytes.len() / 4 * 4)?);
    (words.len() > 5 && words[0] == MAGIC).then_some(words)
}
