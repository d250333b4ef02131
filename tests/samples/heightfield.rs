//! 21_heightfield: each rung compared with the exact ground, and pieces placed on it.

mod judged;
mod marched;
mod standing;
mod world;

#[path = "../../samples/08_intersection/boxes.rs"]
mod boxes;
#[allow(dead_code)]
#[path = "../../samples/21_heightfield/ground.rs"]
mod ground;
#[allow(dead_code)]
#[path = "../../samples/21_heightfield/land.rs"]
mod land;
#[allow(dead_code)]
#[path = "../../samples/21_heightfield/scenes.rs"]
mod scenes;
#[allow(dead_code)]
#[path = "../../samples/21_heightfield/shape.rs"]
mod shape;

use glam::DVec3;
use ground::Landscape;
use judged::{Exact, Verdict};
use marched::{Alone, March, Marched, RUNGS};

use run::plot::{Shown, draw_panels};
use run::{Chapter, expected};
use serde_json::{Map, Value, json};

const NAME: &str = "21_heightfield";
/// The ground's instance, after those of the 28 pieces. Without pieces, it comes after one triangle.
const GROUND: f32 = 28.0;
const GROUND_ALONE: f32 = 1.0;
const HILLS: Landscape = Landscape { k: 1.0, rings: 6 };
const STEEP: Landscape = Landscape { k: 14.0, rings: 3 };
const FLAT: Landscape = Landscape { k: 0.0, rings: 25 };

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// The presets, in the order of the page's table.
const VIEWS: [(&str, Landscape); 5] = [
    ("from above", HILLS),
    ("hills", HILLS),
    ("near ground", HILLS),
    ("steep", STEEP),
    ("flat", FLAT),
];

/// The two views in which rungs have the most errors: hits in the sky, and rays that pass through hills.
#[test]
fn each_rung_is_as_right_as_it_promises() {
    let views = VIEWS.into_iter().filter(|(view, _)| ["hills", "steep"].contains(view));
    rungs_in(&views.collect::<Vec<_>>());
}

#[test]
#[ignore = "nightly: the other views; quick: heightfield::each_rung_is_as_right_as_it_promises"]
fn each_rung_in_each_view() {
    let Rungs { rows, views, by_angle } = rungs_in(&VIEWS);
    let angles = steps_by_angle(&by_angle);
    expected::hold("21_heightfield/rungs", rows.into());
    expected::hold("21_heightfield/views", views.into());
    expected::hold("21_heightfield/angles", angles.into());
}

/// The page's tables, and for each ray that hits the hills, the angle and the steps of each rung.
struct Rungs {
    rows: Map<String, Value>,
    views: Map<String, Value>,
    by_angle: Vec<(f64, [f64; RUNGS.len()])>,
}

