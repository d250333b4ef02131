//! The chess set as glTF 2.0: the position of the book, with two lights and a camera.

use std::collections::HashMap;

use glam::{DMat3, DQuat, DVec3};
use serde_json::{Value, json};

use crate::mesh::QUANTUM;
use crate::obj::{ATTRIBUTE_QUANTUM, Object};

/// Morphy's game at the Paris opera, 1858, before White's tenth move.
const POSITION: &str = "rn2kb1r/p3qppp/2p2n2/1p2p1B1/2B1P3/1QN5/PPP2PPP/R3K2R";

/// The materials, in the order of their numbers; the last has the holes of the screen.
const MATERIALS: [(&str, [f64; 3], f64, f64); 8] = [
    ("white", [0.80, 0.66, 0.44], 0.0, 0.3),
    ("black", [0.035, 0.022, 0.016], 0.0, 0.3),
    ("board_light", [0.62, 0.46, 0.26], 0.0, 0.4),
    ("board_dark", [0.115, 0.048, 0.022], 0.0, 0.4),
    ("frame", [0.075, 0.030, 0.014], 0.0, 0.35),
    // Metals: Akenine-Moeller et al., Real-Time Rendering, 4th ed., table 9.2.
    ("gold", [1.0, 0.782, 0.344], 1.0, 0.1),
    ("silver", [0.972, 0.96, 0.915], 1.0, 0.1),
    ("fretwork", [1.0, 1.0, 1.0], 0.0, 0.45),
];

/// A glTF file and its buffer.
pub struct Files {
    pub json: String,
    pub buffer: Vec<u8>,
}

