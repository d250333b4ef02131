//! Files of sums, written by `--save`, continued by `--resume` and added by `cargo chapters merge`.

use std::fs;
use std::io::Write;
use std::path::Path;

use anyhow::Result;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use instruments::sums::{Header, Origin, Sums, merge};
use reference::random::Random;

use super::corpus;
use crate::format::{Format, Function};
use crate::grammar::ODD_NUMBERS;

/// A file of sums.
pub const FORMAT: Format = Format {
    name: "sums",
    file: "a.sums",
    most: 1 << 14,
    make,
    grammar: None,
    seeds: || [vec![right(0)], corpus("sums")].concat(),
    seal: Some(seal),
};

/// The reader of the format.
pub const FUNCTION: Function = Function {
    beside: |folder| fs::write(folder.join("b.sums"), right(64)).expect("a file can be written"),
    read,
    memory: 64 << 20,
};

/// A file as written by a render of two pixels, with the samples from `first` on.
pub fn right(first: u32) -> Vec<u8> {
    let origin = Origin {
        chapter: "04_jitter_camera".to_owned(),
        size: [2, 1],
        settings: [("seed".to_owned(), "0".to_owned())].into(),
        ..Origin::default()
    };
    let header = Header { origin, samples: (first..first + 4).into(), ..Header::default() };
    Sums { header, values: vec![1 << 64; 8] }.bytes().expect("it is small")
}

fn read(path: &Path) -> Result<String> {
    let header = Header::open(path);
    let sums = Sums::open(path)?;
    assert_eq!(header?, sums.header, "the header alone is another");
    let [width, height] = sums.header.origin.size;
    assert_eq!(sums.values.len() as u64, 4 * u64::from(width) * u64::from(height));
    let mean = sums.mean();
    assert!(mean.pixels.as_flattened().iter().all(|value| value.is_finite()));
    let warned = sums.header.spoiled.warning(width).is_some();
    let merged = merge(&[path, &path.with_file_name("b.sums")]);
    let merged = merged.map_or_else(|error| error.to_string(), |_| "merged".to_owned());
    Ok(format!("{warned} {merged}"))
}

/// Generates a file with a header by the grammar, usually as many sums as it promises, and the right
/// checksum.
fn make(random: &mut Random) -> Vec<u8> {
    let whole = |random: &mut Random| match random.below(6) {
        0 => ODD_NUMBERS[random.below(ODD_NUMBERS.len())].to_owned(),
        _ => random.below(5).to_string(),
    };
    let [width, height, first, last, count, at] = [(); 6].map(|()| whole(random));
    let samples = match random.below(4) {
        0 => format!("[[{first}, {last}], [{count}, {at}]]"),
        1 => "[]".to_owned(),
        _ => format!("[[{first}, {}]]", 5 + random.below(9)),
    };
    let first = if random.below(2) == 0 { "null".to_owned() } else { at };
    let header = format!(
        "{{\"origin\":{{\"chapter\":\"04_jitter_camera\",\"version\":\"\",\"size\":[{width},{height}],\
         \"settings\":{{\"seed\":\"0\"}},\"scene\":{{}},\"unordered\":false,\"shaders\":null,\"device\":\"\",\
         \"driver\":\"\",\"arithmetic\":\"\"}},\"samples\":{samples},\
         \"spoiled\":{{\"count\":{count},\"first\":{first}}}}}"
    );
    let pixels = [&width, &height].map(|side| side.parse::<usize>().unwrap_or(0).min(99));
    let count = 64 * pixels[0] * pixels[1] + [0, 0, 0, 1, 16][random.below(5)];
    let mut sums = vec![0; count];
    for value in sums.chunks_mut(16) {
        let odd = [0, 1, -1, 1 << 64, -(1 << 64), i128::MAX, i128::MIN][random.below(7)];
        value.copy_from_slice(&odd.to_le_bytes()[..value.len()]);
    }
    let length = (header.len() as u32).to_le_bytes();
    let bytes = [b"RTSUMS\x01\0", &length[..], header.as_bytes()].concat();
    let mut packed = ZlibEncoder::new(bytes, Compression::fast());
    packed.write_all(&sums).expect("memory takes it");
    let mut bytes = packed.finish().expect("memory takes it");
    bytes.extend([0; 4]);
    seal(&mut bytes);
    bytes
}

/// Repairs the header's length and the checksum.
fn seal(bytes: &mut [u8]) {
    let end = bytes.windows(3).position(|three| three == b"}}\x78").map(|at| at + 2);
    if let (Some(end), true) = (end, bytes.len() > 12) {
        let length = (end as u32).saturating_sub(12);
        bytes[8..12].copy_from_slice(&length.to_le_bytes());
    }
    if let Some((content, crc)) = bytes.split_last_chunk_mut::<4>() {
        *crc = crc32fast::hash(content).to_le_bytes();
    }
}
