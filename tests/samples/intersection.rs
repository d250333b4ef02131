//! 08_intersection: every hit held to the reference, and what each rung and the margin are worth.

mod errors;
mod plots;
mod reference_shapes;
mod rungs;

use common::gpu::ShaderEnum;
use common::scene::{Camera, Scene, Sun};
use glam::DVec3;
use reference::Ray;

use run::Chapter;
use run::primary_hits::{answer, rays};

#[path = "../../samples/08_intersection/random.rs"]
pub mod random;
#[allow(dead_code)]
#[path = "../../samples/08_intersection/shapes.rs"]
pub mod shapes;

use errors::Errors;
use reference_shapes::ReferenceShapes;
use shapes::SceneKind;

const NAME: &str = "08_intersection";
const SIZE: &str = "120x75";
/// The relative error of one rounding to f32.
const U: f64 = 1.0 / 16_777_216.0;

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// Holds every seventh ray of a scene with many shapes to the exact nearest hit.
fn every_hit_agrees(scene: SceneKind, count: u32, sets: &[&str]) {
    let exact = ReferenceShapes::new(scene, count);
    let camera = shapes::camera(scene, Camera::default(), count, 0.0);
    let name = format!("scene={}", SceneKind::LAYOUT.words[scene as usize]);
    let sets = [&[name.as_str()], sets].concat();
    let hits = chapter(SIZE).sets(&sets).sets(&["show=hit"]).picture();
    let directions = chapter(SIZE).sets(&sets).sets(&["show=ray direction"]).picture();
    let (mut spheres, mut boxes) = (Errors::default(), Errors::default());
    let (mut grazes, mut ties) = (0, 0);
    for (ray, pixel) in rays(&camera, &directions).zip(&hits.pixels).step_by(7) {
        let found = answer(pixel).map(|hit| ((hit.instance, hit.primitive), hit.t));
        let closest = exact.closest(&ray);
        if let (Some((id, t)), Some((exact_id, exact_t))) = (found, closest)
            && id == exact_id
        {
            let of_kind = if id.0 == exact.first { &mut spheres } else { &mut boxes };
            of_kind.add(Some(t), Some(exact_t));
            continue;
        }
        // Otherwise two surfaces at one distance, or an outline: within what 32 bits can tell, which
        // is 8u of the distance across the ray.
        if found.is_none() && closest.is_none() {
            continue;
        }
        let own = |id| exact.hit(&ray, id);
        if let (Some((id, _)), Some((_, exact_t))) = (found, closest)
            && own(id).is_some_and(|t| (t - exact_t).abs() <= 8.0 * U * exact_t)
        {
            ties += 1;
            continue;
        }
        let across = 8.0 * U * (ray.origin.length() + 25.0);
        let may_hit = found.is_none_or(|(id, _)| exact.grown(&ray, id, across).is_some());
        let missed = closest.filter(|(id, _)| found.is_none_or(|found| found.0 != *id));
        let nearer = missed.filter(|(_, t)| found.is_none_or(|found| *t < found.1.into()));
        let may_miss = nearer.is_none_or(|(id, _)| exact.grown(&ray, id, -across).is_none());
        assert!(may_hit && may_miss, "{ray:?}: found {found:?}, exact {closest:?}");
        grazes += 1;
    }
    for (kind, errors) in [("spheres", &spheres), ("boxes", &boxes)] {
        if errors.rays == 0 {
            continue;
        }
        println!("{sets:?}, {kind}: {} hits, {}", errors.ulp.len(), errors.row());
        assert!(errors.at(0.99) <= 4.0, "{kind}: {}", errors.row());
    }
    println!("{grazes} at outlines, {ties} ties");
    assert!(spheres.ulp.len() > 150 && grazes + ties < 10, "{grazes} {ties}");
    if scene == SceneKind::Grid {
        // The division's bar holds for the worst ray.
        assert!(boxes.ulp.len() > 150 && boxes.at(1.0) <= 4.0, "{}", boxes.row());
    }
}

#[test]
fn every_hit_of_the_grid_is_the_reference_s() {
    every_hit_agrees(SceneKind::Grid, 10_000, &[]);
}

#[test]
fn every_hit_of_the_random_ball_is_the_reference_s() {
    for rung in ["projection", "stable"] {
        every_hit_agrees(SceneKind::RandomBall, 1024, &[&format!("sphere rung={rung}")]);
    }
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
    let exact = ReferenceShapes::new(SceneKind::Grid, 1000);
    let camera = shapes::camera(SceneKind::Grid, Camera::default(), 1000, 0.0);
    let [hits, directions, normals] = ["hit", "ray direction", "normal"]
        .map(|view| chapter(SIZE).sets(&["scene=grid", "count=1000"]).set("show", view).picture());
    let mut checked = 0;
    let pixels = rays(&camera, &directions).zip(&hits.pixels).zip(&normals.pixels);
    for ((ray, hit), &[x, y, z, _]) in pixels {
        let Some(hit) = answer(hit) else { continue };
        let shown = DVec3::new(x.into(), y.into(), z.into()) * 2.0 - 1.0;
        let normal = if hit.instance == exact.first {
            exact.spheres[hit.primitive as usize].intersect(&ray).map(|hit| hit.normal)
        } else {
            exact.boxes[hit.primitive as usize].intersect(&ray).map(|hit| hit.normal)
        };
        // t is off by few ULP, and a normal turns by that over the radius; 1e-4 is 10 times that.
        let error = (shown - normal.expect("a hit")).length();
        let outline = shown.dot(ray.direction).abs() < 0.05;
        assert!(error < 1e-4 || outline, "{hit:?} {ray:?}: {shown}, {normal:?}");
        checked += 1;
    }
    assert!(checked > 2000, "{checked}");
}

#[test]
fn no_shape_shadows_itself() {
    let exact = ReferenceShapes::new(SceneKind::Grid, 10_000);
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
        let across = 8.0 * U * 40.0;
        let may_be_dark = others().any(|id| exact.grown(&ray, id, across).is_some());
        let may_be_lit = !others().any(|id| exact.grown(&ray, id, -across).is_some());
        assert!(if seen == 1.0 { may_be_lit } else { may_be_dark }, "{own:?} {ray:?}: {seen}");
        grazes += usize::from(may_be_dark && may_be_lit);
        if seen == 1.0 { lit += 1 } else { dark += 1 }
    }
    println!("{lit} lit, {dark} dark, {grazes} at outlines");
    assert!(lit > 200 && dark > 50 && grazes < 10, "{lit} {dark} {grazes}");
}

/// A grain may be smaller than the rounding of its hit.
#[test]
fn dust_has_a_normal_everywhere() {
    for show in ["picture", "normal", "shadow origin"] {
        let show = format!("show={show}");
        let picture = chapter(SIZE).sets(&["scene=dust", &show]).picture();
        assert!(picture.pixels.iter().flatten().all(|value| value.is_finite()), "{show}");
    }
}
