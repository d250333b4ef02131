//! Scene files of chapter 25.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use anyhow::Result;
use effects::{Composition, Torus, findings, needed};

use super::{corpus, object, ours};
use crate::format::{Format, Function};
use crate::grammar::Grammar;

static GRAMMAR: LazyLock<Grammar> =
    LazyLock::new(|| Grammar::new(include_str!("../grammars/scene.txt")));

/// The text of a scene file.
pub const FORMAT: Format = Format {
    name: "scene",
    file: "s.toml",
    most: 1 << 16,
    make: |random| GRAMMAR.text(random, 3000).into_bytes(),
    grammar: Some(|| &GRAMMAR),
    seeds: || {
        let scenes = ["one_sphere", "solids", "lake", "painted_room", "globes", "crystal"];
        let scenes = scenes.map(|name| ours(&format!("samples/assets/scenes/{name}.toml")));
        [scenes.to_vec(), corpus("scene")].concat()
    },
    seal: None,
};

/// The reader of the format.
pub const FUNCTION: Function = Function { beside, read, memory: 128 << 20 };

/// Writes the model that scenes refer to.
pub fn beside(folder: &Path) {
    fs::write(folder.join("m.obj"), object::MODEL).expect("a file can be written");
}

fn read(path: &Path) -> Result<String> {
    let composition = effects::open(path)?;
    whole(&composition);
    Ok(format!("{:?}", needed(&findings(&composition))))
}

/// Checks that every index refers to something, and that nothing is out of reach of rays.
fn whole(composition: &Composition) {
    let Composition { scene, lights, spheres, boxes, solids, faces, solid_bounds, tori, .. } =
        composition;
    object::whole(&scene.model);
    let materials = scene.model.materials.len();
    assert_eq!(composition.finishes.len(), materials);
    let worn = scene.instances.iter().map(|instance| instance.material);
    let worn = worn.chain(spheres.iter().map(|sphere| sphere.material as usize));
    let worn = worn.chain(boxes.iter().map(|block| block.material as usize));
    let mut worn = worn.chain(tori.iter().map(|torus| torus.material as usize));
    assert!(worn.all(|material| material < materials), "there is no such material");
    for instance in &scene.instances {
        assert!(instance.mesh < scene.model.meshes.len(), "there is no mesh {}", instance.mesh);
        let (low, high) = scene.instance_bounds(instance);
        // The limit of `--scene` for the size of a model: beyond it, products of coordinates overflow.
        let reach = low.abs().max(high.abs()).max_element();
        assert!(reach <= 1e25, "an instance reaches {reach:e} from the origin");
    }
    assert_eq!(solids.len(), solid_bounds.len());
    for solid in solids {
        assert!((solid.first + solid.count) as usize <= faces.len(), "there are no such faces");
    }
    let of_tori: Vec<_> = tori.iter().map(Torus::bounds).collect();
    for (low, high) in solid_bounds.iter().chain(&of_tori) {
        assert!(low.is_finite() && high.is_finite() && low.cmplt(*high).all(), "{low} to {high}");
    }
    assert!(lights.len() <= effects::MAX_LIGHTS);
    let basis = scene.camera.basis(1.6);
    assert!(basis.forward.is_finite() && basis.right.is_finite() && basis.up.is_finite());
}
