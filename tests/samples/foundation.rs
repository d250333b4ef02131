//! 01_foundation: the picture, every pixel compared with the same ray and triangle on the CPU, and the
//! program's output.

use glam::DVec3;
use serde_json::json;

use run::{bits, command, expected, refused, render};

const NAME: &str = "01_foundation";
const SIZE: &str = "240x150";

/// Error bound of a barycentric weight: 32-bit rounding of the ray and of the intersection, about 1e-6 here.
const WEIGHT_ERROR: f64 = 1e-5;

#[test]
fn two_runs_and_two_frames_give_the_same_bits() {
    let [first, second] = [0, 1].map(|_| render(NAME, SIZE, &[]));
    assert_eq!(bits(&first.picture), bits(&second.picture));
    let later = render(NAME, SIZE, &["--frames", "3"]);
    assert_eq!(bits(&first.picture), bits(&later.picture));
    assert_eq!(later.report["frames"], 3);
}

#[test]
fn every_pixel_agrees_with_the_ray_and_the_triangle_in_double_precision() {
    for size in [SIZE, "97x160"] {
        let picture = render(NAME, size, &[]).picture;
        let (mut hits, mut misses, mut worst) = (0, 0, 0.0_f64);
        for (index, pixel) in picture.pixels.iter().enumerate() {
            let (x, y) = (index as u32 % picture.width, index as u32 / picture.width);
            let direction = ray(x, y, picture.width, picture.height);
            let weights = weights(direction);
            let margin = weights.min_element();
            let color = DVec3::new(pixel[0].into(), pixel[1].into(), pixel[2].into());
            // No pixel's middle is so close to an edge that rounding could decide.
            assert!(margin.abs() > WEIGHT_ERROR, "{size} ({x}, {y}) is {margin} from an edge");
            *if margin > 0.0 { &mut hits } else { &mut misses } += 1;
            let wanted = if margin > 0.0 { shade(weights) } else { sky(direction) };
            let error = (color - wanted).abs().max_element();
            assert!(error < WEIGHT_ERROR, "{size} ({x}, {y}): {color} should be {wanted}");
            worst = worst.max(error);
            assert_eq!(pixel[3], 1.0);
        }
        assert!(hits > 1000 && misses > 1000, "{hits} hits, {misses} misses");
        println!("{size}: {hits} hits, {misses} misses, largest error {worst:e}");
        if size == SIZE {
            let found = json!({ "hits": hits, "misses": misses, "error": worst });
            expected::hold("01_foundation/pixels", found);
        }
    }
}

#[test]
fn the_program_tells_every_step() {
    let output = command(NAME).args(["--size", SIZE, "--frames", "2"]).output().unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let steps: Vec<&str> = text.lines().filter_map(|line| line.split_whitespace().next()).collect();
    let expected = "device limits vertices bottom instance top built image pipeline table frame frame \
                    written";
    assert_eq!(steps, expected.split_whitespace().collect::<Vec<_>>(), "{text}");
    let image = "240x150, 16 bytes per pixel: 576000 bytes";
    for part in [image, "3 groups", "frame       2: 36000 rays"] {
        assert!(text.contains(part), "no '{part}' in {text}");
    }
}

#[test]
fn the_report_holds_the_same_story() {
    let report = render(NAME, SIZE, &[]).report;
    let story = report["chapter"].as_array().unwrap();
    assert!(story.iter().any(|line| line.as_str().unwrap().starts_with("table")), "{report}");
    let told = |word: &str| {
        let line = story.iter().find_map(|line| line.as_str()?.strip_prefix("limits")).unwrap();
        let number = line.split_once(&format!("{word} ")).unwrap().1.split([' ', ',', ';']).next();
        number.unwrap().parse::<u32>().unwrap()
    };
    let limits =
        json!({ "handle": told("handle"), "record": told("record"), "region": told("region") });
    expected::hold("01_foundation/limits", limits);
    assert_eq!(report["groups"], 3);
    assert_eq!(report["stages"].as_array().unwrap().len(), 3);
    assert!(report["acceleration_structure_bytes"].as_u64().unwrap() > 0);
    assert!(report["bytes_allocated"].as_u64().unwrap() > 2 * 576_000);
}

#[test]
fn wrong_arguments_are_refused() {
    let cases: [(&[&str], &str); 5] = [
        (&["--set", "light=1"], "01_foundation has no controls"),
        (&["--scene", "a.obj"], "takes no --scene"),
        (&["--unordered"], "nothing to order"),
        (&["--device", "no such device"], "no device 'no such device'; there is"),
        (&["--size", "4000000000x1"], "is too large for"),
    ];
    for (arguments, part) in cases {
        let (code, line) = refused(NAME, arguments);
        assert_eq!(code, 2, "{arguments:?}: {line}");
        assert!(line.contains(part), "{arguments:?}: {line}");
    }
    let listed = command(NAME).arg("--list-controls").output().unwrap();
    assert!(listed.status.success() && listed.stdout.is_empty() && listed.stderr.is_empty());
}

const EYE: DVec3 = DVec3::new(0.0, 0.0, 3.0);

/// The unit direction of a pixel's ray, computed as in `camera.rgen`.
fn ray(x: u32, y: u32, width: u32, height: u32) -> DVec3 {
    const HALF_HEIGHT: f64 = 0.4;
    let (width, height) = (f64::from(width), f64::from(height));
    let across = 2.0 * (f64::from(x) + 0.5) / width - 1.0;
    let down = 2.0 * (f64::from(y) + 0.5) / height - 1.0;
    let right = across * width / height * HALF_HEIGHT;
    DVec3::new(right, -down * HALF_HEIGHT, -1.0).normalize()
}

/// The weights of the three corners at the ray's intersection with the triangle's plane (Cramer's rule).
fn weights(direction: DVec3) -> DVec3 {
    let place = |x: f64, y: f64| DVec3::new(0.8 * x + 0.12, y + 0.05, -0.6 * x);
    let [a, b, c] = [place(-1.1, -0.75), place(1.1, -0.75), place(0.0, 0.9)];
    let (e1, e2, s) = (b - a, c - a, EYE - a);
    let p = direction.cross(e2);
    let determinant = e1.dot(p);
    let u = s.dot(p) / determinant;
    let v = direction.dot(s.cross(e1)) / determinant;
    DVec3::new(1.0 - u - v, u, v)
}

fn shade(weights: DVec3) -> DVec3 {
    let (first, second) = (DVec3::new(0.06, 0.10, 0.80), DVec3::new(0.95, 0.03, 0.22));
    weights.x * first + weights.y * second + weights.z * DVec3::new(1.00, 0.60, 0.06)
}

fn sky(direction: DVec3) -> DVec3 {
    let height = (0.5 + 1.3 * direction.y).clamp(0.0, 1.0);
    DVec3::new(0.085, 0.120, 0.200).lerp(DVec3::new(0.005, 0.008, 0.022), height)
}
