//! The mean over directions that the page computes by hand.

use serde_json::Map;

use run::{evaluate, expected};

/// Heights of four directions above level ground: one in the middle of each quarter.
const HEIGHTS: [f64; 4] = [0.125, 0.375, 0.625, 0.875];

/// Towards +x, +z, -x and -z at these heights: the directions in which the point under the sky looks.
const BODY: &str = "float height = (float(at.x & 3) + 0.5) / 4.0;
    if (at.y == 1) { height = sqrt(height); }
    float aside = sqrt(1.0 - height * height);
    vec2 ways[4] = { vec2(1, 0), vec2(0, 1), vec2(-1, 0), vec2(0, -1) };
    vec2 way = aside * ways[at.x & 3];
    answer = vec4(sky(vec3(way.x, height, way.y)).r, way, height);";

#[test]
fn four_directions_have_the_mean_that_the_page_computes_by_hand() {
    let shown = evaluate("", BODY, "4x2");
    let mut held = Map::new();
    let mut means = [0.0; 2];
    for (i, pixel) in shown.pixels.iter().enumerate() {
        let [red, _, _, height] = pixel.map(f64::from);
        let (row, column) = (i / 4, i % 4);
        let even = HEIGHTS[column];
        // Evenly spaced heights; and heights with a density proportional to their cosine.
        let cosine = if row == 0 { even } else { even.sqrt() };
        assert!((height - cosine).abs() < 1e-6, "{i}: {height} not {cosine}");
        // The sky of shade.glsl, above the horizon: white and blue mixed by the root of the height.
        let expected = 0.84 + (0.23 - 0.84) * cosine.sqrt();
        assert!((red - expected).abs() < 1e-6, "{i}: {red} not {expected}");
        let weight = if row == 0 { 2.0 * cosine } else { 1.0 };
        means[row] += weight * red / 4.0;
        let mut hold = |name: &str, value: f64| {
            held.insert(format!("{name}.{}", column + 1), value.into());
        };
        if row == 0 {
            hold("cosine", cosine);
            hold("red", red);
            hold("weight", weight);
            hold("product", weight * red);
        } else {
            hold("chosen", cosine);
        }
    }
    // The integral of 2·c·(0.84 - 0.61·√c) for c from 0 to 1.
    let all = 0.84 - 0.8 * 0.61;
    println!("{means:?}, all directions {all}");
    assert!(means.iter().all(|mean| (mean - all).abs() < 0.006), "{means:?} {all}");
    held.insert("weights".to_owned(), HEIGHTS.map(|c| 2.0 * c / 4.0).iter().sum::<f64>().into());
    held.insert("mean".to_owned(), means[0].into());
    held.insert("by_cosine".to_owned(), means[1].into());
    held.insert("all".to_owned(), all.into());
    expected::hold("11_path_tracing/by_hand", held.into());
}
