//! A plot and values for the page, on request: `cargo test --test samples rough_metal::plots -- --ignored
//! --nocapture`.

use serde_json::Map;

use super::albedo::AlbedoTable;
use super::{evaluate, set};
use run::expected;
use run::plot::{Axis, Chart, Series, draw};

const SAMPLES: u32 = 4096;

/// For each roughness from 0 to 1 by tenths, the mean weight of a bounce of white metal, its variance under the
/// day's sky, and the part of the samples that are lost; views are spread by their cosine.
fn bounces(sets: &[&str]) -> Vec<[f64; 3]> {
    let body = format!(
        "for (uint i = 0; i < {SAMPLES}; i++) {{
            vec4 u = random(at, i, 0, 9);
            float cosine = sqrt((float(at.x) + u.w) / 64.0);
            vec3 view = vec3(sqrt(max(1.0 - cosine * cosine, 0.0)), 0.0, cosine);
            Microfacets surface = microfacets(push.rough, vec3(1.0), 0.1 * float(at.y), 1.0, view);
            Bounce next = bounce(surface, u.x, u.yz);
            float light = next.weight.r * sky(vec3(next.direction.x, next.direction.z, next.direction.y)).g;
            answer += vec4(next.weight.r, light, light * light, next.weight.r > 0.0 ? 0.0 : 1.0) / {SAMPLES}.0;
        }}"
    );
    let sets = set(sets);
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    let shown = evaluate("", &body, "64x11", &sets);
    let row = |row: usize| {
        let pixels = &shown.pixels[row * 64..(row + 1) * 64];
        let mean = |f: fn(&[f32; 4]) -> f64| pixels.iter().map(f).sum::<f64>() / 64.0;
        let variance = mean(|p| f64::from(p[2]) - f64::from(p[1]).powi(2));
        [mean(|p| p[0].into()), variance, mean(|p| p[3].into())]
    };
    (0..11).map(row).collect()
}

#[test]
#[ignore = "by hand: draws docs/images/45_energy.svg"]
fn energy() {
    let table = AlbedoTable::new();
    let last = (table.means.len() - 1) as f64;
    let theory: Vec<[f64; 2]> = table
        .means
        .iter()
        .enumerate()
        .map(|(row, mean)| (row as f64 / last, mean.lost))
        .map(|(roughness, lost)| [roughness, 1.0 - f64::from(lost) * roughness.powi(2)])
        .collect();
    let dots = |compensation: &str| {
        let rows = bounces(&[&format!("compensation={compensation}")]);
        rows.iter().enumerate().map(|(row, [mean, ..])| [0.1 * row as f64, *mean]).collect()
    };
    let series = vec![
        Series { name: "one reflection, f64", points: theory, line: true, ..Series::default() },
        Series {
            name: "one reflection, rendered",
            points: dots("off"),
            dots: true,
            ..Series::default()
        },
        Series {
            name: "with compensation, rendered",
            points: dots("on"),
            dots: true,
            ..Series::default()
        },
    ];
    let tenths: Vec<f64> = (0..=5).map(|i| f64::from(i) / 5.0).collect();
    let x = Axis { label: "roughness", ticks: &tenths, logarithmic: false };
    let y = Axis { label: "light that leaves", ticks: &tenths, logarithmic: false };
    draw(
        "45_energy.svg",
        (560, 360),
        &[Chart { title: "white metal under a white sky", x, y, series }],
    );
}

#[test]
#[ignore = "by hand: prints the variance of three samplers, and what they lose"]
fn variance() {
    let mut held = Map::new();
    for sampling in ["distribution", "visible", "bounded"] {
        let rows = bounces(&[&format!("sampling={sampling}"), "compensation=off"]);
        for row in [1, 3, 5, 7, 10] {
            let [mean, variance, lost] = rows[row];
            println!(
                "{sampling}, roughness 0.{row}: {mean:.4}, variance {variance:.5}, lost {lost:.4}"
            );
            held.insert(format!("{sampling}.{row}.deviation"), variance.max(0.0).sqrt().into());
            held.insert(format!("{sampling}.{row}.lost"), lost.into());
        }
    }
    expected::hold("45_rough_metal/variance", held.into());
}