/// The files, of which the first names the second and the pictures: that of the screen, and the normal map of the
/// squares.
pub fn write(objects: &[Object], buffer: &str, pictures: [&str; 2]) -> Files {
    let mut writer = Writer::default();
    let object = |name: &str| {
        objects.iter().find(|object| object.name == name).expect("the chess set has each of these")
    };
    let mut part = |name: &str, material: &str| writer.primitive(object(name), number(material));
    let board =
        [("board_light", "board_light"), ("board_dark", "board_dark"), ("board_frame", "frame")];
    let board =
        json!({"name": "board", "primitives": board.map(|(name, material)| part(name, material))});
    let screen = [("screen", "fretwork"), ("screen_frame", "frame")];
    let screen = json!({"name": "screen", "primitives": screen.map(|(name, material)| part(name, material))});
    let mut meshes = vec![board, screen];
    let mut nodes = vec![
        json!({"name": "board", "mesh": 0}),
        json!({"name": "screen", "mesh": 1, "translation": [0.0, 0.02, -4.28]}),
    ];
    let mut known = HashMap::new();
    let mut sides = [Vec::new(), Vec::new()];
    for (row, rank) in POSITION.split('/').enumerate() {
        let mut file = 0;
        for letter in rank.chars() {
            if let Some(empty) = letter.to_digit(10) {
                file += empty;
                continue;
            }
            let is_black = letter.is_ascii_lowercase();
            let mesh = *known.entry(letter).or_insert_with(|| {
                let name = piece(letter);
                let is_royal = matches!(name, "king" | "queen");
                let material = match (is_black, is_royal) {
                    (false, false) => "white",
                    (false, true) => "gold",
                    (true, false) => "black",
                    (true, true) => "silver",
                };
                let side = if is_black { "black" } else { "white" };
                let primitive = writer.primitive(object(name), number(material));
                meshes.push(json!({"name": format!("{side} {name}"), "primitives": [primitive]}));
                meshes.len() - 1
            });
            // Pieces are modelled facing +x. They look at the other side, and a little past it.
            let half = if is_black { -20f64 } else { 70.0 }.to_radians();
            nodes.push(json!({
                "name": format!("{} on {}{}", piece(letter), (b'a' + file as u8) as char, 8 - row),
                "mesh": mesh,
                "rotation": [0.0, digits(half.sin()), 0.0, digits(half.cos())],
                "translation": [f64::from(file) - 3.5, 0.0, row as f64 - 3.5],
            }));
            sides[usize::from(is_black)].push(nodes.len() - 1);
            file += 1;
        }
    }
    let mut roots = vec![0, 1];
    for (side, name) in sides.iter().zip(["white", "black"]) {
        nodes.push(json!({"name": name, "children": side}));
        roots.push(nodes.len() - 1);
    }
    let (azimuth, elevation) = (300f64.to_radians(), 42f64.to_radians());
    let sun = DVec3::new(
        azimuth.sin() * elevation.cos(),
        elevation.sin(),
        azimuth.cos() * elevation.cos(),
    );
    let light = |number: usize| json!({"KHR_lights_punctual": {"light": number}});
    nodes.push(json!({"name": "sun", "rotation": looking(-sun), "extensions": light(0)}));
    nodes.push(json!({"name": "lamp", "translation": [3.0, 2.6, -3.0], "extensions": light(1)}));
    let (eye, target) = (DVec3::new(-5.6, 4.8, 9.2), DVec3::new(0.35, 0.3, -0.2));
    nodes.push(json!({
        "name": "camera",
        "translation": eye.to_array(),
        "rotation": looking(target - eye),
        "camera": 0,
    }));
    roots.extend(nodes.len() - 3..nodes.len());
    let materials = MATERIALS.map(|(name, color, metallic, roughness)| {
        let [r, g, b] = color;
        let mut surface = json!({
            "baseColorFactor": [r, g, b, 1.0],
            "metallicFactor": metallic,
            "roughnessFactor": roughness,
        });
        if name.starts_with("board") {
            let normals = json!({"index": 1});
            return json!({"name": name, "pbrMetallicRoughness": surface, "normalTexture": normals});
        }
        if name != "fretwork" {
            return json!({"name": name, "pbrMetallicRoughness": surface});
        }
        surface["baseColorTexture"] = json!({"index": 0});
        json!({"name": name, "pbrMetallicRoughness": surface, "alphaMode": "MASK", "doubleSided": true})
    });
    let json = json!({
        "asset": {"version": "2.0", "generator": "samples/assets/chess_set"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"name": "sun", "type": "directional", "color": [1.0, 0.92, 0.81], "intensity": 2.6},
            {"name": "lamp", "type": "point", "color": [1.0, 0.62, 0.3], "intensity": 14.0},
        ]}},
        "scene": 0,
        "scenes": [{"name": "opera", "nodes": roots}],
        "nodes": nodes,
        "meshes": meshes,
        "materials": materials,
        "textures": [{"source": 0, "sampler": 0}, {"source": 1, "sampler": 0}],
        "samplers": [{"wrapS": 10497, "wrapT": 10497}],
        "images": pictures.map(|picture| json!({"uri": picture})),
        "cameras": [{"type": "perspective", "perspective": {"yfov": digits(37f64.to_radians()), "znear": 0.1}}],
        "buffers": [{"uri": buffer, "byteLength": writer.bytes.len()}],
        "bufferViews": writer.views,
        "accessors": writer.accessors,
    });
    let mut text = serde_json::to_string_pretty(&json).expect("values are finite");
    text.push('\n');
    Files { json: text, buffer: writer.bytes }
}

/// The buffer in the making.
#[derive(Default)]
struct Writer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    /// The accessors of each object: those of its vertices, and of its indices.
    known: HashMap<&'static str, (Value, usize)>,
}

impl Writer {
    /// The triangles of an object in a material; objects share their accessors.
    fn primitive(&mut self, object: &Object, material: usize) -> Value {
        let (attributes, indices) = match self.known.get(object.name) {
            Some(known) => known.clone(),
            None => {
                let made = self.object(object);
                self.known.insert(object.name, made.clone());
                made
            }
        };
        json!({"attributes": attributes, "indices": indices, "material": material})
    }

