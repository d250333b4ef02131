//! 42's sphere by each rung, compared with the exact one.

use reference::Ray;
use reference::sphere::Sphere;
use reference::ulp::ulp_error;

use super::{found, shown, stored};
use crate::browser::Browser;
use crate::reading::address;

pub const PAGE: &str = "42_distant_spheres.html";

#[test]
#[ignore = "nightly only: in a browser"]
fn the_spheres_agree_with_the_exact_ones() {
    const EVERY: usize = 59;
    let sphere = Sphere { center: [0.0; 3].into(), radius: 1.0 };
    let mut browser = Browser::with_webgl();
    shown(&mut browser, &address(PAGE), "sphere");
    let sample = format!(
        "({{ eye: found.eye, truths: found.truths,
            rays: Array.from({{ length: 57600 }}, (_, i) => i).filter(i => i % {EVERY} === 0)
                .map(i => [i, ...found.answers.slice(4 * i, 4 * i + 4)]) }})"
    );
    // The results of the rungs with Vulkan on llvmpipe, over all rays.
    let given = stored("42_distant_spheres/errors");
    let given = |name: String| given["values"][&*name].as_f64().unwrap();
    for (steps, distance) in [(0, 1), (40, 100), (80, 10_000)] {
        let slider = steps.to_string();
        for rung in ["textbook", "stable", "two-float"] {
            let told = found(&mut browser, &[("distance", &slider), ("rung", rung)], &sample);
            let eye: [f32; 3] = serde_json::from_value(told["eye"].clone()).unwrap();
            let rays: Vec<[u32; 5]> = serde_json::from_value(told["rays"].clone()).unwrap();
            let (mut hits, mut wrong, mut worst, count) = (0, 0, 0.0f64, rays.len());
            for [index, t, x, y, z] in rays {
                let ray = Ray::from_f32(eye, [x, y, z].map(f32::from_bits), 0.0, f32::INFINITY);
                let exact = sphere.intersect_exact(&ray).map_or(0.0, |hit| hit.to_f64().t);
                // The values that the script compares the rungs with. The first line of the results is the
                // lowest one.
                let (line, column) = (239 - index as usize / 240, index as usize % 240);
                let truth = told["truths"][240 * line + column].as_f64().unwrap();
                assert!((truth - exact).abs() <= 1e-12 * exact, "{truth} {exact}");
                let t = f32::from_bits(t);
                match (t == 0.0, exact == 0.0) {
                    (false, false) => {
                        hits += 1;
                        worst = worst.max(ulp_error(t, exact));
                    }
                    (one, other) => wrong += usize::from(one != other),
                }
            }
            assert!(hits > 400, "{hits}");
            // A two-float has 48 bits; its last rounding costs half a place. Another device may round the
            // direction and a quotient differently: a factor of 2 for the worst of the rays.
            let (most_wrong, most) = match rung {
                "two-float" => (0.0, 0.5001),
                _ => {
                    let of = |figure: &str| given(format!("{distance}.{rung}.{figure}"));
                    (2.0 * (of("false_hits") + of("false_misses")), 2.0 * of("max"))
                }
            };
            let wrong = wrong as f64 / count as f64;
            assert!(wrong <= most_wrong + 1e-3, "{rung}, {distance}: {wrong}");
            assert!(worst <= most, "{rung}, {distance}: {worst} ULP");
        }
    }
    // The page's own figures, to within a tenth: 746 ULP, and 25 % of false hits.
    let what = "[found.median, found.falseHits / 240 ** 2]";
    let told = found(&mut browser, &[("distance", "80"), ("rung", "textbook")], what);
    for (at, figure) in ["p50", "false_hits"].into_iter().enumerate() {
        let ratio = told[at].as_f64().unwrap() / given(format!("10000.textbook.{figure}"));
        assert!((0.9..1.1).contains(&ratio), "{figure}: {told}");
    }
}
