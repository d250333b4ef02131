//! 40_curved_cones: the cone behind a curved mirror and a lens, compared with rays, and the difference of
//! each way to carry it from 1,024 rays per pixel.

mod hard;
mod measured;
mod rays;

use run::{Chapter, bits, command, compiled_for, refusal, render, render_by, shaders_with};

const NAME: &str = "40_curved_cones";
const SIZE: &str = "240x150";
const FOOTPRINTS: [&str; 4] = ["point", "flat", "curved", "differentials"];

/// The chapter's functions, before the files of 02.
fn bent() -> String {
    let files = ["common/footprint.glsl", "40_curved_cones/bent.glsl"];
    files
        .map(|file| std::fs::read_to_string(run::root().join("shaders").join(file)).unwrap())
        .concat()
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).repeats();
}

/// A field of an unknown type breaks exactly the pipelines that carry it.
#[test]
fn a_payload_carries_the_cone_or_the_neighbours_and_never_both() {
    a_payload_carries_what_its_footprint_reads(&FOOTPRINTS[2..]);
}

#[test]
#[ignore = "nightly: the other footprints; quick: curved_cones::a_payload_carries_the_cone_or_the_neighbours_and_never_both"]
fn so_it_is_with_every_footprint() {
    a_payload_carries_what_its_footprint_reads(&FOOTPRINTS);
}

fn a_payload_carries_what_its_footprint_reads(footprints: &[&str]) {
    for (field, carried_by) in [("Beam beam;", &FOOTPRINTS[3..]), ("Cone cone;", &FOOTPRINTS[..3])]
    {
        let shaders = shaders_with(&format!("{NAME}/seen.glsl"), field, "NoSuchType field;");
        for footprint in footprints {
            let mut sample = command(NAME);
            sample.env("SHADERS", shaders.path());
            let arguments = ["--set", &format!("footprint={footprint}")];
            if carried_by.contains(footprint) {
                sample.args(["--headless", "--size", "8x8"]).args(arguments);
                let (code, line) = refusal(sample.output().expect("the sample starts"));
                assert!(code == 1 && line.contains("seen.glsl"), "{footprint}, {field} {line}");
            } else {
                let without = render_by(&mut sample, "32x20", &arguments).picture;
                let whole = render(NAME, "32x20", &arguments).picture;
                assert_eq!(bits(&without), bits(&whole), "{footprint}");
            }
        }
    }
}

/// The bare floor, with mirrors and glass out of view.
#[test]
fn without_a_curved_surface_in_view_it_is_19_to_the_bit() {
    let from = ["camera eye=700,3,-40", "camera target=720,0,-60", "show=color"];
    let of = |name: &str, footprint: &str| {
        let footprint = format!("footprint={footprint}");
        bits(&Chapter::new(name).size(SIZE).sets(&from).sets(&[&footprint]).picture())
    };
    let parent = of("19_ray_cones", "ellipse");
    assert_eq!(of(NAME, "curved"), parent);
    assert_eq!(of(NAME, "flat"), parent);
    assert_eq!(of(NAME, "point"), of("19_ray_cones", "point"));
    assert_ne!(of(NAME, "point"), parent, "the view has no far floor");
}

#[test]
#[ignore = "nightly: compiles for a GPU; quick: gpus budgets::no_chapter_costs_a_gpu_more_than_is_recorded"]
fn its_program_spills_no_register() {
    for footprint in FOOTPRINTS {
        let set = format!("footprint={footprint}");
        let Some(programs) = compiled_for(NAME, "navi31", &["--set", &set]) else { return };
        assert_eq!(programs.len(), 1, "rays do not nest: one program");
        assert_eq!(programs[0]["spilled_registers"], 0, "{}", programs[0]);
    }
}
