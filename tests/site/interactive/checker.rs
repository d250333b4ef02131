//! 43's checker board, compared with rays against the exact plane and with the mean of squares in 64 bits.

use glam::{DVec2, DVec3};
use reference::Ray;
use reference::plane::Plane;
use serde_json::Value;

use super::{found, shown};
use crate::browser::Browser;
use crate::reading::address;

pub const PAGE: &str = "43_filtered_checker.html";

const SIDE: usize = 128;
const FINE: usize = 12;

/// The figure's camera, from its results.
struct Camera([DVec3; 4]);

impl Camera {
    fn of(view: &Value) -> Self {
        let vector = |name: &str| serde_json::from_value::<[f64; 3]>(view[name].clone()).unwrap();
        Self(["eye", "forward", "right", "up"].map(|name| vector(name).into()))
    }

    /// The point where the ray through a point of the picture hits the board, and its distance.
    fn board(&self, point: DVec2) -> Option<(DVec2, f64, DVec3)> {
        let Self([origin, forward, right, up]) = *self;
        let screen = 2.0 * point / SIDE as f64 - 1.0;
        let direction = (forward + screen.x * right - screen.y * up).normalize();
        let ray = Ray { origin, direction, tmin: 0.0, tmax: f64::INFINITY };
        let t = Plane { normal: DVec3::Y, distance: 0.0 }.intersect(&ray)?.t;
        let at = origin + t * direction;
        Some((DVec2::new(at.x, at.z), t, direction))
    }
}

/// The colour of the board at a point: 1 on a light square.
fn light(at: DVec2) -> f64 {
    f64::from((at.x.floor() + at.y.floor()).rem_euclid(2.0) == 0.0)
}

/// The mean of stripes, +1 between 0 and 1, over an interval: its light part minus its dark part.
fn stripes(middle: f64, width: f64) -> f64 {
    let light_until = |x: f64| (x / 2.0).floor() + x.rem_euclid(2.0).min(1.0);
    let (from, to) = (middle - width / 2.0, middle + width / 2.0);
    2.0 * (light_until(to) - light_until(from)) / width - 1.0
}

#[test]
#[ignore = "nightly only: in a browser"]
fn filtered_squares_are_the_mean_of_a_box_and_nearer_to_the_truth_than_one_square() {
    let mut browser = Browser::with_webgl();
    shown(&mut browser, &address(PAGE), "checker");
    // Its initial text agrees with the page's text about the chapter's picture.
    let said = "document.querySelector('.figure .said').textContent";
    let errors = serde_json::from_value::<[f64; 2]>(found(
        &mut browser,
        &[],
        "[found.filtered, found.point]",
    ));
    assert_eq!(errors.unwrap().map(|error| (100.0 * error).round()), [3.0, 18.0]);
    let text = browser.run(said).as_str().unwrap().to_owned();
    assert!(
        text.contains("\"filtered\" is 0.028, of \"point\", one square a pixel, 0.18."),
        "{text}"
    );
    assert!(!text.contains("truth"), "{text}");
    let text = found(&mut browser, &[("checker", "144 rays")], said);
    assert!(text.as_str().unwrap().starts_with("The mean of 144 rays is the truth"), "{text}");
    // Rows are counted from the top.
    let sample = "(floats => [found.view, found.filtered, found.point, Array.from({ length: 443 }, (_, i) => 37 * i)
        .map(i => [i, ...floats.subarray(4 * ((127 - (i >> 7)) * 128 + i % 128)).subarray(0, 4)])
    ])(new Float32Array(found.answers.buffer))";
    let (mut boards, mut skies) = (0, 0);
    for (height, tilt) in [("20", "16"), ("10", "0"), ("30", "60"), ("40", "30")] {
        let told = found(&mut browser, &[("height", height), ("tilt", tilt)], sample);
        let camera = Camera::of(&told[0]);
        let pixels: Vec<[f64; 5]> = serde_json::from_value(told[3].clone()).unwrap();
        let (mut errors, mut near) = ([0.0, 0.0], 0.0);
        for [index, filtered, point, many, t] in pixels {
            let corner = DVec2::new((index as usize % SIDE) as f64, (index as usize / SIDE) as f64);
            let Some((at, exact, direction)) = camera.board(corner + 0.5) else {
                assert_eq!(t, 0.0);
                skies += 1;
                continue;
            };
            assert!((t / exact - 1.0).abs() < 1e-4, "{t} {exact}");
            // Farther away, 32 bits cannot determine the square.
            if exact > 300.0 {
                continue;
            }
            boards += 1;
            let edge = (at - at.round()).abs().min_element();
            assert!(edge < 2e-3 || (point - light(at)).abs() < 1e-6, "{point} at {at}");

            // The ellipse of the pixel's cone: as wide as the cone, and longer by the slant of the ray.
            let [_, forward, _, up] = camera.0;
            let width = 2.0 * up.length() / SIDE as f64 * direction.dot(forward) * exact;
            let along = DVec2::new(direction.x, direction.z).normalize();
            let long = width / direction.y.abs() * along;
            let wide = width * along.perp();
            let size = DVec2::new(long.x.hypot(wide.x), long.y.hypot(wide.y));
            let mean = 0.5 + 0.5 * stripes(at.x, size.x) * stripes(at.y, size.y);
            assert!((filtered - mean).abs() < 2e-3, "{filtered} {mean} at {exact}");

            let rays = (0..FINE * FINE).map(|i| {
                let inside = DVec2::new((i % FINE) as f64, (i / FINE) as f64) + 0.5;
                camera.board(corner + inside / FINE as f64)
            });
            let Some(rays) = rays.collect::<Option<Vec<_>>>() else { continue };
            let truth = rays.iter().map(|ray| light(ray.0)).sum::<f64>() / rays.len() as f64;
            assert!((many - truth).abs() < 0.03, "{many} {truth} at {exact}");
            errors[0] += (filtered - truth).abs();
            errors[1] += (point - truth).abs();
            near += 1.0;
        }
        let [filtered, point] = errors.map(|sum| sum / near);
        println!(
            "{height}, {tilt}: off by {filtered:.4}, by one square {point:.4}; told {} {}",
            told[1], told[2]
        );
        assert!(4.0 * filtered < point, "{filtered} {point}");
        // The figure's result for all pixels agrees approximately with this sample.
        let all = [&told[1], &told[2]].map(|of| of.as_f64().unwrap());
        assert!(4.0 * all[0] < all[1], "{all:?}");
        if tilt != "0" {
            assert!((all[1] - point).abs() < 0.03 && (all[0] - filtered).abs() < 0.01, "{all:?}");
        }
    }
    assert!(boards > 600 && skies > 100, "{boards} {skies}");
}
