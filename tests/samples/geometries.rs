//! 44_geometries: the record of every ray for every stride; one level equals many; the cost of each.

use std::fs;
use std::ops::Range;

use common::app::Picture;
use common::gpu::sbt;
use common::scene::{Instance, Scene};
use glam::{Affine3A, Vec3};
use serde_json::{Value, json};

use run::primary_hits::{answer, judge, rays, reference};
use run::{Chapter, bits, expected, same_answers, same_colors};

#[allow(dead_code)]
#[path = "../../samples/44_geometries/levels.rs"]
mod levels;
#[path = "../../samples/44_geometries/parts.rs"]
mod parts;

mod boxes;
mod measured;

use parts::Cut;

const NAME: &str = "44_geometries";
const SIZE: &str = "240x150";
/// Records per geometry: for its look and for inspection.
const RAY_TYPES: u32 = 2;
/// The number in a picture that marks a ray for a look that used a record for inspection.
const INSPECTED: f32 = -2.0;

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

/// A run whose pieces have this many parts; with one part, there is no shape to set.
fn cut_in(chapter: Chapter, cut: &str, parts: u32) -> Chapter {
    let chapter = chapter.set("parts", parts);
    if parts > 1 { chapter.set("cut", cut) } else { chapter }
}

/// The chapter's own scene, cut, and its places.
fn scene(cut: Cut, parts: u32) -> (Scene, Vec<Range<usize>>) {
    let mut scene = parts::cut(&Scene::chess().unwrap(), cut, parts);
    let places = levels::places(&mut scene.instances, usize::MAX);
    (scene, places)
}

/// The place of an instance.
fn place(places: &[Range<usize>], instance: u32) -> &Range<usize> {
    places.iter().find(|place| place.contains(&(instance as usize))).expect("its place")
}

/// The group an instance should use, by the number in `push.glsl`.
fn group(scene: &Scene, instance: &Instance) -> u32 {
    let mesh = scene.model.meshes[instance.mesh].name.as_str();
    match scene.model.materials[instance.material].name.as_str() {
        "white" => 1,
        "black" | "inlay" => 3,
        "board_light" | "board_dark" => 2,
        "frame" if mesh == "board_frame" => 2,
        "frame" => 3,
        _ => 0,
    }
}

#[test]
fn every_ray_takes_the_record_of_its_geometry() {
    for (cut, word) in [(Cut::Slices, "slices"), (Cut::Rings, "rings")] {
        let (scene, places) = scene(cut, 3);
        let [hits, directions, geometries, groups, records] =
            ["hit", "ray direction", "geometry", "group", "record"]
                .map(|view| chapter().set("cut", word).set("show", view).picture());
        // The reference gives the instance a ray hits, and the triangle of its mesh.
        let answers = hits.pixels.iter().map(answer);
        let tally = judge(&reference(&scene), rays(&scene.camera, &directions).zip(answers));
        assert_eq!(tally.wrong, 0, "{:?}", tally.first_wrong);
        let mut rays_of = [0; 3];
        for (index, hit) in hits.pixels.iter().enumerate() {
            let found = [&geometries, &groups, &records].map(|picture| picture.pixels[index][3]);
            let Some(answer) = answer(hit) else {
                assert_eq!(found, [-1.0; 3]);
                continue;
            };
            let geometry = answer.instance - place(&places, answer.instance).start as u32;
            let group = group(&scene, &scene.instances[answer.instance as usize]);
            let record = answer.instance * RAY_TYPES;
            assert_eq!(found, [geometry, group, record].map(|number| number as f32), "{answer:?}");
            rays_of[geometry as usize] += 1;
        }
        assert!(rays_of.iter().all(|&rays| rays > 300), "{word}: {rays_of:?}");
    }
}

/// The pictures of two builds: the same triangles at the same distances in another order. Only the index of
/// the instance in the build differs.
#[test]
fn one_level_equals_many() {
    for show in SHOWS {
        levels_agree("rings", 5, show);
    }
    for parts in [1, 3] {
        for show in ["hit", "record"] {
            levels_agree("slices", parts, show);
        }
    }
}

