//! 21_heightfield: each rung held to the exact ground, and a ground that takes part in everything.

mod judged;
mod marched;
mod world;

#[allow(dead_code)]
#[path = "../../samples/21_heightfield/ground.rs"]
mod ground;
#[allow(dead_code)]
#[path = "../../samples/21_heightfield/land.rs"]
mod land;

use std::collections::{BTreeMap, BTreeSet};

use common::app::Picture;
use common::scene::Sun;
use glam::DVec3;
use ground::Landscape;
use judged::{Exact, Verdict};
use marched::{Alone, March, Marched, RUNGS};
use reference::Ray;
use world::{World, chess, traced};

use run::{bits, golden, plot, render};

const NAME: &str = "21_heightfield";
/// What `show=hit` says of plane and ground, instead of an instance.
const PLANE: f32 = -2.0;
const GROUND: f32 = -3.0;
/// How high the lake is.
const LAKE: f32 = 0.45;
const HILLS: Landscape = Landscape { k: 1.0, rings: 6 };
const STEEP: Landscape = Landscape { k: 14.0, rings: 3 };
const FLAT: Landscape = Landscape { k: 0.0, rings: 25 };

fn shown(size: &str, sets: &[&str], more: &[&str]) -> Picture {
    let sets = sets.iter().flat_map(|&set| ["--set", set]);
    render(NAME, size, &sets.chain(more.iter().copied()).collect::<Vec<_>>()).picture
}

#[test]
fn the_picture_is_the_golden_one() {
    // Tolerance set by llvmpipe (Mesa 25.0.7), which made the golden and repeats it to the bit.
    golden(NAME, &shown("240x150", &[], &[]), 0.002);
}

// The ground alone ------------------------------------------------------------------------------

/// The presets, in the order of the page's table.
const VIEWS: [(&str, Landscape); 5] = [
    ("from above", HILLS),
    ("hills", HILLS),
    ("near ground", HILLS),
    ("steep", STEEP),
    ("flat", FLAT),
];

#[test]
fn each_rung_in_each_view() {
    let alone = Alone::new();
    println!(
        "| view | rung | steps | right | too near | too far | through | false | lost | p50 | p99 |"
    );
    let mut by_angle = Vec::new();
    for (view, landscape) in VIEWS {
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
            println!("| {view} | {rung} | {} |", marched.row());
        }
        let [relaxed, lipschitz, over_relaxed, bisected] = &marched;
        let hits = relaxed.hits();
        let misses = marched.each_ref().map(|marched| format!("{:.1}", marched.steps_of_misses()));
        println!(
            "{hits} of {rays} rays hit the ground, at {:.1} degrees (median); steps of the others: {}",
            relaxed.angle(),
            misses.join(", ")
        );
        // What bisects errs nowhere; where hills have their edges, rounding may decide.
        for best in [over_relaxed, bisected] {
            assert_eq!(best.right(), rays, "{view}");
            assert!(best.count(Verdict::Grazes) * 1000 <= rays, "{view}");
        }
        // What steps no farther than the slope allows never goes through, but it stops early.
        assert_eq!(lipschitz.count(Verdict::Through) + lipschitz.count(Verdict::FalseMiss), 0);
        if view == "flat" {
            // With a slope of 0 the first step is right.
            assert!(lipschitz.right() == rays && bisected.steps() < 5.0);
        } else {
            assert!(lipschitz.count(Verdict::TooNear) * 10 > 9 * hits, "{view}");
        }
        if view == "steep" {
            assert!(
                relaxed.count(Verdict::Through) > 200 && relaxed.count(Verdict::FalseMiss) > 50
            );
        } else {
            // Wherever it hits, it stops early; and it sees ground in the sky.
            assert!(relaxed.count(Verdict::TooNear) * 20 > 19 * hits, "{view}");
            let invents = ["hills", "near ground"].contains(&view);
            assert!(!invents || relaxed.count(Verdict::FalseHit) > 20, "{view}");
            // The claim of the page: what errs nowhere asks less often, the more so where rays graze.
            let part = if view == "from above" { 1.0 } else { 0.8 };
            assert!(bisected.steps() < part * relaxed.steps(), "{view}");
        }
    }
    println!("| angle | rays | relaxed | lipschitz | over-relaxed | bisected |");
    for (from, to) in [(0.0, 5.0), (5.0, 15.0), (15.0, 45.0), (45.0, 90.0)] {
        let rays = by_angle.iter().filter(|(angle, _)| (from..to).contains(angle));
        let (mut count, mut sums) = (0, [0.0; 4]);
        for (_, steps) in rays {
            count += 1;
            sums = std::array::from_fn(|rung| sums[rung] + steps[rung]);
        }
        let [relaxed, lipschitz, over_relaxed, bisected] = sums.map(|sum| sum / f64::from(count));
        println!(
            "| {from} to {to} | {count} | {relaxed:.1} | {lipschitz:.1} | {over_relaxed:.1} | {bisected:.1} |"
        );
        assert!(count > 100 && (to > 15.0 || bisected < 0.75 * relaxed));
    }
}

