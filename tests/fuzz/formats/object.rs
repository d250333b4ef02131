//! OBJ files, and the MTL files they refer to.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use anyhow::Result;
use common::model::Model;
use common::scene::Scene;

use super::{corpus, ours, texture};
use crate::format::{Format, Function};
use crate::grammar::Grammar;

static OBJECT: LazyLock<Grammar> =
    LazyLock::new(|| Grammar::new(include_str!("../grammars/object.txt")));
static MATERIAL: LazyLock<Grammar> =
    LazyLock::new(|| Grammar::new(include_str!("../grammars/material.txt")));

/// A material file for models.
pub const MATERIALS: &str = "newmtl a\nKd 0.8 0.2 0.1\nmap_Kd t.png\nnewmtl b\nd 0.5\nillum 3\n";
/// A model for material files and textures.
pub const MODEL: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n\
                         usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 3 2 1\n";

/// The text of a model.
pub const FORMAT: Format = Format {
    name: "object",
    file: "m.obj",
    most: 1 << 16,
    make: |random| OBJECT.text(random, 4000).into_bytes(),
    grammar: Some(|| &OBJECT),
    seeds: || {
        [vec![MODEL.into(), ours("samples/assets/box_on_plane.obj")], corpus("object")].concat()
    },
    seal: None,
};

/// The reader of models.
pub const FUNCTION: Function = Function {
    beside: |folder| {
        for name in ["a.mtl", "a b.mtl"] {
            fs::write(folder.join(name), MATERIALS).expect("a file can be written");
        }
        fs::write(folder.join("t.png"), texture::small()).expect("a file can be written");
    },
    read,
    memory: 64 << 20,
};

/// The text of a material file.
pub const MATERIAL_FORMAT: Format = Format {
    name: "material",
    file: "a.mtl",
    most: 1 << 16,
    make: |random| MATERIAL.text(random, 4000).into_bytes(),
    grammar: Some(|| &MATERIAL),
    seeds: || {
        [vec![MATERIALS.into(), ours("samples/assets/chess.mtl")], corpus("material")].concat()
    },
    seal: None,
};

/// The reader of material files.
pub const MATERIAL_FUNCTION: Function = Function {
    beside: |folder| {
        fs::write(folder.join("m.obj"), MODEL).expect("a file can be written");
        for name in ["t.png", "u.png"] {
            fs::write(folder.join(name), texture::small()).expect("a file can be written");
        }
    },
    read: |path| read(&path.with_file_name("m.obj")),
    memory: 64 << 20,
};

/// Opens a model, checks that it is consistent, and summarises it.
pub fn read(path: &Path) -> Result<String> {
    let scene = Scene::open(path)?;
    whole(&scene.model);
    let (low, high) = scene.bounds();
    assert!(low.is_finite() && high.is_finite() && low.cmple(high).all(), "{low} to {high}");
    let Model { meshes, materials, textures, warnings, .. } = scene.model;
    let counts = [meshes.len(), materials.len(), textures.len()].map(magnitude);
    Ok(format!("{counts:?} {}", warnings.join(" ")))
}

/// Checks that every index refers to something, and that every number is finite.
pub fn whole(model: &Model) {
    for mesh in &model.meshes {
        assert!(!mesh.triangles.is_empty(), "a mesh without triangles");
        assert!(mesh.material < model.materials.len(), "there is no material {}", mesh.material);
        for &corner in mesh.triangles.as_flattened() {
            assert!((corner as usize) < mesh.vertices.len(), "there is no vertex {corner}");
        }
        for vertex in &mesh.vertices {
            assert!(vertex.position.is_finite() && vertex.uv.is_finite(), "{vertex:?}");
            assert!((vertex.normal.length() - 1.0).abs() < 1e-5, "{vertex:?}");
        }
    }
    for material in &model.materials {
        for slot in [material.base_texture, material.opacity_texture].into_iter().flatten() {
            assert!(slot < model.textures.len(), "there is no texture {slot}");
        }
        let colors = [material.base_color, material.specular, material.emission];
        assert!(colors.iter().all(|color| color.is_finite() && color.min_element() >= 0.0));
        assert!((0.0..=1.0).contains(&material.opacity), "opacity {}", material.opacity);
        assert!(material.shininess.is_finite() && material.refraction.is_finite());
    }
    for texture in &model.textures {
        let texels = texture.width as usize * texture.height as usize;
        assert_eq!(texture.rgba.len(), 4 * texels);
    }
}

/// The magnitude of a count, so that models of similar size have equal summaries.
fn magnitude(count: usize) -> char {
    // A letter, because numbers are ignored in comparisons.
    let log = count.checked_ilog2().map_or(0, |log| log + 1);
    (b'a' + log as u8) as char
}
