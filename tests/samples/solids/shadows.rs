//! Shadows of solids, on themselves and on nothing else.

use common::scene::Sun;
use reference::Ray;
use reference::solid::bound::{SolidVerdict, Stray};

use super::counterpart::counterpart;
use super::stub::Stub;
use super::{OUTSIDE, shape};

#[test]
fn no_face_shades_itself_and_shadows_are_the_exact_ones() {
    let stub = Stub;
    let sun = Sun { azimuth: 305.0, elevation: 34.0, ..Sun::default() };
    let light = sun.light().direction.to_array();
    // Convex solids only have the shadow of their own far side.
    for sets in [["size=1", "moved=0"], ["size=1000", "moved=0"], ["size=0.001", "moved=10000"]] {
        let (mut lit, mut dark) = (0, 0);
        for name in ["crystal", "lens", "cube"] {
            let [normals, shadows] = ["show=normal", "show=shadow origin"]
                .map(|show| stub.seen(OUTSIDE, name, &[&sets[..], &[show]].concat()));
            for (normal, shadow) in normals.pixels.iter().zip(&shadows.pixels) {
                if shadow[3] < 0.0 {
                    continue;
                }
                let towards: f32 = (0..3).map(|i| (normal[i] * 2.0 - 1.0) * light[i]).sum();
                // On the terminator, the sign itself is rounded.
                if towards.abs() > 1e-5 {
                    assert_eq!(shadow[3] == 1.0, towards > 0.0, "{name} {sets:?}: {shadow:?}");
                    *if towards > 0.0 { &mut lit } else { &mut dark } += 1;
                }
            }
        }
        println!("{sets:?}: {lit} lit, {dark} dark");
        assert!(lit > 500 && dark > 100, "{lit} {dark}");
    }
    let (mut lit, mut dark, mut apart) = (0, 0, 0);
    for name in ["die", "tower", "shell"] {
        let [solid, clip] = counterpart(&shape(name), &[]);
        let [normals, shadows] =
            ["show=normal", "show=shadow origin"].map(|show| stub.seen(OUTSIDE, name, &[show]));
        for (normal, &[x, y, z, visible]) in normals.pixels.iter().zip(&shadows.pixels) {
            if visible < 0.0 {
                continue;
            }
            let ray = Ray::from_f32([x, y, z], light, 0.0, 1e30);
            let exact = solid.intersect(&ray);
            if exact.is_none() == (visible == 1.0) {
                *if visible == 1.0 { &mut lit } else { &mut dark } += 1;
                continue;
            }
            // An outline; or the terminator of a ball: a ray from a height h above it passes it if its sine
            // is below the root of 2h/r, where h is 2e-6, and r 0.2 or more.
            let outline = visible == 1.0
                && solid.judge(&clip, &ray, Stray::default(), None) == SolidVerdict::Near;
            let towards: f32 = (0..3).map(|i| (normal[i] * 2.0 - 1.0) * light[i]).sum();
            assert!(outline || towards.abs() < 5e-3, "{name}: {ray:?} {visible} {exact:?}");
            apart += 1;
        }
    }
    println!("{lit} lit, {dark} dark, {apart} on an outline");
    assert!(lit > 500 && dark > 200 && apart < 10, "{lit} {dark} {apart}");
}
