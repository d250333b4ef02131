//! 36_two_normals: the effects of a shadow ray's terminator offset, and what it leaves unchanged.

use common::scene::Scene;
use serde_json::json;

use crate::shadow_rays::seen;
use run::primary_hits::reference;
use run::{expected, render, same_answers, same_colors};

const NAME: &str = "36_two_normals";
const SIZE: &str = "240x150";

const OFF: &str = "smooth terminator=off";

#[test]
fn without_the_cure_it_is_the_picture_of_41() {
    let off = render(NAME, SIZE, &["--set", OFF]).picture;
    same_colors("36 and 41", NAME, &off, &render("41_ray_offset", SIZE, &[]).picture);
    let origins = ["--set", "show=shadow origin"];
    let off = render(NAME, SIZE, &[&["--set", OFF], &origins[..]].concat()).picture;
    let flat = render("41_ray_offset", SIZE, &origins).picture;
    same_answers("36 without the cure and 41", NAME, &off, &flat);
}

#[test]
fn the_offset_changes_only_what_turns_away_from_the_light() {
    let exact = reference(&Scene::chess().unwrap());
    let [flat, smooth] = [&[OFF][..], &[]].map(|sets| seen(&exact, NAME, sets));
    let (mut lifted, mut lit, mut dark, mut highest) = (0, 0, 0, 0.0);
    for (flat, smooth) in flat.iter().zip(&smooth) {
        let height = f64::from((smooth.origin - flat.origin).length());
        highest = f64::max(highest, height);
        lifted += usize::from(height > 0.0);
        lit += usize::from(smooth.lit && !flat.lit);
        dark += usize::from(!smooth.lit && flat.lit);
        if smooth.lit != flat.lit {
            assert!(height > 0.0, "nothing was lifted at {:?}", flat.origin);
        }
    }
    let all = flat.len();
    println!("{lifted} of {all} lifted by up to {highest:.1e}; {lit} became lit, {dark} dark");
    expected::hold(
        "36_two_normals/lift",
        json!({ "surfaces": all, "lifted": lifted, "height": highest, "lit": lit, "dark": dark }),
    );
    assert!(lit > 10 && lit * 20 < all && dark * 100 < all, "{lit} lit, {dark} dark");
    // The pieces are turned from about 32 sides: r·(1 - cos(π/32)) is below a hundredth.
    assert!(highest < 0.01, "{highest}");
}
