//! 47_normal_maps: what five rules lose, against f64; tangent frames; and the plate's black pixels.

mod energy;
mod frames;
mod twin;

use super::rough_metal::{self, Estimate, twin as rough_twin};
use common::app::Picture;
use run::{Chapter, copy_of_shaders, expected, set_arguments};
use serde_json::Map;
use tempfile::TempDir;

const NAME: &str = "47_normal_maps";

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// The results of this chapter's functions, one per pixel: `body` reads the pixel from `uvec2 at` and sets `vec4
/// answer`; `declarations` come before it.
fn evaluate(declarations: &str, body: &str, size: &str, arguments: &[&str]) -> Picture {
    evaluate_in(&copy_of_shaders(), declarations, body, size, arguments)
}

/// As [`evaluate`], with these shaders.
fn evaluate_in(
    folder: &TempDir,
    declarations: &str,
    body: &str,
    size: &str,
    arguments: &[&str],
) -> Picture {
    rough_metal::evaluate_in((NAME, folder), declarations, body, size, arguments)
}

/// Reflections until a path leaves a hit: all of them, by random numbers of their own.
const WALK: &str = "
struct Walk { vec3 sun, direction, weight; bool is_black; };
Walk walk(vec2 slope, vec3 view, float roughness, vec3 light, uvec2 at, uint i) {
    Walk all = Walk(vec3(0.0), vec3(0.0, 0.0, 1.0), vec3(1.0), false);
    bool is_between = false;
    for (uint k = 0; k < 256; k++) {
        Relief relief = relief_of(slope, is_between ? -all.direction : view, is_between);
        vec4 u = random(at, i * 256 + k, 0, 9), v = random(at, i * 256 + k, 1, 9);
        Reflection next = reflection(relief, vec3(1.0), roughness, 1.0, light, is_between, u.x, u.yz, u.w, v.xy);
        all = Walk(all.sun + all.weight * next.sun, next.direction, all.weight * next.weight, next.is_black);
        if (next.leaves) {
            break;
        }
        is_between = true;
    }
    return all;
}";

/// `sets` as the arguments of a run.
fn set(sets: &[&str]) -> Vec<String> {
    set_arguments(sets).into_iter().map(str::to_owned).collect()
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).frames(4).repeats();
}

/// Pixels of the plate under the sun and the day's sky, which is nowhere black.
#[test]
fn the_plate_has_black_pixels_under_two_rules() {
    let mut held = Map::new();
    for rule in energy::RULES {
        let picture = |show: &str, strength: f32, frames: u32| {
            let sets = [format!("rule={rule}"), format!("show={show}"), "scene=plate".to_owned()];
            chapter("160x100").frames(frames).sets(&sets).set("strength", strength).picture()
        };
        let shown = picture("picture", 1.0, 16);
        let black = shown.pixels.iter().filter(|pixel| pixel[..3] == [0.0; 3]).count();
        let below = |strength: f32| {
            let shown = picture("below", strength, 4);
            shown.pixels.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>()
        };
        // The ball has no map, but shading normals, which send a few rays below its triangles.
        let below = below(1.0) - below(0.0);
        println!("{rule}: {black} black pixels, {below} rays below");
        let is_naive = matches!(rule, "none" | "cut");
        assert_eq!(black > 0, is_naive, "{rule}: {black}");
        assert_eq!(below > 0.0, rule != "two facets", "{rule}: {below}");
        let name = rule.replace(' ', "-");
        held.insert(format!("{name}.black"), black.into());
        held.insert(format!("{name}.below"), (below * 4.0).into());
    }
    expected::hold("47_normal_maps/plate", held.into());
}

/// A ray that starts below the plate hits it from behind at once, where the mapped normal looks away.
#[test]
fn dropped_rays_would_have_found_no_light() {
    let picture = |rule: &str| {
        let sets = ["scene=plate".to_owned(), format!("rule={rule}"), "roulette=off".to_owned()];
        chapter("96x60").frames(4).sets(&sets).picture()
    };
    let [none, cut] = ["none", "cut"].map(picture);
    let Estimate { mean, confidence } = rough_metal::difference(&none, &cut);
    println!("none - cut: {mean:.2e} ± {confidence:.2e}");
    assert!(mean.abs() <= confidence + 1e-3, "{mean} ± {confidence}");
}
