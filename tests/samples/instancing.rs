//! 09_instancing: every matrix, mask and flag compared with the reference.

mod flags;
pub mod normals;

use std::cell::OnceCell;

use common::app::Picture;
use common::scene::{self, Camera, Scene, Sun};
use glam::{DMat3, DVec3};
use reference::Ray;
use reference::scene::Scene as Exact;
use reference::transform::Transform;

use run::primary_hits::{Tally, answer, judge, rays, reference};
use run::{Chapter, Near, Run, expected, same_hits};
use serde_json::{Map, Value, json};

#[allow(dead_code)]
#[path = "../../samples/09_instancing/formation.rs"]
pub mod formation;

use formation::{Formation, Piece, SceneKind};

const NAME: &str = "09_instancing";
const SIZE: &str = "120x75";
pub const SPECIMEN: &str = "scene=specimens";
/// Few enough pieces for the reference to have a copy of each.
const FEW: [&str; 3] = ["squares=60", "camera eye=1,5,8", "camera target=0,0.8,0"];

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

/// A scene and a sample's view of it: its pieces, and the reference's copy.
pub struct ViewedScene {
    sample: &'static str,
    pub pieces: Vec<Piece>,
    exact: Exact,
    pub camera: Camera,
    /// The picture of `show=ray direction`, which depends only on the camera's controls.
    directions: OnceCell<Picture>,
}

impl ViewedScene {
    /// A scene and a view of it, both translated by `shift`.
    pub fn new(
        sample: &'static str,
        scene: SceneKind,
        squares: u32,
        mut camera: Camera,
        shift: DVec3,
    ) -> Self {
        let meshes = formation::meshes().unwrap();
        let mut pieces = Formation::new(scene, squares, &meshes.model).unwrap().pieces;
        pieces.iter_mut().for_each(|piece| piece.at += shift);
        camera.eye += shift;
        let instances = pieces.iter().map(Piece::instance).collect();
        let exact = reference(&Scene { model: meshes.model, instances, camera });
        Self { sample, pieces, exact, camera, directions: OnceCell::new() }
    }

    /// The specimens of a sample that moves them by `shift`.
    pub fn moved_specimens(sample: &'static str, shift: DVec3) -> Self {
        let camera = formation::camera(SceneKind::Specimens);
        Self::new(sample, SceneKind::Specimens, 0, camera, shift)
    }

    fn specimens() -> Self {
        Self::moved_specimens(NAME, DVec3::ZERO)
    }

    fn few() -> Self {
        let camera = Camera::new(DVec3::new(1.0, 5.0, 8.0), DVec3::new(0.0, 0.8, 0.0), 36.0);
        Self::new(NAME, SceneKind::Ripples, 60, camera, DVec3::ZERO)
    }

    /// The sample's picture of it.
    pub fn picture(&self, sets: &[&str]) -> Picture {
        Chapter::new(self.sample).size(SIZE).sets(sets).picture()
    }

    /// The matrix of a piece on the device.
    pub fn transform(&self, index: usize) -> Transform {
        let rows = scene::transform(&self.pieces[index].instance().transform).matrix;
        let row = |i: usize| std::array::from_fn(|k| rows[4 * i + k]);
        Transform::from_rows([row(0), row(1), row(2)]).unwrap()
    }

    /// The rays of a picture with their hits.
    fn hits(&self, sets: &[&str]) -> Vec<(Ray, [f32; 4])> {
        let show = |view| self.picture(&[sets, &[view]].concat());
        let directions = self.directions.get_or_init(|| show("show=ray direction"));
        rays(&self.camera, directions).zip(show("show=hit").pixels).collect()
    }
}

/// The piece at each pixel; `None` for the sky.
fn indices(hits: &Picture) -> impl Iterator<Item = Option<usize>> {
    hits.pixels.iter().map(|pixel| (pixel[0] >= 0.0).then_some(pixel[0] as usize))
}

#[test]
fn hits_agree_under_every_matrix() {
    for (viewed, sets) in [(ViewedScene::specimens(), &[SPECIMEN][..]), (ViewedScene::few(), &FEW)]
    {
        let hits = viewed.hits(sets);
        let mut seen = vec![0; viewed.pieces.len()];
        for hit in hits.iter().filter_map(|(_, hit)| answer(hit)) {
            seen[hit.instance as usize] += 1;
        }
        let tally = judge(&viewed.exact, hits.iter().map(|(ray, hit)| (*ray, answer(hit))));
        println!("{sets:?}: {tally}");
        let Tally { wrong, first_wrong, agree, .. } = &tally;
        assert_eq!(*wrong, 0, "{first_wrong:?}");
        assert!(*agree > 8_950, "{tally}");
        // Six knights at the end of the row, all of them visible.
        if sets == [SPECIMEN] {
            let knights = &seen[seen.len() - 6..];
            assert!(knights.iter().all(|&pixels| pixels > 30), "{knights:?}");
        }
    }
}

