//! Why a path of the furnace gets into a closed piece: the ray that took it there, by exact arithmetic.

use reference::Ray;
use run::primary_hits::reference;

use super::NAME;
use run::{command, copy_of_shaders, render_by};

#[allow(dead_code)]
#[path = "../../../samples/29_emitters/alias.rs"]
mod alias;
#[allow(dead_code)]
#[path = "../../../samples/29_emitters/emitters.rs"]
mod emitters;
#[allow(dead_code)]
#[path = "../../../samples/29_emitters/scenes.rs"]
mod scenes;

/// The first ray of a caught path that met a triangle from behind, after which it met all from behind.
#[derive(Debug)]
pub struct Entry {
    origin: [f32; 3],
    direction: [f32; 3],
    t: f32,
    bounce: u32,
    instance: u32,
}

/// The entries of all caught paths, by shaders that note them.
pub fn entries(sets: &[&str]) -> Vec<Entry> {
    let folder = copy_of_shaders();
    let change = |file: &str, changes: &[(&str, &str)]| {
        let path = folder.path().join("29_emitters").join(file);
        let mut text = std::fs::read_to_string(&path).expect("a shader can be read");
        for (from, to) in changes {
            assert_eq!(text.matches(from).count(), 1, "{file} has not one '{from}'");
            text = text.replace(from, to);
        }
        std::fs::write(&path, text).expect("a copy can be written");
    };
    let behind = "hit = report(weights);
        hit.triangle |= gl_HitKindEXT == gl_HitKindBackFacingTriangleEXT ? 1u << 31 : 0;";
    change("shade.rchit", &[("hit = report(weights);", behind)]);
    let note = "bool is_behind = hit.t >= 0.0 && hit.triangle >> 31 == 1;
        if (is_behind && !behind) {
            entry = ray;
            met = vec3(hit.t, path.bounce, hit.instance);
        }
        behind = is_behind;
        advance(path, ray, hit);";
    change(
        "camera.rgen",
        &[
            (
                "    do {\n",
                "bool behind = false; Ray entry = ray; vec3 met = vec3(0.0);\n    do {\n",
            ),
            ("advance(path, ray, hit);", note),
            (
                "imageStore(picture, ivec2(id), vec4(mean_of_whole(sum), 1.0));",
                "bool caught = path.bounce > push.depth;
                if (caught || sum.count == 1) {
                    imageStore(picture, ivec2(id), caught ? vec4(ROW) : vec4(0.0));
                }",
            ),
        ],
    );
    let rows = ["entry.origin, met.x", "entry.direction, met.y", "met, 1.0"].map(|row| {
        let path = folder.path().join("29_emitters/camera.rgen");
        let text = std::fs::read_to_string(&path).expect("a shader can be read");
        std::fs::write(&path, text.replace("ROW", row)).expect("a copy can be written");
        let mut arguments = vec!["--frames", "16"];
        arguments.extend(sets.iter().flat_map(|set| ["--set", set]));
        let by = &mut command(NAME);
        let shown = render_by(by.env("SHADERS", folder.path()), "96x60", &arguments).picture;
        std::fs::write(&path, text).expect("a copy can be written");
        shown.pixels
    });
    let [origins, directions, others] = rows;
    let noted = (0..others.len()).filter(|&i| others[i][3] == 1.0);
    noted
        .map(|i| {
            let [[x, y, z, t], [u, v, w, bounce]] = [origins[i], directions[i]];
            let (bounce, instance) = (bounce as u32, others[i][2] as u32);
            Entry { origin: [x, y, z], direction: [u, v, w], t, bounce, instance }
        })
        .collect()
}

#[test]
fn a_path_is_caught_where_a_ray_passes_between_two_triangles() {
    let chess = scenes::chess().expect("the chess set").scene;
    let scene = reference(&chess);
    for entry in entries(&["scene=furnace", "depth=256", "estimator=BSDF"]) {
        println!("{entry:?}");
        let ray = Ray::from_f32(entry.origin, entry.direction, 0.0, 1e30);
        for hit in scene.all_hits(&ray) {
            let c = scene.candidate(&ray, hit);
            println!(
                "   exact {} {} t {} ccw {} graze {:?}",
                hit.instance, hit.primitive, hit.t, hit.counterclockwise, c.graze
            );
        }
        for c in scene.near_candidates(&ray) {
            println!(
                "   near {} {} t {} ± {} ccw {} graze {:?}",
                c.hit.instance,
                c.hit.primitive,
                c.hit.t,
                c.t_bound,
                c.hit.counterclockwise,
                c.graze
            );
        }
    }
}
