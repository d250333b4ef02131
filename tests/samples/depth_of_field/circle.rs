//! The spread of a small light out of focus, compared with the formula; one in focus is not spread.

use std::fmt::Write;
use std::fs;

use common::app::Picture;
use serde_json::{Map, json};
use tempfile::TempDir;

use super::{NAME, chapter};
use run::{command, expected};

/// The radiance of the light: that of the sky behind it is a millionth.
const RADIANCE: f64 = 1e6;
/// The field of view, in degrees, and the picture's size.
const VIEW: f64 = 10.0;
const SIZE: [u32; 2] = [280, 56];
/// The distance of the plane in focus.
const FOCUS: f64 = 5.0;

/// The number of pixels in a length of 1 at distance 1.
fn pixels() -> f64 {
    f64::from(SIZE[1]) / 2.0 / (VIEW.to_radians() / 2.0).tan()
}

/// A luminous square, seen along -z from `eye`.
#[derive(Clone, Copy)]
pub struct Lamp {
    /// Position in the picture, in pixels to the right of the middle.
    pub at: f64,
    /// Distance along the view.
    pub depth: f64,
    /// Its side in the picture, in pixels.
    pub side: f64,
}

/// Lamps as a model, and the settings that show them.
pub struct Lamps {
    folder: TempDir,
    eye: [f64; 3],
}

impl Lamps {
    /// A model of these lamps in front of an eye.
    pub fn new(lamps: &[Lamp], eye: [f64; 3]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut text = "mtllib lamps.mtl\nusemtl lamp\n".to_owned();
        for Lamp { at, depth, side } in lamps {
            for (x, y) in [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)] {
                let scale = depth / pixels();
                let place =
                    [eye[0] + scale * (at + side * x), eye[1] + scale * side * y, eye[2] - depth];
                writeln!(text, "v {} {} {}", place[0], place[1], place[2]).expect("text");
            }
            text += "f -4 -3 -2 -1\n";
        }
        if eye != [0.0; 3] {
            // An invisible triangle. Without it, the model would be moved to the origin.
            text += "usemtl dark\nv 0 0 0\nv 0 1 0\nv 0 0 1\nf -3 -2 -1\n";
        }
        let material = format!(
            "newmtl lamp\nKd 0 0 0\nKe {RADIANCE} {RADIANCE} {RADIANCE}\nillum 0\nnewmtl dark\nKd 0 0 0\n"
        );
        for (name, text) in [("lamps.obj", text), ("lamps.mtl", material)] {
            fs::write(folder.path().join(name), text).expect("a file can be written");
        }
        Self { folder, eye }
    }

    /// The fraction of each pixel's samples that hit a lamp.
    pub fn shown(&self, frames: u32, sets: &[&str]) -> Vec<f64> {
        let model = self.folder.path().join("lamps.obj");
        let [x, y, z] = self.eye;
        let camera = [
            format!("camera eye={x},{y},{z}"),
            format!("camera target={x},{y},{}", z - 1.0),
            format!("field of view={VIEW}"),
            format!("focus distance={FOCUS}"),
        ];
        let chapter = chapter(&format!("{}x{}", SIZE[0], SIZE[1])).scene(model).frames(frames);
        let Picture { pixels, .. } = chapter.sets(&camera).sets(sets).picture();
        pixels.iter().map(|pixel| f64::from(pixel[0]) / RADIANCE).collect()
    }
}

/// The light in a part of a picture: the total, and the mean squared distance from a place.
struct Spread {
    light: f64,
    square: f64,
}

/// The light around a place on the middle line, up to `radius` pixels away.
fn spread(picture: &[f64], at: f64, radius: f64) -> Spread {
    let middle = [f64::from(SIZE[0]) / 2.0 + at, f64::from(SIZE[1]) / 2.0];
    let (mut light, mut square) = (0.0, 0.0);
    for (i, value) in picture.iter().enumerate() {
        let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
        let distance =
            (f64::from(x) + 0.5 - middle[0]).powi(2) + (f64::from(y) + 0.5 - middle[1]).powi(2);
        // The sky is a millionth of the lamp at most.
        if distance < radius * radius && *value > 2e-6 {
            light += value;
            square += value * distance;
        }
    }
    Spread { light, square: square / light }
}

