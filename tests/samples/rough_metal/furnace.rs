//! White furnaces: all that arrives must leave.

use std::sync::LazyLock;

use serde_json::Map;

use super::albedo::{Albedo, AlbedoTable, DirectionRule, STEPS};
use super::{Estimate, brightness, chapter, evaluate, set, twin};
use run::expected;

/// Eleven roughnesses from 0 to 1, and 16 cosines, more of them small.
const ROWS: usize = 11;
const COLUMNS: usize = 16;
const SAMPLES: u32 = 2048;

fn roughness(row: usize) -> f64 {
    f64::from(row as f32 * 0.1)
}

fn cosine(column: usize) -> f64 {
    ((column as f64 + 0.5) / COLUMNS as f64).powi(2)
}

/// The weights of random ways to go on under a white sky: for each roughness and view their mean and four standard
/// errors.
fn furnace(metallic: u32, sets: &[&str]) -> Vec<Estimate> {
    let body = format!(
        "float cosine = (float(at.x) + 0.5) / {COLUMNS}.0;
        cosine *= cosine;
        vec3 view = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine);
        Microfacets surface = microfacets(push.rough, vec3(1.0), 0.1 * float(at.y), {metallic}.0, view);
        for (uint i = 0; i < {SAMPLES}; i++) {{
            vec4 u = random(at, i, 0, 9);
            float weight = bounce(surface, u.x, u.yz).weight.r;
            answer.xy += vec2(weight, weight * weight) / {SAMPLES}.0;
        }}"
    );
    let sets = set(sets);
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    let shown = evaluate("", &body, &format!("{COLUMNS}x{ROWS}"), &sets);
    let estimate = |pixel: &[f32; 4]| {
        let [mean, squares] = [pixel[0], pixel[1]].map(f64::from);
        let variance = (squares - mean * mean).max(0.0) / f64::from(SAMPLES);
        // Adding 2048 floats that are about 1 is off by less than 2048 roundings.
        Estimate { mean, confidence: 4.0 * variance.sqrt() + 2048.0 / 16_777_216.0 }
    };
    shown.pixels.iter().map(estimate).collect()
}

/// As `albedo` in `albedo.glsl`, in f64.
fn looked_up(table: &[Albedo], roughness: f64, cosine: f64) -> [f64; 2] {
    if roughness == 0.0 {
        return [0.0; 2];
    }
    let (alpha, last) = (roughness * roughness, (STEPS - 1) as f64);
    let at = [last * cosine * (1.0 + alpha) / (cosine + alpha), last * roughness];
    let cell = at.map(|place| (place as usize).min(STEPS - 2));
    let part = [at[0] - cell[0] as f64, at[1] - cell[1] as f64];
    let value = |column: usize, row: usize| {
        let Albedo { lost, more } = table[row * STEPS + column];
        [lost, more].map(f64::from)
    };
    let mix = |a: [f64; 2], b: [f64; 2], part: f64| [0, 1].map(|k| a[k] + (b[k] - a[k]) * part);
    let row = |row: usize| mix(value(cell[0], row), value(cell[0] + 1, row), part[0]);
    mix(row(cell[1]), row(cell[1] + 1), part[1])
}

/// The largest errors of the table: of what facets lose, and of the fifth power.
fn table_errors() -> [f64; 2] {
    let (table, rule) = (AlbedoTable::new(), DirectionRule::new([96, 48]));
    let mut most = [0f64; 2];
    for row in 1..=40 {
        let roughness = f64::from(row) / 40.0;
        for column in 0..40 {
            let cosine = ((f64::from(column) + 0.5) / 40.0).powi(2);
            let there = rule.differences(roughness * roughness, cosine);
            let read = looked_up(&table.albedos, roughness, cosine);
            most = [0, 1].map(|k| most[k].max((read[k] - there[k]).abs()));
        }
    }
    most
}

/// The error of a furnace by the means, linear between rows, because they are not the means of what is looked up:
/// for metal, and for an insulator's base.
fn mean_errors() -> [f64; 2] {
    let table = AlbedoTable::new();
    let last = (STEPS - 1) as f64;
    let mut most = [0f64; 2];
    for row in 4..=400 {
        let roughness = f64::from(row) / 400.0;
        let steps = 2000;
        let (mut all, mut largest) = ([0f64; 2], 0f64);
        for i in 0..steps {
            // Denser at low angles, where smooth surfaces lose their light.
            let place = (f64::from(i) + 0.5) / f64::from(steps);
            let (cosine, slope) = (place.powi(4), 4.0 * place.powi(3));
            let read = looked_up(&table.albedos, roughness, cosine);
            all = [0, 1].map(|k| all[k] + read[k] * 2.0 * cosine * slope / f64::from(steps));
            largest = largest.max(read[0]);
        }
        let cell = ((last * roughness) as usize).min(STEPS - 2);
        let part = last * roughness - cell as f64;
        let mean = |f: fn(&Albedo) -> f32| {
            let [a, b] = [cell, cell + 1].map(|row| f64::from(f(&table.means[row])));
            a + (b - a) * part
        };
        let [lost, more] = [mean(|a| a.lost) * roughness.powi(2), mean(|a| a.more)];
        let passed = |lost: f64, more: f64| 1.0 - 0.04 * (1.0 - lost) - 0.96 * (1.0 / 21.0 + more);
        most[0] = most[0].max(largest * (all[0] / lost - 1.0).abs());
        most[1] = most[1].max((passed(all[0], all[1]) / passed(lost, more) - 1.0).abs());
    }
    most
}

