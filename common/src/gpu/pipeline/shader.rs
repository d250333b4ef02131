//! GLSL to SPIR-V: includes spliced in, compiled by glslang, cached by content.
//!
//! Shaders are compiled when a sample starts, from the folder `shaders/`, so that an edit takes effect at once and
//! an error names its file and line. The result is stored in the cache `spirv`, under a hash of the whole text
//! with all includes.

mod not_included;
mod source;

use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use anyhow::{Context, Result, anyhow, bail};
use ash::vk;
use glslang::{
    CompilerOptions, ShaderInput, ShaderMessage, ShaderSource, ShaderStage, SourceLanguage,
    SpirvVersion, Target, VulkanVersion, error::GlslangError,
};

use crate::files::{self, cache};
use crate::gpu::pipeline::contraction;
use crate::gpu::pipeline::desc::PipelineDesc;
use crate::paths;

/// A compiled shader.
#[derive(Hash)]
pub struct Shader {
    /// Its path below `shaders/`, such as `02_basic/camera.rgen`.
    pub path: String,
    /// The stage, from the file's extension.
    pub stage: vk::ShaderStageFlags,
    /// The module's words.
    pub spirv: Vec<u32>,
    /// Its text with all includes.
    pub text: String,
}

/// The empty definition of a shader's `PRINT`, used unless output is collected.
const SILENT_PRINT: &str = "PRINT(format, value)";

/// True if shaders come from a folder other than the book's.
pub fn are_others() -> bool {
    std::env::var_os("SHADERS").is_some() || paths::folder().is_some()
}

/// The folders searched for shaders, in this order: the program's own, or the one that `SHADERS` in the
/// environment names in its place, and the book's, if the program is of another crate.
pub fn folders() -> Vec<PathBuf> {
    let book = || paths::book().join("shaders");
    let own = paths::folder().map(|home| home.join("shaders"));
    let others = own.is_some().then(book);
    let named = std::env::var_os("SHADERS").map(PathBuf::from);
    [named.or(own).unwrap_or_else(book)].into_iter().chain(others).collect()
}

/// The whole text of a stage with all includes, and the options for compiling it.
#[derive(Clone, Debug, Default)]
pub struct StageText<'a> {
    /// Its path below `shaders/`.
    pub path: &'a str,
    /// The text.
    pub text: String,
    /// Macros, names and values.
    pub defines: &'a [(&'a str, String)],
    /// True if the compiler must not rearrange arithmetic.
    pub as_written: bool,
    /// The pipeline it is for, whose SPIR-V may be missing.
    pub pipeline: Option<&'a PipelineDesc>,
}

impl StageText<'_> {
    /// Its SPIR-V: version 1.6 for Vulkan 1.3, 1.5 for a compute shader; from the cache if possible.
    ///
    /// # Errors
    /// If it does not compile: the first message, as `file:line: what`.
    pub fn words(&self) -> Result<Vec<u32>> {
        let Self { path, text, defines, as_written, .. } = self;
        let cached = cache_file(path, text, defines);
        // Sealed with a hash, because a driver may crash on damaged SPIR-V.
        let words = match cached.as_deref().and_then(files::read_sealed) {
            Some(bytes) => bytemuck::pod_collect_to_vec(&bytes),
            None => {
                let words = COMPILER.get().unwrap_or(&(to_spirv as Compiler))(path, text, defines)?;
                let write = |file: &Path| files::write_sealed(file, bytemuck::cast_slice(&words));
                cached.as_deref().map(write);
                words
            }
        };
        if *as_written { contraction::without(&words) } else { Ok(words) }
    }
}

/// Compiles a stage from its path, its whole text and its macros.
pub type Compiler = fn(&str, &str, &[(&str, String)]) -> Result<Vec<u32>>;

static COMPILER: OnceLock<Compiler> = OnceLock::new();

/// Replaces [`to_spirv`] with this compiler from now on.
pub fn compile_by(compiler: Compiler) {
    let _ = COMPILER.set(compiler);
}

/// Compiles `path` (below one of [`folders`]) without macros.
///
/// # Errors
/// If a file is missing, or does not compile: the first message, as `file:line: what`.
pub fn compile(path: &str) -> Result<Shader> {
    Shader::of(path, &[], |stage| stage.words())
}

impl Shader {
    /// Reads the stage at `path` and compiles it with these macros.
    ///
    /// # Errors
    /// If a file is missing, or does not compile.
    pub fn of(
        path: &str,
        defines: &[(&str, String)],
        words: impl FnOnce(StageText) -> Result<Vec<u32>>,
    ) -> Result<Self> {
        let (stage, text) = (stage(path)?, source::spliced(path)?);
        let spirv = words(StageText { path, text: text.clone(), defines, ..StageText::default() })?;
        Ok(Self { path: path.to_owned(), stage, spirv, text })
    }