    fn object(&mut self, object: &Object) -> (Value, usize) {
        let (mut positions, mut normals, mut uvs) = (Vec::new(), Vec::new(), Vec::new());
        let mut indices = Vec::new();
        let mut numbers = HashMap::new();
        for corner in object.mesh.triangles.iter().flatten() {
            let steps = |value: f64, quantum: f64| (value / quantum).round() as i64;
            let position = corner.position.to_array().map(|value| steps(value, QUANTUM));
            let normal = corner.normal.to_array().map(|value| steps(value, ATTRIBUTE_QUANTUM));
            // The first row of a picture is the upper one.
            let uv = [corner.uv.x, 1.0 - corner.uv.y].map(|value| steps(value, ATTRIBUTE_QUANTUM));
            let next = numbers.len() as u32;
            let number = *numbers.entry((position, normal, uv)).or_insert(next);
            if number == next {
                positions.push(position.map(|steps| (steps as f64 * QUANTUM) as f32));
                let normal = DVec3::from(normal.map(|steps| steps as f64)).normalize();
                normals.push(normal.as_vec3().to_array());
                uvs.push(uv.map(|steps| (steps as f64 * ATTRIBUTE_QUANTUM) as f32));
            }
            indices.push(number);
        }
        let position = self.floats(&positions);
        let bounds = |pick: fn(f32, f32) -> f32| {
            let first = positions[0];
            positions
                .iter()
                .fold(first, |all, one| [0, 1, 2].map(|axis| pick(all[axis], one[axis])))
        };
        self.accessors[position]["min"] = json!(bounds(f32::min));
        self.accessors[position]["max"] = json!(bounds(f32::max));
        let (normal, uv) = (self.floats(&normals), self.floats(&uvs));
        let is_short = numbers.len() < usize::from(u16::MAX);
        let size = if is_short { 2 } else { 4 };
        let bytes: Vec<u8> =
            indices.iter().flat_map(|index| index.to_le_bytes()[..size].to_vec()).collect();
        let kind = if is_short { 5123 } else { 5125 };
        let indices = self.accessor(&bytes, indices.len(), "SCALAR", kind, 34963);
        (json!({"POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv}), indices)
    }

    fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
        self.accessor(&bytes, values.len(), if N == 3 { "VEC3" } else { "VEC2" }, 5126, 34962)
    }

    /// Adds bytes with an accessor of their own. `target` says whether they are vertices or indices.
    fn accessor(
        &mut self,
        bytes: &[u8],
        count: usize,
        kind: &str,
        component: u32,
        target: u32,
    ) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let (offset, length) = (self.bytes.len(), bytes.len());
        self.bytes.extend(bytes);
        self.views.push(
            json!({"buffer": 0, "byteOffset": offset, "byteLength": length, "target": target}),
        );
        let view = self.views.len() - 1;
        self.accessors.push(
            json!({"bufferView": view, "componentType": component, "count": count, "type": kind}),
        );
        self.accessors.len() - 1
    }
}

/// The number of a material.
fn number(name: &str) -> usize {
    let found = MATERIALS.iter().position(|(known, ..)| *known == name);
    found.expect("the list has each of these")
}

/// The object of a letter of the position.
fn piece(letter: char) -> &'static str {
    match letter.to_ascii_lowercase() {
        'p' => "pawn",
        'r' => "rook",
        'n' => "knight",
        'b' => "bishop",
        'q' => "queen",
        _ => "king",
    }
}

/// The rotation of a node that looks along its own -z, with y up.
fn looking(forward: DVec3) -> [f64; 4] {
    let back = -forward.normalize();
    let right = DVec3::Y.cross(back).normalize();
    let rotation = DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back));
    rotation.to_array().map(digits)
}

/// Seven digits after the point: the sines of another platform may differ in the last bit.
fn digits(value: f64) -> f64 {
    (value * 1e7).round() / 1e7
}