/// Checks each rung's promises in these views.
fn rungs_in(chosen: &[(&str, Landscape)]) -> Rungs {
    let alone = Alone::new();
    println!(
        "| view | rung | steps | right | visible | too near | too far | through | false | lost | p50 | p99 |"
    );
    let mut by_angle = Vec::new();
    let (mut rows, mut views) = (Map::new(), Map::new());
    for &(view, landscape) in chosen {
        let preset = format!("preset={view}");
        let marched = Marched::new(&alone, "96x60", &[&preset], landscape);
        if landscape == HILLS {
            for (i, march) in marched[0].0.iter().enumerate() {
                let steps = marched.each_ref().map(|marched| marched.0[i].steps);
                by_angle.extend(march.angle.map(|angle| (angle, steps)));
            }
        }
        let rays = marched[0].0.len();
        for (rung, marched) in RUNGS.iter().zip(&marched) {
            let row = marched.row();
            println!("| {view} | {rung} | {row} |");
            rows.extend(row.values(&format!("{view}.{rung}")));
        }
        let [relaxed, secant, lipschitz, over_relaxed, bisected] = &marched;
        let hits = relaxed.hits();
        println!("{hits} of {rays} rays hit, at {:.1} degrees (median)", relaxed.angle());
        let of_view = |what: &str| format!("{view}.{what}").replace(' ', "-");
        views.insert(of_view("rays"), rays.into());
        views.insert(of_view("angle"), relaxed.angle().into());
        views.insert(of_view("relaxed.wrong"), (rays - relaxed.right()).into());
        views.insert(of_view("secant.visible"), secant.visible().into());
        for (rung, marched) in RUNGS.iter().zip(&marched) {
            let steps = marched.steps_of_misses();
            println!("{rung}: {steps:.1} steps of a ray that misses");
            views.insert(of_view(&format!("{rung}.steps_of_misses")), steps.into());
        }
        // The rungs that bisect have no errors; at the edges of hills, rounding may decide.
        for best in [over_relaxed, bisected] {
            assert_eq!(best.right(), rays, "{view}");
            assert!(best.count(Verdict::Grazes) * 1000 <= rays, "{view}");
        }
        // One step of the secant improves most hits, but fixes neither a hit in the sky nor a missed hill.
        assert!(secant.visible() <= relaxed.visible(), "{view}");
        if view != "steep" {
            assert!(secant.errors()[0] < 0.1 * relaxed.errors()[0], "{view}");
        }
        // The rung limited by the slope never passes through, but it stops early.
        assert_eq!(lipschitz.count(Verdict::Through) + lipschitz.count(Verdict::FalseMiss), 0);
        if view == "flat" {
            // With a slope of 0, the first step is exact.
            assert!(lipschitz.right() == rays && bisected.steps() < 5.0);
        } else {
            assert!(lipschitz.count(Verdict::TooNear) * 10 > 9 * hits, "{view}");
        }
        if view == "steep" {
            assert!(
                relaxed.count(Verdict::Through) > 200 && relaxed.count(Verdict::FalseMiss) > 50
            );
        } else {
            // All of its hits are too early, and it finds ground in the sky.
            assert!(relaxed.count(Verdict::TooNear) * 20 > 19 * hits, "{view}");
            let invents = ["hills", "near ground"].contains(&view);
            assert!(!invents || relaxed.count(Verdict::FalseHit) > 20, "{view}");
            // The page's claim: the rung without errors needs fewer evaluations, especially for grazing rays.
            let part = if view == "from above" { 1.0 } else { 0.8 };
            assert!(bisected.steps() < part * relaxed.steps(), "{view}");
        }
    }
    Rungs { rows, views, by_angle }
}

/// The mean steps of each rung, by the angle between ray and ground in degrees.
fn steps_by_angle(by_angle: &[(f64, [f64; RUNGS.len()])]) -> Map<String, Value> {
    let mut angles = Map::new();
    println!("| angle | rays | relaxed | secant | lipschitz | over-relaxed | bisected |");
    for (from, to) in [(0.0, 5.0), (5.0, 15.0), (15.0, 45.0), (45.0, 90.0)] {
        let rays = by_angle.iter().filter(|(angle, _)| (from..to).contains(angle));
        let (mut count, mut sums) = (0, [0.0; RUNGS.len()]);
        for (_, steps) in rays {
            count += 1;
            sums = std::array::from_fn(|rung| sums[rung] + steps[rung]);
        }
        let means = sums.map(|sum| sum / f64::from(count));
        let [relaxed, secant, lipschitz, over_relaxed, bisected] = means;
        angles.insert(format!("{from}.rays"), count.into());
        angles.extend(
            RUNGS.iter().zip(means).map(|(rung, mean)| (format!("{from}.{rung}"), mean.into())),
        );
        println!(
            "| {from} to {to} | {count} | {relaxed:.1} | {secant:.1} | {lipschitz:.1} | {over_relaxed:.1} | {bisected:.1} |"
        );
        assert!(count > 100 && (to > 15.0 || bisected < 0.75 * relaxed));
    }
    angles
}