    /// Its source files: itself, then its includes, below `shaders/`.
    pub fn files(&self) -> Vec<String> {
        let begun =
            |line: &str| Some(line.strip_prefix("#line 1 \"")?.trim_end_matches('"').to_owned());
        std::iter::once(self.path.clone()).chain(self.text.lines().filter_map(begun)).collect()
    }
}

/// The stage that a file's extension names.
///
/// # Errors
/// If it is not one of a stage.
pub fn stage(path: &str) -> Result<vk::ShaderStageFlags> {
    use vk::ShaderStageFlags as Flags;
    let extension = Path::new(path).extension().and_then(|e| e.to_str()).unwrap_or_default();
    Ok(match extension {
        "rgen" => Flags::RAYGEN_KHR,
        "rmiss" => Flags::MISS_KHR,
        "rchit" => Flags::CLOSEST_HIT_KHR,
        "rahit" => Flags::ANY_HIT_KHR,
        "rint" => Flags::INTERSECTION_KHR,
        "rcall" => Flags::CALLABLE_KHR,
        "comp" => Flags::COMPUTE,
        "vert" => Flags::VERTEX,
        "frag" => Flags::FRAGMENT,
        _ => bail!(
            "shader '{path}': unknown stage '.{extension}'; known are rgen, rmiss, rchit, rahit, rint, \
             rcall, comp, vert, frag"
        ),
    })
}

/// Compiles a stage with glslang, from its path, its whole text and its macros.
///
/// # Errors
/// As [`StageText::words`].
pub fn to_spirv(path: &str, text: &str, defines: &[(&str, String)]) -> Result<Vec<u32>> {
    let stage = match stage(path)? {
        vk::ShaderStageFlags::RAYGEN_KHR => ShaderStage::RayGeneration,
        vk::ShaderStageFlags::MISS_KHR => ShaderStage::Miss,
        vk::ShaderStageFlags::CLOSEST_HIT_KHR => ShaderStage::ClosestHit,
        vk::ShaderStageFlags::ANY_HIT_KHR => ShaderStage::AnyHit,
        vk::ShaderStageFlags::INTERSECTION_KHR => ShaderStage::Intersect,
        vk::ShaderStageFlags::CALLABLE_KHR => ShaderStage::Callable,
        vk::ShaderStageFlags::VERTEX => ShaderStage::Vertex,
        vk::ShaderStageFlags::FRAGMENT => ShaderStage::Fragment,
        _ => ShaderStage::Compute,
    };
    let compiler = glslang::Compiler::acquire().context("glslang does not start")?;
    let source = ShaderSource::from(text);
    // In 1.6, a workgroup size given by specialization constants becomes `LocalSizeId`, which needs the device
    // feature maintenance4.
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
    let defines = defines.iter().map(|(name, value)| (*name, Some(value.as_str())));
    let defines: Vec<_> = defines.chain([(SILENT_PRINT, None)]).collect();
    let input = ShaderInput::new(&source, stage, &options, Some(&defines), None);
    let compiled = input.and_then(|input| {
        let shader = compiler.create_shader(input)?;
        let mut program = compiler.create_program();
        program.add_shader(&shader);
        program.compile(stage)
    });
    compiled.map_err(|error| anyhow!(first_message(path, text, &error)))
}

/// glslang's first error as one line, `file:line: what`.
fn first_message(path: &str, text: &str, error: &GlslangError) -> String {
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
    // Before the first `#line`, glslang calls the file 0; some messages have no location at all.
    let placed = match message.strip_prefix("0:") {
        Some(rest) => format!("{path}:{rest}"),
        None if has_place(&message) => message,
        None => format!("{path}: {message}"),
    };
    let hint = not_included::hint(path, &placed, text)
        .map_or_else(String::new, |hint| format!(": {hint}"));
    format!("shader does not compile: {placed}{hint}")
}

/// True if a message begins with `file:line:`.
fn has_place(message: &str) -> bool {
    let mut parts = message.splitn(3, ':').skip(1);
    parts.next().is_some_and(|line| line.parse::<u32>().is_ok()) && parts.next().is_some()
}

/// The cache file for SPIR-V. Programs of other crates may share the user's folder, and be built with another
/// version of this file.
fn cache_file(path: &str, text: &str, defines: &[(&str, String)]) -> Option<PathBuf> {
    let mut hasher = DefaultHasher::new();
    (env!("CARGO_PKG_VERSION"), include_str!("shader.rs"), path, text, defines).hash(&mut hasher);
    Some(cache::folder("spirv")?.join(format!("{:016x}.words", hasher.finish())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_message_names_its_file() {
        let message = |text: &str| {
            let error = to_spirv("a/b.rmiss", text, &[]).err().unwrap();
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
