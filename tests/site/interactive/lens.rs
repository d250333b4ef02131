//! 28's thin lens, compared with the drawing, with exact rays and with the chapter's measurements.

use std::fs;

use glam::DVec3;
use reference::Ray;
use reference::plane::PointPlane;
use serde_json::Value;

use super::{found, root, shown, stored};
use crate::browser::Browser;
use crate::reading::address;

pub const PAGE: &str = "28_depth_of_field.html";

fn number(of: &Value) -> f64 {
    of.as_f64().unwrap()
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * (1.0 + a.abs())
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_circle_is_as_large_as_rays_from_the_rims_make_it() {
    let mut browser = Browser::start();
    shown(&mut browser, &address(PAGE), "lens");
    // Initially, the light behind the plane in focus is that of the drawing.
    let told = found(&mut browser, &[], "found");
    let svg = fs::read_to_string(root().join("docs/images/thin_lens.svg")).unwrap();
    let half = number(&told["c"]) / 2.0;
    let mark = format!("<path d=\"M196.0 {:.1} L196.0 {:.1}\"", 150.0 - half, 150.0 + half);
    assert!(svg.contains(&mark), "{mark}");

    for (aperture, focus, light) in [
        (120, 150, 90),
        (120, 150, 212),
        (1, 320, 60),
        (77, 110, 330),
        (50, 200, 200),
        (0, 130, 250),
    ] {
        let set = [aperture, focus, light].map(|at: i32| at.to_string());
        let controls = [("aperture", &*set[0]), ("focus", &set[1]), ("light", &set[2])];
        let told = found(&mut browser, &controls, "found");
        let [aperture, focus, light] = [aperture, focus, light].map(f64::from);
        let plane = PointPlane { point: DVec3::X * focus, normal: DVec3::X };
        let mut spread = (0.0f64, 0.0f64);
        for ray in told["rays"].as_array().unwrap() {
            let [place, crossing, on_film] = [0, 1, 2].map(|at| number(&ray[at]));
            let origin = DVec3::Y * place;
            let direction = DVec3::X * light - origin;
            let exact = Ray { origin, direction, tmin: 0.0, tmax: f64::INFINITY };
            let at = origin + plane.intersect_exact(&exact).unwrap().to_f64().t * direction;
            assert!(near(at.y, crossing), "{at} {ray}");
            spread = (spread.0.min(crossing), spread.1.max(crossing));
            // The film shows an image of the plane in focus, in proportion to their distances.
            let film = number(&told["film"]);
            assert!(near(on_film, -crossing * film / focus), "{ray}");
        }
        assert!(near(spread.1 - spread.0, number(&told["c"])), "{told}");
        let rim = number(&told["rays"][4][0]);
        assert!(near(2.0 * rim, aperture));
        for (image, object) in [(&told["film"], focus), (&told["meets"], light)] {
            assert!(
                near(1.0 / number(&told["focal"]), 1.0 / number(image) + 1.0 / object),
                "{told}"
            );
        }
        // The apparent size of c from the eye, in a picture of 600 pixels and 37 degrees.
        let half = (f64::atan(number(&told["c"]) / 2.0 / focus)).tan() / 18.5f64.to_radians().tan();
        assert!(near(300.0 * 2.0 * half, number(&told["pixels"])), "{told}");
        let said = browser.run("figure.said.textContent");
        let start = format!("c = {aperture} × |{light} − {focus}| / {light} = ");
        assert!(said.as_str().unwrap().starts_with(&start), "{said}");
    }

    // The chapter's lamps, scaled by 40: their formula, and the result of its pictures.
    let given = stored("28_depth_of_field/circles");
    let mut lamp = |light: &str| {
        let controls = [("aperture", "40"), ("focus", "200"), ("light", light)];
        number(&found(&mut browser, &controls, "found.pixels"))
    };
    let first = lamp("100");
    for (light, name) in [("160", "4"), ("200", "5"), ("280", "7")] {
        let part = lamp(light) / first;
        let of = |what: &str, name: &str| number(&given["values"][format!("{name}.{what}")]);
        assert!(
            (part - of("formula", name) / of("formula", "2.5")).abs() < 1e-4,
            "{light}: {part}"
        );
        assert!((part - of("found", name) / of("found", "2.5")).abs() < 0.005, "{light}: {part}");
    }
}
