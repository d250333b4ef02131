//! `--arithmetic`: the arithmetic of a run, the driver's own or the worst-case rounding allowed by Vulkan; the latter
//! also makes traversal report more candidates than necessary.

mod operations;
mod rewrite;
mod signature;

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use anyhow::{Context, Result};
use clap::ValueEnum;

use common::gpu::shader::StageText;
use common::gpu::{DriverShim, Requirements, contraction};
use glam::Vec3;

/// The new name of a shader's own `main`, called by the added one.
const MAIN: &str = "shader_main";

/// The arithmetic of shaders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, ValueEnum)]
pub enum Arithmetic {
    /// The driver's own
    #[default]
    Driver,
    /// Worst-case rounding allowed by Vulkan; the same operation on the same operands gives the same result
    Worst,
    /// The same, but the result also depends on the position of the operation in the code
    // With a `seed`, it also depends on the pipeline.
    WorstByPlace,
}

/// The number in the environment variable `ARITHMETIC_SEED`, for tests: every pipeline then behaves as if built by
/// another compiler, and every build has another order. Vulkan guarantees equal results only for *identical* pipelines
/// (appendix Invariance, rules 4 and 7).
pub fn seed() -> Option<u64> {
    std::env::var("ARITHMETIC_SEED").ok()?.parse().ok()
}

impl Arithmetic {
    /// This, or `worst-by-place` if it is the default and there is a [`seed`].
    pub fn or_seeded(self) -> Self {
        match self {
            Self::Driver if seed().is_some() => Self::WorstByPlace,
            asked => asked,
        }
    }

    /// True if shaders are rewritten.
    pub fn is_worst(self) -> bool {
        self != Self::Driver
    }

    /// A shader's text extended for its SPIR-V, compiled before: worst.glsl, and a new `main` that mentions every
    /// function it will call, because glslang removes unused ones.
    ///
    /// # Errors
    /// If the words are not SPIR-V, or contain an operation that worst.glsl does not have.
    fn prepared(text: &str, words: &[u32]) -> Result<String> {
        let worst = include_str!("worst.glsl");
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

    /// The stage's module as passed to the driver. The seed of its operations includes its path and, if there is a
    /// [`seed`], the pipeline.
    ///
    /// # Errors
    /// If the words are not SPIR-V, or contain an operation that worst.glsl does not have.
    pub fn applied(self, stage: &StageText, words: Vec<u32>) -> Result<Vec<u32>> {
        let seed = match self {
            Self::Driver => return Ok(words),
            Self::Worst => None,
            Self::WorstByPlace => {
                let mut hasher = DefaultHasher::new();
                stage.path.hash(&mut hasher);
                if let Some(seed) = seed() {
                    (seed, stage.pipeline, stage.defines, stage.as_written).hash(&mut hasher);
                }
                Some(hasher.finish() as u32)
            }
        };
        let rewritten = rewrite::worst(&words, seed).with_context(|| {
            format!("cannot rewrite shader '{}' for the worst arithmetic", stage.path)
        })?;
        // The driver must not rearrange the emulated arithmetic itself.
        contraction::without(&rewritten)
    }
}

impl DriverShim for Arithmetic {
    fn name(&self) -> &'static str {
        match self {
            Self::Driver => "driver",
            Self::Worst => "worst",
            Self::WorstByPlace => "worst-by-place",
        }
    }

    fn requirements(&self, asked: Requirements) -> Requirements {
        if self.is_worst() { asked.float64() } else { asked }
    }

    fn words(&self, stage: &StageText) -> Result<Vec<u32>> {
        if !self.is_worst() {
            return stage.words();
        }
        let plain = StageText { as_written: false, ..stage.clone() }.words()?;
        let text = Self::prepared(&stage.text, &plain).with_context(|| {
            format!("cannot prepare shader '{}' for the worst arithmetic", stage.path)
        })?;
        let words = StageText { text, ..stage.clone() }.words()?;
        self.applied(stage, words)
    }

    /// By place, it claims not to support it, so that both kinds of shaders are tested.
    fn rounds_to_nearest_even(&self) -> bool {
        *self != Self::WorstByPlace
    }

    /// Reversed, or shuffled if there is a [`seed`].
    fn order(&self, mut primitives: Vec<u32>) -> Vec<u32> {
        match seed() {
            _ if !self.is_worst() => {}
            None => primitives.reverse(),
            Some(seed) => shuffle(&mut primitives, seed),
        }
        primitives
    }

    /// Each twice, including opaque ones: a ray's flags may make them call any-hit shaders.
    fn candidates(&self, triangles: Vec<u32>) -> Vec<u32> {
        let times = if self.is_worst() { 2 } else { 1 };
        triangles.into_iter().flat_map(|i| std::iter::repeat_n(i, times)).collect()
    }

    /// Larger by half of the longest side in each direction.
    fn boxes(&self, mut boxes: Vec<[Vec3; 2]>) -> Vec<[Vec3; 2]> {
        for [low, high] in boxes.iter_mut().filter(|_| self.is_worst()) {
            let by = 0.5 * (*high - *low).max_element();
            (*low, *high) = (*low - by, *high + by);
        }
        boxes
    }
}

/// Permutes a list depending on the seed, the list and the program, so that each program's builds differ.
fn shuffle(order: &mut [u32], seed: u64) {
    let program =
        std::env::args_os().next().and_then(|path| Some(Path::new(&path).file_name()?.to_owned()));
    let key = |i: &u32| {
        let mut hasher = DefaultHasher::new();
        (seed, &program, order.len(), i).hash(&mut hasher);
        hasher.finish()
    };
    let mut keyed: Vec<(u64, u32)> = order.iter().map(|i| (key(i), *i)).collect();
    // Neighbours stay close to each other, to save time: whole runs are permuted, and the elements within each.
    keyed.chunks_mut(16).for_each(|run| run.sort_unstable());
    let mut runs: Vec<_> = keyed.chunks(16).collect();
    runs.sort_unstable();
    let shuffled: Vec<u32> = runs.into_iter().flatten().map(|(_, i)| *i).collect();
    order.copy_from_slice(&shuffled);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_a_permutation_of_its_own() {
        let shuffled = |seed| {
            let mut order: Vec<u32> = (0..100).collect();
            shuffle(&mut order, seed);
            order
        };
        let (one, two) = (shuffled(1), shuffled(2));
        assert_eq!(one, shuffled(1));
        assert_ne!(one, two);
        for mut order in [one, two] {
            order.sort_unstable();
            assert!(order.into_iter().eq(0..100));
        }
    }
}
