//! The look of the plane: its two sides, and the objects on and above it.

use common::scene::Camera;
use glam::DVec3;
use reference::sphere::Sphere;

use super::{Octahedron, PLANE, chapter, level};
use run::bits;
use run::primary_hits::rays;

#[test]
fn inside_and_outside_are_told_apart() {
    let model = Octahedron::out_of_sight();
    let seen = |sets: &[&str]| {
        let picture = model.picture(&[&["preset=pov", "show=hit"], sets].concat());
        let on_plane: Vec<f32> =
            picture.pixels.iter().filter(|pixel| pixel[0] == PLANE).map(|pixel| pixel[3]).collect();
        let inside = on_plane.iter().filter(|inside| **inside == 1.0).count();
        (on_plane.len() - inside, inside)
    };
    let below = "camera eye=-4.2,-5,6.4";
    let (outside, inside) = seen(&[]);
    assert!(outside > 4000 && inside == 0, "{outside} {inside}");
    assert_eq!(seen(&["inverse=on"]), (0, outside));
    let (outside, inside) = seen(&[below]);
    assert!(outside == 0 && inside > 3000, "{outside} {inside}");
    assert_eq!(seen(&[below, "inverse=on"]), (inside, 0));
    assert_eq!(seen(&[below, "inside=through"]), (0, 0));
    // The surface is the same, whichever side is the inside.
    let [plain, inverse] =
        ["inverse=off", "inverse=on"].map(|set| model.picture(&["preset=pov", set]));
    assert_eq!(bits(&plain), bits(&inverse));
    // The same plane, given by a point of it.
    let look = ["camera eye=1,3,4", "camera target=0,0,0"];
    let distance = [&look[..], &["plane distance=0.5"]].concat();
    let point = [&look[..], &["plane form=point and normal", "plane point=7,0.5,-3"]].concat();
    assert_eq!(bits(&model.picture(&distance)), bits(&model.picture(&point)));
}

#[test]
fn the_four_spheres_are_where_they_should_be() {
    let sphere = |x, y, z, radius| Sphere { center: DVec3::new(x, y, z), radius };
    let spheres = [
        sphere(-5.0, -8.0, 15.0, 4.0),
        sphere(5.0, -8.0, 15.0, 4.0),
        sphere(0.0, -8.0, 7.0, 4.0),
        sphere(0.0, 9.0, 16.0, 7.0),
    ];
    let sets = ["preset=four spheres"];
    let model = Octahedron::out_of_sight();
    let show =
        |view| chapter().size("150x150").sets(&sets).sets(&[view]).scene(model.path()).picture();
    let (hits, directions) = (show("show=hit"), show("show=ray direction"));
    let eye = DVec3::new(0.0, 0.0, -10.0);
    let camera = Camera::new(eye, DVec3::ZERO, 90.0);
    let mut seen = [0; 6];
    for (index, (ray, hit)) in rays(&camera, &directions).zip(&hits.pixels).enumerate() {
        // The window is 20 by 20 around the origin: each pixel's ray passes through the expected point.
        let (column, row) = (index % 150, index / 150);
        let window =
            DVec3::new((75.0 - column as f64 - 0.5) / 7.5, (75.0 - row as f64 - 0.5) / 7.5, 0.0);
        assert!((window - eye).normalize().distance(ray.direction) < 1e-6);
        let nearest = spheres
            .iter()
            .enumerate()
            .filter_map(|(i, sphere)| Some((sphere.intersect(&ray)?.t, i as f32)));
        let plane = level(-14.0).intersect(&ray).map(|hit| (hit.t, PLANE));
        let nearest = nearest.chain(plane).min_by(|a, b| a.0.total_cmp(&b.0));
        let (t, expected) = nearest.unwrap_or((0.0, -1.0));
        if expected != hit[0] {
            // The balls are made of triangles: less than 1/2000 of the radius is missing at the silhouette.
            let nearly = spheres.iter().any(|sphere| {
                let to = sphere.center - ray.origin;
                let impact = to.cross(ray.direction).length() / ray.direction.length();
                (impact / sphere.radius - 1.0).abs() < 5e-4
            });
            assert!(nearly, "{ray:?}: {hit:?} instead of {expected}");
            continue;
        }
        assert!(expected == -1.0 || (f64::from(hit[2]) - t).abs() < 0.1, "{hit:?} {t}");
        let place = match hit[0] {
            PLANE => 4,
            -1.0 => 5,
            ball => ball as usize,
        };
        seen[place] += 1;
    }
    println!("pixels of the three red balls, the blue one, the plane, the sky: {seen:?}");
    assert!(seen.iter().all(|count| *count > 200), "{seen:?}");
}
