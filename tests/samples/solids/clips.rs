//! Clips, the inverse, and the inside.

use glam::{DVec3, Vec3};
use reference::solid::Solid as ReferenceSolid;
use reference::solid::bound::Stray;
use reference::transform::U;

use super::counterpart::{counterpart, largest};
use super::solid::{self, Solid};
use super::stub::Stub;
use super::tally::Tally;
use super::{INSIDE, OUTSIDE, is_endless, shape};
use run::bits;

#[test]
fn a_clip_cuts_open_and_an_intersection_caps() {
    let stub = Stub;
    let rays = stub.rays(OUTSIDE);
    let cut = solid::plane(Vec3::new(1.0, 1.0, 2.0), 0.1);
    for name in ["cube", "die", "bishop", "shell"] {
        let show = |kind: &str| stub.hits(OUTSIDE, name, &[&format!("cut={kind}")]);
        let (open, capped) = (show("clipped by"), show("intersection"));
        let solid = shape(name);
        let with_lid = solid.clone().intersection(Solid::Convex(vec![cut], "red"));
        let clipped = counterpart(&solid, &[cut]);
        let closed = counterpart(&with_lid, &[]);
        let (mut of_open, mut of_closed) = (Tally::default(), Tally::default());
        let (mut seen_inside, mut lids) = (0, 0);
        let mut members = 0;
        closed[0].each(&mut |_| members += 1);
        for ((ray, open), capped) in rays.iter().zip(&open.pixels).zip(&capped.pixels) {
            of_open.judge(&clipped, ray, Stray::default(), open);
            of_closed.judge(&closed, ray, Stray::default(), capped);
            seen_inside += usize::from(open[0] >= 0.0 && open[3] == 1.0);
            lids += usize::from(capped[0] >= 0.0 && capped[1] as usize == members - 1);
            // The lid hides the inside, and only the part left by the clip is visible.
            assert!(capped[0] < 0.0 || capped[3] == 0.0, "{name}: {capped:?}");
            assert!(open[0] < 0.0 || open[1] as usize != members - 1, "{name}: {open:?}");
        }
        println!("{name}: open {of_open}, {seen_inside} inside; capped {of_closed}, {lids} lids");
        for tally in [&of_open, &of_closed] {
            assert!(tally.wrong.is_empty(), "{name}: {}", tally.wrong[0]);
            assert!(tally.near < 5, "{tally}");
        }
        assert!(seen_inside > 50 && lids > 50, "{name}: {seen_inside} {lids}");
    }
}

#[test]
fn inverse_exchanges_the_sides_and_twice_changes_nothing() {
    inverses_exchange_the_sides(&["die", "slotted cube", "half-space"], &["shell"]);
}

#[test]
#[ignore = "nightly: the other solids; quick: solids::clips::inverse_exchanges_the_sides_and_twice_changes_nothing"]
fn so_they_do_of_other_solids() {
    let outside =
        ["die", "tower", "shell", "wedge", "slotted cube", "all but a cube", "half-space"];
    inverses_exchange_the_sides(&outside, &["shell"]);
}

/// The names of the solids seen from outside, and from inside.
fn inverses_exchange_the_sides(outside: &[&str], inside: &[&str]) {
    let stub = Stub;
    for (view, names) in [(OUTSIDE, outside), (INSIDE, inside)] {
        let show = |name: &str, sets: &[&str]| stub.seen(view, name, sets);
        let twice = show("all but a cube", &["inverse solids=on"]);
        assert_eq!(bits(&twice), bits(&show("cube", &[])));
        for name in names {
            let hits = stub.hits(view, name, &[]);
            let inverse = stub.hits(view, name, &["inverse solids=on"]);
            for (hit, inverse) in hits.pixels.iter().zip(&inverse.pixels) {
                assert_eq!(hit[..3], inverse[..3], "{name}");
                assert!(hit[0] < 0.0 || hit[3] == 1.0 - inverse[3], "{name}: {hit:?} {inverse:?}");
            }
        }
    }
}

#[test]
fn inside_and_outside_are_those_of_the_exact_solid() {
    let stub = Stub;
    let rays = stub.rays(OUTSIDE);
    let cut = solid::plane(Vec3::new(1.0, 1.0, 2.0), 0.1);
    let (mut inside, mut outside, mut near) = (0, 0, 0);
    for name in ["die", "tower", "halves", "wedge", "all but a cube", "half-space"] {
        for (sets, clip) in [
            (&["section distance=4"][..], vec![]),
            (&["section distance=5", "cut=clipped by"], vec![cut]),
        ] {
            let clip = if is_endless(name) { [clip, largest()].concat() } else { clip };
            let solid = ReferenceSolid::Intersection(counterpart(&shape(name), &clip).into());
            let section = stub.seen(OUTSIDE, name, &[sets, &["show=section"]].concat());
            let distance = if clip.is_empty() || sets.len() == 1 { 4.0 } else { 5.0 };
            for (ray, pixel) in rays.iter().zip(&section.pixels) {
                let point = ray.at(distance);
                if solid.contains(point) == (pixel[3] == 1.0) {
                    *if pixel[3] == 1.0 { &mut inside } else { &mut outside } += 1;
                    continue;
                }
                // The point itself is rounded, by u of its distance.
                let around = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * 16.0 * U);
                let sides = around.iter().flat_map(|&step| [point + step, point - step]);
                let known = solid.contains(point);
                let unsure = sides.map(|side| solid.contains(side)).any(|other| other != known);
                assert!(unsure, "{name}: {ray:?} {pixel:?}");
                near += 1;
            }
        }
    }
    println!("{inside} points inside, {outside} outside, {near} on a surface");
    assert!(inside > 2000 && outside > 8_000 && near < 20, "{inside} {outside} {near}");
}