#[test]
#[ignore = "nightly: each view of each cut; quick: geometries::one_level_equals_many"]
fn one_level_equals_many_in_each_view_of_each_cut() {
    for (cut, parts) in [("slices", 1), ("slices", 3), ("rings", 5)] {
        SHOWS.iter().for_each(|show| levels_agree(cut, parts, show));
    }
}

const SHOWS: [&str; 6] = ["picture", "normal", "triangle", "hit", "record", "group"];

fn levels_agree(cut: &str, parts: u32, show: &str) {
    let view = |levels: &str| {
        let chapter = chapter().set("levels", levels).set("show", show);
        let mut picture = cut_in(chapter, cut, parts).picture();
        if show == "hit" {
            picture.pixels.iter_mut().for_each(|pixel| pixel[3] = 0.0);
        }
        picture
    };
    let [one, many] = ["one", "many"].map(view);
    let same = if show == "picture" { same_colors } else { same_answers };
    same(&format!("{show}, {parts} {cut}"), NAME, &one, &many);
}

#[test]
fn a_wrong_stride_leads_to_the_records_that_the_formula_says() {
    let (_, places) = scene(Cut::Slices, 3);
    for stride in 0..=RAY_TYPES {
        let hits = chapter().set("show", "hit").shared_picture();
        let records = chapter().set("stride", stride).set("show", "record").picture();
        let mut wrong = 0;
        for (hit, record) in hits.pixels.iter().zip(&records.pixels) {
            let Some(answer) = answer(hit) else { continue };
            let first = place(&places, answer.instance).start as u32;
            let taken = sbt::hit_record(RAY_TYPES * first, answer.instance - first, stride, 0);
            // Odd records are for inspection.
            let expected = if taken.is_multiple_of(RAY_TYPES) { taken as f32 } else { INSPECTED };
            assert_eq!(record[3], expected, "stride {stride}: {answer:?}");
            wrong += usize::from(taken != RAY_TYPES * answer.instance);
        }
        assert_eq!(stride == RAY_TYPES, wrong == 0, "stride {stride}: {wrong}");
        assert!(stride == RAY_TYPES || wrong > 5000, "stride {stride}: {wrong}");
    }
}

#[test]
fn the_stride_does_not_matter_to_levels_of_one_geometry() {
    let view = |stride: u32| chapter().set("levels", "many").set("stride", stride).picture();
    let right = bits(&view(RAY_TYPES));
    assert!(right == bits(&view(0)) && right == bits(&view(1)));
}

/// With stride 0, a place has a single look, that of its first geometry, as if all its meshes used the first
/// one's record.
#[test]
fn with_stride_0_black_and_white_are_red() {
    let (scene, places) = scene(Cut::Slices, 3);
    let groups = chapter().set("stride", 0).set("show", "group").picture();
    let hits = chapter().set("show", "hit").picture();
    let mut pieces = 0;
    for (hit, found) in hits.pixels.iter().zip(&groups.pixels) {
        let Some(answer) = answer(hit) else { continue };
        let first = &scene.instances[place(&places, answer.instance).start];
        assert_eq!(found[3], group(&scene, first) as f32, "{answer:?}");
        pieces += usize::from(scene.model.materials[first.material].name == "inlay");
    }
    assert!(pieces > 3000, "{pieces}");
}