/// The bounds on a furnace of insulators and on one of metal: their distances from 1.
///
/// The light of facets is sampled; that of the table is off by the table's error: for metal that of the loss, for
/// an insulator those of both entries, weighted by 0.04 and 0.96. The means add their own.
static BOUNDS: LazyLock<[f64; 2]> = LazyLock::new(|| {
    let ([lost, more], [metal, base]) = (table_errors(), mean_errors());
    println!("the table is off by {lost:.4} and {more:.4}, means by {metal:.4} and {base:.4}");
    [0.04 * lost + 0.96 * more + base, lost + metal]
});

#[test]
fn the_table_is_the_integral() {
    // At normal incidence on the roughest surface the integral is 1 - ln 2.
    let rule = DirectionRule::new([40, 16]);
    let closed = 1.0 - 2f64.ln();
    assert!((rule.albedos(1.0, 1.0)[0] - closed).abs() < 1e-6);
    // Another way to integrate, by the midpoint rule, which is off by about 1/steps where light is cut off.
    for (alpha, cosine) in [(0.01, 0.3), (0.09, 0.1), (0.25, 0.7), (0.64, 0.4), (1.0, 0.05)] {
        let [ours, other] = [rule.albedos(alpha, cosine), twin::albedo(alpha, cosine, 600)];
        println!("alpha {alpha}, cosine {cosine}: {ours:?} {other:?}");
        assert!((0..2).all(|k| (ours[k] - other[k]).abs() < 1e-3), "{ours:?} {other:?}");
    }
    // A finer rule changes no entry by more than `albedo.rs` says.
    let fine = DirectionRule::new([160, 64]);
    let mut most = 0f64;
    for row in 0..12 {
        for column in 0..12 {
            let alpha = ((f64::from(row) + 0.5) / 12.0).powi(2);
            let cosine = ((f64::from(column) + 0.5) / 12.0).powi(2);
            let [a, b] = [&rule, &fine].map(|rule| rule.albedos(alpha, cosine));
            most = most.max((a[0] - b[0]).abs()).max((a[1] - b[1]).abs());
        }
    }
    println!("the rule is off by {most:.1e}");
    assert!(most < 7e-4, "{most}");
}

#[test]
fn with_compensation_a_furnace_is_white() {
    let mut held = Map::new();
    for (metallic, name) in [(1, "metal"), (0, "insulator")] {
        let bound = BOUNDS[metallic as usize];
        let mut most = 0f64;
        for (i, Estimate { mean, confidence }) in furnace(metallic, &[]).iter().enumerate() {
            let (row, column) = (i / COLUMNS, i % COLUMNS);
            most = most.max((mean - 1.0).abs() - confidence);
            assert!(
                (mean - 1.0).abs() < bound + confidence,
                "{name}, roughness {}, cosine {}: {mean} ± {confidence} + {bound}",
                roughness(row),
                cosine(column)
            );
        }
        println!("{name}: off by {most:.5} beyond the confidence; bound {bound:.4}");
        // The last digits depend on the platform's sine.
        held.insert(name.to_owned(), ((bound * 1e5).round() / 1e5).into());
    }
    expected::hold_exact("45_rough_metal/furnace", held.into());
}

#[test]
fn without_compensation_it_is_the_albedo() {
    let rule = DirectionRule::new([96, 48]);
    for sampling in ["distribution", "visible", "bounded"] {
        let sets = [&format!("sampling={sampling}"), "compensation=off"];
        let shown = furnace(1, &sets);
        for (i, Estimate { mean, confidence }) in shown.iter().enumerate() {
            let (row, column) = (i / COLUMNS, i % COLUMNS);
            let alpha = roughness(row).powi(2);
            let all = if row == 0 { 1.0 } else { rule.albedos(alpha, cosine(column))[0] };
            // A part of the samples that is rarely drawn may be in none: weights between 0 and 1 have a variance of
            // at most mean · (1 - mean).
            let scatter = 4.0 * (all * (1.0 - all) / f64::from(SAMPLES)).max(0.0).sqrt();
            assert!(
                (mean - all).abs() < confidence.max(scatter) + 2e-4,
                "{sampling}, roughness {}, cosine {}: {mean} ± {confidence} or {scatter}, not {all}",
                roughness(row),
                cosine(column)
            );
        }
        assert!(shown[ROWS * COLUMNS - 1].mean < 0.4, "the roughest surface is dark");
    }
}

/// The whole program: the spheres also light each other.
#[test]
fn white_spheres_vanish_under_a_white_sky() {
    for scene in ["furnace", "insulator furnace"] {
        let sets = [&format!("scene={scene}"), "depth=256", "roulette=off"];
        let values = brightness(&chapter("120x40").frames(16).sets(&sets).picture());
        let Estimate { mean, confidence } = Estimate::of(&values);
        println!("{scene}: {mean:.5} ± {confidence:.5}");
        // Each reflection may be off; fewer than half of the rays hit a sphere, and these fewer than three in a
        // row on average.
        let bound = 1.5 * BOUNDS[1];
        assert!(
            (mean - 1.0).abs() < confidence + bound,
            "{scene}: {mean} ± {confidence} + {bound}"
        );
    }
}
