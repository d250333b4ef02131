//! Fog that stays outside.

use glam::{DVec3, Vec3};
use reference::solid::Solid as ReferenceSolid;

use super::counterpart::{counterpart, largest};
use super::stub::Stub;
use super::{INSIDE, OUTSIDE, is_endless, shape, solid};
use run::bits;

/// The length from 0 to `end` covered by these intervals.
fn covered(intervals: &[[f64; 2]], end: f64) -> f64 {
    let part = |[enter, leave]: &[f64; 2]| (leave.min(end) - enter.max(0.0)).max(0.0);
    intervals.iter().map(part).sum()
}

#[test]
fn fog_is_counted_on_the_way_outside_only() {
    let stub = Stub;
    let cut = solid::plane(Vec3::NEG_Z, 0.3);
    let sets = ["fog distance=2", "cut=clipped by", "cut normal=0,0,-1", "cut distance=0.3"];
    let (mut both, mut none, mut all) = (0, 0, 0);
    // From inside through the opening, from behind, and from the front into it.
    let views = [
        (DVec3::new(0.1, 0.2, 0.5), DVec3::new(0.9, -0.1, -0.4)),
        (DVec3::new(0.4, 0.3, 4.0), DVec3::ZERO),
        (DVec3::new(0.8, 0.9, -4.0), DVec3::ZERO),
    ];
    for view in views {
        let rays = stub.rays(view);
        for name in ["room", "sunk room", "half-space", "shell"] {
            let clip = if is_endless(name) { [vec![cut], largest()].concat() } else { vec![cut] };
            let solid = ReferenceSolid::Intersection(counterpart(&shape(name), &clip).into());
            let show =
                |more: &[&str]| stub.seen(view, name, &[&sets[..], more, &["show=fog"]].concat());
            let fog = show(&[]);
            for (ray, fog) in rays.iter().zip(&fog.pixels) {
                let [way, clear, t, _] = fog.map(f64::from);
                let end = if t < 0.0 { 1e30 } else { t };
                let within = covered(&solid.intervals(ray), end);
                let exact = end - within;
                // A grazed edge contains little of the path; the rest is the rounding of t.
                assert!(
                    (way - exact).abs() <= 1e-5 * end.max(1.0),
                    "{name}: {ray:?} {way} {exact}"
                );
                assert!((clear - (-way / 2.0).exp()).abs() < 1e-5);
                *if within == 0.0 {
                    &mut all
                } else if exact < 1e-6 {
                    &mut none
                } else {
                    &mut both
                } += 1;
            }
            // If fog is everywhere, the position of a ray does not matter: one view is enough.
            if view == views[0] {
                for &[way, _, t, _] in &show(&["hollow=on"]).pixels {
                    assert_eq!(way, if t < 0.0 { 1e30 } else { t }, "{name}");
                }
            }
        }
    }
    println!("{all} rays in fog, {none} in none, {both} in both");
    assert!(all > 2000 && none > 200 && both > 2000, "{all} {none} {both}");
}

#[test]
fn fog_stays_out_of_a_closed_solid_unless_it_is_hollow() {
    let stub = Stub;
    for (name, view) in [("cube", INSIDE), ("king", INSIDE), ("all but a cube", OUTSIDE)] {
        let show = |sets: &[&str]| bits(&stub.seen(view, name, sets));
        let clear = show(&["fog distance=0"]);
        assert_eq!(show(&["fog distance=0.5"]), clear, "{name}");
        let hollow = show(&["fog distance=0.5", "hollow=on"]);
        let changed = hollow.iter().zip(&clear).filter(|(a, b)| a != b).count();
        assert!(changed > 400, "{name}: {changed}");
    }
    let show = |sets: &[&str]| bits(&stub.seen(OUTSIDE, "cube", sets));
    assert_ne!(show(&["fog distance=5"]), show(&["fog distance=0"]));
    // Below a plane, the eye is in its half-space, which also contains no fog.
    let below = (DVec3::new(0.5, -2.0, 0.4), DVec3::new(0.2, 0.0, 0.1));
    let show = |name: &str, sets: &[&str]| bits(&stub.seen(below, name, sets));
    assert_eq!(show("half-space", &["fog distance=2"]), show("half-space", &["fog distance=0"]));
    assert_ne!(
        show("half-space", &["fog distance=2", "inverse solids=on"]),
        show("half-space", &["fog distance=0", "inverse solids=on"])
    );
}
