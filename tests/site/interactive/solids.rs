//! 22's two solids, compared with the reference's intervals and boundaries.

use glam::DVec3;
use reference::Ray;
use reference::random::Random;
use reference::solid::Solid;
use reference::sphere::Sphere;

use super::{found, shown};
use crate::browser::Browser;
use crate::reading::address;

pub const PAGE: &str = "22_solids.html";

/// The figure's result for a ray: for the first hit, its t and part, whether the ray enters that part, and
/// whether it enters the solid.
type Found = ([f64; 2], [f64; 2], Vec<Vec<Option<f64>>>, bool, Option<(f64, usize, bool, bool)>);

const WHAT: &str = "[found.ray.eye, found.ray.d, found.solid, found.begins, \
                    found.first && [found.first.t, found.first.part, found.first.comes, found.first.enters]]";

/// The figure's ball, and its box of four half-spaces.
fn parts() -> [Solid; 2] {
    let ball = Sphere { center: DVec3::new(290.5, 112.5, 0.0), radius: 84.0 };
    let faces =
        [(DVec3::NEG_X, -130.5), (DVec3::X, 270.5), (DVec3::NEG_Y, -60.5), (DVec3::Y, 150.5)];
    let faces = faces.map(|(normal, offset)| Solid::HalfSpace { normal, offset });
    [Solid::Ball(ball), Solid::Intersection(faces.into())]
}

fn made(operation: &str) -> Solid {
    let [a, b] = parts();
    match operation {
        "union" => Solid::Union(vec![a, b]),
        "intersection" => Solid::Intersection(vec![a, b]),
        "difference" => Solid::difference(a, b),
        _ => Solid::Inverse(Box::new(a)),
    }
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_intervals_and_the_first_face_are_those_of_the_reference() {
    let mut browser = Browser::start();
    shown(&mut browser, &address(PAGE), "solids");
    let mut random = Random(22);
    let mut within = |low: usize, high: usize| low + random.below(high + 1 - low);
    // The number of first hits of each part from its outside and from its inside, and the number of misses.
    let (mut met, mut missed) = ([[0; 2]; 2], 0);
    for number in 0..240 {
        let operation = ["union", "intersection", "difference", "inverse"][number % 4];
        let places = [within(64, 400), within(10, 206), within(10, 206)].map(|x| x.to_string());
        found(&mut browser, &[("operation", operation)], "0");
        let controls = [("eye x", &*places[0]), ("eye y", &*places[1]), ("aim y", &*places[2])];
        let told = found(&mut browser, &controls, WHAT);
        let what = format!("{operation} {controls:?}: {told}");
        let (eye, d, intervals, begins, first): Found = serde_json::from_value(told).unwrap();
        let solid = made(operation);
        let ray = Ray {
            origin: DVec3::new(eye[0], eye[1], 0.0),
            direction: DVec3::new(d[0], d[1], 0.0),
            tmin: 0.0,
            tmax: (452.0 - eye[0]) / d[0],
        };
        let exact = solid.intervals(&ray);
        assert_eq!(intervals.len(), exact.len(), "{what}");
        for (ends, exact) in intervals.iter().zip(&exact) {
            for (end, exact) in ends.iter().zip(exact) {
                // JSON has no infinity.
                let close = end.map_or(exact.is_infinite(), |end| (end - exact).abs() < 1e-9);
                assert!(close, "{what}, not {exact}");
            }
        }
        assert_eq!(begins, solid.contains(ray.origin), "{what}");
        let boundary = solid.intersect(&ray);
        assert_eq!(first.is_some(), boundary.is_some(), "{what}, not {boundary:?}");
        let Some(((t, part, comes, enters), boundary)) = first.zip(boundary) else {
            missed += 1;
            continue;
        };
        assert!((t - boundary.t).abs() < 1e-9 && enters == boundary.enters, "{what}");
        // The ball comes first, then the four faces.
        let named = boundary.through.iter().map(|face| usize::from(*face > 0));
        assert!(named.clone().all(|named| named == part), "{what}, not {boundary:?}");
        let into = parts()[part].contains(ray.at(t + 1e-6));
        assert_eq!(comes, into, "{what}");
        // A part removed by a difference is seen from its inside.
        assert!(operation != "difference" || begins || comes == (part == 0), "{what}");
        let side = if comes { "outside" } else { "inside" };
        let said = browser.run("figure.said.textContent");
        let face = format!("a face of {0}, from {0}’s {side}", ["A", "B"][part]);
        assert!(said.as_str().unwrap().contains(&face), "{said}, not {face}");
        met[part][usize::from(comes)] += 1;
    }
    assert!(missed > 10 && met.iter().flatten().all(|count| *count > 5), "{missed} {met:?}");
}
