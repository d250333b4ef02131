//! 02's point in a triangle, compared with the exact hit.

use std::fs;

use glam::DVec3;
use reference::Ray;
use reference::triangle::intersect_exact;

use super::{found, root, shown, taken};
use crate::browser::Browser;
use crate::reading::{DESK, address, sized};

pub const PAGE: &str = "02_basic.html";

#[test]
#[ignore = "nightly only: in a browser"]
fn the_weights_are_those_of_the_exact_hit() {
    let mut browser = Browser::with_webgl();
    sized(&mut browser, DESK);
    shown(&mut browser, &address(PAGE), "triangle");
    let drawn = found(&mut browser, &[], "[found.corners, found.weights, found.color]");
    let svg = fs::read_to_string(root().join("docs/images/barycentrics.svg")).unwrap();
    let corners: [[f64; 2]; 3] = serde_json::from_value(drawn[0].clone()).unwrap();
    let points = corners.map(|[x, y]| format!("{x:.1},{y:.1}")).join(" ");
    assert!(svg.contains(&format!("<polygon points=\"{points}\" fill=\"none\"")), "{points}");
    let mut random = 1u32;
    let mut within = |low: u32, high: u32| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        low + (random >> 16) % (high + 1 - low)
    };
    let triangle = corners.map(|[x, y]| DVec3::new(x, y, 0.0));
    let (mut hits, mut points) = (0, vec![(250, 131)]);
    points.extend((0..100).map(|_| (within(40, 450), within(20, 240))));
    for (x, y) in points {
        let (across, up) = (x.to_string(), y.to_string());
        let told = found(&mut browser, &[("x", &across), ("y", &up)], "found");
        let ray = Ray {
            origin: DVec3::new(f64::from(x), 300.0 - f64::from(y), 1.0),
            direction: DVec3::new(0.0, 0.0, -1.0),
            tmin: 0.0,
            tmax: f64::INFINITY,
        };
        let exact = intersect_exact(&ray, &triangle);
        assert_eq!(told["hit"], exact.is_some(), "{told}");
        let weights: [f64; 3] = serde_json::from_value(told["weights"].clone()).unwrap();
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{told}");
        let said = browser.run("figure.said.textContent");
        assert_eq!(said.as_str().unwrap().contains("misses the triangle"), exact.is_none());
        let Some(exact) = exact else {
            assert!(weights.iter().any(|&weight| weight < 0.0), "{told}");
            continue;
        };
        hits += 1;
        for (weight, exact) in weights.iter().zip(&exact.weights) {
            assert!((weight - exact.to_f64().value()).abs() < 1e-12, "{told}");
        }
    }
    assert!(hits > 20 && hits < 90, "{hits}");

    // The drawing's mixed color, at a place that no point covers.
    found(&mut browser, &[("x", "450"), ("y", "240")], "found");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mixed.png");
    taken(&mut browser, "figure.stage.querySelector('svg')", &file);
    let picture = image::open(&file).unwrap().to_rgb8();
    let scale = f64::from(picture.width()) / 416.0;
    let [x, y] = [250.0 - 34.0, 169.0 - 44.0].map(|at| (at * scale) as u32);
    let weights: [f64; 3] = serde_json::from_value(drawn[1].clone()).unwrap();
    for (channel, weight) in picture.get_pixel(x, y).0.into_iter().zip(weights) {
        assert!((f64::from(channel) - 255.0 * weight).abs() < 4.0, "{:?}", picture.get_pixel(x, y));
    }
}
