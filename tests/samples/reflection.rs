//! 06_reflection: a loop and recursion that agree, and mirrors.

mod plots;

use common::app::Picture;
use common::gpu::{Gpu, GpuOptions, RayTracingPipeline, Requirements};
use common::scene::{Scene, Sun};
use glam::{DVec3, Vec3};
use reference::Ray;
use serde_json::json;

use run::leaving::{Leaving, Tally};
use run::primary_hits::{answer, rays, reference};
use run::{Chapter, bits, expected, refused, render, same_answers, same_colors, shaders_with};

const NAME: &str = "06_reflection";
const SIZE: &str = "120x75";

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

fn gpu() -> Gpu {
    let requirements = Requirements::ray_tracing().textures();
    Gpu::new(&GpuOptions { requirements, ..GpuOptions::default() }).unwrap()
}

/// Returns whether shaders may trace rays from a hit, as recursion requires; prints a message if not.
fn nests() -> bool {
    let limit = gpu().limits.max_ray_recursion_depth;
    if limit < 10 {
        println!(
            "not tried: the device allows a recursion depth of {limit}, less than the 10 of this test"
        );
    }
    limit >= 10
}

#[test]
fn a_loop_and_recursion_give_the_same_picture() {
    loop_and_recursion_agree(&[0, 1, 2, 8]);
}

#[test]
#[ignore = "nightly: every depth; quick: reflection::a_loop_and_recursion_give_the_same_picture"]
fn a_loop_and_recursion_give_the_same_picture_at_every_depth() {
    loop_and_recursion_agree(&[0, 1, 2, 3, 4, 5, 6, 7, 8]);
}

fn loop_and_recursion_agree(depths: &[u32]) {
    if !nests() {
        return;
    }
    let mut last: Option<Picture> = None;
    for depth in depths.iter().map(|depth| format!("depth={depth}")) {
        let run = |method: &str| {
            let sets = ["--set", &depth, "--set", method, "--set", "minimum contribution=0"];
            render(NAME, SIZE, &sets)
        };
        let (iterative, recursive) = (run("method=iterative"), run("method=recursive"));
        // The two perform the same operations in the same order.
        same_colors(&depth, NAME, &iterative.picture, &recursive.picture);
        // Even the last reflection is visible somewhere; otherwise the comparison would be vacuous.
        if let Some(last) = &last {
            assert_ne!(bits(last), bits(&iterative.picture), "{depth} changes nothing");
        }
        last = Some(iterative.picture);
    }
}

#[test]
fn a_shadow_ray_changes_nothing_of_what_a_hit_is() {
    let asks = "visible = visibility(start, push.light.direction, 1e30);";
    let without = shaders_with("06_reflection/path.glsl", asks, "");
    let methods = ["method=iterative", "method=recursive"];
    for method in methods.into_iter().take(if nests() { 2 } else { 1 }) {
        let sets = ["show=hit", "bounce=1", method];
        let off = chapter(SIZE).shaders(without.path()).sets(&sets).picture();
        same_answers(method, NAME, &off, &chapter(SIZE).sets(&sets).picture());
    }
}

#[test]
fn a_depth_beyond_the_device_s_limit_is_refused() {
    let (code, line) = refused(NAME, &["--headless", "--set", "depth=9"]);
    assert_eq!(code, 2);
    assert!(line.contains("'depth' cannot be '9': it takes a whole number from 0 to 8"), "{line}");
    // Every device here supports 10 or more, so the control never exceeds it, and the check is called
    // directly.
    let gpu = gpu();
    let limit = gpu.limits.max_ray_recursion_depth;
    let builder = RayTracingPipeline::builder(NAME).raygen("camera.rgen").recursion(limit + 1);
    let error = builder.build(&gpu).err().expect("deeper than allowed").to_string();
    let expected = format!("needs a recursion depth of {}; {} allows {limit}", limit + 1, gpu.name);
    assert!(error.contains(&expected), "{error}");
}

