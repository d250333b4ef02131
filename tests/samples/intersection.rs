//! 08_intersection: every hit compared with the reference.

mod every_hit;
mod reference_shapes;

use common::scene::{Camera, Scene, Sun};
use glam::DVec3;
use reference::Ray;
use reference::ulp::ulp_error;

use run::Chapter;
use run::primary_hits::{answer, rays};

#[path = "../../samples/08_intersection/random.rs"]
pub mod random;
#[allow(dead_code)]
#[path = "../../samples/08_intersection/scenes.rs"]
pub mod scenes;
#[allow(dead_code)]
#[path = "../../samples/08_intersection/shapes.rs"]
pub mod shapes;

pub use every_hit::{Bound, Hits};
pub use reference_shapes::ReferenceShapes;
use scenes::SceneKind;

const NAME: &str = "08_intersection";
const SIZE: &str = "120x75";
/// The relative error of one rounding to f32.
const U: f64 = 1.0 / 16_777_216.0;

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// The first `count` shapes of the grid.
fn grid(count: u32) -> ReferenceShapes {
    ReferenceShapes::new(|model, pieces| scenes::shapes(SceneKind::Grid, count, model, pieces))
}

/// An error bound of the formula in `sphere.rint`.
///
/// With a unit direction and D the distance to the centre, b is off by 3u·D, so b² by 7u·D²; a·c is off by 8u·D²,
/// and their difference by 16u·D² with its own rounding. Half of the chord is the root of that difference.
fn textbook(exact: &ReferenceShapes, ray: &Ray, (_, id): (u32, u32)) -> Bound {
    let sphere = exact.spheres[id as usize];
    let f = ray.origin - sphere.center;
    let unit = ray.direction.normalize();
    let error = 16.0 * U * f.length_squared();
    let half_chord = (sphere.radius.powi(2) - f.cross(unit).length_squared()).max(0.0).sqrt();
    let along = (error / half_chord).min((2.0 * error).sqrt()) + 8.0 * U * f.length();
    Bound { along, across: error / sphere.radius }
}

#[test]
fn every_hit_of_the_grid_is_the_reference_s() {
    let (exact, camera) =
        (grid(10_000), scenes::camera(SceneKind::Grid, Camera::default(), 10_000));
    let [hits, directions] = ["hit", "ray direction"]
        .map(|show| chapter(SIZE).set("scene", "grid").set("show", show).picture());
    let bound = |ray: &Ray, id: (u32, u32)| {
        let far = ray.origin.length() + 25.0;
        let division = Bound { along: 8.0 * U * far, across: 8.0 * U * far };
        if id.0 == exact.first { textbook(&exact, ray, id) } else { division }
    };
    let found = Hits::compare(&exact, &camera, [&hits, &directions], bound);
    let mut counts = [0; 2];
    for (ray, id, t, exact_t) in &found.same {
        let is_box = id.0 != exact.first;
        counts[usize::from(is_box)] += 1;
        if is_box {
            let error = ulp_error(*t, *exact_t);
            assert!(error <= 4.0, "{ray:?}: {error} ULP");
        } else {
            let (error, bound) = ((f64::from(*t) - exact_t).abs(), textbook(&exact, ray, *id));
            assert!(error <= bound.along, "{ray:?}: {error}, bound {}", bound.along);
        }
    }
    println!("{counts:?} hits with spheres, boxes");
    assert!(counts.iter().all(|&count| count > 150), "{counts:?}");
    assert!(found.outlines + found.ties < 10, "{} {}", found.outlines, found.ties);
}

#[test]
fn hit_kinds_tell_spheres_boxes_and_triangles() {
    let first = Scene::chess().unwrap().instances.len() as f32;
    let (hits, kinds) = (
        chapter(SIZE).sets(&["show=hit"]).picture(),
        chapter(SIZE).sets(&["show=hit kind"]).picture(),
    );
    let mut counts = [0; 3];
    for (hit, kind) in hits.pixels.iter().zip(&kinds.pixels) {
        let expected = match hit[0] {
            miss if miss < 0.0 => &[-1.0][..],
            mesh if mesh < first => &[254.0, 255.0],
            sphere if sphere == first => &[0.0],
            _ => &[1.0],
        };
        assert!(expected.contains(&kind[3]), "{hit:?}: {kind:?}");
        // A sphere is black, the colour of kind 0; the sky is not.
        let is_black = kind[..3] == [0.0; 3];
        assert_eq!(is_black, kind[3] == 0.0, "{hit:?}: {kind:?}");
        if hit[0] >= 0.0 {
            counts[(hit[0] - first + 1.0).max(0.0) as usize] += 1;
        }
    }
    println!("{counts:?} pixels of triangles, spheres, boxes");
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
}