/// Three views, and the errors of each rung in them.
#[test]
#[ignore = "draws a picture of the page, with UPDATE=1"]
fn error_maps() {
    const WIDTH: u32 = 240;
    let alone = Alone::new();
    let rows: Vec<Vec<Picture>> = [("hills", HILLS), ("near ground", HILLS), ("steep", STEEP)]
        .into_iter()
        .map(|(view, landscape)| {
            let preset = format!("preset={view}");
            let marched = Marched::new(&alone, "240x150", &[&preset], landscape);
            marched.iter().map(|marched| marched.map(WIDTH)).collect()
        })
        .collect();
    if std::env::var_os("UPDATE").is_some_and(|value| value == "1") {
        let whole = |map| (map, [0, 0, WIDTH, 150]);
        let rows: Vec<Vec<_>> = rows.iter().map(|row| row.iter().map(whole).collect()).collect();
        plot::crops("21_errors.png", 1, &rows);
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
    let (mut gave_up, mut early, mut example) = (0, 0, String::new());
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
        // 300 steps of 0.4 of the height leave (1 - 0.4·sine)^300 of it.
        let end = exact * (1.0 - (1.0 - 0.4 * sine).powi(300));
        if 1.0 - end * sine > 0.0016 * end && end < 300.0 {
            assert_eq!(march.steps, 300.0);
            let t = march.found.unwrap();
            assert!((t / end - 1.0).abs() < 1e-3, "{t} for {end}, {exact}");
            gave_up += 1;
            if (sine - 0.2f64.to_radians().sin()).abs() < 2e-5 {
                example = format!("at 0.2 degrees: a hit at {t:.1}, the ground is at {exact:.1}");
            }
        }
    }
    for March { ray, found, .. } in &march(5.0)[0].0 {
        // It stops where the height is 0.0015·t, or at most a step of 0.4 of that further.
        let (sine, t) = (-ray.direction.y, found.unwrap());
        let stop = 1.0 / (sine + 0.0015);
        assert!(t > stop * 0.9999 && t < 1.0 / sine, "{t} {stop}");
        early += 1;
    }
    println!("{example}");
    println!("{gave_up} rays gave up after 300 steps, {early} stopped early");
    assert!(gave_up > 100 && early == 625, "{gave_up} {early}");
}

#[test]
fn from_below_the_ground_is_the_ground() {
    let alone = Alone::new();
    // In a hill, 2.2 high, that looks at its inside and out of the pond beside it.
    let sets = ["camera eye=8,0.5,2", "camera target=20,0.25,-6", "field of view=100"];
    let [relaxed, _, over_relaxed, bisected] = Marched::new(&alone, "60x40", &sets, HILLS);
    let above = Exact::new(HILLS, DVec3::splat(100.0));
    assert!(above.height_above(&relaxed.0[0].ray, 0.0) < -1.0);
    assert!(relaxed.hits() > 1000, "{}", relaxed.hits());
    for best in [over_relaxed, bisected] {
        assert_eq!(best.right(), best.0.len());
    }
    // A negative height is a step back.
    assert!(relaxed.right() + relaxed.count(Verdict::FalseMiss) == relaxed.0.len());
    assert!(relaxed.count(Verdict::FalseMiss) == relaxed.hits());
}

