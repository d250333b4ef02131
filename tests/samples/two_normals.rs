//! 36_two_normals: what the lift of a shadow ray's start changes, and what it does not.

use common::scene::Scene;
use serde_json::json;

use crate::shadow_rays::{picture_by, seen};
use run::primary_hits::reference;
use run::{copy_of_shaders, expected, flat_shaders, render, same_answers, same_colors};

const NAME: &str = "36_two_normals";
const SIZE: &str = "240x150";

#[test]
fn with_the_cure_it_is_the_picture_of_05() {
    let [cured, of_05] = [NAME, "05_shadow_miss"].map(|name| render(name, SIZE, &[]).picture);
    same_colors("36 and 05", NAME, &cured, &of_05);
}

#[test]
fn without_the_cure_rays_leave_the_triangles_themselves() {
    let sets = ["show=shadow origin"];
    let off = ["--set", "smooth terminator=off", "--set", sets[0]];
    let off = render(NAME, SIZE, &off).picture;
    let flat = picture_by(flat_shaders().path(), "05_shadow_miss", &sets);
    same_answers("36 without and 05 on flat triangles", NAME, &off, &flat);
}

#[test]
fn lifting_the_origin_changes_only_what_turns_away_from_the_light() {
    let exact = reference(&Scene::chess().unwrap());
    let [flat, smooth] =
        [flat_shaders(), copy_of_shaders()].map(|shaders| seen(&exact, shaders.path(), NAME));
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
    // The pieces are turned from 32 sides or so: r·(1 - cos(π/32)) is below a hundredth.
    assert!(highest < 0.01, "{highest}");
}
