//! PNG and JPEG files, and invalid ones.

use std::fs;
use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use reference::random::Random;

use super::{corpus, object};
use crate::format::{Format, Function};

const SIGNATURE: &[u8; 8] = b"\x89PNG\r\n\x1a\n";

/// A picture that a material refers to.
pub const FORMAT: Format = Format {
    name: "texture",
    file: "t.png",
    most: 1 << 17,
    make,
    grammar: None,
    seeds: || [vec![small(), JPEG.to_vec()], corpus("texture")].concat(),
    seal: Some(seal),
};

/// The reader of the format.
pub const FUNCTION: Function = Function {
    beside: |folder| {
        fs::write(folder.join("m.obj"), object::MODEL).expect("a file can be written");
        let materials = "newmtl a\nmap_Kd t.png\nnewmtl b\nmap_d t.png\n";
        fs::write(folder.join("a.mtl"), materials).expect("a file can be written");
    },
    read: |path| object::read(&path.with_file_name("m.obj")),
    memory: 64 << 20,
};

/// The beginning of a JPEG file.
const JPEG: &[u8] =
    b"\xff\xd8\xff\xe0\x00\x10JFIF\x00\x01\x01\x00\x00\x01\x00\x01\x00\x00\xff\xdb\x00\x43\x00";

/// A valid picture of four texels.
pub fn small() -> Vec<u8> {
    let mut bytes = SIGNATURE.to_vec();
    chunk(&mut bytes, b"IHDR", &header(2, 2, 8, 6, 0));
    chunk(
        &mut bytes,
        b"IDAT",
        &packed(&[0, 255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 0, 255, 0, 9, 9, 9, 255]),
    );
    chunk(&mut bytes, b"IEND", &[]);
    bytes
}

fn header(width: u32, height: u32, depth: u8, color: u8, interlace: u8) -> Vec<u8> {
    let rest = [depth, color, 0, 0, interlace];
    [&width.to_be_bytes()[..], &height.to_be_bytes(), &rest].concat()
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::fast());
    packed.write_all(bytes).expect("memory takes it");
    packed.finish().expect("memory takes it")
}

fn chunk(to: &mut Vec<u8>, kind: &[u8; 4], data: &[u8]) {
    let start = to.len() + 4;
    to.extend((data.len() as u32).to_be_bytes());
    to.extend(kind);
    to.extend(data);
    let crc = crc32fast::hash(&to[start..]);
    to.extend(crc.to_be_bytes());
}

/// Sides that are zero, small, large, or too large; never two large ones that would be accepted.
fn sides(random: &mut Random) -> (u32, u32) {
    let large = [16384, 16385, 65535, i32::MAX as u32, u32::MAX];
    match random.below(8) {
        0 => (large[random.below(5)], [0, 1, 2, 16385, u32::MAX][random.below(5)]),
        1 => (random.below(3) as u32, large[random.below(5)]),
        2 => (0, random.below(3) as u32),
        3 => (random.below(900) as u32, random.below(900) as u32),
        _ => (1 + random.below(9) as u32, 1 + random.below(9) as u32),
    }
}

fn make(random: &mut Random) -> Vec<u8> {
    let (width, height) = sides(random);
    let (depth, color) = match random.below(8) {
        0 => (random.bits() as u8, random.bits() as u8),
        _ => {
            let kinds =
                [(8, 0), (8, 2), (8, 3), (8, 4), (8, 6), (16, 0), (16, 2), (16, 6), (1, 0), (4, 3)];
            kinds[random.below(kinds.len())]
        }
    };
    let mut bytes = SIGNATURE.to_vec();
    chunk(&mut bytes, b"IHDR", &header(width, height, depth, color, random.below(3) as u8 % 2));
    for _ in 0..random.below(4) {
        extra(random, &mut bytes);
    }
    if color == 3 && random.below(4) > 0 {
        let colors = 3 * random.below(300);
        let colors: Vec<u8> = (0..colors).map(|_| random.bits() as u8).collect();
        chunk(&mut bytes, b"PLTE", &colors);
    }
    // As many bytes as the header promises, or another number; each row begins with a filter.
    let row = 1 + u64::from(width) * 8;
    let promised = row.saturating_mul(u64::from(height)).min(1 << 22) as usize;
    let count = [promised, promised, promised / 2, random.below(100)][random.below(4)];
    let data = vec![[0, 0, 1, 4, 255][random.below(5)]; count];
    let data = packed(&data);
    let cut = if random.below(4) == 0 { random.below(data.len()) } else { data.len() };
    let parts = data[..cut].chunks(1 + random.below(3000));
    parts.take(200).for_each(|part| chunk(&mut bytes, b"IDAT", part));
    if random.below(8) > 0 {
        chunk(&mut bytes, b"IEND", &[]);
    }
    bytes
}

/// Further chunks: profiles and texts that expand enormously, and others.
fn extra(random: &mut Random, to: &mut Vec<u8>) {
    let bomb = || packed(&vec![b'x'; 8 << 20]);
    let few: Vec<u8> = (0..random.below(40)).map(|_| random.bits() as u8).collect();
    match random.below(8) {
        0 => chunk(to, b"iCCP", &[b"a\0\0", &bomb()[..]].concat()),
        1 => chunk(to, b"zTXt", &[b"a\0\0", &bomb()[..]].concat()),
        2 => chunk(to, b"iTXt", &[b"a\0\x01\0\0\0", &bomb()[..]].concat()),
        3 => chunk(to, b"tRNS", &few),
        4 => chunk(to, b"gAMA", &few),
        5 => chunk(to, b"acTL", &[1u32.to_be_bytes(), u32::MAX.to_be_bytes()].concat()),
        6 => chunk(to, b"tEXt", &few),
        _ => chunk(to, b"cHRM", &few),
    }
}

/// Repairs the checksums of all chunks. Reduces the height of a JPEG file, because one of its sides may be
/// large.
fn seal(bytes: &mut [u8]) {
    if bytes.starts_with(b"\xff\xd8") {
        let frame = bytes.windows(2).position(|pair| matches!(pair, [0xff, 0xc0..=0xc2]));
        if let Some(height) = frame.and_then(|frame| bytes.get_mut(frame + 5)) {
            *height &= 1;
        }
        return;
    }
    let mut at = SIGNATURE.len();
    while let Some(length) = bytes.get(at..at + 4) {
        let length = u32::from_be_bytes([length[0], length[1], length[2], length[3]]) as usize;
        let end = at.saturating_add(8).saturating_add(length);
        let Some(crc) = bytes.get(at + 4..end).map(crc32fast::hash) else { return };
        let Some(stored) = bytes.get_mut(end..end + 4) else { return };
        stored.copy_from_slice(&crc.to_be_bytes());
        at = end + 4;
    }
}
