//! 04_jitter_camera: the directions of the rays, the weights of the filters, and the accuracy of the mean.

mod mean;
mod plots;

use common::app::Picture;
use common::scene::Scene;
use glam::DVec3;

use crate::sequences::points::hash;
use run::primary_hits::{answer, judge, rays, reference};
use run::{Chapter, bits, render, same_colors};

const NAME: &str = "04_jitter_camera";
const SIZE: &str = "240x150";
/// Enough pixels for many points, few enough for many frames.
const SMALL: &str = "64x40";
/// The purpose of a random number: the place within the pixel, as in `shaders/common/random.glsl`.
const DIMENSION_PIXEL: u32 = 1;

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// The root of the mean squared difference, over all pixels and colours.
pub fn error(a: &Picture, b: &Picture) -> f64 {
    let pairs = || a.pixels.iter().zip(&b.pixels);
    let squares = pairs().flat_map(|(a, b)| [0, 1, 2].map(|i| f64::from(a[i] - b[i]).powi(2)));
    (squares.sum::<f64>() / (3 * a.pixels.len()) as f64).sqrt()
}

/// The offset of each ray from its pixel's middle, in pixels, from the directions that the GPU wrote.
pub fn offsets(directions: &Picture) -> Vec<[f64; 2]> {
    let (width, height) = (f64::from(directions.width), f64::from(directions.height));
    let camera = Scene::chess().unwrap().camera.basis(width / height);
    let [right, up, forward] =
        [camera.right, camera.up, camera.forward].map(|axis| axis.as_dvec3());
    let offset = |(index, pixel): (usize, &[f32; 4])| {
        let direction = DVec3::new(pixel[0].into(), pixel[1].into(), pixel[2].into());
        let depth = direction.dot(forward) / forward.length_squared();
        let x = direction.dot(right) / right.length_squared() / depth;
        let y = -direction.dot(up) / up.length_squared() / depth;
        let (column, row) = (index as u32 % directions.width, index as u32 / directions.width);
        [
            (x + 1.0) / 2.0 * width - f64::from(column) - 0.5,
            (y + 1.0) / 2.0 * height - f64::from(row) - 0.5,
        ]
    };
    directions.pixels.iter().enumerate().map(offset).collect()
}

#[test]
fn two_runs_give_the_same_bits() {
    chapter(SIZE).frames(3).repeats();
}

#[test]
fn rays_through_the_centre_give_the_picture_of_02() {
    let basic = render("02_basic", SIZE, &[]).picture;
    // The mean of equal colours is that colour, bit for bit, for every filter.
    for filter in ["box", "tent", "Blackman-Harris"] {
        let picture = chapter(SIZE).frames(3).sets(&["jitter=off"]).set("filter", filter).picture();
        same_colors(&format!("04 and 02, {filter}"), NAME, &picture, &basic);
    }
}

#[test]
fn each_ray_goes_where_the_hash_says() {
    for frame in [0, 98] {
        let directions =
            chapter(SMALL).frames(frame + 1).sets(&["filter=box", "show=ray direction"]).picture();
        for (i, offset) in offsets(&directions).into_iter().enumerate() {
            let [x, y] = [i as u32 % directions.width, i as u32 / directions.width];
            let point = hash([x | y << 16, frame, 0, DIMENSION_PIXEL]);
            // A direction of 24 bits determines the place in a picture of 64 columns to 2^-16 of a column.
            let is_near = |axis: usize| {
                let place = f64::from(point[axis] >> 8) * 0.5f64.powi(24);
                (offset[axis] + 0.5 - place).abs() < 0.5f64.powi(16)
            };
            assert!(is_near(0) && is_near(1), "frame {frame}, pixel {x},{y}: {offset:?} {point:?}");
        }
    }
}

#[test]
fn neighbours_and_frames_have_no_points_in_common() {
    let frame = |index: u32| {
        offsets(
            &chapter(SIZE).frames(index + 1).sets(&["filter=box", "show=ray direction"]).picture(),
        )
    };
    let (points, next) = (frame(5), frame(6));
    let correlation = |others: &[[f64; 2]], axis: usize| {
        // The variance of a uniform number over a pixel is 1/12.
        let pairs = points.iter().zip(others);
        let count = pairs.len() as f64;
        pairs.map(|(a, b)| 12.0 * a[axis] * b[axis]).sum::<f64>() / count
    };
    let neighbours = [1, 2, 240, 241, 480].map(|apart| &points[apart..]);
    let all = neighbours.into_iter().chain([&next[..]]);
    let most = all.flat_map(|others| [0, 1].map(|axis| correlation(others, axis).abs()));
    let most = most.fold(0.0, f64::max);
    println!("they correlate by {most:.3} at most");
    assert!(most < 4.0 / (points.len() as f64).sqrt(), "{most}");
}

#[test]
fn four_times_the_samples_halve_the_error() {
    error_halves([4, 16, 64], 256);
}

