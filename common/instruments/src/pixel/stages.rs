//! Shaders that log their work: the chapter's text, with lines before and after it.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::Result;
use ash::vk::{BufferUsageFlags as Usage, ShaderStageFlags as Kind};
use common::gpu::shader::{self, StageText, to_spirv};
use common::gpu::{Buffer, DriverShim, Gpu, contraction};

use super::log::{ANY_HIT, BACK, HIT, MANY, MISS, PRINT, RAY, WORDS};

/// The logging functions that shaders call.
const LOG: &str = include_str!("log.glsl");

/// The extensions [`LOG`] needs, inserted after `#version`.
const EXTENSIONS: [&str; 4] = [
    "GL_EXT_buffer_reference",
    "GL_EXT_buffer_reference_uvec2",
    "GL_EXT_scalar_block_layout",
    "GL_EXT_debug_printf",
];

/// A modified shader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Known {
    /// Its path below `shaders/`.
    pub path: String,
    /// The variables of its payloads, by location.
    pub payloads: Vec<(u32, String)>,
    /// True if it prints.
    pub prints: bool,
}

/// The actual driver, with every shader modified.
#[derive(Default)]
pub struct Stages {
    /// Address of the log on the device.
    address: AtomicU64,
    known: Mutex<Vec<Known>>,
    /// The log and its device, which owns this: [`Stages::close`] breaks the cycle.
    opened: Mutex<Option<(Gpu, Buffer)>>,
}

impl Stages {
    /// The log and its device.
    pub fn opened(&self) -> MutexGuard<'_, Option<(Gpu, Buffer)>> {
        self.opened.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Frees the log.
    pub fn close(&self) {
        self.opened().take();
    }

    /// The modified shaders so far; an entry of the log refers to one by its number.
    pub fn known(&self) -> Vec<Known> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// The number of a shader.
    fn number(&self, stage: &StageText) -> usize {
        let shader = Known {
            path: stage.path.to_owned(),
            payloads: payloads(&stage.text),
            prints: stage.text.lines().any(prints),
        };
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        known.iter().position(|known| *known == shader).unwrap_or_else(|| {
            known.push(shader);
            known.len() - 1
        })
    }
}

impl DriverShim for Stages {
    fn opened(&self, gpu: &Gpu) -> Result<()> {
        let usage = Usage::SHADER_DEVICE_ADDRESS
            | Usage::STORAGE_BUFFER
            | Usage::TRANSFER_SRC
            | Usage::TRANSFER_DST;
        let log = Buffer::new(gpu, "ray log", 4 * (WORDS + 1), usage)?;
        self.address.store(log.address, Ordering::Relaxed);
        *self.opened() = Some((gpu.clone(), log));
        Ok(())
    }

    fn words(&self, stage: &StageText) -> Result<Vec<u32>> {
        let address = self.address.load(Ordering::Relaxed);
        let text = logging(shader::stage(stage.path)?, &stage.text, self.number(stage), address);
        // Not from the cache: the address differs in each run.
        let words = to_spirv(stage.path, &text, stage.defines)?;
        if stage.as_written { contraction::without(&words) } else { Ok(words) }
    }
}

