//! Scenes whose light has a closed form.

use std::f64::consts::PI;
use std::fs;

use common::app::Picture;
use glam::DVec3;
use serde_json::Map;

use super::{ESTIMATORS, Estimate, NAME, U, brightness, chapter, estimator};
use crate::path_tracing::closed_forms::{SQUARES, form_factors};
use run::{expected, render};

/// The balls of the scenes: centre, radius, radiance.
pub fn balls(scene: &str) -> Vec<(DVec3, f64, f64)> {
    let wide = |x: f32| f64::from(x);
    match scene {
        "ball" => vec![(DVec3::new(wide(0.2), wide(0.1), 1.25), wide(0.4), 1.0)],
        "low ball" => vec![(DVec3::new(wide(0.9), wide(0.1), wide(0.1)), wide(0.3), 1.0)],
        "many balls" => {
            let at = |k: u32| (f64::from(k) - 3.5) * 0.14;
            let radiance = |i: u32| 4000.0 * (-f64::from(i * 37 % 64) / 4.0).exp2();
            let ball = |i: u32| (DVec3::new(at(i % 8), at(i / 8), 1.0), 0.01, radiance(i));
            (0..64).map(ball).collect()
        }
        other => panic!("no balls in {other}"),
    }
}

/// The cosine-weighted fraction of the half-space above a point of the plane z = 0 that a ball fills. The
/// ball may be partly below the plane. By Stokes' theorem this fraction is half the integral of r × dr along
/// the rim of the visible part of the ball: an arc of its outline, and an arc of the horizon.
pub fn part_of_ball(point: DVec3, center: DVec3, radius: f64) -> f64 {
    let to = center - point;
    let sine = radius / to.length();
    let cosine = (1.0 - sine * sine).sqrt();
    // The cosine and sine of the angle between the centre and the normal.
    let (up, aside) = (to.z / to.length(), to.truncate().length() / to.length());
    if cosine * up >= sine * aside {
        return up * sine * sine;
    }
    if -cosine * up >= sine * aside {
        return 0.0;
    }
    let end = (-cosine * up / (sine * aside)).clamp(-1.0, 1.0).acos();
    let outline = end * sine * sine * up - sine * cosine * aside * end.sin();
    let horizon = (sine * end.sin()).atan2(cosine * aside - sine * end.cos() * up);
    (outline + horizon) / PI
}

/// The value of each pixel of a picture of `side` pixels that shows the whole white square.
pub fn lit_by_balls(scene: &str, side: u32) -> Vec<f64> {
    let balls = balls(scene);
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(side) - 0.5;
    let pixels = (0..side * side).map(|i| DVec3::new(place(i % side), -place(i / side), 0.0));
    let lit = |point| {
        balls.iter().map(|&(at, radius, light)| light * part_of_ball(point, at, radius)).sum()
    };
    pixels.map(lit).collect()
}

#[test]
fn the_closed_form_is_the_integral() {
    // The integral of the cosine over the ball's cone, by midpoints.
    let by_points = |to: DVec3, radius: f64| {
        let whole = 1.0 - (1.0 - radius * radius / to.length_squared()).sqrt();
        let axis = to.normalize();
        let right = axis.any_orthonormal_vector();
        let up = axis.cross(right);
        let (rows, columns) = (1000, 1000);
        let mut sum = 0.0;
        for row in 0..rows {
            let w = whole * (f64::from(row) + 0.5) / f64::from(rows);
            let sine = (w * (2.0 - w)).sqrt();
            for column in 0..columns {
                let turn = 2.0 * PI * (f64::from(column) + 0.5) / f64::from(columns);
                let side = turn.cos() * right + turn.sin() * up;
                sum += ((1.0 - w) * axis + sine * side).z.max(0.0);
            }
        }
        2.0 * whole * sum / f64::from(rows * columns)
    };
    for (x, z, radius) in [(0.3, 1.0, 0.4), (1.0, 0.2, 0.5), (1.0, 0.0, 0.7), (1.0, -0.2, 0.5)] {
        let to = DVec3::new(x, 0.1, z);
        let (closed, points) = (part_of_ball(DVec3::ZERO, to, radius), by_points(to, radius));
        assert!((closed - points).abs() < 1e-5, "{to} {radius}: {closed} {points}");
        assert!(closed > 0.001, "{to} {radius}: {closed}");
    }
    assert_eq!(part_of_ball(DVec3::ZERO, DVec3::new(1.0, 0.0, -0.6), 0.5), 0.0);
}

