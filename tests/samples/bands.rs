//! A picture in many bands of rows equals the picture in few, bit for bit.

use run::{Chapter, bits};

/// A chapter, and its settings.
type Choice = (&'static str, &'static [&'static str]);

// A pipeline, a frame that builds what moves, a compute shader, and a raster pass.
#[test]
fn many_bands_give_the_same_bytes_as_few() {
    hold(&[
        ("02_basic", &[]),
        ("14_animation", &["frame=932", "play=off"]),
        ("16_ray_query", &["workgroup=16x16"]),
        ("17_ray_query_raster", &[]),
    ]);
}

#[test]
#[ignore = "nightly: every chapter; quick: bands::many_bands_give_the_same_bytes_as_few"]
fn and_in_every_chapter() {
    hold(&[
        ("03_any_hit", &["mode=random", "samples=2"]),
        ("04_jitter_camera", &["accumulate=off", "jitter=off"]),
        ("05_shadow_miss", &[]),
        ("06_reflection", &[]),
        ("07_multi_closest_hit", &[]),
        ("08_intersection", &[]),
        ("09_instancing", &[]),
        ("12_infinite_plane", &[]),
        ("21_heightfield", &[]),
        ("22_solids", &[]),
        ("23_motion_blur", &["frame=934", "play=off", "shutter=2", "samples=4"]),
        ("24_accuracy", &[]),
        ("25_scene_effects", &["scene=soft evening"]),
        ("26_leaving_a_surface", &[]),
        ("34_lights", &[]),
        ("35_soft_shadows", &["light size=0.5"]),
        ("36_two_normals", &[]),
        ("39_far_from_origin", &["coordinates=both"]),
    ]);
}

fn hold(choices: &[Choice]) {
    // The cost of a first frame is unknown, so its first band is one row. The second frame is known to cost
    // the same, and is so small that it is one band unless the machine is very busy.
    for &(name, sets) in choices.iter().filter(|(name, _)| run::is_offered(name)) {
        let [many, few] =
            [1, 2].map(|frames| Chapter::new(name).size("40x24").sets(sets).frames(frames).run());
        assert!(many.report["bands"].as_u64() > Some(1), "{name}: {}", many.report["bands"]);
        assert_eq!(bits(&many.picture), bits(&few.picture), "{name}");
    }
}
