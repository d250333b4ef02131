//! Whose arithmetic a run is done in: the driver's, or the worst that the specification lets any driver
//! have.

mod operations;
mod rewrite;
mod signature;

use std::fmt;
use std::hash::{DefaultHasher, Hash, Hasher};

use anyhow::{Context, Result};
use clap::ValueEnum;

use super::contraction;

/// The name of a shader's own `main` while another calls it.
const MAIN: &str = "shader_main";

/// How shaders compute.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, ValueEnum)]
pub enum Arithmetic {
    /// As the driver does.
    #[default]
    Driver,
    /// As inexactly as Vulkan allows: the same operation on the same operands gives the same result.
    Worst,
    /// The same, but the result also depends on the place of the operation in the code, and on the pipeline
    /// if there is a [`seed`].
    WorstByPlace,
}

/// The number that `ARITHMETIC_SEED` gives tests: every pipeline is then another compiler's work, and every
/// build in another order. Vulkan promises equal results of *identical* pipelines alone (appendix Invariance,
/// rules 4 and 7).
pub fn seed() -> Option<u64> {
    std::env::var("ARITHMETIC_SEED").ok()?.parse().ok()
}

impl Arithmetic {
    /// This, or `worst-by-place` where nothing else is asked for and there is a [`seed`].
    pub(super) fn or_seeded(self) -> Self {
        match self {
            Self::Driver if seed().is_some() => Self::WorstByPlace,
            asked => asked,
        }
    }

    /// Whether shaders are rewritten.
    pub fn is_worst(self) -> bool {
        self != Self::Driver
    }

    /// A shader's text with all that its words, compiled before, will call: worst.glsl, and in place of the
    /// shader's `main` one that mentions it, as glslang leaves out what nothing mentions.
    ///
    /// # Errors
    /// If the words are no SPIR-V, or hold an operation that worst.glsl does not have.
    pub(super) fn prepared(text: &str, words: &[u32]) -> Result<String> {
        let worst = include_str!("arithmetic/worst.glsl");
        let rewrite::Needs { calls, declared, meets_triangles } = rewrite::needs(words)?;
        let macros = declared.into_iter().chain([("WORST_TRIANGLES", meets_triangles)]);
        let macros: String =
            macros.map(|(name, is_so)| format!("#define {name} {}\n", u32::from(is_so))).collect();
        let calls = calls.join("\n");
        let (version, text) = text.split_once('\n').context("the text is empty")?;
        Ok(format!(
            "{version}\n#define main {MAIN}\n{text}\n{macros}{worst}#undef main\n\
             void main() {{\n{MAIN}();\nif (false) {{\n{calls}\n}}\n}}\n"
        ))
    }

    /// The module as the driver gets it; `path` tells one module's places from another's, and where there is a
    /// [`seed`], so does the `pipeline` that it is for.
    ///
    /// # Errors
    /// If the words are no SPIR-V, or hold an operation that worst.glsl does not have.
    pub fn applied(self, path: &str, pipeline: u64, words: Vec<u32>) -> Result<Vec<u32>> {
        let seed = match self {
            Self::Driver => return Ok(words),
            Self::Worst => None,
            Self::WorstByPlace => {
                let mut hasher = DefaultHasher::new();
                path.hash(&mut hasher);
                if let Some(seed) = seed() {
                    (seed, pipeline).hash(&mut hasher);
                }
                Some(hasher.finish() as u32)
            }
        };
        let rewritten = rewrite::worst(&words, seed)
            .with_context(|| format!("shader '{path}' cannot be had in the worst arithmetic"))?;
        // What the worst arithmetic computes itself, the driver must not rearrange.
        contraction::without(&rewritten)
    }
}

impl fmt::Display for Arithmetic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Driver => "driver",
            Self::Worst => "worst",
            Self::WorstByPlace => "worst-by-place",
        })
    }
}
