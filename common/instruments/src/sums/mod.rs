//! `--samples`: exact sums of samples, and their files.
//!
//! A colour's sum is an integer in units of 2^-64, in 128 bits. Integers do not round, so a sum does not depend on
//! the order of the samples, nor on how a render was split: 24_accuracy, rung A3, with more bits.
//!
//! A file consists of `RTSUMS`, its version and the length of its header in little-endian; the header, JSON; the
//! sums, deflated; and a CRC-32 of all of it.

mod gather;
mod origin;
mod sample_set;

use std::fs::File;
use std::io::{Read, Write};
use std::ops::Range;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use flate2::{Compression, read::ZlibDecoder, write::ZlibEncoder};
use serde::{Deserialize, Serialize};

use common::app::Picture;
use common::files::write_whole;
use common::model::text::{regular, shown};

pub use gather::{Gather, Options, resumed};
pub use origin::{Difference, Origin};
pub use sample_set::{SampleSet, range};

/// The first bytes of a file.
const MAGIC: &[u8; 6] = b"RTSUMS";
/// The file version that this program reads and writes.
const FORM: u16 = 1;
/// Magic, version and the header's length.
const BEGINNING: usize = 12;
/// The most bytes of a header: names and values of controls, and a line per file.
const HEADER_BYTES: u32 = 1 << 20;
/// The most bytes of a file: more than [`PIXELS`] incompressible pixels need.
const FILE_BYTES: u64 = 5 << 30;
/// The most pixels of a picture, of 64 bytes each.
const PIXELS: u64 = 1 << 26;
/// Number of fraction bits of a sum; `sum.glsl` has the same number.
const FRACTION: i32 = 64;
/// Bits of a colour's integer part: a value of 2^31 or more is added as black.
const COLOR: i32 = 31;

/// Samples that were not numbers or too large, and were added as black.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spoiled {
    /// Number of them.
    pub count: u64,
    /// The first pixel with one, counted row by row.
    pub first: Option<u32>,
}

impl Spoiled {
    /// A warning about a picture of this width, if there is one.
    pub fn warning(&self, width: u32) -> Option<String> {
        let (first, count) = (self.first?, self.count);
        let (x, y) = (first % width, first / width);
        let what = "is not finite, or not below 2^31: added as black";
        Some(format!("a colour of {count} samples, the first in pixel {x},{y}, {what}"))
    }
}

/// The part of a file before the sums.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// The common origin of the samples.
    pub origin: Origin,
    /// The samples.
    pub samples: SampleSet,
    /// The samples that could not be added.
    pub spoiled: Spoiled,
}

/// Sums of samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sums {
    /// The origin and numbers of the samples.
    pub header: Header,
    /// Four per pixel, in units of 2^-64, rows from top to bottom.
    pub values: Vec<i128>,
}

impl Header {
    /// Number of sums that follow it.
    fn len(&self) -> usize {
        let [width, height] = self.origin.size;
        4 * width as usize * height as usize
    }

    /// Reads the header of a file, and nothing after it.
    ///
    /// # Errors
    /// If the file does not exist, or is not a file of sums.
    pub fn open(path: &Path) -> Result<Self> {
        Self::read(&mut regular(path, &shown(path), FILE_BYTES)?, &shown(path))
    }

    fn read(file: &mut impl Read, name: &str) -> Result<Self> {
        let mut beginning = [0; BEGINNING];
        let is_ours = file.read_exact(&mut beginning).is_ok() && beginning.starts_with(MAGIC);
        ensure!(is_ours, "{name}: was not written by --save");
        let form = u16::from_le_bytes([beginning[6], beginning[7]]);
        ensure!(form == FORM, "{name}: has form {form}; this program reads form {FORM}");
        let length = u32::from_le_bytes([beginning[8], beginning[9], beginning[10], beginning[11]]);
        ensure!(length <= HEADER_BYTES, damaged(name, "its header is too long"));
        let mut text = vec![0; length as usize];
        file.read_exact(&mut text).map_err(|_| damaged(name, "it ends within its header"))?;
        let header: Self = serde_json::from_slice(&text).map_err(|error| {
            // Parts quoted from the file may contain line breaks.
            let error = error.to_string().replace(char::is_control, "\u{fffd}");
            damaged(name, &format!("its header: {error}"))
        })?;
        let [width, height] = header.origin.size;
        let pixels = u64::from(width) * u64::from(height);
        ensure!(
            (1..=PIXELS).contains(&pixels),
            "{name}: {width}x{height} is empty or too large: at most {PIXELS} pixels are read"
        );
        let samples = header.samples.count();
        ensure!(samples > 0, damaged(name, "it has no samples"));
        let Spoiled { count, first } = header.spoiled;
        let counts = count <= samples.saturating_mul(pixels) && (count > 0) == first.is_some();
        let is_inside = first.is_none_or(|first| u64::from(first) < pixels);
        ensure!(counts && is_inside, damaged(name, "its number of spoiled samples is impossible"));
        Ok(header)
    }
}

