//! The table and the picture of the errors at every distance.

use common::app::Picture;
use common::scene::Camera;
use glam::DVec3;
use reference::sphere::Sphere;
use serde_json::Map;

use super::chapter;
use super::errors::Errors;
use super::rungs::{RUNGS, with_t};
use super::scenes::{self, SceneKind};
use run::expected;
use run::plot::{Shown, draw_panels};

/// The page's table and its error maps: `UPDATE=1` writes the picture.
#[test]
#[ignore = "by hand: a measurement: it prints a table and makes a picture"]
fn errors_at_every_distance() {
    const SIDE: u32 = 240;
    let size = format!("{SIDE}x{SIDE}");
    let distances = [1.0, 1e2, 1e4];
    let sphere = Sphere { center: DVec3::ZERO, radius: 1.0 };
    let mut rows: [Vec<(String, Picture)>; 4] = Default::default();
    let mut table = Map::new();
    println!("| rung | distance | p50 | p99 | max | false hits | false misses |");
    for distance in distances {
        for rung in RUNGS {
            let sets = [
                "scene=one sphere",
                &format!("distance={distance}"),
                &format!("sphere rung={rung}"),
            ];
            let camera = scenes::camera(SceneKind::OneSphere, Camera::default(), 1, distance);
            let shown = chapter(&size).sets(&sets).sets(&["show=ray direction"]).picture();
            let mut errors = Errors::default();
            let mut map = Vec::new();
            for (ray, t) in with_t(&camera, &shown) {
                let exact = sphere.intersect_exact(&ray).map(|hit| hit.to_f64().t);
                let mut one = Errors::default();
                one.add(t, exact);
                map.push(error_color(&one));
                errors.rays += 1;
                errors.false_hits += one.false_hits;
                errors.false_misses += one.false_misses;
                errors.ulp.extend(one.ulp);
            }
            println!("| {rung} | {distance} | {} |", errors.row());
            let name = format!("{distance}.{}", rung.replace(' ', "-"));
            let figures = errors.values();
            table.extend(figures.map(|(figure, value)| (format!("{name}.{figure}"), value.into())));
            let Some(row) = ["textbook", "stable"].iter().position(|&shown| shown == rung) else {
                continue;
            };
            let label = format!("{rung}, distance {distance}");
            rows[2 * row].push((label, chapter(&size).sets(&sets).picture()));
            let map = Picture { width: SIDE, height: SIDE, pixels: map };
            rows[2 * row + 1].push((errors.label(), map));
        }
    }
    expected::hold("42_distant_spheres/errors", table.into());
    if std::env::var_os("UPDATE").is_some_and(|value| value == "1") {
        draw_panels("42_errors.png", 1, &rows.each_ref().map(|row| Shown::row(row)));
    }
}

/// Grey for a correct miss; from dark blue (half a ULP) through violet and orange to white (a million); red
/// for a false hit, green for a false miss.
fn error_color(one: &Errors) -> [f32; 4] {
    const RAMP: [[f32; 3]; 5] = [
        [0.01, 0.02, 0.10],
        [0.12, 0.03, 0.30],
        [0.50, 0.06, 0.16],
        [0.95, 0.40, 0.04],
        [1.0, 1.0, 0.85],
    ];
    let [r, g, b] = match one.ulp.first() {
        _ if one.false_hits > 0 => [1.0, 0.0, 0.0],
        _ if one.false_misses > 0 => [0.0, 0.8, 0.15],
        None => [0.25, 0.25, 0.25],
        Some(ulp) => {
            let place = ((ulp.max(0.5).log2() + 1.0) / 21.0 * 4.0).clamp(0.0, 3.999);
            let (low, part) = (RAMP[place as usize], place.fract() as f32);
            let high = RAMP[place as usize + 1];
            std::array::from_fn(|i| low[i] + (high[i] - low[i]) * part)
        }
    };
    [r, g, b, 1.0]
}