#[test]
fn a_model_in_one_place_is_one_level() {
    // Three squares side by side, red, green and blue.
    let folder = tempfile::tempdir().unwrap();
    let colors = ["1 0 0", "0 1 0", "0 0 1"];
    let (mut obj, mut mtl) = ("mtllib squares.mtl\n".to_owned(), String::new());
    for (i, color) in colors.iter().enumerate() {
        mtl += &format!("newmtl m{i}\nKd {color}\n");
        for (x, y) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
            obj += &format!("v {} {y} 0\n", x + i);
        }
        let [a, b, c, d] = [1, 2, 3, 4].map(|corner| corner + 4 * i);
        obj += &format!("o square{i}\nusemtl m{i}\nf {a} {b} {c} {d}\n");
    }
    fs::write(folder.path().join("squares.mtl"), mtl).unwrap();
    let file = folder.path().join("squares.obj");
    fs::write(&file, obj).unwrap();
    let run = |levels: &str, stride: u32| {
        let chapter = chapter().scene(&file).set("levels", levels).set("stride", stride);
        let chapter = chapter.sets(&["camera eye=1.5,0.5,3", "camera target=1.5,0.5,0"]);
        chapter.run()
    };
    let [one, many, wrong] = [("one", 2), ("many", 2), ("one", 0)].map(|(l, s)| run(l, s));
    let number = |report: &Value, name: &str| report["chapter"][name].as_u64().unwrap();
    assert_eq!([number(&one.report, "levels"), number(&one.report, "instances")], [1, 1]);
    assert_eq!([number(&many.report, "levels"), number(&many.report, "instances")], [3, 3]);
    same_colors("squares", NAME, &one.picture, &many.picture);
    // The strongest of red, green and blue in the middle of each square.
    let strongest = |picture: &Picture| {
        [0.5f32, 1.5, 2.5].map(|x| {
            let column = (120.0 + (x - 1.5) * 40.0) as usize;
            let pixel = picture.pixels[75 * 240 + column];
            (0..3).max_by(|&a, &b| pixel[a].total_cmp(&pixel[b])).unwrap()
        })
    };
    assert_eq!(strongest(&one.picture), [0, 1, 2]);
    assert_eq!(strongest(&wrong.picture), [0, 0, 0]);
}

#[test]
fn places_are_complete_and_never_above_the_limit() {
    let (whole, places) = scene(Cut::Rings, 5);
    let all: usize = places.iter().map(Range::len).sum();
    assert_eq!(all, whole.instances.len());
    for place in &places {
        let here = whole.instances[place.start].transform;
        assert!(whole.instances[place.clone()].iter().all(|one| one.transform == here));
    }
    for most in 1..7 {
        let mut instances = whole.instances.clone();
        let limited = levels::places(&mut instances, most);
        let fits = |place: &Range<usize>| !place.is_empty() && place.len() <= most;
        assert!(limited.iter().all(fits));
        let expected: usize = places.iter().map(|place| place.len().div_ceil(most)).sum();
        assert_eq!(limited.len(), expected);
        // They follow each other without gaps.
        assert!(limited.windows(2).all(|pair| pair[0].end == pair[1].start));
    }
    assert!(levels::places(&mut [], 7).is_empty());
    // Mirrored, or moved by the smallest amount, it is another place.
    let at = |x: f32| Affine3A::from_translation(Vec3::new(x, 0.0, 0.0));
    let instance = |transform| Instance { mesh: 0, transform, material: 0, record_offset: 0 };
    let mut some = [at(1.0), at(1.0f32.next_up()), at(1.0)].map(instance);
    assert_eq!(levels::places(&mut some, 9), [0..2, 2..3]);
}

#[test]
fn pieces_of_the_same_parts_share_a_level() {
    let numbers = |levels: &str| {
        let report = chapter().set("levels", levels).run().report;
        let number = |name: &str| report["chapter"][name].as_u64().unwrap();
        [number("levels"), number("instances")]
    };
    let ([one, places], [many, meshes]) = (numbers("one"), numbers("many"));
    let values = json!({ "one": one, "places": places, "many": many, "meshes": meshes });
    // Six kinds of pieces of three parts, the board of three, the screen of two.
    assert_eq!([one, many], [6 + 2, 6 * 3 + 3 + 2]);
    expected::hold_exact("44_geometries/levels", values);
}

#[test]
fn the_page_shows_the_printed_table() {
    let report = chapter().run().report;
    let lines = report["chapter"]["table"].as_array().expect("the report has the table");
    let lines: Vec<&str> = lines.iter().map(|line| line.as_str().expect("text")).collect();
    let (scene, _) = scene(Cut::Slices, 3);
    assert_eq!(lines.len(), 1 + scene.instances.len());
    let page = fs::read_to_string(run::root().join(format!("docs/{NAME}.md"))).unwrap();
    let (_, shown) = page.split_once(&format!("```text\n{}\n", lines[0])).expect("the table");
    let (shown, _) = shown.split_once("```").expect("its end");
    let shown: Vec<_> = shown.lines().filter(|line| line.trim() != "…").collect();
    assert!(shown.len() > 5 && shown.iter().all(|line| lines.contains(line)), "{shown:?}");
}
