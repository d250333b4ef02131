//! 30_own_tree: the picture of 16 without an acceleration structure, and every hit compared with the
//! reference.

use common::app::Picture;
use common::scene::Scene;

use run::primary_hits::{answer, judge, rays, reference};
use run::{Chapter, command, expected, refusal, refused, render, shaders_with};
use serde_json::json;

const NAME: &str = "30_own_tree";
const SIZE: &str = "240x150";

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

/// The number of pixels in which two pictures differ at all.
fn differing(a: &Picture, b: &Picture) -> usize {
    a.pixels.iter().zip(&b.pixels).filter(|(a, b)| a != b).count()
}

#[test]
fn every_hit_agrees_with_the_reference() {
    let scene = Scene::chess().unwrap();
    let (hits, directions) = (
        chapter().sets(&["show=hit"]).picture(),
        chapter().sets(&["show=ray direction"]).picture(),
    );
    let answers = hits.pixels.iter().map(answer);
    let tally = judge(&reference(&scene), rays(&scene.camera, &directions).zip(answers));
    println!("{tally}");
    expected::hold("30_own_tree/hits", tally.values());
    assert_eq!(tally.wrong, 0, "{:?}", tally.first_wrong);
    assert!(tally.ties + tally.grazes < hits.pixels.len() / 500, "{tally}");
    assert!(hits.pixels.iter().filter(|pixel| pixel[2] > 0.0).count() > hits.pixels.len() / 2);
}

/// 16 uses the device, whose triangle test rounds differently: at edges another triangle may be hit, and the
/// weights differ in the last place everywhere.
#[test]
fn it_is_the_picture_of_16() {
    run::needs!("16_ray_query");
    let of_16 = render("16_ray_query", SIZE, &[]).picture;
    let own = chapter().shared_picture();
    let far = |(a, b): (&[f32; 4], &[f32; 4])| (0..3).any(|k| (a[k] - b[k]).abs() > 1.0 / 255.0);
    let count = of_16.pixels.iter().zip(&own.pixels).filter(|&pair| far(pair)).count();
    println!("{count} pixels differ by more than a step of 8 bits");
    expected::hold("30_own_tree/query", json!({ "pixels": own.pixels.len(), "differ": count }));
    assert!(count < own.pixels.len() / 1000, "{count}");
}

/// A device that builds nothing, and one whose nodes and triangles are random.
#[test]
fn what_a_device_built_that_is_not_a_tree_is_refused_in_a_line() {
    let nothing = "Child none = Child(vec3(0.0), 0, vec3(0.0), 0);";
    let anything = "Child none = Child(vec3(0.0), i * 2654435761u, vec3(1.0), i & 1u);";
    for (children, words) in
        [(nothing, "node 0 is reached twice"), (anything, "leads beyond the tree")]
    {
        let whole = "int i = int(invocation());";
        let broken = format!(
            "{{ uint i = invocation(); if (i < push.nodes_count) {{ {children} \
             push.nodes.at[i].children = Child[2](none, none); push.ends.at[i] = NO_NODE; }} \
             return; }} {whole}"
        );
        let shaders = shaders_with("30_own_tree/hierarchy.comp", whole, &broken);
        let mut sample = command(NAME);
        sample.env("SHADERS", shaders.path());
        sample.args(["--headless", "--size", "8x8", "--set", "tree=device"]);
        let (code, line) = refusal(sample.output().expect("the sample starts"));
        let mesh = "the device's tree of the mesh \"";
        assert!(code == 1 && line.contains(mesh) && line.contains(words), "{line}");
    }
}

/// A tree only affects which boxes are tested, never the hit.
#[test]
fn no_tree_and_no_node_changes_the_picture() {
    let own = chapter().shared_picture();
    for set in ["tree=binned", "tree=device", "nodes=36 bytes"] {
        let count = differing(&own, &chapter().sets(&[set]).picture());
        // Two triangles may be hit at the same distance; then the first one found counts.
        assert!(count <= own.pixels.len() / 2000, "{set}: {count} pixels differ");
    }
}

#[test]
fn each_way_to_test_gives_nearly_the_same_picture() {
    tests_give_nearly_the_same_picture(&["boxes=bare", "triangles=moeller"]);
}

#[test]
#[ignore = "nightly: the other ways; quick: own_tree::each_way_to_test_gives_nearly_the_same_picture"]
fn so_do_margins_and_two_floats() {
    tests_give_nearly_the_same_picture(&["boxes=guess", "boxes=ize", "boxes=two-float"]);
}

fn tests_give_nearly_the_same_picture(sets: &[&str]) {
    let own = chapter().shared_picture();
    for set in sets {
        let count = differing(&own, &chapter().sets(&[set]).picture());
        assert!(count <= own.pixels.len() / 50, "{set}: {count} pixels differ");
    }
}

/// The views count steps, show the edges of boxes, and draw the walk of one ray step by step.
#[test]
fn the_views_show_the_tree() {
    let sky = |picture: &Picture| picture.pixels[0];
    let shown = |sets: &[&str]| chapter().size("120x75").sets(sets).picture();
    let [steps, boxes] = [shown(&["show=steps"]), shown(&["show=boxes"])];
    assert_ne!(sky(&steps), sky(&boxes));
    let [early, late, again] =
        ["walk step=2", "walk step=12", "walk step=12"].map(|step| shown(&["show=walk", step]));
    let count = differing(&early, &late);
    assert!(count > 100, "later steps draw more boxes: {count} pixels differ");
    assert_eq!(differing(&late, &again), 0);
}

#[test]
fn neither_an_extension_nor_an_acceleration_structure_is_asked_for() {
    let report = render(NAME, "16x10", &[]).report;
    assert_eq!(report["acceleration_structure_bytes"], 0);
    assert_eq!(report["groups"], 0);
    assert_eq!(report["stages"], json!(["30_own_tree/trace.comp"]));
}

#[test]
fn a_step_that_there_is_not_is_refused_in_one_line() {
    let (code, line) = refused(NAME, &["--headless", "--set", "walk step=0"]);
    assert!(code == 2 && line.contains("walk step"), "{code}: {line}");
}