#[test]
fn attributes_are_those_of_the_nearest_hit() {
    let exact = grid(1000);
    let camera = scenes::camera(SceneKind::Grid, Camera::default(), 1000);
    let [hits, directions, normals] = ["hit", "ray direction", "normal"]
        .map(|view| chapter(SIZE).sets(&["scene=grid", "count=1000"]).set("show", view).picture());
    let mut checked = 0;
    let pixels = rays(&camera, &directions).zip(&hits.pixels).zip(&normals.pixels);
    for ((ray, hit), &[x, y, z, _]) in pixels {
        let Some(hit) = answer(hit) else { continue };
        let shown = DVec3::new(x.into(), y.into(), z.into()) * 2.0 - 1.0;
        let place = hit.primitive as usize;
        // A sphere's normal turns by the error of t over the radius; a unit vector is off by less than 32u.
        let (normal, turned) = if hit.instance == exact.first {
            let sphere = exact.spheres[place];
            let bound = textbook(&exact, &ray, (hit.instance, hit.primitive));
            (sphere.intersect(&ray).map(|hit| hit.normal), bound.along / sphere.radius)
        } else {
            (exact.boxes[place].intersect(&ray).map(|hit| hit.normal), 0.0)
        };
        let outline = shown.dot(ray.direction).abs() < 0.05;
        let error = normal.map(|normal| (shown - normal).length());
        let right = error.is_some_and(|error| error <= turned + 32.0 * U);
        assert!(right || outline, "{hit:?} {ray:?}: {shown}, {normal:?}");
        checked += 1;
    }
    assert!(checked > 2000, "{checked}");
}

#[test]
fn from_inside_the_far_side_is_hit() {
    let look = ["camera target=0,0,0", "field of view=90"];
    for (count, eye) in
        [(1, DVec3::new(0.0625, -0.03125, 0.125)), (8, DVec3::new(0.6, -0.45, -0.4))]
    {
        let exact = grid(count);
        let (count, at) =
            (format!("count={count}"), format!("camera eye={},{},{}", eye.x, eye.y, eye.z));
        let sets = [&["scene=grid", &count, &at, "show=ray direction"], &look[..]].concat();
        let picture = chapter("40x25").sets(&sets).picture();
        let camera = Camera::new(eye, DVec3::ZERO, 90.0);
        for (ray, pixel) in rays(&camera, &picture).zip(&picture.pixels) {
            assert!(pixel[3] >= 0.0, "a wall all around");
            let (_, t) = exact.closest(&ray).expect("a wall all around");
            let error = ulp_error(pixel[3], t);
            assert!(error <= 8.0, "{count}: {error} ULP on {ray:?}");
        }
    }
}

#[test]
fn no_shape_shadows_itself() {
    let exact = grid(10_000);
    let sets = ["scene=grid", "sun elevation=35", "sun azimuth=75"];
    let hits = chapter(SIZE).sets(&sets).sets(&["show=hit"]).picture();
    let origins = chapter(SIZE).sets(&sets).sets(&["show=shadow origin"]).picture();
    let sun = Sun { azimuth: 75.0, elevation: 35.0, ..Sun::default() };
    let direction = sun.light().direction;
    let (mut lit, mut dark, mut grazes) = (0, 0, 0);
    for (hit, &[x, y, z, seen]) in hits.pixels.iter().zip(&origins.pixels).step_by(5) {
        let Some(hit) = answer(hit) else { continue };
        let ray = Ray::from_f32([x, y, z], direction.to_array(), 0.0, 1e30);
        let own = (hit.instance, hit.primitive);
        let outward = if own.0 == exact.first {
            let sphere = exact.spheres[own.1 as usize];
            let height = (ray.origin - sphere.center).length() - sphere.radius;
            assert!(height > 0.0 && height < 1e-4, "{height}");
            (ray.origin - sphere.center).normalize()
        } else {
            let aabb = exact.boxes[own.1 as usize];
            assert!(!aabb.contains_exact(&ray.origin.into()), "{ray:?}");
            let off = (ray.origin - aabb.low).min(aabb.high - ray.origin);
            DVec3::from_array(std::array::from_fn(|i| {
                let middle = (aabb.low + aabb.high) / 2.0;
                if off[i] < 0.0 { (ray.origin - middle)[i].signum() } else { 0.0 }
            }))
        };
        if outward.dot(ray.direction) < 1e-6 {
            continue;
        }
        let others = || exact.near(&ray).into_iter().filter(|id| *id != own);
        let across = |id: (u32, u32)| {
            if id.0 == exact.first { textbook(&exact, &ray, id).across } else { 8.0 * U * 40.0 }
        };
        let may_be_dark = others().any(|id| exact.grown(&ray, id, across(id)).is_some());
        let may_be_lit = !others().any(|id| exact.grown(&ray, id, -across(id)).is_some());
        assert!(if seen == 1.0 { may_be_lit } else { may_be_dark }, "{own:?} {ray:?}: {seen}");
        grazes += usize::from(may_be_dark && may_be_lit);
        if seen == 1.0 { lit += 1 } else { dark += 1 }
    }
    println!("{lit} lit, {dark} dark, {grazes} at outlines");
    assert!(lit > 200 && dark > 50 && grazes < 10, "{lit} {dark} {grazes}");
}