/// The page's bounds that follow from the formula of the land alone.
#[test]
fn the_land_is_as_steep_and_as_exact_as_the_page_says() {
    let slope = |landscape: Landscape| f64::from(landscape.shape().lipschitz);
    let (low, high) = HILLS.bounds(0.0);
    let reach = low.abs().max(high.abs()).as_dvec3();
    let values = json!({
        "hills.slope": slope(HILLS),
        "steep.slope": slope(STEEP),
        "error": HILLS.error(reach),
    });
    expected::hold_exact("21_heightfield/land", values);
    for landscape in [HILLS, STEEP] {
        // At least half of the bound is reached somewhere, and it is never exceeded.
        let field = judged::exact(landscape);
        let places = (0..400).flat_map(|i| (0..400).map(move |j| [i, j]));
        let slopes = places.map(|[i, j]| {
            let (_, [dx, dz]) = field.height(f64::from(i) * 0.16, f64::from(j) * 0.16);
            dx.hypot(dz)
        });
        let steepest = slopes.fold(0.0, f64::max);
        assert!(steepest <= slope(landscape) && steepest > 0.5 * slope(landscape), "{steepest}");
    }
}

/// Three views, and the errors of each rung in them.
#[test]
#[ignore = "by hand: draws a picture of the page, with UPDATE=1"]
fn error_maps() {
    const WIDTH: u32 = 240;
    let alone = Alone::new();
    let rows =
        [("hills", HILLS), ("near ground", HILLS), ("steep", STEEP)].map(|(view, landscape)| {
            let preset = format!("preset={view}");
            let marched = Marched::new(&alone, "240x150", &[&preset], landscape);
            // The percentage of wrong rays; the first panel of a row also names its view.
            let label = |number: usize| {
                let march = &marched[number];
                let part = 1.0 - march.right() as f64 / march.0.len() as f64;
                let view = if number == 0 { format!("{view}, ") } else { String::new() };
                format!("{view}{}: {:.0} % wrong", RUNGS[number], 100.0 * part)
            };
            let labels = [0, 1, 2, 3, 4].map(label);
            labels.into_iter().zip(marched.map(|marched| marched.map(WIDTH))).collect::<Vec<_>>()
        });
    if std::env::var_os("UPDATE").is_some_and(|value| value == "1") {
        draw_panels("21_errors.png", 1, &rows.each_ref().map(|row| Shown::row(row)));
    }
}

#[test]
fn on_flat_ground_the_relaxed_rung_gives_up_and_calls_it_a_hit() {
    let alone = Alone::new();
    let march = |pitch: f64| {
        // From a height of 1.
        let (sine, cosine) = pitch.to_radians().sin_cos();
        let target = format!("camera target={:?},{:?},{:?}", 8.0 + cosine, 1.0 - sine, 0.0);
        let sets = ["preset=flat", "camera eye=8,1,0", &target, "field of view=1"];
        Marched::new(&alone, "25x25", &sets, FLAT)
    };
    let (mut gave_up, mut early, mut example) = (0, 0, None);
    let [relaxed, .., bisected] = march(0.2);
    for (march, best) in relaxed.0.iter().zip(&bisected.0) {
        let sine = -march.ray.direction.y;
        if sine < 1e-3 {
            continue;
        }
        let exact = 1.0 / sine;
        if let Some(best) = best.found {
            assert!((best / exact - 1.0).abs() < 1e-4, "{best} for {exact}");
        }
        // After 300 steps of 0.4 of the height, (1 - 0.4·sine)^300 of it is left.
        let end = exact * (1.0 - (1.0 - 0.4 * sine).powi(300));
        if 1.0 - end * sine > 0.0016 * end && end < 300.0 {
            assert_eq!(march.steps, 300.0);
            let t = march.found.unwrap();
            assert!((t / end - 1.0).abs() < 1e-3, "{t} for {end}, {exact}");
            gave_up += 1;
            if (sine - 0.2f64.to_radians().sin()).abs() < 2e-5 {
                example = Some((t, exact));
            }
        }
    }
    for March { ray, found, .. } in &march(5.0)[0].0 {
        // It stops where the height is 0.0015·t, or at most a step of 0.4 of that later.
        let (sine, t) = (-ray.direction.y, found.unwrap());
        let stop = 1.0 / (sine + 0.0015);
        assert!(t > stop * 0.9999 && t < 1.0 / sine, "{t} {stop}");
        early += 1;
    }
    let (found, ground) = example.expect("a ray at 0.2 degrees");
    println!("at 0.2 degrees: a hit at {found:.1}, the ground is at {ground:.1}");
    expected::hold("21_heightfield/gave_up", json!({ "found": found, "ground": ground }));
    println!("{gave_up} rays gave up after 300 steps, {early} stopped early");
    assert!(gave_up > 100 && early == 625, "{gave_up} {early}");
}

