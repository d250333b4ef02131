//! The two forms of a glTF file: JSON as text, or a binary container (GLB) of JSON and one buffer.

use std::fmt::Display;
use std::ops::Range;

use anyhow::{Result, anyhow, bail, ensure};
use gltf::json::Root;
use gltf::json::extensions::texture::TextureTransform;
use serde_json::Value;

/// The first bytes of a GLB file.
pub(super) const MAGIC: &[u8] = b"glTF";

/// Bytes of the header of a GLB file: magic, version, length.
const HEADER: usize = 12;

/// Bytes of the header of a chunk: length, kind.
const CHUNK: usize = 8;

/// Bytes that an object of the JSON part may take in memory; the largest, a material, has 600.
const OBJECT: u64 = 1024;
/// Bytes that a value of a list may take, in a list that grows by doubling.
const VALUE: u64 = 64;
/// The largest JSON part that is parsed a second time, into values.
const MENDED: usize = 16 << 20;

/// The JSON part of a file and the place of its buffer.
pub(super) struct Parts {
    /// The JSON part.
    pub json: Range<usize>,
    /// The contents of the first buffer, if the file brings it.
    pub buffer: Option<Range<usize>>,
}

impl Parts {
    /// The parts of a file.
    ///
    /// # Errors
    /// If a GLB file is cut off, of another version, or without JSON.
    pub fn of(bytes: &[u8]) -> Result<Self> {
        if !bytes.starts_with(MAGIC) {
            let start = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
            return Ok(Self { json: start..bytes.len(), buffer: None });
        }
        let version = number(bytes, 4)?;
        ensure!(version == 2, "is glTF {version}, and glTF 2 is read; export it again as glTF 2.0");
        let length = number(bytes, 8)? as usize;
        ensure!(
            length <= bytes.len(),
            "is cut off: it has {} of {length} bytes; copy it again",
            bytes.len()
        );
        let json = chunk(bytes, HEADER)?.filter(|chunk| chunk.kind == *b"JSON");
        let Some(json) = json else { bail!("has no JSON part first, as a GLB file has") };
        let next = json.range.end.next_multiple_of(4);
        let buffer = chunk(bytes, next)?.filter(|chunk| chunk.kind == *b"BIN\0");
        Ok(Self { json: json.range, buffer: buffer.map(|chunk| chunk.range) })
    }
}

/// A part of a GLB file.
struct Chunk {
    kind: [u8; 4],
    range: Range<usize>,
}

/// The chunk that starts at a byte; none at the end of the file.
fn chunk(bytes: &[u8], at: usize) -> Result<Option<Chunk>> {
    if at + CHUNK > bytes.len() {
        return Ok(None);
    }
    let length = number(bytes, at)? as usize;
    let mut kind = [0; 4];
    kind.copy_from_slice(&bytes[at + 4..at + CHUNK]);
    let range = at + CHUNK..at + CHUNK + length;
    ensure!(range.end <= bytes.len(), "is cut off within a part of {length} bytes; copy it again");
    Ok(Some(Chunk { kind, range }))
}

/// The little-endian number at a byte.
fn number(bytes: &[u8], at: usize) -> Result<u32> {
    match bytes.get(at..at + 4) {
        Some(&[a, b, c, d]) => Ok(u32::from_le_bytes([a, b, c, d])),
        _ => bail!("is cut off: it ends in its header; copy it again"),
    }
}

/// The message about a file of another version.
pub(super) fn other_version(version: impl Display) -> String {
    format!("is glTF {version}, and glTF 2 is read; export it again as glTF 2.0")
}

/// Parses the JSON part.
///
/// # Errors
/// If it is not JSON, not glTF 2, or would take more than `memory` bytes; says where.
pub(super) fn parse(json: &[u8], is_text: bool, memory: u64) -> Result<Root> {
    // Three bytes make an object, so a small file could take all memory.
    let count = |letter: u8| json.iter().filter(|&&byte| byte == letter).count() as u64;
    let objects = count(b'{');
    let need = objects * OBJECT + count(b',') * VALUE + 2 * json.len() as u64;
    let gigabytes = |bytes: u64| bytes as f64 / 1e9;
    ensure!(
        need <= memory,
        "would take up to {:.1} GB of memory for the {objects} objects of its JSON part; at most {:.1} GB are taken",
        gigabytes(need),
        gigabytes(memory)
    );
    // Compiled in its own crate: `serde_json::from_slice` would compile two hundred types a second time.
    Root::from_slice(json).or_else(|error| mended(json).ok_or(error)).map_err(|error| {
        if let Some(old) = version(json).filter(|version| !version.starts_with("2.")) {
            return anyhow!("{}", other_version(&old));
        }
        let place = match (is_text, error.line()) {
            (_, 0) => String::new(),
            (true, line) => format!("line {line}: "),
            (false, 1) => format!("byte {} of its JSON part: ", error.column()),
            (false, line) => format!("line {line} of its JSON part: "),
        };
        anyhow!("{place}{}", reason(&error, json))
    })
}