// The ground among other things -----------------------------------------------------------------

#[test]
fn the_chess_set_stands_on_the_ground() {
    let scene = chess();
    for landscape in [HILLS, STEEP] {
        let (mut feet, mut highest) = (0, 0.0f32);
        for piece in &scene.instances {
            let mesh = &scene.model.meshes[piece.mesh];
            let Some(placed) = land::stand(landscape, piece, mesh) else {
                continue;
            };
            // Upright, above the place where it stood.
            let by = placed.transform.translation - piece.transform.translation;
            assert!(
                placed.transform.matrix3 == piece.transform.matrix3 && by.x == 0.0 && by.z == 0.0
            );
            let bottom = mesh.bounds().0.y;
            let foot = mesh.vertices.iter().map(|vertex| vertex.position);
            let gaps = foot.filter(|position| position.y == bottom).map(|position| {
                let at = placed.transform.transform_point3(position);
                f64::from(at.y) - landscape.height(at.x, at.z)
            });
            let (least, most) =
                gaps.fold((f64::MAX, f64::MIN), |(a, b), gap| (a.min(gap), b.max(gap)));
            // It touches the ground, and nothing of the foot is in the air.
            assert!(most.abs() < 1e-5 && least > -0.6, "{least} {most}");
            highest = highest.max(placed.transform.translation.y);
            feet += 1;
        }
        println!("k = {}: {feet} pieces stand, the highest at {highest}", landscape.k);
        assert!(if landscape == HILLS { feet == 28 } else { feet < 28 && feet > 0 });
        // The device has just those.
        let k = format!("steepness={}", landscape.k);
        let sets = [&k[..], "plane=off", "camera eye=8,70,1", "camera target=8,0,0"];
        let sets = [&sets[..], &["field of view=8", "show=hit"]].concat();
        let seen = shown("300x300", &sets, &[]);
        let seen: BTreeSet<i32> = seen.pixels.iter().map(|hit| hit[0] as i32).collect();
        assert_eq!(seen.iter().filter(|instance| **instance >= 0).count(), feet);
    }
}

#[test]
fn ground_pieces_and_lake_mirror_each_other() {
    let world = World::new();
    // Everything mirrors: rays leave pieces, lake and ground, many of them grazing it.
    let sets = ["ground reflection=1"];
    let (first, second) = (traced("120x75", &sets, 0), traced("120x75", &sets, 1));
    let mut seen = BTreeMap::<String, usize>::new();
    let (mut edges, mut from_ground) = (0, 0);
    for (bounce, (ray, hit)) in
        first.iter().map(|hit| (0, hit)).chain(second.iter().map(|hit| (1, hit)))
    {
        let on_lake = bounce == 1 && ray.origin.y == f64::from(LAKE);
        let height = world.ground.height_above(ray, 0.0);
        if bounce == 1 && height < 4.0 * world.ground.error {
            // The start is above the ground by more than a height may be wrong.
            from_ground += 1;
            assert!(height > world.ground.error || on_lake, "{ray:?} {height}");
        }
        let (expected, t) = world.first(ray, on_lake);
        if expected != hit[0] {
            assert!(
                world.is_close(ray, on_lake),
                "bounce {bounce}: {ray:?} {hit:?} {expected} {t}"
            );
            edges += 1;
            continue;
        }
        if expected == GROUND {
            let exact = world.ground.hit(ray);
            let verdict = world.ground.judge(ray, Some(hit[2].into()), exact.as_ref());
            assert!(verdict == Verdict::Right, "{ray:?} {hit:?} {verdict:?}");
        }
        let kind = match expected {
            GROUND => "ground",
            PLANE => "lake",
            -1.0 => "sky",
            _ => "piece",
        };
        *seen.entry(format!("{bounce} {kind}")).or_default() += 1;
    }
    println!("{seen:?}, {from_ground} rays start on the ground, {edges} at edges");
    assert!(seen.values().all(|count| *count > 50), "{seen:?}");
    assert!(seen.len() == 8 && from_ground > 3000, "{seen:?} {from_ground}");
    assert!(edges * 200 < first.len(), "{edges}");
}