#[test]
fn from_below_the_ground_is_the_ground() {
    let alone = Alone::new();
    // Inside a hill, 2.2 high, looking at its inside and out of the pond next to it.
    let sets = ["camera eye=8,0.5,2", "camera target=20,0.25,-6", "field of view=100"];
    let [relaxed, _, _, over_relaxed, bisected] = Marched::new(&alone, "60x40", &sets, HILLS);
    let above = Exact::new(HILLS, DVec3::splat(100.0));
    assert!(above.height_above(&relaxed.0[0].ray, 0.0) < -1.0);
    assert!(relaxed.hits() > 1000, "{}", relaxed.hits());
    for best in [over_relaxed, bisected] {
        assert_eq!(best.right(), best.0.len());
    }
    // A negative height is a backward step.
    assert!(relaxed.right() + relaxed.count(Verdict::FalseMiss) == relaxed.0.len());
    assert!(relaxed.count(Verdict::FalseMiss) == relaxed.hits());
}

#[test]
fn normals_are_those_of_the_height_function() {
    let alone = Alone::new();
    let field = judged::exact(STEEP);
    let sets = ["preset=steep"];
    let show = |view| alone.shown("120x75", &[&sets[..], &[view]].concat());
    let [normals, hits] = ["show=normal", "show=hit"].map(show);
    let rays = alone.rays("120x75", &sets);
    let (mut count, mut worst) = (0, 0.0f64);
    for ((ray, normal), hit) in rays.iter().zip(&normals.pixels).zip(&hits.pixels) {
        if hit[0] != GROUND_ALONE {
            continue;
        }
        let p = ray.at(hit[2].into());
        let (_, [dx, dz]) = field.height(p.x, p.z);
        let exact = DVec3::new(-dx, 1.0, -dz).normalize();
        let exact = if exact.dot(ray.direction) > 0.0 { -exact } else { exact };
        let normal = DVec3::from([0, 1, 2].map(|i| 2.0 * f64::from(normal[i]) - 1.0));
        worst = worst.max(normal.distance(exact));
        count += 1;
    }
    println!("{count} normals, off by {worst:.1e} at most");
    // The error of the position times the rate of change of the slope: 9·32·(2.2/32² + ...) per unit.
    assert!(count > 4000 && worst < 1e-4, "{count} {worst}");
}

#[test]
fn what_is_traced_is_what_is_marched() {
    for rung in ["relaxed", "bisected"] {
        let rung = format!("rung={rung}");
        let show = |view| chapter("120x75").sets(&[&rung]).sets(&[view]).picture();
        let (hits, marched) = (show("show=hit"), show("show=march"));
        let mut ground = 0;
        for (hit, marched) in hits.pixels.iter().zip(&marched.pixels) {
            if hit[0] == GROUND {
                assert_eq!(hit[2].to_bits(), marched[0].to_bits(), "{rung}");
                ground += 1;
            } else {
                // Sky, or a piece in front of the ground.
                assert!(
                    marched[0] < 0.0 || hit[0] >= 0.0 && hit[2] < marched[0],
                    "{hit:?} {marched:?}"
                );
            }
        }
        assert!(ground > 3000, "{rung}: {ground}");
    }
}