/// The specimens' shadow rays: none may be blocked by the triangle it leaves, however that is stretched.
#[test]
fn no_matrix_makes_a_triangle_shadow_itself() {
    let viewed = ViewedScene::specimens();
    let hits = viewed.hits(&[SPECIMEN]);
    let sets = [SPECIMEN, "show=shadow origin"];
    let origins = chapter().sets(&sets).picture();
    let sun = Sun { azimuth: 300.0, elevation: 22.0, ..Sun::default() }.light().direction;
    let (mut lit, mut dark) = (0, 0);
    for ((ray, hit), &[x, y, z, seen]) in hits.iter().zip(&origins.pixels).step_by(3) {
        let Some(hit) = answer(hit) else { continue };
        let own = (hit.instance, hit.primitive);
        let shadow = Ray::from_f32([x, y, z], sun.to_array(), 0.0, 1e30);
        let mut candidates = viewed.exact.near_candidates(&shadow);
        candidates.retain(|near| (near.hit.instance, near.hit.primitive) != own);
        let [a, b, c] = *viewed.exact.triangle(own.0, own.1).unwrap();
        let normal = (b - a).cross(c - a).normalize();
        let cosine = -normal.dot(ray.direction).signum() * normal.dot(shadow.direction);
        if candidates.iter().any(|near| near.must_hit(&shadow)) {
            assert!(seen == 0.0, "lit through a triangle: {shadow:?}");
        } else if candidates.is_empty() && cosine > 1e-6 {
            assert!(seen == 1.0, "piece {} shadows itself: {shadow:?}", hit.instance);
        }
        lit += usize::from(seen == 1.0);
        dark += usize::from(seen == 0.0);
    }
    println!("{lit} lit, {dark} dark");
    assert!(lit > 500 && dark > 100, "{lit} {dark}");
}

pub fn absolute(m: DMat3) -> DMat3 {
    DMat3::from_cols_array(&m.to_cols_array().map(f64::abs))
}

#[test]
fn the_custom_index_does_not_depend_on_the_order() {
    let show =
        |view: &str, ordering: &[&str]| chapter().with(ordering).sets(&FEW).sets(&[view]).picture();
    let [[hits, ids], [unordered_hits, unordered_ids]] = [&[][..], &["--unordered"]]
        .map(|ordering| ["show=hit", "show=instance id"].map(|view| show(view, ordering)));
    same_hits("ordered and not", NAME, &hits, &unordered_hits);
    let (mut moved, mut others) = (0, 0);
    for ((hit, a), b) in hits.pixels.iter().zip(&ids.pixels).zip(&unordered_ids.pixels) {
        // With the pieces in order, gl_InstanceID is their index. At an edge, each view may show either
        // piece.
        others += u32::from(hit[0] != b[3]);
        moved += usize::from(a[3] != b[3]);
    }
    let flips = if run::device::is_software() { 0 } else { Near::of(NAME).both().flips(&hits) };
    assert!(moved > 3000 && others <= flips, "{moved}, {others} others");
}

/// The percentage of pixels in which two pictures of hits show different triangles.
pub fn percent_changed(a: &Picture, b: &Picture) -> f64 {
    let pairs = a.pixels.iter().zip(&b.pixels);
    let changed = pairs.filter(|(a, b)| a[..2] != b[..2]).count();
    100.0 * changed as f64 / a.pixels.len() as f64
}

