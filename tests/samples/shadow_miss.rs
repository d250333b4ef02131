//! 05_shadow_miss: the effect of an offset, and what each choice must not change.

mod times;

use serde_json::Map;

use crate::shadow_rays::{Shadows, picture_by};
use run::{Chapter, expected, same_answers, same_colors, shaders_with};

const NAME: &str = "05_shadow_miss";
const SIZE: &str = "240x150";

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

/// The line of `shadow.glsl` that ends a shadow ray at its first hit, and the same line without the flag.
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

/// Without an offset, surfaces shadow themselves; with a thousandth of a square, few pixels of this scene are
/// wrong.
#[test]
fn an_offset_cures_acne() {
    let shadows = |chapter: Chapter| chapter.size("480x300").set("show", "shadow").picture();
    let right = shadows(Chapter::new("41_ray_offset"));
    let mut found = Map::new();
    for offset in ["0", "1e-3", "0.1"] {
        let shown = shadows(Chapter::new(NAME).set("offset", offset));
        let Shadows { lit, dark, leaks } = Shadows::compare(&right, &shown);
        println!("offset {offset}: of {lit} lit pixels {dark} are dark; {leaks} leaks");
        found.insert("lit".to_owned(), lit.into());
        found.insert(format!("{offset}.dark"), dark.into());
        found.insert(format!("{offset}.leaks"), leaks.into());
        match offset {
            "0" => assert!(dark > lit / 10, "{dark} of {lit}"),
            "1e-3" => assert!(dark + leaks < 200, "{dark} dark, {leaks} leaks"),
            _ => assert!(leaks > 100, "{leaks} leaks"),
        }
    }
    expected::hold("05_shadow_miss/acne", found.into());
}