/// Checks that the difference of each pixel from its expected value is random with mean 0.
#[track_caller]
fn is_lit_as(expected: &[f64], sets: &[&str], frames: u32) -> Estimate {
    let side = (expected.len() as f64).sqrt() as u32;
    let shown = brightness(&chapter(&format!("{side}x{side}")).frames(frames).sets(sets).picture());
    let off: Vec<f64> = shown.iter().zip(expected).map(|(shown, e)| shown - e).collect();
    let estimate = Estimate::of(&off);
    estimate.is(0.0, &format!("{sets:?}"));
    let mean = expected.iter().sum::<f64>() / expected.len() as f64;
    assert!(estimate.confidence < 0.1 * mean, "{sets:?}: {} of {mean}", estimate.confidence);
    Estimate { mean: mean + estimate.mean, ..estimate }
}

#[test]
fn a_ball_lights_a_plane_as_its_closed_form_says() {
    // Partly below the horizon: the harder case of the two.
    let expected = lit_by_balls("low ball", 64);
    for name in ESTIMATORS {
        is_lit_as(&expected, &["scene=low ball", &estimator(name), "depth=1"], 16);
    }
}

#[test]
#[ignore = "nightly: 64 samples per pixel; quick: emitters::closed_forms::a_ball_lights_a_plane_as_its_closed_form_says"]
fn so_does_a_ball_above_it_by_more_samples() {
    let mut held = Map::new();
    for scene in ["ball", "low ball"] {
        let expected = lit_by_balls(scene, 64);
        let closed = expected.iter().sum::<f64>() / expected.len() as f64;
        let key = scene.replace(' ', "_");
        held.insert(format!("{key}.closed"), closed.into());
        for name in ESTIMATORS {
            let set = format!("scene={scene}");
            let estimate = is_lit_as(&expected, &[&set, &estimator(name), "depth=1"], 64);
            held.insert(format!("{key}.{name}"), estimate.mean.into());
            held.insert(format!("{key}.{name}.confidence"), estimate.confidence.into());
        }
    }
    expected::hold("29_emitters/balls", held.into());
}

#[test]
fn many_balls_light_it_as_all_of_them_do_whichever_are_asked() {
    let expected = lit_by_balls("many balls", 64);
    for (choice, frames) in [("all", 1), ("by power", 16)] {
        let set = format!("emitters={choice}");
        is_lit_as(&expected, &["scene=many balls", "estimator=light", "depth=1", &set], frames);
    }
}

#[test]
#[ignore = "nightly: 256 samples per pixel; quick: emitters::closed_forms::many_balls_light_it_as_all_of_them_do_whichever_are_asked"]
fn so_they_do_by_more_samples() {
    let expected = lit_by_balls("many balls", 64);
    let mut held = Map::new();
    for (choice, frames) in [("one", 256), ("all", 4), ("by power", 64)] {
        let set = format!("emitters={choice}");
        let sets = ["scene=many balls", "estimator=light", "depth=1", &set];
        let estimate = is_lit_as(&expected, &sets, frames);
        // The deviation of a single shadow ray; with Sobol's points it falls faster than with random ones.
        let single = brightness(&chapter("64x64").frames(1).sets(&sets).picture());
        let squares = single.iter().zip(&expected).map(|(s, e)| (s - e).powi(2)).sum::<f64>();
        let deviation = (squares / expected.len() as f64).sqrt();
        println!("{choice}: one sample is off by {deviation:.4}");
        let rays =
            brightness(&chapter("64x64").frames(1).sets(&sets).sets(&["show=rays"]).picture());
        let rays = 16.0 * Estimate::of(&rays).mean;
        held.insert(format!("{}.rays", choice.replace(' ', "-")), rays.into());
        held.insert(format!("{choice}.mean"), estimate.mean.into());
        held.insert(format!("{choice}.confidence"), estimate.confidence.into());
        held.insert(format!("{}.single", choice.replace(' ', "-")), deviation.into());
    }
    let closed = expected.iter().sum::<f64>() / expected.len() as f64;
    held.insert("closed".to_owned(), closed.into());
    expected::hold("29_emitters/many", held.into());
}