/// Parses a JSON part with what glTF allows and the parser does not: a scene without nodes, and animations, which are
/// not shown, of anything but a node.
fn mended(json: &[u8]) -> Option<Root> {
    if json.len() > MENDED {
        return None;
    }
    let mut value: Value = serde_json::from_slice(json).ok()?;
    let list = |value: &mut Value, key: &str| -> Vec<Value> {
        value.get_mut(key).and_then(Value::as_array_mut).map(std::mem::take).unwrap_or_default()
    };
    let mut scenes = list(&mut value, "scenes");
    for scene in &mut scenes {
        scene.as_object_mut()?.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
    let animations = list(&mut value, "animations").len();
    let root = value.as_object_mut()?;
    root.insert("scenes".to_owned(), Value::Array(scenes));
    let still = serde_json::json!({"channels": [], "samplers": []});
    root.insert("animations".to_owned(), Value::Array(vec![still; animations]));
    Root::from_slice(&serde_json::to_vec(&value).ok()?).ok()
}

/// The version that a JSON part states, if only that can be read.
fn version(json: &[u8]) -> Option<String> {
    #[derive(serde::Deserialize)]
    struct Head {
        asset: Asset,
    }
    #[derive(serde::Deserialize)]
    struct Asset {
        version: String,
    }
    Some(serde_json::from_slice::<Head>(json).ok()?.asset.version)
}

/// The key whose value ends where the parser stopped, or holds that place: the last one before it.
fn key_before(json: &[u8], line: usize, column: usize) -> Option<&str> {
    let start = json.split_inclusive(|&byte| byte == b'\n').take(line.checked_sub(1)?);
    let end = start.map(<[u8]>::len).sum::<usize>() + column;
    let before = str::from_utf8(json.get(..end.min(json.len()))?).ok()?;
    let mut colons = before.rmatch_indices(':').map(|(at, _)| before[..at].trim_end());
    // A colon within a string does not follow a quote.
    let key = colons.find_map(|before| before.strip_suffix('"'))?;
    key.rsplit('"').next().filter(|key| key.len() < 64)
}

/// The `KHR_texture_transform` of each material's normal map, which the parser of the whole leaves out.
pub(super) fn normal_transforms(json: &[u8]) -> Vec<Option<TextureTransform>> {
    #[derive(serde::Deserialize)]
    struct Materials {
        materials: Vec<Material>,
    }
    #[derive(serde::Deserialize)]
    #[serde(rename_all = "camelCase")]
    struct Material {
        normal_texture: Option<NormalTexture>,
    }
    #[derive(serde::Deserialize)]
    struct NormalTexture {
        extensions: Option<Extensions>,
    }
    #[derive(serde::Deserialize)]
    struct Extensions {
        #[serde(rename = "KHR_texture_transform")]
        transform: Option<TextureTransform>,
    }
    let Ok(Materials { materials }) = serde_json::from_slice(json) else { return Vec::new() };
    let maps = materials.into_iter().map(|material| material.normal_texture?.extensions);
    maps.map(|extensions| extensions?.transform).collect()
}

/// The reason of the parser in our own words, which name what it names.
fn reason(error: &serde_json::Error, json: &[u8]) -> String {
    use serde_json::error::Category;
    match error.classify() {
        Category::Eof => "the JSON ends too soon; the file is perhaps cut off".to_owned(),
        Category::Io => "cannot be read".to_owned(),
        Category::Syntax => "is not JSON, so this is no glTF file, or a damaged one".to_owned(),
        Category::Data => {
            let said = error.to_string();
            let name = |after: &str| Some(said.split_once(after)?.1.split('`').nth(1)?.to_owned());
            match (name("missing field"), name("unknown variant"), name("duplicate field")) {
                (Some(key), _, _) => format!("the key \"{key}\" is missing here"),
                (_, Some(value), _) => format!("\"{value}\" is no value that glTF 2 has here"),
                (_, _, Some(key)) => format!("the key \"{key}\" is there twice"),
                _ => match key_before(json, error.line(), error.column()) {
                    Some(key) => {
                        format!("the key \"{key}\" has a value of another type than in glTF 2")
                    }
                    None => "a value of another type than glTF 2 has here".to_owned(),
                },
            }
        }
    }
}
