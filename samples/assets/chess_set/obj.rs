//! Wavefront OBJ and MTL text.

use std::collections::HashMap;
use std::fmt::Write;

use crate::mesh::{Mesh, QUANTUM};

/// Normals and texture coordinates are written in multiples of this.
pub const ATTRIBUTE_QUANTUM: f64 = 1e-4;

/// A mesh with the names that the file gives it.
pub struct Object {
    /// The `o` line.
    pub name: &'static str,
    /// The `usemtl` line.
    pub material: &'static str,
    /// The triangles.
    pub mesh: Mesh,
}

/// The OBJ file for the objects, in their order.
pub fn write(objects: &[Object], library: &str) -> String {
    let mut text = format!(
        "# The chess set of this book, written by samples/assets/chess_set. Do not edit.\n\
         # One square of the board is 1 x 1; y is up; front faces are counter-clockwise.\n\
         mtllib {library}\n"
    );
    // Numbers run on from object to object, so these tables do too.
    let mut positions = Table::new("v", QUANTUM);
    let mut uvs = Table::new("vt", ATTRIBUTE_QUANTUM);
    let mut normals = Table::new("vn", ATTRIBUTE_QUANTUM);
    for object in objects {
        let _ = writeln!(text, "o {}\nusemtl {}", object.name, object.material);
        let mut faces = String::new();
        for triangle in &object.mesh.triangles {
            faces.push('f');
            for corner in triangle {
                let v = positions.index(&mut text, &corner.position.to_array());
                let vt = uvs.index(&mut text, &corner.uv.to_array());
                let vn = normals.index(&mut text, &corner.normal.to_array());
                let _ = write!(faces, " {v}/{vt}/{vn}");
            }
            faces.push('\n');
        }
        text += &faces;
    }
    text
}

/// Numbers the different values of one kind, and writes each where it first occurs.
struct Table {
    keyword: &'static str,
    quantum: f64,
    indices: HashMap<Vec<i64>, usize>,
}

impl Table {
    fn new(keyword: &'static str, quantum: f64) -> Self {
        Self { keyword, quantum, indices: HashMap::new() }
    }

    /// The number of `value`, counted from 1 as OBJ does.
    fn index(&mut self, text: &mut String, value: &[f64]) -> usize {
        let key: Vec<_> = value.iter().map(|x| (x / self.quantum).round() as i64).collect();
        let next = self.indices.len() + 1;
        *self.indices.entry(key).or_insert_with_key(|key| {
            text.push_str(self.keyword);
            for &steps in key {
                let _ = write!(text, " {}", decimal(steps, self.quantum));
            }
            text.push('\n');
            next
        })
    }
}

/// `steps` × `quantum` in as few characters as can be: no trailing zeros, no minus before zero.
fn decimal(steps: i64, quantum: f64) -> String {
    let digits = -quantum.log10().round() as usize;
    let scale = 10_u64.pow(digits as u32);
    let (whole, part) = (steps.unsigned_abs() / scale, steps.unsigned_abs() % scale);
    let sign = if steps < 0 { "-" } else { "" };
    let text = format!("{sign}{whole}.{part:0digits$}");
    text.trim_end_matches('0').trim_end_matches('.').to_string()
}

/// The MTL file. Colours are linear; the map has sRGB colours and the cut-out in its alpha.
pub fn materials(fretwork: &str) -> String {
    let mut text = String::from("# The materials of the chess set. Colours are linear.\n");
    let plain = [
        ("white", [0.80, 0.66, 0.44], [0.04, 0.04, 0.04], 220.0),
        ("black", [0.035, 0.022, 0.016], [0.05, 0.05, 0.05], 320.0),
        ("board_light", [0.62, 0.46, 0.26], [0.03, 0.03, 0.03], 90.0),
        ("board_dark", [0.115, 0.048, 0.022], [0.03, 0.03, 0.03], 90.0),
        ("frame", [0.075, 0.030, 0.014], [0.04, 0.04, 0.04], 140.0),
    ];
    for (name, diffuse, specular, exponent) in plain {
        let [diffuse, specular] =
            [diffuse, specular].map(|c| format!("{} {} {}", c[0], c[1], c[2]));
        let _ = writeln!(
            text,
            "\nnewmtl {name}\nKd {diffuse}\nKs {specular}\nNs {exponent}\nd 1\nillum 3"
        );
    }
    let _ = writeln!(
        text,
        "\nnewmtl fretwork\nKd 1 1 1\nKs 0.12 0.1 0.06\nNs 60\nd 1\nillum 2\n\
         map_Kd {fretwork}\nmap_d {fretwork}"
    );
    text
}
