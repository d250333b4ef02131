//! 04_jitter_camera: where the rays go, what the filters weigh, and that the mean is and stays right.

mod converging;
mod mean;
mod plots;
mod points;

use common::app::Picture;
use common::scene::Scene;
use glam::DVec3;
use serde_json::json;

use self::points::{Scrambling, Sequence, sample_point};
use run::primary_hits::{answer, judge, rays, reference};
use run::{bits, figures, golden, render, same_colors};

const NAME: &str = "04_jitter_camera";
const SIZE: &str = "240x150";
/// Enough pixels for many points, few enough for many frames.
const SMALL: &str = "64x40";

fn run(size: &str, frames: u32, settings: &[&str]) -> Picture {
    let frames = frames.to_string();
    let mut arguments = vec!["--frames", &frames];
    arguments.extend(settings.iter().flat_map(|setting| ["--set", setting]));
    render(NAME, size, &arguments).picture
}

/// The root of the mean squared difference, over all pixels and colours.
fn error(a: &Picture, b: &Picture) -> f64 {
    let pairs = || a.pixels.iter().zip(&b.pixels);
    let squares = pairs().flat_map(|(a, b)| [0, 1, 2].map(|i| f64::from(a[i] - b[i]).powi(2)));
    (squares.sum::<f64>() / (3 * a.pixels.len()) as f64).sqrt()
}