#[test]
fn squares_light_each_other_as_their_form_factors_say() {
    squares_light_each_other(8);
}

#[test]
#[ignore = "nightly: 64 samples per pixel; quick: emitters::closed_forms::squares_light_each_other_as_their_form_factors_say"]
fn so_they_do_by_many_shadow_rays() {
    squares_light_each_other(64);
}

fn squares_light_each_other(frames: u32) {
    for (scene, square) in &SQUARES {
        let expected = form_factors(64, square);
        let set = format!("scene={scene}");
        for points in ["triangles=area", "triangles=solid angle"] {
            is_lit_as(&expected, &[&set, "estimator=light", points, "depth=1"], frames);
        }
    }
}

#[test]
#[ignore = "nightly: the other estimators; quick: emitters::closed_forms::squares_light_each_other_as_their_form_factors_say"]
fn so_they_do_when_paths_meet_them() {
    for (scene, square) in &SQUARES {
        let expected = form_factors(64, square);
        let set = format!("scene={scene}");
        is_lit_as(&expected, &[&set, "estimator=BSDF", "depth=1"], 64);
        for points in ["triangles=area", "triangles=solid angle"] {
            is_lit_as(&expected, &[&set, "estimator=MIS", points, "depth=1"], 64);
        }
    }
}

/// The variance of one sample, for light of 1: a path hits the ball or not; and a shadow ray brings the
/// cosine of its direction, which is uniform in the cone, times the solid angle over pi.
pub fn variances_of_ball(point: DVec3, center: DVec3, radius: f64) -> [f64; 2] {
    let to = center - point;
    let part = part_of_ball(point, center, radius);
    let cosine = (1.0 - radius * radius / to.length_squared()).sqrt();
    let along = (1.0 + cosine + cosine * cosine) / 3.0;
    let up = (to.z / to.length()).powi(2);
    let squares = up * along + (1.0 - up) * 0.5 * (1.0 - along);
    [part * (1.0 - part), (2.0 * (1.0 - cosine)).powi(2) * squares - part * part]
}

/// The mean over the picture of one sample's variance for luminous balls: of a path, and of a shadow ray to a
/// ball chosen by its power. All balls of a scene have the same size.
pub fn mean_variances(scene: &str, side: u32) -> [f64; 2] {
    let balls = balls(scene);
    let all: f64 = balls.iter().map(|(_, _, radiance)| radiance).sum();
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(side) - 0.5;
    let mut sums = [0.0; 2];
    for i in 0..side * side {
        let point = DVec3::new(place(i % side), -place(i / side), 0.0);
        // The means of the squares of a sample's light, and its mean.
        let (mut squares, mut mean) = ([0.0; 2], 0.0);
        for &(center, radius, radiance) in &balls {
            let part = part_of_ball(point, center, radius);
            let [path, ray] = variances_of_ball(point, center, radius).map(|v| v + part * part);
            squares[0] += radiance * radiance * path;
            squares[1] += radiance * all * ray;
            mean += radiance * part;
        }
        (0..2).for_each(|k| sums[k] += (squares[k] - mean * mean) / f64::from(side * side));
    }
    sums
}

/// The same for a luminous square at a right angle to the lit one. A shadow ray goes to either of its two
/// triangles with equal probability, and is uniform in that triangle's solid angle.
pub fn variances_of_squares(side: u32) -> [f64; 2] {
    const FINE: u32 = 256;
    let factors = form_factors(side, &SQUARES[1].1);
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(side) - 0.5;
    let part = |i: u32| (f64::from(i) + 0.5) / f64::from(FINE);
    let mut sums = [0.0; 2];
    for (i, factor) in (0..side * side).zip(&factors) {
        let point = DVec3::new(place(i % side), -place(i / side), 0.0);
        // For each triangle: its solid angle, and the integral of the squared cosine over it.
        let mut integrals = [[0.0; 2]; 2];
        for k in 0..FINE * FINE {
            let (across, along) = (k % FINE, k / FINE);
            // The square is in the plane y = -1/2, from x = -1/2 to 1/2 and from z = 0 to 1.
            let to = DVec3::new(part(across) - 0.5, -0.5, part(along)) - point;
            let distance = to.length();
            let angle = to.y.abs() / distance.powi(3) / f64::from(FINE * FINE);
            let triangle = &mut integrals[usize::from(across < along)];
            triangle[0] += angle;
            triangle[1] += angle * (to.z / distance).powi(2);
        }
        let square: f64 = integrals.iter().map(|[angle, square]| 2.0 * angle * square).sum();
        sums[0] += factor * (1.0 - factor);
        sums[1] += square / (PI * PI) - factor * factor;
    }
    sums.map(|sum| sum / f64::from(side * side))
}

