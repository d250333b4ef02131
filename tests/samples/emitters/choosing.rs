//! The benefit of the two decisions about a shadow ray: which emitter it goes to, and how its light is
//! weighted against that of the path's own rays.

use serde_json::Map;

use super::plots::{rays, relative};
use super::{ESTIMATORS, brightness, chapter, estimator};
use crate::path_tracing::closed_forms::{SQUARES, form_factors};
use run::expected;

/// A luminous square touches one that is not. Near the edge the path's own rays find it, and far away shadow
/// rays do: MIS is better than either, even for the same number of rays.
#[test]
fn mis_wins_where_a_lamp_touches_what_it_lights() {
    let expected = form_factors(32, &SQUARES[1].1);
    let [bsdf, light, mis] = ESTIMATORS.map(|name| {
        let sets = ["scene=perpendicular squares", "depth=1", &estimator(name)];
        let of =
            |show, frames| chapter("32x32").frames(frames).sets(&sets).set("show", show).picture();
        let error = relative(&brightness(&of("picture", 64)), &expected);
        let rays = rays(&of("rays", 4));
        println!("{name}: off by {error:.4}, {rays:.1} rays a path");
        // The error falls with the root of the samples, and so of the rays.
        error * rays.sqrt()
    });
    assert!(mis < 0.75 * bsdf.min(light), "{mis}, {bsdf}, {light}");
}

/// On the chess set, the noise of shadow rays comes from the choice by power alone, which ignores distance.
/// With a uniform choice, or one shadow ray per emitter, it disappears.
#[test]
#[ignore = "nightly: gives figures of the page, by 1,024 samples; quick: emitters::choosing::mis_wins_where_a_lamp_touches_what_it_lights"]
fn a_choice_by_power_alone_is_noisy_near_small_lamps() {
    let of = |sets: &[&str], frames: u32| {
        let shared = ["depth=4", "clamp=0"];
        chapter("96x60").frames(frames).sets(&shared).sets(sets).picture()
    };
    let reference = brightness(&of(&["seed=9"], 1024));
    let mut held = Map::new();
    let mut errors = Vec::new();
    for choice in ["one", "by power", "all"] {
        let emitters = format!("emitters={choice}");
        let sets = ["estimator=light", &emitters];
        let error = relative(&brightness(&of(&sets, 64)), &reference);
        let rays = rays(&of(&[&sets[..], &["show=rays"]].concat(), 4));
        println!("{choice}: off by {error:.4}, {rays:.1} rays a path");
        let choice = choice.replace(' ', "-");
        held.insert(format!("{choice}.error"), error.into());
        held.insert(format!("{choice}.rays"), rays.into());
        errors.push(error);
    }
    let [one, power, all] = errors[..] else { unreachable!("three choices") };
    assert!(one < 0.5 * power && all < one, "{errors:?}");
    expected::hold("29_emitters/choosing", held.into());
}