impl Sums {
    /// Reads a file.
    ///
    /// # Errors
    /// If the file does not exist, is not a file of sums, or is truncated or damaged.
    pub fn open(path: &Path) -> Result<Self> {
        let name = shown(path);
        // The rest after the header: its sums, which deflating hardly enlarges, and a CRC-32.
        let header = Header::open(path)?;
        let most = u64::from(HEADER_BYTES) + 17 * header.len() as u64 + 1024;
        let file = regular(path, &name, most)?;
        let mut bytes = Vec::new();
        let failed = |error: std::io::Error| anyhow!("{name}: cannot be read: {error}");
        file.take(most).read_to_end(&mut bytes).map_err(failed)?;
        Self::parse(&bytes, &name)
    }

    /// True if a file begins like a file of sums.
    pub fn begins(path: &Path) -> bool {
        Header::open(path).is_ok()
    }

    fn parse(bytes: &[u8], name: &str) -> Result<Self> {
        // Check the type before the checksum: a picture given by mistake is not damaged.
        let mut all = bytes;
        let header = Header::read(&mut all, name)?;
        let (content, crc) =
            bytes.split_last_chunk().ok_or_else(|| damaged(name, "it is cut off"))?;
        let found = crc32fast::hash(content);
        ensure!(
            found == u32::from_le_bytes(*crc),
            damaged(name, "it is cut off, or its bytes are not those that were written")
        );
        // A header may be so long that it includes the checksum.
        let packed = all.len().checked_sub(crc.len());
        let packed =
            packed.with_context(|| damaged(name, "it ends within its header").to_string())?;
        let mut sums = ZlibDecoder::new(&all[..packed]);
        // It grows with the actual data, whatever size the header claims.
        let mut values = Vec::new();
        let mut some = [0; 4096];
        let mut left = 16 * header.len();
        while left > 0 {
            let part = &mut some[..left.min(4096)];
            sums.read_exact(part).map_err(|_| damaged(name, "it has too few sums"))?;
            left -= part.len();
            let words = part.as_chunks::<16>().0;
            values.extend(words.iter().map(|bytes| i128::from_le_bytes(*bytes)));
        }
        let more = sums.read(&mut some[..1]).unwrap_or(1);
        ensure!(more == 0, damaged(name, "it has too many sums"));
        // With these bounds, no union of files overflows.
        let most = u128::from(header.samples.count()) << (FRACTION + COLOR);
        let fits = values.iter().all(|value| value.unsigned_abs() <= most);
        ensure!(fits, damaged(name, "a sum is larger than its samples can be"));
        Ok(Self { header, values })
    }

    /// The bytes of a file: equal sums give equal bytes.
    ///
    /// # Errors
    /// If memory is short.
    pub fn bytes(&self) -> Result<Vec<u8>> {
        let header = serde_json::to_vec(&self.header)?;
        let length = u32::try_from(header.len()).ok().filter(|length| *length <= HEADER_BYTES);
        let length = length.context("the settings are too long for a file of sums")?;
        let mut bytes = [&MAGIC[..], &FORM.to_le_bytes(), &length.to_le_bytes()].concat();
        bytes.extend(header);
        let mut sums = ZlibEncoder::new(bytes, Compression::fast());
        for values in self.values.chunks(256) {
            let part: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
            sums.write_all(&part)?;
        }
        let mut bytes = sums.finish()?;
        let crc = crc32fast::hash(&bytes);
        bytes.extend(crc.to_le_bytes());
        Ok(bytes)
    }