/// The circle of confusion of a light, in pixels: the lens's diameter times the difference of the inverse
/// distances.
fn formula(diameter: f64, depth: f64) -> f64 {
    diameter * (1.0 / FOCUS - 1.0 / depth).abs() * pixels()
}

#[test]
fn a_light_is_spread_over_the_circle_of_confusion() {
    const DIAMETER: f64 = 0.3;
    const FRAMES: u32 = 256;
    const SIDE: f64 = 4.0;
    let depths = [2.5, 4.0, 5.0, 7.0, 15.0, 1000.0];
    let lamps: Vec<Lamp> = depths
        .iter()
        .enumerate()
        .map(|(i, &depth)| Lamp { at: 44.0 * i as f64 - 110.0, depth, side: SIDE })
        .collect();
    let scene = Lamps::new(&lamps, [0.0; 3]);
    let shown = scene.shown(FRAMES, &[&format!("lens diameter={DIAMETER}"), "blades=0"]);
    // The spread of a light in focus: its own size, and the pixels' filter, twice the variance of a square of
    // side 1.
    let sharp = 2.0 * (SIDE * SIDE / 12.0 + 1.0 / 6.0);
    let mut table = Map::new();
    for Lamp { at, depth, .. } in lamps {
        let expected = formula(DIAMETER, depth);
        let Spread { light, square } = spread(&shown, at, 22.0);
        // Blurred or not, as many rays hit the lamp as it has pixels.
        assert!((light / (SIDE * SIDE) - 1.0).abs() < 0.03, "{depth}: light of {light} pixels");
        // On a disk the mean square of the radius is half of the largest.
        let found = (8.0 * (square - sharp)).max(0.0).sqrt();
        println!("a light at {depth}: {expected:.2} pixels by the formula, {found:.2} found");
        table.insert(format!("{depth}.formula"), expected.into());
        table.insert(format!("{depth}.found"), found.into());
        // The random error of the mean of n squares, independent here, is 0.6 of it over the root of n.
        let chance = 4.0 * 0.6 * square / (SIDE * SIDE * f64::from(FRAMES)).sqrt();
        assert!((square - sharp - expected * expected / 8.0).abs() < chance, "{depth}: {square}");
        // Nothing is outside of the circle, except for the size of the lamp and of the filter.
        let beyond = expected / 2.0 + SIDE / 2f64.sqrt() + 2f64.sqrt();
        let all = spread(&shown, at, beyond + 1.0).light;
        assert_eq!(all, light, "{depth}: light beyond {beyond} pixels");
    }
    expected::hold("28_depth_of_field/circles", table.into());
}

#[test]
fn what_is_in_focus_stays_sharp_with_any_lens() {
    let lamps = Lamps::new(&[Lamp { at: 3.3, depth: FOCUS, side: 5.0 }], [0.0; 3]);
    let [pinhole, lens] =
        ["lens diameter=0", "lens diameter=4"].map(|diameter| lamps.shown(64, &[diameter]));
    // The same rays cross the plane in focus, except for those that pass an edge within rounding.
    let differ = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-3;
    let differ = pinhole.iter().zip(&lens).filter(|(a, b)| differ((a, b))).count();
    assert!(differ <= 2, "{differ} pixels differ");
    assert!(spread(&pinhole, 3.3, 20.0).light > 24.0, "no lamp");
    // A lens this large blurs everything out of focus by hundreds of pixels.
    let behind = Lamps::new(&[Lamp { at: 3.3, depth: 2.0 * FOCUS, side: 5.0 }], [0.0; 3]);
    let brightest = behind.shown(64, &["lens diameter=4"]).into_iter().fold(0.0, f64::max);
    assert!(brightest < 0.2, "{brightest}");
}