#[test]
fn shadows_fall_both_ways_and_no_ground_shades_itself() {
    let world = World::new();
    // By what is in the shadow and what throws it.
    let mut seen = BTreeMap::<String, usize>::new();
    let (mut edges, mut facing_away) = (0, 0);
    let in_the_pond = ["camera eye=-8,0.25,6", "camera target=-8,-0.75,-2"];
    // The second sun is so low that hills reach hills.
    for (azimuth, elevation, more) in
        [(270.0, 17.0, &[][..]), (240.0, 10.0, &[]), (270.0, 17.0, &in_the_pond)]
    {
        let sun = Sun { azimuth, elevation, ..Sun::default() };
        let light = sun.light().direction.to_array();
        let sun = [format!("sun azimuth={azimuth}"), format!("sun elevation={elevation}")];
        let show = |view| shown("150x94", &[&[&sun[0][..], &sun[1], view], more].concat(), &[]);
        let (hits, shadows) = (show("show=hit"), show("show=shadow origin"));
        for (hit, &[x, y, z, visible]) in hits.pixels.iter().zip(&shadows.pixels) {
            let on = match hit[0] {
                PLANE => "lake",
                GROUND => "ground",
                -1.0 => continue,
                _ => "piece",
            };
            let ray = Ray::from_f32([x, y, z], light, 0.0, 1e30);
            let ground = world.ground.field.height(x.into(), z.into()).1;
            let faces = match on {
                "ground" => DVec3::new(-ground[0], 1.0, -ground[1]).dot(ray.direction) > 1e-6,
                // Which way its triangle faces is not known here; what is lit does.
                "piece" => visible > 0.0 || world.first(&ray, false).0 != -1.0,
                _ => true,
            };
            if !faces {
                // What faces away from the sun needs no ray.
                assert!(visible == 0.0);
                facing_away += 1;
                continue;
            }
            let (by, _) = world.first(&ray, on == "lake");
            let by = match by {
                -1.0 => "nothing",
                GROUND => "ground",
                PLANE => "lake",
                _ => "a piece",
            };
            if (by == "nothing") != (visible > 0.0) {
                assert!(world.is_close(&ray, on == "lake"), "{on} {by} {ray:?}");
                edges += 1;
                continue;
            }
            *seen.entry(format!("{on} by {by}")).or_default() += 1;
        }
    }
    println!("{seen:?}, {facing_away} face away, {edges} at edges");
    for kind in [
        "ground by nothing",
        "ground by ground",
        "ground by a piece",
        "ground by lake",
        "lake by nothing",
        "lake by ground",
        "lake by a piece",
        "piece by nothing",
        "piece by a piece",
    ] {
        assert!(seen.get(kind).is_some_and(|count| *count > 20), "{kind}: {seen:?}");
    }
    assert!(edges < 20, "{edges}");
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
        if hit[0] != GROUND {
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
    // How far the place is off, times how fast the slope changes: 9·32·(2.2/32² + ...) a unit.
    assert!(count > 4000 && worst < 1e-4, "{count} {worst}");
}

#[test]
fn what_is_traced_is_what_is_marched() {
    for rung in ["relaxed", "bisected"] {
        let sets = ["plane=off", "shadow rays=off", &format!("rung={rung}")];
        let show = |view| shown("120x75", &[&sets[..], &[view]].concat(), &[]);
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

#[test]
fn loop_and_recursion_before_and_after_give_the_same_bits() {
    let sets = ["ground reflection=0.4", "light=both", "depth=3"];
    let show = |more: &[&str]| bits(&shown("120x75", &[&sets[..], more].concat(), &[]));
    let picture = show(&[]);
    assert!(picture == show(&["method=recursive"]));
    assert!(picture == show(&["plane test=after"]));
    assert!(picture != show(&["rung=relaxed"]));
}
