//! Shadows on the plane and cast by it; no ray hits the plane that it leaves.

use common::scene::Sun;
use glam::Vec3;
use reference::Ray;

use super::{Octahedron, PLANE, chapter, pieces};

#[test]
fn no_ray_meets_the_plane_that_it_leaves() {
    // Far from the world's origin, the points of a tilted plane are off it by rounding.
    let model = Octahedron::out_of_sight();
    let black = ["plane specular=0", "light squares=0,0,0", "dark squares=0,0,0", "depth=1"];
    let near = ["plane distance=1", "camera eye=6.3,2.9,6.1", "camera target=0,0.5,0"];
    let far =
        ["plane distance=1e5", "camera eye=-30144,90458,30156", "camera target=-30150,90453,30150"];
    for place in [near, far] {
        let sets = ["plane normal=-1,3,1", "sun azimuth=300", "sun elevation=40"];
        let place = &[&sets[..], &place].concat()[..];
        let show = |more: &[&str]| model.picture(&[place, more].concat());
        let (hits, shadows) = (show(&["show=hit"]), show(&["show=shadow"]));
        let mirrors = show(&[&black[..], &["plane reflection=1"]].concat());
        let mut count = 0;
        for i in (0..hits.pixels.len()).filter(|&i| hits.pixels[i][0] == PLANE) {
            assert_eq!(shadows.pixels[i][0], 1.0, "{:?}", hits.pixels[i]);
            // The sky is nowhere as dark as the plane's own black.
            assert!(mirrors.pixels[i][2] > 0.2, "{:?}", mirrors.pixels[i]);
            count += 1;
        }
        println!("{count} pixels of {place:?}");
        assert!(count > 1000, "{count}");
    }
}

#[test]
fn pieces_throw_shadows_on_the_plane() {
    let exact = pieces();
    let hits = chapter().sets(&["show=hit"]).picture();
    let shadows = chapter().sets(&["show=shadow origin"]).picture();
    let sun = Sun { azimuth: 285.0, elevation: 17.0, ..Sun::default() };
    let light = sun.light().direction.to_array();
    let (mut lit, mut dark, mut edges) = (0, 0, 0);
    for (hit, &[x, y, z, visible]) in hits.pixels.iter().zip(&shadows.pixels) {
        if hit[0] != PLANE {
            continue;
        }
        let ray = Ray::from_f32([x, y, z], light, 0.0, 1e30);
        let blocked = exact.closest_hit(&ray, |_| true).is_some();
        if blocked == (visible == 0.0) {
            *if blocked { &mut dark } else { &mut lit } += 1;
        } else {
            let near = exact.near_candidates(&ray);
            assert!(near.iter().any(|near| near.may_hit(&ray) && !near.must_hit(&ray)), "{ray:?}");
            edges += 1;
        }
    }
    println!("{lit} lit, {dark} dark, {edges} at edges");
    assert!(lit > 1000 && dark > 200 && edges < 10, "{lit} {dark} {edges}");
}

#[test]
fn the_plane_throws_its_shadow_on_what_is_below() {
    // An octahedron, the plane above it, and the eye below the plane.
    let model = Octahedron::new(&[Vec3::Y]);
    let above = ["plane distance=3", "camera eye=-1,1.4,2.4", "camera target=0,1,0"];
    let hits = model.picture(&[&above[..], &["show=hit"]].concat());
    let pixels = hits.pixels.iter().filter(|hit| hit[0] >= 0.0).count();
    assert!(pixels > 2000, "{pixels}");
    let lit = |more: &[&str]| {
        let seen = model.picture(&[&above[..], &["show=shadow origin"], more].concat());
        let on_it = seen.pixels.iter().zip(&hits.pixels).filter(|(_, hit)| hit[0] >= 0.0);
        on_it.filter(|(seen, _)| seen[3] > 0.0).count()
    };
    assert_eq!(lit(&[]), 0);
    // The plane does not block a lamp below it.
    assert!(lit(&["light=point", "lamp position=-3,2,3"]) > 1000);
    assert_eq!(lit(&["light=point", "lamp position=-3,3.5,3"]), 0);
    // If rays pass from inside to outside, so do shadow rays.
    assert!(lit(&["inside=through"]) > 1000);
    assert_eq!(lit(&["inside=through", "inverse=on"]), 0);
}