/// How far from its pixel's middle each ray passes, in pixels, from the directions that the GPU wrote.
fn offsets(directions: &Picture) -> Vec<[f64; 2]> {
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
fn the_picture_is_the_golden_one() {
    // Tolerance set by llvmpipe (Mesa 25.0.7), which made the golden and repeats it to the bit.
    golden(NAME, &run(SIZE, 16, &[]), 0.002);
}

#[test]
fn two_runs_give_the_same_bits() {
    let [first, second] = [0, 1].map(|_| run(SIZE, 3, &[]));
    assert_eq!(bits(&first), bits(&second));
}

#[test]
fn rays_through_the_centre_give_the_picture_of_02() {
    let basic = render("02_basic", SIZE, &[]).picture;
    // The mean of equal colours is that colour, to the bit, whatever the filter.
    for filter in ["box", "tent", "Blackman-Harris"] {
        let picture = run(SIZE, 3, &["sequence=centre", &format!("filter={filter}")]);
        same_colors(&format!("04 and 02, {filter}"), NAME, &picture, &basic);
    }
}

#[test]
fn the_points_are_those_of_the_literature() {
    let cases = [
        (Sequence::Random, "random", Scrambling::Owen, "Owen"),
        (Sequence::Halton, "Halton", Scrambling::Rotation, "rotation"),
        (Sequence::R2, "R2", Scrambling::Rotation, "rotation"),
        (Sequence::Sobol, "Sobol", Scrambling::None, "none"),
        (Sequence::Sobol, "Sobol", Scrambling::Owen, "Owen"),
    ];
    for (sequence, name, scrambling, scrambled) in cases {
        for index in [1, 98] {
            let settings = [
                &format!("sequence={name}"),
                &format!("scrambling={scrambled}"),
                "filter=box",
                "seed=7",
                "show=ray direction",
            ];
            let directions = run(SMALL, index + 1, &settings);
            for (i, offset) in offsets(&directions).into_iter().enumerate() {
                let pixel = [i as u32 % directions.width, i as u32 / directions.width];
                let point = sample_point(sequence, scrambling, pixel, 7, index);
                // A direction of 24 bits tells the place in a picture of 64 columns to 2^-16 of one.
                let most = [0, 1].map(|axis| (offset[axis] + 0.5 - point[axis]).abs());
                let near = most.iter().all(|&error| error < 0.5f64.powi(16));
                assert!(near, "{name} {scrambled} {index} at {pixel:?}: {offset:?} {point:?}");
            }
        }
    }
}

#[test]
fn each_box_of_a_scrambled_net_holds_one_point() {
    for pixel in 0..50 {
        let points = |count: u32| {
            (0..count).map(move |i| {
                sample_point(Sequence::Sobol, Scrambling::Owen, [pixel, 7 * pixel], 0, i)
            })
        };
        for bits in 0..=10 {
            for columns in 0..=bits {
                let (columns, rows) = (1 << columns, 1 << (bits - columns));
                let mut seen = vec![false; 1 << bits];
                for [x, y] in points(1 << bits) {
                    let (column, row) = (x * f64::from(columns), y * f64::from(rows));
                    let cell = row as usize * columns as usize + column as usize;
                    assert!(!seen[cell], "pixel {pixel}: two points in a box of {columns}×{rows}");
                    seen[cell] = true;
                }
            }
        }
    }
}

#[test]
fn in_floats_the_multiples_of_r2_run_out_of_digits() {
    let mut places: Vec<u32> =
        (100_000..101_024).map(|i| (i as f32 * 0.754_877_7).fract().to_bits()).collect();
    places.sort_unstable();
    places.dedup();
    println!("{} places of 1024 in floats", places.len());
    assert!(places.len() <= 128);
    let whole = |i: u32| i.wrapping_mul(3_242_174_889);
    let error = |i: u32| (f64::from(whole(i)) * 0.5f64.powi(32) - points::r2(i)[0]).abs();
    // The step is rounded to 2^-33, a hundred thousand times.
    assert!((100_000..101_024).all(|i| error(i) < 101_024.0 * 0.5f64.powi(33)));
}

#[test]
fn the_first_points_are_those_in_print() {
    let first =
        |sequence| (0..8).map(move |i| sample_point(sequence, Scrambling::None, [0, 0], 0, i));
    let third = 1.0 / 3.0;
    let ninth = third * third;
    let halton = [
        [0.0, 0.0],
        [0.5, third],
        [0.25, 2.0 * third],
        [0.75, ninth],
        [0.125, 4.0 * ninth],
        [0.625, 7.0 * ninth],
        [0.375, 2.0 * ninth],
        [0.875, 5.0 * ninth],
    ];
    let sobol = [
        [0.0, 0.0],
        [0.5, 0.5],
        [0.25, 0.75],
        [0.75, 0.25],
        [0.125, 0.625],
        [0.625, 0.125],
        [0.375, 0.375],
        [0.875, 0.875],
    ];
    for (sequence, expected) in [(Sequence::Halton, halton), (Sequence::Sobol, sobol)] {
        for (point, expected) in first(sequence).zip(expected) {
            let near = [0, 1].iter().all(|&axis| (point[axis] - expected[axis]).abs() < 1e-15);
            assert!(near, "{sequence:?}: {point:?}, not {expected:?}");
        }
    }
}

#[test]
fn a_jittered_ray_sees_what_the_reference_sees() {
    let scene = Scene::chess().unwrap();
    let hits = run(SIZE, 5, &["show=hit"]);
    let directions = run(SIZE, 5, &["show=ray direction"]);
    let answers = hits.pixels.iter().map(answer);
    let tally = judge(&reference(&scene), rays(&scene.camera, &directions).zip(answers));
    println!("{tally}");
    assert_eq!(tally.wrong, 0, "{:?}", tally.first_wrong);
    assert!(tally.ties + tally.grazes < hits.pixels.len() / 500, "{tally}");
    assert!(hits.pixels.iter().filter(|pixel| pixel[2] > 0.0).count() > hits.pixels.len() / 2);
}

/// How much of a filter lies below an offset in pixels, one axis.
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
        let offsets = offsets(&run(SIZE, 1, &settings));
        let count = offsets.len() as f64;
        for axis in [0, 1] {
            let mut along: Vec<f64> = offsets.iter().map(|offset| offset[axis]).collect();
            along.sort_by(f64::total_cmp);
            // 240 columns leave a direction of 24 bits 2^-14 of one.
            let slack = 0.5f64.powi(14);
            assert!(along[0] >= -radius - slack && along[along.len() - 1] <= radius + slack);
            // Kolmogorov and Smirnov: of sets drawn from the filter one in a thousand is farther off.
            let bound = 1.95 / count.sqrt();
            let off = |(i, &x): (usize, &f64)| (part_below(filter, x) - i as f64 / count).abs();
            let most = along.iter().enumerate().map(off).fold(0.0, f64::max);
            assert!(most < bound, "{filter}, axis {axis}: {most} above {bound}");
            // The filter mirrored is the filter: so must be the parts beyond x and -x.
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
fn neighbours_have_their_points_in_common_only_without_scrambling() {
    let points = |sequence: &str, scrambling: &str| {
        let [sequence, scrambling] =
            [format!("sequence={sequence}"), format!("scrambling={scrambling}")];
        offsets(&run(SIZE, 6, &[&sequence, &scrambling, "filter=box", "show=ray direction"]))
    };
    // The directions tell an offset to 2^-14 of a pixel.
    let shared = points("Sobol", "none");
    let most =
        |axis: usize| shared.iter().map(|p| (p[axis] - shared[0][axis]).abs()).fold(0.0, f64::max);
    assert!(most(0).max(most(1)) < 0.5f64.powi(13), "{} {}", most(0), most(1));

    for (sequence, scrambling) in [("random", "Owen"), ("R2", "rotation"), ("Sobol", "Owen")] {
        let points = points(sequence, scrambling);
        let correlation = |axis: usize, (column, row): (usize, usize)| {
            // The variance of a number that is uniform over a pixel is 1/12.
            let pairs = points.iter().zip(&points[row * 240 + column..]);
            let count = pairs.len() as f64;
            pairs.map(|(a, b)| 12.0 * a[axis] * b[axis]).sum::<f64>() / count
        };
        let near = [(1, 0), (0, 1), (1, 1), (2, 0), (0, 2)];
        let all = near.iter().flat_map(|&place| [0, 1].map(|axis| correlation(axis, place).abs()));
        let most = all.fold(0.0, f64::max);
        println!("{sequence}: neighbours correlate by {most:.3} at most");
        assert!(most < 4.0 / (points.len() as f64).sqrt(), "{sequence}: {most}");
    }
}

/// The page says of a key that is not reversed: its low bits, which are related, decide first.
#[test]
fn keys_that_are_not_reversed_relate_the_first_points_of_neighbours() {
    let naive = |key: u32| f64::from(points::owen(0, key.reverse_bits())) * 0.5f64.powi(32) - 0.5;
    let at = |x: u32, y: u32, axis: usize| naive(points::hash([x, y, 0, 1])[axis]);
    let correlation = |axis: usize, (dx, dy): (u32, u32)| {
        let places = (0..150).flat_map(|y| (0..240).map(move |x| (x, y)));
        let products = places.map(|(x, y)| 12.0 * at(x, y, axis) * at(x + dx, y + dy, axis));
        products.sum::<f64>() / (240.0 * 150.0)
    };
    let near = [(1, 0), (0, 1), (1, 1), (2, 0), (0, 2)];
    let all = near.iter().flat_map(|&place| [0, 1].map(|axis| correlation(axis, place).abs()));
    let most = all.fold(0.0, f64::max);
    println!("{most:.2}");
    figures::hold_exact("04_jitter_camera/neighbours", json!({ "correlation": most }));
}

#[test]
fn a_changed_control_starts_again() {
    // `--compare` changes the control again and again within one run, as a reader does in the window.
    let arguments = ["--compare", "filter=tent|box", "--frames", "4"];
    let after = render(NAME, SMALL, &arguments).picture;
    let filters = ["tent", "box"].map(|filter| run(SMALL, 1, &[&format!("filter={filter}")]));
    assert_ne!(bits(&filters[0]), bits(&filters[1]));
    assert!(filters.iter().any(|fresh| bits(fresh) == bits(&after)), "the old mean shines through");
}
