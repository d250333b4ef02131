//! 41_ray_offset: shadow rays compared with the reference, and the failures of a constant offset.

mod price;

use common::app::Picture;
use common::scene::Sun;
use glam::Vec3;
use reference::Ray;
use serde_json::{Map, json};

use crate::shadow_rays::{Shadows, hold_answers, hold_origins, is_on_a_square};
use run::{Chapter, expected, same_colors, shaders_with};

const NAME: &str = "41_ray_offset";
const SIZE: &str = "240x150";

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

fn to_sun(origin: Vec3) -> Ray {
    let sun = Sun { azimuth: 60.0, elevation: 17.0, ..Sun::default() };
    Ray::from_f32(origin.to_array(), sun.light().direction.to_array(), 0.0, 1e30)
}

#[test]
fn every_shadow_ray_gets_the_reference_s_answer() {
    let found = hold_answers(NAME, to_sun);
    expected::hold(
        "41_ray_offset/rays",
        json!({ "surfaces": found.surfaces, "lit": found.lit, "edges": found.edges,
                "turned_away": found.turned_away }),
    );
}

#[test]
fn shadows_are_those_of_the_exact_hit_points() {
    let found = hold_origins(NAME, to_sun);
    expected::hold(
        "41_ray_offset/origins",
        json!({ "differ": found.differ, "surfaces": found.surfaces, "height": found.height,
                "height_on_slivers": found.height_on_slivers, "moved": found.moved }),
    );
}

#[test]
fn its_constant_is_that_of_05() {
    let [constant, of_05] = [
        chapter().set("offset", "constant").picture(),
        Chapter::new("05_shadow_miss").size(SIZE).picture(),
    ];
    same_colors("41 by a constant and 05", NAME, &constant, &of_05);
}

/// A sun on the horizon is in the plane of the board, not above it.
#[test]
fn a_sun_on_the_horizon_does_not_light_the_board() {
    let level = chapter().sets(&["sun elevation=0", "show=shadow origin"]).picture();
    let board = level.pixels.iter().filter(|pixel| is_on_a_square(pixel));
    assert!(board.clone().count() > 5000 && board.clone().all(|pixel| pixel[3] == 0.0));
}

fn shadows(sets: &[&str]) -> Picture {
    Chapter::new(NAME).size("480x300").set("show", "shadow").sets(sets).picture()
}

/// The shadows of the set at each size, near the origin and far from it, compared with the original set's.
#[test]
fn a_constant_fails_at_another_size_and_far_away() {
    let right = shadows(&[]);
    let mut found = Map::new();
    for (name, place) in [
        ("here", &[][..]),
        ("small", &["size=0.001"]),
        ("large", &["size=1000"]),
        ("far", &["moved=1000000"]),
    ] {
        for offset in ["constant", "bound"] {
            let offset_set = format!("offset={offset}");
            let shown = shadows(&[place, &[offset_set.as_str()]].concat());
            let Shadows { dark, leaks, .. } = Shadows::compare(&right, &shown);
            println!("{name}, {offset}: {dark} dark, {leaks} leaks");
            found.insert(format!("{name}.{offset}.dark"), dark.into());
            found.insert(format!("{name}.{offset}.leaks"), leaks.into());
            let wrong = dark + leaks;
            match (name, offset) {
                ("large", "constant") => assert!(dark > 5_000, "{dark} dark"),
                ("small", "constant") => assert!(leaks > 1_000, "{leaks} leaks"),
                ("far", "constant") => assert!(wrong > 1_000, "{wrong} wrong"),
                // A million units away, the bound itself is as large as a piece.
                ("far", "bound") => assert!(dark < leaks, "{dark} dark, {leaks} leaks"),
                _ => assert!(wrong < 200, "{name}, {offset}: {wrong} wrong"),
            }
        }
    }
    expected::hold("41_ray_offset/places", found.into());
}

/// The bound of `ray_offset.glsl`.
const BOUND: &str = "at.offset = ROUNDING * (dot(abs(at.face), error_bound) + test);";

/// The number of pixels that become dark by mistake if the origin is closer to the surface than the bound
/// requires.
#[test]
fn specks_come_where_the_bound_is_not_kept() {
    let right = shadows(&[]);
    let mut scaled = Map::new();
    for factor in ["0.3", "0.1", "0.03", "0.01", "0.0"] {
        let line = BOUND.replace("ROUNDING", &format!("{factor} * ROUNDING"));
        let shaders = shaders_with("common/ray_offset.glsl", BOUND, &line);
        let picture = Chapter::new(NAME).size("480x300").shaders(shaders.path());
        let picture = picture.set("show", "shadow").picture();
        let Shadows { lit, dark, .. } = Shadows::compare(&right, &picture);
        scaled.insert(factor.to_owned(), dark.into());
        scaled.insert("lit".to_owned(), lit.into());
    }
    println!("dark by the offset's factor, and lit by the whole bound: {scaled:?}");
    expected::hold("41_ray_offset/scaled", scaled.into());
}