#[test]
fn copies_look_the_same_and_take_the_memory() {
    let sets = |geometry| [&FEW[..], &[geometry, "show=hit"]].concat();
    let instances = chapter().sets(&sets("geometry=instances")).run();
    let copies = chapter().sets(&sets("geometry=copies")).run();
    let changed = percent_changed(&instances.picture, &copies.picture);
    // A baked vertex is rounded once more, so rays at an edge may take the other side.
    assert!(changed < 0.5, "{changed} %");
    let number = |run: &Run, name: &str| run.report["chapter"][name].as_u64().unwrap();
    assert_eq!(number(&instances, "triangles"), number(&copies, "triangles"));
    assert_eq!(number(&copies, "meshes"), number(&copies, "pieces"));
    // A copied triangle needs at least its three indices and a leaf; a piece needs 64 bytes.
    let more = |name| number(&copies, name) - number(&instances, name);
    let triangles = number(&copies, "triangles");
    assert!(more("mesh_bytes") + more("bottom_level_bytes") > 40 * triangles);
    let more = chapter().sets(&["squares=4000", "show=hit"]).run();
    let pieces = number(&more, "pieces") - number(&instances, "pieces");
    for name in ["mesh_bytes", "bottom_level_bytes"] {
        assert_eq!(number(&more, name), number(&instances, name), "{name}");
    }
    let per_piece = ["top_level_bytes", "record_bytes", "instance_bytes"]
        .map(|name| (number(&more, name) - number(&instances, name)) as f64 / pieces as f64);
    println!("bytes a piece, top level, record, instance: {per_piece:.1?}");
    let [top_level, record, _] = per_piece;
    expected::hold("09_instancing/piece", json!({ "top_level": top_level, "record": record }));
    assert!(per_piece.iter().sum::<f64>() < 500.0, "{per_piece:?}");
}

/// The page's table of memory.
#[test]
fn copies_of_a_thousand_squares_take_what_the_page_says() {
    let [instances, copies] = ["instances", "copies"]
        .map(|geometry| chapter().sets(&["squares=1000"]).set("geometry", geometry).run().report);
    let mut table = Map::new();
    let mut row = |name: &str, of: fn(&Value, &str) -> u64| {
        let pair = [&instances, &copies].map(|report| of(report, name));
        println!("| {name} | {} | {} |", pair[0], pair[1]);
        table.insert(format!("{name}.instances"), pair[0].into());
        table.insert(format!("{name}.copies"), pair[1].into());
        pair
    };
    let own = |report: &Value, name: &str| report["chapter"][name].as_u64().unwrap();
    let parts = ["mesh_bytes", "bottom_level_bytes", "top_level_bytes", "record_bytes"];
    let parts = parts.map(|name| row(name, own));
    // The size of buffers depends on their placement by the driver, by some hundred bytes in all.
    let all = row("bytes_allocated", |report, name| {
        report[name].as_u64().unwrap().next_multiple_of(100_000)
    });
    let pieces = own(&copies, "pieces");
    let each = (parts[0][1] + parts[1][1]) / pieces;
    println!("{pieces} pieces, {each} bytes for a copy");
    expected::hold("09_instancing/memory", table.into());
    expected::hold("09_instancing/copies", json!({ "pieces": pieces, "each": each }));
    // The table's rows add up to less than the total. The rest is what a frame needs, equal in both columns.
    let rest = [0, 1].map(|i| all[i] - parts.iter().map(|pair| pair[i]).sum::<u64>());
    assert!(rest.iter().all(|&bytes| bytes < 16 << 20) && all[1] > 30 * all[0], "{rest:?}");
}

#[test]
fn a_hundred_thousand_instances_are_built_and_traced() {
    // From above, so that the whole disk is visible.
    let sets = ["squares=70000", "camera eye=0,330,60", "camera target=0,0,0", "field of view=50"];
    let run = chapter().sets(&sets).sets(&["show=hit"]).run();
    let pieces = run.report["chapter"]["pieces"].as_u64().unwrap();
    println!("{pieces} instances, {} ms", run.report["gpu_milliseconds"]["median"]);
    assert!(pieces > 100_000, "{pieces}");
    let seen: std::collections::BTreeSet<_> = indices(&run.picture).flatten().collect();
    assert!(seen.len() > 3000, "{} seen", seen.len());
    // Indices beyond 16 bits arrive intact, and the last squares are at the rim.
    assert!(seen.iter().any(|&index| index > 65_536) && *seen.last().unwrap() < pieces as usize);
    assert!(seen.last().unwrap() + 2000 > pieces as usize, "{:?}", seen.last());
}

#[test]
fn wrong_controls_are_refused() {
    for (set, possible) in
        [("squares=0", "1 to 1000000"), ("normals=right", "matrix, device inverse, host inverse")]
    {
        let (code, line) = run::refused(NAME, &["--headless", "--set", set]);
        assert!(code == 2 && line.contains(possible), "{code}: {line}");
    }
}
