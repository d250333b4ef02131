//! 05_shadow_miss: shadows held to the reference, and what each choice must not change.

mod offsets;
mod price;

use common::scene::Sun;
use glam::Vec3;
use reference::Ray;
use serde_json::json;

use crate::shadow_rays::{hold_answers, hold_origins, is_on_a_square, picture_by};
use run::{Chapter, expected, same_answers, same_colors, shaders_with};

const NAME: &str = "05_shadow_miss";
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
    hold_answers(NAME, to_sun, false);
    let found = hold_answers(NAME, to_sun, true);
    expected::hold(
        "05_shadow_miss/rays",
        json!({ "surfaces": found.surfaces, "lit": found.lit, "edges": found.edges,
                "turned_away": found.turned_away }),
    );
}

#[test]
fn shadows_are_those_of_the_exact_hit_points() {
    let found = hold_origins(NAME, to_sun);
    expected::hold(
        "05_shadow_miss/origins",
        json!({ "differ": found.differ, "surfaces": found.surfaces, "height": found.height,
                "height_on_slivers": found.height_on_slivers, "moved": found.moved }),
    );
}

/// The line of `shadow.glsl` that lets the first hit end a shadow ray, and the same without.
const FIRST_HIT: [&str; 2] = ["gl_RayFlagsTerminateOnFirstHitEXT | ", ""];

#[test]
fn ending_at_the_first_hit_changes_nothing() {
    let [with, without] = FIRST_HIT;
    let nearest = shaders_with("common/shadow.glsl", with, without);
    let nearest = picture_by(nearest.path(), NAME, &[]);
    same_colors("to the first and to the nearest hit", NAME, &chapter().picture(), &nearest);
}

#[test]
fn a_shadow_ray_changes_nothing_of_what_a_hit_is() {
    let asks = "dot(start.up, to_light) > 0.0 && is_lit(start.origin, to_light, end)";
    let silent = shaders_with("common/lighting.glsl", asks, "dot(start.up, to_light) > 0.0");
    let silent = picture_by(silent.path(), NAME, &["show=hit"]);
    same_answers(
        "with and without shadow rays",
        NAME,
        &silent,
        &chapter().sets(&["show=hit"]).picture(),
    );
}

/// The sun on the horizon is within the plane of the board, and not above it.
#[test]
fn a_sun_on_the_horizon_does_not_light_the_board() {
    let level = chapter().sets(&["sun elevation=0", "show=shadow origin"]).picture();
    let board = level.pixels.iter().filter(|pixel| is_on_a_square(pixel));
    assert!(board.clone().count() > 5000 && board.clone().all(|pixel| pixel[3] == 0.0));
}