#[test]
fn the_noise_of_one_sample_is_that_of_theory() {
    let expected = lit_by_balls("ball", 64);
    for (name, theory) in ["BSDF", "light"].iter().zip(mean_variances("ball", 64)) {
        let mut squares = Vec::new();
        for seed in 0..4 {
            let sets = ["scene=ball", &estimator(name), "depth=1", &format!("seed={seed}")];
            let shown = brightness(&chapter("64x64").frames(1).sets(&sets).picture());
            squares.extend(shown.iter().zip(&expected).map(|(s, e)| (s - e).powi(2)));
        }
        Estimate::of(&squares).is(theory, &format!("variance of {name}"));
    }
}

/// Nothing is in between: a shadow ray that hit the emitter itself would leave a black pixel.
fn no_shadow_ray_meets_its_emitter(arithmetic: &str) {
    for (scene, points) in [
        ("scene=ball", "triangles=area"),
        ("scene=many balls", "triangles=area"),
        ("scene=parallel squares", "triangles=area"),
        ("scene=parallel squares", "triangles=solid angle"),
    ] {
        let sets = [scene, points, "estimator=light", "depth=1"];
        let shown = chapter("96x96").arithmetic(arithmetic).frames(1).sets(&sets).picture();
        let dark = shown.pixels.iter().filter(|pixel| pixel[..3] == [0.0; 3]).count();
        assert_eq!(dark, 0, "{arithmetic} {sets:?}");
    }
}

#[test]
fn no_shadow_ray_meets_what_it_asks_for() {
    no_shadow_ray_meets_its_emitter("driver");
}

#[test]
#[ignore = "nightly: compiles for long; quick: emitters::closed_forms::no_shadow_ray_meets_what_it_asks_for"]
fn nor_does_it_in_the_worst_arithmetic() {
    if run::has_worst_arithmetic() {
        no_shadow_ray_meets_its_emitter("worst");
        no_shadow_ray_meets_its_emitter("worst-by-place");
    }
}

/// A scene file: a white square, a luminous square above it, and one that covers the latter from below.
fn covered(gap: f64, shift: f64) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let square = |z: f64, half: f64| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| format!("v {} {} {}\n", shift + half * x, half * y, z))
            .concat()
    };
    let names = ["white", "shining", "black"];
    let squares = [square(0.0, 0.5), square(1.0, 0.5), square(1.0 - gap, 0.6)];
    let mut text = "mtllib a.mtl\n".to_owned();
    for (i, (name, square)) in names.iter().zip(squares).enumerate() {
        let first = 4 * i + 1;
        text += &format!("o {name}\n{square}usemtl {name}\n");
        text += &format!("f {first} {} {}\n", first + 1, first + 2);
        text += &format!("f {first} {} {}\n", first + 2, first + 3);
    }
    fs::write(folder.path().join("a.obj"), text).unwrap();
    let materials =
        "newmtl white\nKd 1 1 1\nnewmtl shining\nKd 0 0 0\nKe 1 1 1\nnewmtl black\nKd 0 0 0\n";
    fs::write(folder.path().join("a.mtl"), materials).unwrap();
    let file = folder.path().join("a.obj").to_str().unwrap().to_owned();
    (folder, file)
}

