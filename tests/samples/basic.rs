//! 02_basic: the picture, and primary visibility held to the reference pixel by pixel.

use common::app::Picture;
use common::reference::Ray;
use common::reference::verdict::Answer;
use common::scene::{Camera, Scene};

use crate::run::exact::{judge, reference};
use crate::run::{bits, golden, render};

const SIZE: &str = "240x150";

#[test]
fn the_picture_is_the_golden_one() {
    // Tolerance set by llvmpipe (Mesa 25.0.7), which made the golden and repeats it to the bit.
    golden("02_basic", &render("02_basic", SIZE, &[]).picture, 0.002);
}

#[test]
fn two_runs_give_the_same_bits() {
    let [first, second] = [0, 1].map(|_| render("02_basic", SIZE, &[]));
    assert_eq!(bits(&first.picture), bits(&second.picture));
}

#[test]
fn every_hit_agrees_with_the_reference() {
    let scene = Scene::chess().unwrap();
    let hits = render("02_basic", SIZE, &["--set", "show=hit"]).picture;
    let directions = render("02_basic", SIZE, &["--set", "show=ray direction"]).picture;
    let tally = judge(&reference(&scene), rays(&scene.camera, &hits, &directions));
    println!("{tally:?}");
    assert_eq!(tally.wrong, 0, "{:?}", tally.first_wrong);
    // Edges are thin: where more than one ray in five hundred needs an excuse, something is wrong.
    assert!(tally.ties + tally.grazes < hits.pixels.len() / 500, "{tally:?}");
    // The scene is no empty sky: most rays must have met something.
    assert!(hits.pixels.iter().filter(|pixel| pixel[2] > 0.0).count() > hits.pixels.len() / 2);
}

/// The rays whose bits the GPU wrote, with what it says that they hit.
pub fn rays<'a>(
    camera: &Camera,
    hits: &'a Picture,
    directions: &'a Picture,
) -> impl Iterator<Item = (Ray, Option<Answer>)> + 'a {
    let origin = camera.eye.as_vec3().to_array();
    hits.pixels.iter().zip(&directions.pixels).map(move |(hit, &[x, y, z, t])| {
        let answer = (hit[0] >= 0.0).then(|| {
            assert_eq!(hit[2], t, "two runs found different distances");
            Answer { instance: hit[0] as u32, primitive: hit[1] as u32, t }
        });
        (Ray::from_f32(origin, [x, y, z], 0.0, 1e30), answer)
    })
}
