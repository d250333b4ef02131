//! The start of 41's shadow ray, compared with its hits.

use glam::DVec3;
use reference::Ray;
use reference::triangle::intersect_exact;
use serde_json::json;

use super::{found, shown};
use crate::browser::Browser;
use crate::reading::address;

const PAGE: &str = "41_ray_offset.html";

#[test]
#[ignore = "nightly only: in a browser"]
fn the_starts_hit_their_surface_where_the_figure_says_acne() {
    // The figure's surface, from corner to corner.
    let [low, high] = [0.1f32, 0.7].map(f64::from);
    let corners = [[0.0, low, -8.0], [0.0, low, 8.0], [2.0, high, 0.0]].map(DVec3::from);
    let mut browser = Browser::start();
    shown(&mut browser, &address(PAGE), "start");
    let mut acne = 0;
    // In steps of the sliders: 20 steps are a factor of ten.
    for point in ["along the ray", "by corners"] {
        for distance in ["0", "20", "40", "80"] {
            for step in ["0", "20", "35", "60"] {
                let controls =
                    [("point", point), ("distance of the eye", distance), ("step", step)];
                let told = found(&mut browser, &controls, "found");
                let start: [f64; 2] = serde_json::from_value(told["start"].clone()).unwrap();
                let height = told["height"].as_f64().unwrap();
                assert_eq!(start, start.map(|x| f64::from(x as f32)), "a start is a float");
                let ray = Ray {
                    origin: DVec3::new(start[0], start[1], 0.0),
                    direction: DVec3::new(0.3, 1.0, 0.0),
                    tmin: 0.0,
                    tmax: f64::INFINITY,
                };
                let hits = intersect_exact(&ray, &corners).is_some();
                assert_eq!(hits, height < 0.0, "{controls:?}: {told}");
                let said = browser.run("figure.said.textContent");
                assert_eq!(said.as_str().unwrap().contains(": acne."), hits, "{said}");
                let all = ["acne", "leaks"].map(|what| told[what].as_f64().unwrap() > 0.0);
                let verdict = match all {
                    [true, true] => "too short for some, too long for others",
                    [true, false] => "too short",
                    [false, true] => "too long",
                    [false, false] => "right for all",
                };
                let said = said.as_str().unwrap();
                assert!(said.contains(&format!("the step is {verdict}. ")), "{told}: {said}");
                acne += usize::from(hits);
                // From the bound on, no start computed by corners is below the surface, however far the eye
                // is.
                let safe = 1e-8 * 10f64.powf(step.parse::<f64>().unwrap() / 20.0)
                    >= told["bound"].as_f64().unwrap();
                let all = told["acne"].as_f64().unwrap();
                assert!(all == 0.0 || point == "along the ray" || !safe, "{controls:?}: {told}");
            }
        }
    }
    assert!(acne > 2, "{acne}");
    // Within a power of four, the start moves and the picture does not; the legend only lists visible
    // objects.
    let place = "[document.querySelector('.figure .stage svg text').textContent,
        Number(document.querySelector('.figure .stage .begin:not(.key)').getAttribute('cy')),
        document.querySelector('.figure .key.sheet').hidden]";
    let mut seen = |step: &str| -> (String, f64, bool) {
        let controls = [("point", "by corners"), ("distance of the eye", "20"), ("step", step)];
        serde_json::from_value(found(&mut browser, &controls, place)).unwrap()
    };
    let [low, high, next, sheet] = ["53", "60", "67", "80"].map(&mut seen);
    assert_eq!([&*low.0, &*high.0, &*next.0], ["10⁻⁵", "10⁻⁵", "10⁻⁴"]);
    assert!(low.1 - high.1 > 20.0, "{low:?} {high:?}");
    assert!(low.2 && !sheet.2, "{low:?} {sheet:?}");
    // The page's statement: a short step has acne, a long one leaks.
    let part = "[found.acne, found.leaks]";
    let far = [("point", "along the ray"), ("distance of the eye", "80"), ("step", "20")];
    assert!(found(&mut browser, &far, part)[0].as_f64().unwrap() > 0.3);
    assert_eq!(
        found(&mut browser, &[("distance of the eye", "20"), ("step", "100")], part),
        json!([0, 1])
    );
}