fn of_file(file: &str, shift: f64, frames: u32) -> Picture {
    let eye = format!("camera eye={shift},0,0.75");
    let target = format!("camera target={shift},0,0");
    let angle = format!("field of view={}", 2.0 * (0.5f64 / 0.75).atan().to_degrees());
    let sets = ["sky=black", "estimator=light", "depth=1", &eye, &target, &angle];
    chapter("64x64").scene(file).frames(frames).sets(&sets).picture()
}

/// If a shadow ray ended short of its emitter, a surface within that gap would not hide the emitter.
#[test]
fn no_light_leaks_through_what_lies_close_before_an_emitter() {
    for (shift, gap) in [(0.0, 4e-5), (16.0, 4e-4)] {
        let (_folder, file) = covered(gap, shift);
        let lit = of_file(&file, shift, 16);
        let leaks = lit.pixels.iter().filter(|pixel| pixel[..3] != [0.0; 3]).count();
        assert_eq!(leaks, 0, "pixels get light through a cover {gap} before the emitter");
    }
    // Without the cover, the file is luminous by its Ke.
    let (_folder, file) = covered(-0.5, 0.0);
    let lit = brightness(&of_file(&file, 0.0, 16));
    let expected = form_factors(64, &SQUARES[0].1);
    let off: Vec<f64> = lit.iter().zip(&expected).map(|(lit, e)| lit - e).collect();
    Estimate::of(&off).is(0.0, "a square from a file");
}

#[test]
fn a_furnace_is_white_whoever_finds_its_light() {
    the_furnace_is_white(8);
}

#[test]
#[ignore = "nightly: 16 samples per pixel; quick: emitters::closed_forms::a_furnace_is_white_whoever_finds_its_light"]
fn so_it_is_by_more_samples() {
    the_furnace_is_white(16);
}

fn the_furnace_is_white(frames: u32) {
    for name in ESTIMATORS {
        let sets = ["scene=furnace", "depth=256", &estimator(name)];
        let shown = chapter("96x60").frames(frames).sets(&sets).picture();
        let estimate = Estimate::of(&brightness(&shown));
        estimate.is(1.0, &format!("furnace, {name}"));
        assert!(estimate.confidence < 0.03, "{name}");
        if name == "BSDF" {
            // Every path brings 1, whatever way it takes: nothing is random or rounded. Seed 0 loses some:
            // see `caught`.
            let other = chapter("96x60").frames(frames).sets(&sets).sets(&["seed=1"]).picture();
            let grey = other.pixels.iter().filter(|pixel| **pixel != [1.0; 4]).count();
            assert_eq!(grey, 0, "pixels of the furnace that are not white");
        }
    }
}

#[test]
fn a_room_that_shines_is_as_bright_as_its_series() {
    the_room_is_as_bright_as_its_series(&["MIS"], &[0, 1, 256], 8);
}

#[test]
#[ignore = "nightly: every estimator; quick: emitters::closed_forms::a_room_that_shines_is_as_bright_as_its_series"]
fn so_it_is_by_every_estimator_to_every_depth() {
    the_room_is_as_bright_as_its_series(&ESTIMATORS, &[0, 1, 2, 256], 16);
}

fn the_room_is_as_bright_as_its_series(estimators: &[&str], depths: &[i32], frames: u32) {
    for name in estimators {
        for &depth in depths {
            let set = format!("depth={depth}");
            let sets = ["scene=closed room", &set, &estimator(name)];
            let shown = chapter("96x60").frames(frames).sets(&sets).picture();
            let estimate = Estimate::of(&brightness(&shown));
            // 1/2 + 1/4 + … + 1/2^(depth + 1): the three agree for each depth.
            let expected = 1.0 - 0.5f64.powi(depth + 1);
            if depth == 0 {
                assert_eq!(estimate.mean, 0.5, "{name}");
            } else {
                estimate.is(expected, &format!("room of depth {depth}, {name}"));
                assert!(estimate.confidence < 0.02 + 8.0 * U, "{name} {depth}");
            }
        }
    }
}

#[test]
fn a_file_in_which_nothing_shines_is_seen_by_day() {
    let file = "samples/assets/box_on_plane.obj";
    let shown = render(NAME, "32x20", &["--scene", file, "--frames", "1"]).picture;
    let bright = brightness(&shown).iter().filter(|value| **value > 0.05).count();
    assert!(bright > 600, "{bright} of 640 pixels are to be seen");
}