#[test]
#[ignore = "nightly: 1,024 samples per pixel; quick: jitter_camera::four_times_the_samples_halve_the_error"]
fn so_they_do_by_many_samples() {
    error_halves([16, 64, 256], 1024);
}

fn error_halves(frames: [u32; 3], most: u32) {
    // Other points, the same mean.
    let reference = Chapter::new("37_sequences").size(SMALL).frames(most).picture();
    let errors = frames.map(|frames| error(&chapter(SMALL).frames(frames).picture(), &reference));
    println!("{errors:.5?}");
    for pair in errors.windows(2) {
        assert!((1.7..2.4).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
}

#[test]
fn a_jittered_ray_sees_what_the_reference_sees() {
    let scene = Scene::chess().unwrap();
    let hits = chapter(SIZE).frames(5).sets(&["show=hit"]).picture();
    let directions = chapter(SIZE).frames(5).sets(&["show=ray direction"]).picture();
    let answers = hits.pixels.iter().map(answer);
    let tally = judge(&reference(&scene), rays(&scene.camera, &directions).zip(answers));
    println!("{tally}");
    assert_eq!(tally.wrong, 0, "{:?}", tally.first_wrong);
    assert!(tally.ties + tally.grazes < hits.pixels.len() / 500, "{tally}");
    assert!(hits.pixels.iter().filter(|pixel| pixel[2] > 0.0).count() > hits.pixels.len() / 2);
}

/// The fraction of a filter below an offset in pixels, along one axis.
fn part_below(filter: &str, x: f64) -> f64 {
    let tau = std::f64::consts::TAU;
    match filter {
        "box" => (x + 0.5).clamp(0.0, 1.0),
        "tent" => {
            let x = x.clamp(-1.0, 1.0);
            if x < 0.0 { (1.0 + x).powi(2) / 2.0 } else { 1.0 - (1.0 - x).powi(2) / 2.0 }
        }
        _ => {
            // The window of Harris 1978, three pixels wide, summed in small steps.
            let window = |x: f64| {
                let turn = tau * x / 3.0;
                0.35875
                    + 0.48829 * turn.cos()
                    + 0.14128 * (2.0 * turn).cos()
                    + 0.01168 * (3.0 * turn).cos()
            };
            let area = |to: f64| {
                let step = (to + 1.5) / 256.0;
                (0..256).map(|i| window(-1.5 + (f64::from(i) + 0.5) * step) * step).sum::<f64>()
            };
            area(x.clamp(-1.5, 1.5)) / area(1.5)
        }
    }
}

#[test]
fn offsets_are_spread_as_the_filter_says() {
    for (filter, radius) in [("box", 0.5), ("tent", 1.0), ("Blackman-Harris", 1.5)] {
        let settings = [&format!("filter={filter}"), "show=ray direction"];
        let offsets = offsets(&chapter(SIZE).frames(1).sets(&settings).picture());
        let count = offsets.len() as f64;
        for axis in [0, 1] {
            let mut along: Vec<f64> = offsets.iter().map(|offset| offset[axis]).collect();
            along.sort_by(f64::total_cmp);
            // With 240 columns, a direction of 24 bits determines the place to 2^-14 of a column.
            let slack = 0.5f64.powi(14);
            assert!(along[0] >= -radius - slack && along[along.len() - 1] <= radius + slack);
            // Kolmogorov and Smirnov: one set in a thousand drawn from the filter deviates more.
            let bound = 1.95 / count.sqrt();
            let off = |(i, &x): (usize, &f64)| (part_below(filter, x) - i as f64 / count).abs();
            let most = along.iter().enumerate().map(off).fold(0.0, f64::max);
            assert!(most < bound, "{filter}, axis {axis}: {most} above {bound}");
            // The filter is symmetric, so the fractions beyond x and -x must be equal.
            let below = |x: f64| along.partition_point(|&y| y < x) as f64 / count;
            for part in 1..10 {
                let x = radius * f64::from(part) / 10.0;
                let lopsided = (below(-x) - (1.0 - below(x))).abs();
                assert!(lopsided < 2.0 * bound, "{filter}, axis {axis} at {x}: {lopsided}");
            }
        }
        let product: f64 = offsets.iter().map(|[x, y]| x * y).sum::<f64>() / count;
        let square: f64 = offsets.iter().map(|[x, y]| x * x + y * y).sum::<f64>() / (2.0 * count);
        assert!((product / square).abs() < 4.0 / count.sqrt(), "{filter}: x and y are related");
    }
}

#[test]
fn a_changed_control_starts_again() {
    // `--compare` changes the control repeatedly within one run, like a user in the window.
    let arguments = ["--compare", "filter=tent|box", "--frames", "4"];
    let after = render(NAME, SMALL, &arguments).picture;
    let filters =
        ["tent", "box"].map(|filter| chapter(SMALL).frames(1).set("filter", filter).picture());
    assert_ne!(bits(&filters[0]), bits(&filters[1]));
    assert!(filters.iter().any(|fresh| bits(fresh) == bits(&after)), "the old mean shines through");
}
