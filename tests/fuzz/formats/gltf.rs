//! glTF files, as text and binary.

use std::fs;
use std::sync::LazyLock;

use super::{corpus, object, ours, texture};
use crate::format::{Format, Function};
use crate::grammar::Grammar;

static GRAMMAR: LazyLock<Grammar> =
    LazyLock::new(|| Grammar::new(include_str!("../grammars/gltf.txt")));

/// A model with four vertices, a skin, a target, a texture with holes, two lights and a camera.
const MODEL: &str = r#"{"asset":{"version":"2.0"},
"scene":0,"scenes":[{"nodes":[0,1,2,3]}],
"nodes":[{"mesh":0,"children":[4]},{"camera":0,"translation":[0,0,3]},
{"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[1,1,1]},
{"mesh":0,"skin":0,"weights":[0.5]},{"rotation":[0,0,1,0],"scale":[2,-1,1]}],
"meshes":[{"name":"a","primitives":[{"attributes":{"POSITION":0,"NORMAL":0,"TEXCOORD_0":2,"JOINTS_0":3,"WEIGHTS_0":4},"indices":1,"material":0,"targets":[{"POSITION":0}]}]}],
"skins":[{"joints":[4,0]}],
"materials":[{"alphaMode":"MASK","alphaCutoff":0.4,"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
"textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33071}],"images":[{"uri":"t.png"}],
"cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1}}],
"extensionsUsed":["KHR_lights_punctual"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{},"intensity":9}]}},
"buffers":[{"byteLength":240,"uri":"b.bin"}],
"bufferViews":[{"buffer":0,"byteLength":240},{"buffer":0,"byteOffset":48,"byteLength":12},{"buffer":0,"byteOffset":60,"byteLength":16}],
"accessors":[{"bufferView":0,"count":4,"type":"VEC3","componentType":5126},
{"bufferView":1,"count":6,"type":"SCALAR","componentType":5123},
{"bufferView":0,"count":4,"type":"VEC2","componentType":5126},
{"bufferView":2,"count":4,"type":"VEC4","componentType":5121},
{"bufferView":2,"count":4,"type":"VEC4","componentType":5121,"normalized":true}]}"#;

/// The file.
pub const FORMAT: Format = Format {
    name: "gltf",
    file: "m.gltf",
    most: 1 << 16,
    make: |random| GRAMMAR.text(random, 6000).into_bytes(),
    grammar: Some(|| &GRAMMAR),
    seeds: || {
        let own = ours("samples/assets/chess.gltf");
        [vec![MODEL.into(), binary(), own], corpus("gltf")].concat()
    },
    seal: None,
};

/// The reader of the format.
pub const FUNCTION: Function = Function {
    beside: |folder| {
        for (name, bytes) in [("b.bin", buffer()), ("t.png", texture::small())] {
            fs::write(folder.join(name), bytes).expect("a file can be written");
        }
    },
    read: object::read,
    memory: 64 << 20,
};

/// Four vertices, the indices of two triangles, joints, and zeros.
fn buffer() -> Vec<u8> {
    let corners = [[0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mut bytes: Vec<u8> = corners.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
    bytes.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    bytes.extend([0, 1, 0, 0].repeat(4));
    bytes.resize(240, 0);
    bytes
}

/// The model in a binary file.
fn binary() -> Vec<u8> {
    let mut json = MODEL.replace(r#","uri":"b.bin""#, "").into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let buffer = buffer();
    let number = |n: usize| (n as u32).to_le_bytes();
    let length = number(28 + json.len() + buffer.len());
    let head = [*b"glTF", number(2), length, number(json.len()), *b"JSON"].concat();
    [head, json, [number(buffer.len()), *b"BIN\0"].concat(), buffer].concat()
}
