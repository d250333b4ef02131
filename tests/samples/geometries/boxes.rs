//! The number of boxes a ray is tested against, counted with trees of 38_primitive_order: for many levels,
//! for one level with the geometries one after the other, and for one level sorted as a whole by a builder.

use std::ops::Range;

use common::gpu::order::{self, Bounds};
use common::scene::{Scene, moved_bounds};
use glam::{DAffine3, DMat3, DVec3};
use serde_json::{Map, json};

use run::expected;
use run::primary_hits::{answer, rays};

use super::{Cut, chapter, cut_in, scene};
use crate::primitive_order::{tested, tested_leaves, tree};
use tree::Node;

/// The trees of a scene: that of the top level, whose leaves are instances, and those of the bottom levels.
struct Trees {
    top: Vec<Node>,
    /// For each leaf of the top level, in order: the transform to its space, and its tree.
    below: Vec<(DAffine3, usize)>,
    bottom: Vec<Vec<Node>>,
}

/// Boxes in an order suitable for halving.
fn sorted(bounds: &[Bounds]) -> Vec<Bounds> {
    order::kd_median(bounds).into_iter().map(|i| bounds[i as usize]).collect()
}

impl Trees {
    /// With `whole`, the triangles of a level are sorted across its geometries.
    fn new(scene: &Scene, places: &[Range<usize>], whole: bool) -> Self {
        let boxes = scene.model.meshes.iter().map(|mesh| mesh.triangle_bounds());
        let boxes: Vec<_> = boxes.collect();
        let mut bottom = Vec::new();
        let mut around = Vec::new();
        for place in places {
            let of_place = || scene.instances[place.clone()].iter().map(|one| &boxes[one.mesh]);
            let list: Vec<Bounds> = if whole {
                sorted(&of_place().flatten().copied().collect::<Vec<_>>())
            } else {
                of_place().flat_map(|boxes| sorted(boxes)).collect()
            };
            around
                .push(moved_bounds(order::around(&list), &scene.instances[place.start].transform));
            bottom.push(tree::nodes(&list));
        }
        let order = order::kd_median(&around);
        let below = order.iter().map(|&place| {
            let transform = scene.instances[places[place as usize].start].transform;
            let columns = [0, 1, 2].map(|i| transform.matrix3.col(i).as_dvec3());
            let [x, y, z] = columns;
            let matrix = DMat3::from_cols(x, y, z);
            let to_world =
                DAffine3::from_mat3_translation(matrix, transform.translation.as_dvec3());
            (to_world.inverse(), place as usize)
        });
        let below = below.collect();
        let top = order.iter().map(|&place| around[place as usize]).collect::<Vec<_>>();
        Self { top: tree::nodes(&top), below, bottom }
    }

    /// The number of boxes a ray is tested against up to `end`, in both levels.
    fn tested(&self, origin: DVec3, direction: DVec3, end: f64) -> usize {
        let (mut tests, entered) = tested_leaves(&self.top, origin, direction, end);
        for leaf in entered {
            let (to_object, level) = &self.below[leaf];
            let origin = to_object.transform_point3(origin);
            let direction = to_object.transform_vector3(direction);
            tests += tested(&self.bottom[*level], origin, direction, end);
        }
        tests
    }
}

#[test]
fn boxes_per_ray() {
    let mut held = Map::new();
    for (cut, word) in [(Cut::Slices, "slices"), (Cut::Rings, "rings")] {
        for parts in [1, 4, 16] {
            let (scene, places) = scene(cut, parts);
            let apart: Vec<_> = (0..scene.instances.len()).map(|i| i..i + 1).collect();
            let run = cut_in(chapter().size("120x75"), word, parts);
            let view = |show: &str| run.clone().set("show", show).picture();
            let [hits, directions] = ["hit", "ray direction"].map(view);
            let all = [(&places, true), (&places, false), (&apart, false)];
            let [whole, one, many] = all.map(|(places, whole)| {
                let trees = Trees::new(&scene, places, whole);
                let rays = rays(&scene.camera, &directions).zip(&hits.pixels);
                let tests: usize = rays
                    .map(|(ray, hit)| {
                        let end = answer(hit).map_or(1e30, |hit| hit.t.into());
                        trees.tested(ray.origin, ray.direction, end)
                    })
                    .sum();
                tests as f64 / hits.pixels.len() as f64
            });
            println!("{parts} {word}: whole {whole:.1}, one {one:.1}, many {many:.1}");
            for (name, value) in [("whole", whole), ("one", one), ("many", many)] {
                held.insert(format!("{word}.{parts}.{name}"), json!((value * 10.0).round() / 10.0));
            }
            // A tree of all triangles of the pieces does not depend on the cuts.
            assert!(whole <= 1.001 * many.min(one), "{parts} {word}: {whole} {one} {many}");
        }
    }
    expected::hold("44_geometries/boxes", held.into());
}