    /// Writes a file, whole or not at all.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        write_whole(path, &self.bytes()?)
    }

    /// Adds the samples of `other`, which has the same origin; none may be present already.
    ///
    /// # Errors
    /// Names those that are; then nothing is added. Sums that no render can produce are refused as well.
    pub fn add(&mut self, other: &Self) -> Result<(), String> {
        let mut samples = self.header.samples.clone();
        samples.add(&other.header.samples).map_err(|both| format!("samples {both}"))?;
        let pairs = self.values.iter().zip(&other.values);
        let sums: Option<Vec<_>> = pairs.map(|(a, b)| a.checked_add(*b)).collect();
        self.values = sums.ok_or("sums too large to be those of colours")?;
        self.header.samples = samples;
        let (mine, others) = (&mut self.header.spoiled, other.header.spoiled);
        mine.count = mine.count.saturating_add(others.count);
        mine.first = [mine.first, others.first].into_iter().flatten().min();
        Ok(())
    }

    /// The mean of all samples: each sum divided by their number, rounded once to nearest even.
    pub fn mean(&self) -> Picture {
        let [width, height] = self.header.origin.size;
        let count = self.header.samples.count();
        let pixels = self.values.as_chunks::<4>().0;
        let pixels = pixels.iter().map(|sums| sums.map(|sum| quotient(sum, count))).collect();
        Picture { width, height, pixels }
    }

    /// The CRC-32 of a file.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn crc_of(path: &Path) -> Result<u32> {
        let failed = || format!("{}: cannot be read", shown(path));
        let mut file = File::open(path).with_context(failed)?;
        let mut hasher = crc32fast::Hasher::new();
        let mut some = vec![0; 1 << 16];
        loop {
            match file.read(&mut some).with_context(failed)? {
                0 => return Ok(hasher.finalize()),
                count => hasher.update(&some[..count]),
            }
        }
    }
}

fn damaged(name: &str, how: &str) -> anyhow::Error {
    anyhow!("{name}: is damaged: {how}")
}

/// A sum divided by a count, as a float: rounded once to nearest, ties to even.
fn quotient(sum: i128, count: u64) -> f32 {
    let size = sum.unsigned_abs();
    if size == 0 || count == 0 {
        return 0.0;
    }
    // Shifted up as far as possible: the quotient has many more digits than a float.
    let up = size.leading_zeros();
    let (dividend, divisor) = (size << up, u128::from(count));
    let (digits, rest) = (dividend / divisor, dividend % divisor);
    let dropped = u128::BITS - digits.leading_zeros() - f32::MANTISSA_DIGITS;
    let (kept, below) = (digits >> dropped, digits & ((1 << dropped) - 1));
    let half = 1 << (dropped - 1);
    let is_above = below > half || (below == half && (rest > 0 || kept & 1 == 1));
    // 24 bits, or a power of two: exact, and so is the scaling, because no sum is so small or large.
    let kept = (kept + u128::from(is_above)) as f64;
    let value = (kept * 2f64.powi(dropped as i32 - up as i32 - FRACTION)) as f32;
    if sum < 0 { -value } else { value }
}

/// The union of files that belong together.
///
/// # Errors
/// On files that do not match, or have samples in common; names them.
pub fn merge(files: &[&Path]) -> Result<Sums> {
    let [first, others @ ..] = files else { bail!("no files of sums") };
    let mut sums = Sums::open(first)?;
    let mut known = vec![(shown(first), sums.header.samples.clone())];
    for file in others {
        let name = shown(file);
        let other = Sums::open(file)?;
        if let Some(difference) = sums.header.origin.difference(&other.header.origin) {
            let places = [format!("in {}", known[0].0), format!("in {name}")];
            let line = difference.line(places.each_ref().map(String::as_str));
            bail!("{name} does not fit: {line}");
        }
        let is_new = sums.header.samples.overlap(&other.header.samples).count() == 0;
        for (before, samples) in known.iter().filter(|_| !is_new) {
            let both = samples.overlap(&other.header.samples);
            ensure!(both.count() == 0, "samples {both} are in both {before} and {name}");
        }
        sums.add(&other).map_err(|what| anyhow!("{name}: {what}"))?;
        known.push((name, other.header.samples));
    }
    Ok(sums)
}

/// Fails if samples of `whole` are missing.
///
/// # Errors
/// Names the missing ones.
pub fn check_complete(samples: &SampleSet, whole: Range<u32>) -> Result<()> {
    let missing = samples.missing(whole);
    ensure!(missing.count() == 0, "samples {missing} are missing");
    Ok(())
}

#[cfg(test)]
mod tests;