/// The chapter's default lens, if a square of the board is 55 mm wide and the film 24 mm high.
#[test]
fn a_photographer_has_the_same_circle() {
    let listed = command(NAME).arg("--list-controls").output().expect("the sample starts").stdout;
    let listed = String::from_utf8(listed).expect("text");
    let control = |name: &str| -> f64 {
        let line = listed.lines().find(|line| line.split('\t').next() == Some(name));
        let value = line.and_then(|line| line.split('\t').next_back());
        value.expect("it is listed").parse().expect("a number")
    };
    let [square, film] = [55.0, 24.0];
    let [diameter, focus] = ["lens diameter", "focus distance"].map(|name| square * control(name));
    let half_view = (control("field of view").to_radians() / 2.0).tan();
    // Rays from a point in focus meet at the film, whose place follows from the field of view.
    let behind = film / 2.0 / half_view;
    let focal_length = 1.0 / (1.0 / behind + 1.0 / focus);
    for depth in [0.3, 0.9, 1.0, 1.7, 40.0].map(|part| part * focus) {
        let before = diameter * (depth - focus).abs() / depth;
        let on_film = before * focal_length / (focus - focal_length);
        let by_inverses = diameter * (1.0 / focus - 1.0 / depth).abs() / (2.0 * half_view);
        assert!((on_film / film - by_inverses).abs() < 1e-14, "{depth}: {on_film} mm");
    }
    let number = focal_length / diameter;
    println!("{diameter} mm, f/{number}, {focal_length} mm");
    expected::hold_exact(
        "28_depth_of_field/photograph",
        json!({ "square": square, "diameter": diameter, "number": number, "film": film }),
    );
}

/// Neighbouring floats are 1/16 apart at the eye, and the lamp in focus is as wide: its corners are floats,
/// four pixels of the picture apart.
#[test]
fn far_from_the_origin_it_stays_sharp_on_one_rung() {
    let lamps = Lamps::new(&[Lamp { at: 2.0, depth: FOCUS, side: 4.0 }], [1e6, 0.0, 0.0]);
    let pinhole = lamps.shown(64, &["lens diameter=0"]);
    let light: f64 = pinhole.iter().sum();
    assert!((light - 16.0).abs() < 1.0, "a lamp of {light} pixels");
    // The fraction of the light outside of the lamp.
    let astray = |rung: &str| {
        let shown = lamps.shown(64, &["lens diameter=0.5", rung]);
        let differences = shown.iter().zip(&pinhole).map(|(a, b)| (a - b).abs());
        differences.sum::<f64>() / 2.0 / light
    };
    let [world, eye, start] = ["rung=world", "rung=eye", "rung=start"].map(astray);
    println!("astray: {world:.3} world, {eye:.3} eye, {start:.3} start");
    assert!(start < 0.02, "{start}");
    assert!(world > 0.1 && eye > 0.1, "{world} and {eye}");
}

/// The unevenness of a blurred light's disk after some samples.
#[test]
#[ignore = "nightly: 1,024 samples per pixel; quick: depth_of_field::aperture::places_are_uniform_over_the_aperture_and_fill_it"]
fn samples_against_the_noise_of_a_blurred_light() {
    const DIAMETER: f64 = 0.4;
    let lamp = Lamp { at: 0.0, depth: 15.0, side: 4.0 };
    let scene = Lamps::new(&[lamp], [0.0; 3]);
    let circle = formula(DIAMETER, lamp.depth);
    // The fraction of the lens through which a point of the disk sees the lamp.
    let part = lamp.side * lamp.side / (std::f64::consts::PI / 4.0 * circle * circle);
    let mut table = Map::new();
    println!("| samples | found | independent |");
    for frames in [16u32, 64, 256, 1024] {
        let shown = scene.shown(frames, &[&format!("lens diameter={DIAMETER}"), "blades=0"]);
        let inside = circle / 2.0 - lamp.side / 2f64.sqrt() - 2f64.sqrt();
        let middle = [f64::from(SIZE[0]) / 2.0, f64::from(SIZE[1]) / 2.0];
        let (mut sum, mut count) = (0.0, 0.0);
        for (i, value) in shown.iter().enumerate() {
            let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
            if (f64::from(x) + 0.5 - middle[0]).hypot(f64::from(y) + 0.5 - middle[1]) < inside {
                sum += (value / part - 1.0).powi(2);
                count += 1.0;
            }
        }
        let found = (sum / count).sqrt();
        let independent = ((1.0 - part) / (part * f64::from(frames))).sqrt();
        println!("| {frames} | {found:.3} | {independent:.3} |");
        assert!(found < 1.1 * independent, "{frames}: {found}, more than by chance: {independent}");
        table.insert(format!("{frames}.found"), found.into());
        table.insert(format!("{frames}.independent"), independent.into());
    }
    table.insert("part".to_owned(), part.into());
    expected::hold("28_depth_of_field/noise", table.into());
}