/// The text of a shader that logs its work at an address.
fn logging(kind: Kind, text: &str, number: usize, address: u64) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let is = |line: &&str, word: &str| line.trim_start().starts_with(word);
    // The first include may ask for extensions within its guard. One that a condition may leave out stays where it is.
    let words = [
        "#version",
        "#extension",
        "#line",
        "#ifndef INCLUDED_",
        "#define INCLUDED_",
        "#endif",
        "//",
    ];
    let begins = |line: &&&str| line.is_empty() || words.iter().any(|word| is(line, word));
    let begun = &lines[..lines.iter().take_while(begins).count()];
    let version = begun.iter().position(|line| is(line, "#version")).unwrap_or_default();
    let extension = begun.iter().rposition(|line| is(line, "#extension"));
    let head = extension.unwrap_or(version);
    // The position of the next line, which `#line` may have set before.
    let place = lines[..=head].iter().rposition(|line| is(line, "#line")).map(|at| {
        let mut words = lines[at].splitn(3, ' ').skip(1);
        let first: usize = words.next().and_then(|word| word.parse().ok()).unwrap_or_default();
        (first + head - at, words.next().unwrap_or_default().to_owned())
    });
    let (line, file) = place.unwrap_or((head + 2, String::new()));
    let mut new: Vec<String> = lines[..=version].iter().map(|line| (*line).to_owned()).collect();
    new.extend(EXTENSIONS.map(|name| format!("#extension {name} : require")));
    new.extend(lines[version + 1..=head].iter().map(|line| (*line).to_owned()));
    let numbers = [
        ("RAY_LOG_STAGE", number as u64),
        ("RAY_LOG_LOW", address & 0xffff_ffff),
        ("RAY_LOG_HIGH", address >> 32),
        ("RAY_LOG_WORDS", WORDS),
    ];
    new.extend(numbers.map(|(name, value)| format!("#define {name} {value:#x}u")));
    let kinds = [
        ("LOG_RAY", RAY),
        ("LOG_MANY", MANY),
        ("LOG_BACK", BACK),
        ("LOG_PRINT", PRINT),
        ("LOG_MISS", MISS),
    ];
    new.extend(kinds.map(|(name, value)| format!("#define {name} {value}u")));
    let met = match kind {
        Kind::CLOSEST_HIT_KHR => Some(format!("#define LOG_SURFACES {HIT}u")),
        Kind::ANY_HIT_KHR => Some(format!("#define LOG_SURFACES {ANY_HIT}u")),
        Kind::MISS_KHR => Some("#define LOG_MISSES".to_owned()),
        _ => None,
    };
    let traces = [Kind::RAYGEN_KHR, Kind::CLOSEST_HIT_KHR, Kind::MISS_KHR].contains(&kind);
    new.extend(traces.then(|| "#define LOG_TRACES".to_owned()));
    new.extend(met.clone());
    new.push(LOG.to_owned());
    new.extend(met.is_some().then(|| "#define main of_the_chapter".to_owned()));
    new.push(format!("#line {line} {file}"));
    new.extend(lines[head + 1..].iter().map(|line| (*line).to_owned()));
    new.extend(met.map(|_| {
        "#undef main\nvoid main() {\n    log_met();\n    of_the_chapter();\n}".to_owned()
    }));
    new.join("\n") + "\n"
}

/// True if a line calls `PRINT`.
fn prints(line: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default();
    let before = code.split("PRINT(").next().filter(|before| before.len() < code.len());
    before.is_some_and(|before| !before.ends_with(|c: char| c.is_alphanumeric() || c == '_'))
}

/// The variables declared as payloads, by location.
fn payloads(text: &str) -> Vec<(u32, String)> {
    let payload = |line: &str| {
        let (before, after) = line.split_once("rayPayload")?;
        let location = before.split_once("location")?.1.trim_start_matches([' ', '=']);
        let digits: String = location.chars().take_while(char::is_ascii_digit).collect();
        let name = after.split(';').next()?.split_whitespace().last()?;
        Some((digits.parse().ok()?, name.to_owned()))
    };
    text.lines().filter_map(payload).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_keep_their_place() {
        let version = "#version 460\n#extension GL_EXT_ray_tracing : require\n";
        let included = "#extension GL_GOOGLE_include_directive : require\n#line 4 \"a.rmiss\"\n";
        for (text, place) in [
            (format!("{version}void main() {{\n    nonsense;\n}}\n"), "a.rmiss:4: "),
            (format!("{version}{included}void main() {{\n    nonsense;\n}}\n"), "a.rmiss:5: "),
        ] {
            let plain = to_spirv("a.rmiss", &text, &[]).unwrap_err().to_string();
            let logging = logging(Kind::MISS_KHR, &text, 0, 0);
            let changed = to_spirv("a.rmiss", &logging, &[]).unwrap_err().to_string();
            assert!(plain.contains(place), "{plain}");
            assert_eq!(changed, plain);
        }
    }

    #[test]
    fn a_print_is_a_call() {
        let lines = ["PRINT(\"a\", 1);", "  x; PRINT(f, x);", "// PRINT(f, x);", "REPRINT(f, x);"];
        assert_eq!(lines.map(prints), [true, true, false, false]);
    }

    #[test]
    fn payloads_are_known_by_location() {
        let text = "layout(location = 0) rayPayloadEXT Hit hit;\nfloat x;\n\
                    layout(location=1) rayPayloadInEXT bool lit;\n";
        assert_eq!(payloads(text), [(0, "hit".to_owned()), (1, "lit".to_owned())]);
    }
}