#[test]
fn rays_are_reflected_as_they_should_and_dropped_where_they_may() {
    const MINIMUM: f32 = 0.1;
    let scene = Scene::chess_of_metal().unwrap();
    let exact = reference(&scene);
    let show =
        |sets: &[&str]| chapter(SIZE).sets(&["minimum contribution=0.1"]).sets(sets).picture();
    let [hits, directions, normals] =
        ["hit", "ray direction", "normal"].map(|view| show(&[&format!("show={view}")]));
    let reflected = show(&["show=ray direction", "bounce=1"]);
    let (mut traced, mut dropped, mut turned) = (0, 0, 0);
    for (i, ray) in rays(&scene.camera, &directions).enumerate() {
        let [x, y, z, _] = reflected.pixels[i];
        let on = Vec3::new(x, y, z);
        let Some(hit) = answer(&hits.pixels[i]) else {
            assert_eq!(on, Vec3::ZERO, "the sky reflects");
            continue;
        };
        let material = &scene.model.materials[scene.instances[hit.instance as usize].material];
        if material.illumination < 3 {
            assert_eq!(on, Vec3::ZERO, "{} reflects", material.name);
            continue;
        }
        let [x, y, z, _] = normals.pixels[i];
        let normal = 2.0 * Vec3::new(x, y, z) - 1.0;
        let direction = ray.direction.as_vec3();
        // Schlick's formula; the view is rounded, so near the minimum either answer is right.
        let (head_on, cosine) = (material.specular, -normal.dot(direction).min(0.0));
        let mirror = head_on + (1.0 - head_on) * (1.0 - cosine).powi(5);
        if (mirror.max_element() - MINIMUM).abs() < 1e-5 {
            continue;
        }
        assert_eq!(on != Vec3::ZERO, mirror.max_element() > MINIMUM, "{mirror} at {ray:?}");
        if on == Vec3::ZERO {
            dropped += 1;
            continue;
        }
        traced += 1;
        let [a, b, c] = *exact.triangle(hit.instance, hit.primitive).unwrap();
        let up = (b - a).cross(c - a).normalize().as_vec3();
        let up = -up * up.dot(direction).signum();
        let mut expected = direction - 2.0 * direction.dot(normal) * normal;
        let below = expected.dot(up).min(0.0);
        turned += usize::from(below < 0.0);
        expected -= 2.0 * below * up;
        assert!((on - expected.normalize()).length() < 1e-5, "{on} not {expected} at {ray:?}");
        // Beyond the rounding of a dot product and of the normal, none enters its triangle.
        assert!(on.dot(up) > -1e-6, "{on} enters the triangle of {up}");
    }
    println!("{traced} reflected, {turned} of them at the triangle, {dropped} dropped");
    assert!(traced > 200 && dropped > 2000 && turned > 0, "{traced} {dropped} {turned}");
}

#[test]
fn no_ray_hits_what_it_left_or_passes_what_stands_there() {
    let scene = Scene::chess_of_metal().unwrap();
    let exact = reference(&scene);
    // A reflected ray starts where the shadow ray of the same hit does.
    let show =
        |sets: &[&str]| chapter("240x150").sets(&["minimum contribution=0"]).sets(sets).picture();
    let [hits, starts] = ["show=hit", "show=shadow origin"].map(|view| show(&[view]).pixels);
    let directions = show(&["show=ray direction"]);
    let [on, found] =
        ["show=ray direction", "show=hit"].map(|view| show(&[view, "bounce=1"]).pixels);
    let sun = Sun { azimuth: 340.0, elevation: 20.0, ..Sun::default() };
    let light = sun.light().direction.to_array();
    let [mut mirrored, mut shadows] = [(); 2].map(|()| Tally::default());
    for (i, arriving) in rays(&scene.camera, &directions).enumerate() {
        let Some(hit) = answer(&hits[i]) else { continue };
        let [x, y, z, visible] = starts[i];
        let [a, b, c, _] = on[i];
        let ray = Ray::from_f32([x, y, z], [a, b, c], 0.0, 1e30);
        if ray.direction != DVec3::ZERO {
            let leaving = Leaving::new(&exact, &arriving, &hit, &ray);
            mirrored.add(&leaving, &ray, |leaving| leaving.nearest(answer(&found[i])));
        }
        let ray = Ray::from_f32([x, y, z], light, 0.0, 1e30);
        let leaving = Leaving::new(&exact, &arriving, &hit, &ray);
        // The shader knows without a ray that a light below the surface is blocked.
        if leaving.steepness() > 0.0 {
            shadows.add(&leaving, &ray, |leaving| leaving.any(visible == 0.0));
        }
    }
    let both =
        json!({ "rays": mirrored.rays + shadows.rays, "lost": mirrored.lost + shadows.lost });
    expected::hold("06_reflection/mirrored", mirrored.values());
    expected::hold("06_reflection/shadows", shadows.values());
    expected::hold("06_reflection/both", both);
    for tally in [mirrored, shadows] {
        println!("{tally}");
        // The height of a sliver exceeds the reference's tolerance; 26 has a smaller one.
        assert_eq!((tally.self_hits, tally.lost - tally.slivers), (0, 0), "{:?}", tally.first);
        assert!(tally.rays > 10_000 && tally.slivers * 1000 < tally.rays, "{tally}");
        assert!(tally.close * 8 < tally.rays, "{tally}");
    }
}
