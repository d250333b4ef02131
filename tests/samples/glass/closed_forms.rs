//! A slab, a ball and a prism, for which the exit of a ray is known.

use common::app::Picture;
use common::scene::Camera;
use glam::DVec3;
use run::expected;
use serde_json::json;

use super::{U, chapter};

/// The index of all three bodies.
const INDEX: f64 = 1.5;

/// The camera's rays, through the middles of a picture's pixels.
fn rays(camera: &Camera, size: (u32, u32)) -> Vec<(DVec3, DVec3)> {
    let basis = camera.basis(f64::from(size.0) / f64::from(size.1));
    let [origin, right, up, forward] =
        [basis.origin, basis.right, basis.up, basis.forward].map(|v| v.as_dvec3());
    let along = |i: u32, n: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0;
    let ray = |i: u32| {
        let (x, y) = (along(i % size.0, size.0), along(i / size.0, size.1));
        (origin, (forward + x * right - y * up).normalize())
    };
    (0..size.0 * size.1).map(ray).collect()
}

/// The last rays of a picture's paths, and the number of rays of each path.
fn last_rays(size: &str, sets: &[&str]) -> Vec<(DVec3, DVec3, u32)> {
    let show = |show: &str| chapter(size).frames(1).sets(sets).sets(&[show]).picture();
    let [origins, directions] = ["show=last origin", "show=last direction"].map(show);
    let vector = |p: &[f32; 4]| DVec3::new(p[0].into(), p[1].into(), p[2].into());
    let pixels = |p: &Picture| p.pixels.clone();
    let both = pixels(&origins).into_iter().zip(pixels(&directions));
    both.map(|(o, d)| (vector(&o), vector(&d), o[3] as u32)).collect()
}

/// Snell's law, in f64.
fn bent(direction: DVec3, normal: DVec3, from: f64, to: f64) -> DVec3 {
    let q = -from * direction.dot(normal);
    let p = ((to - from) * (to + from) + q * q).sqrt();
    (from * direction + (q - p) * normal).normalize()
}

#[test]
fn a_slab_moves_a_ray_aside_and_turns_it_by_nothing() {
    let camera = Camera::new(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, 40.0);
    let normal = DVec3::new(f64::from(0.5f32).sin(), 0.0, f64::from(0.5f32).cos());
    let (mut turned, mut off, mut aside) = (0f64, 0f64, 0f64);
    let last = last_rays("64x40", &["scene=slab"]);
    for ((eye, ray), (origin, direction, count)) in rays(&camera, (64, 40)).into_iter().zip(last) {
        // The camera's, one inside the slab, and one behind it: no ray hits the surface it left.
        assert_eq!(count, 3, "rays of {ray}");
        let cosine = -ray.dot(normal);
        let sine = (1.0 - cosine * cosine).sqrt();
        let within = (1.0 - (sine / INDEX).powi(2)).sqrt();
        let expected = sine * (1.0 - cosine / (INDEX * within));
        let moved = (origin - eye).cross(ray).length();
        aside = aside.max(expected);
        turned = turned.max((direction - ray).length() / U);
        // Each start is off its surface by the bound of 05, and this is the distance of the second. The rest
        // is rounding of coordinates as large as the path.
        let way = (origin - eye).length();
        let height = -origin.dot(normal) - 0.5;
        let error = (moved - expected).abs();
        assert!(height > 0.0 && error < 3.0 * height + 16.0 * U * way, "{error} {height}");
        off = off.max(error / (U * way));
    }
    println!("up to {aside:.3} aside, off by {off:.1} u of the way; turned by {turned:.1} u");
    // The ray and two refractions of 8 u each.
    assert!(turned < 24.0, "{turned}");
    expected::hold("27_glass/slab", json!({ "aside": aside, "off": off, "turned": turned }));
}

/// The point where a ray passes closest to the z axis.
fn crossing(origin: DVec3, direction: DVec3) -> f64 {
    let (o, d) = (origin.truncate(), direction.truncate());
    origin.z - direction.z * o.dot(d) / d.dot(d)
}

/// The path of a ray through the unit ball around the origin.
fn through_ball(origin: DVec3, direction: DVec3) -> (DVec3, DVec3) {
    let to_middle = -origin.dot(direction);
    let aside = origin + to_middle * direction;
    let first = aside - (1.0 - aside.length_squared()).sqrt() * direction;
    let within = bent(direction, first, 1.0, INDEX);
    let second = first - 2.0 * first.dot(within) * within;
    (second, bent(within, -second, INDEX, 1.0))
}

#[test]
fn a_ball_has_its_focal_length() {
    // The closed form: nR / 2(n - 1) from the middle, for rays close to the axis.
    let (origin, direction) = through_ball(DVec3::new(1e-5, 0.0, 3.0), DVec3::NEG_Z);
    let focal = INDEX / (2.0 * (INDEX - 1.0));
    assert!((crossing(origin, direction) + focal).abs() < 1e-9);

    let camera = Camera::new(DVec3::new(0.0, 0.0, 1000.0), DVec3::ZERO, 0.02);
    let last = last_rays("64x40", &["scene=ball"]);
    let (mut worst, mut nearest) = (0f64, (f64::INFINITY, 0.0, 0.0));
    for ((eye, ray), (origin, direction, count)) in rays(&camera, (64, 40)).into_iter().zip(last) {
        assert_eq!(count, 3, "rays of {ray}");
        let height = (eye - eye.z / ray.z * ray).length();
        if height < 0.05 {
            continue;
        }
        let exact = through_ball(eye, ray);
        let (shown, expected) = (crossing(origin, direction), crossing(exact.0, exact.1));
        worst = worst.max((shown - expected).abs());
        if height < nearest.0 {
            nearest = (height, -shown, -expected);
        }
    }
    // The normals are those of the ball, and the triangles are below it by their sagitta at most: half a
    // diagonal of a square of side 2 pi/512. Each surface turns the ray by half of the total, and the more the
    // closer it is to the middle: the crossing, 1.5 away, moves by at most 1.5 sagittae.
    let sagitta = (std::f64::consts::TAU / 512.0).powi(2) / 4.0;
    println!("at most {worst:.2e} off, sagitta {sagitta:.2e}; nearest {nearest:?}");
    assert!(worst < 1.6 * sagitta + 64.0 * U / 0.05, "{worst}");
    expected::hold(
        "27_glass/ball",
        json!({ "off": worst, "sagitta": sagitta, "crossing": nearest.1, "exact": nearest.2 }),
    );
}

#[test]
fn a_prism_deviates_by_its_least_angle_and_never_by_less() {
    let least = 2.0 * (INDEX * 0.5).asin() - std::f64::consts::FRAC_PI_3;
    let camera = Camera::new(DVec3::new(4.99, 0.0, -1.45), DVec3::new(0.25, 0.0, 0.144), 5.0);
    let mut found = f64::INFINITY;
    let last = last_rays("96x60", &["scene=prism"]);
    let mut passed = 0;
    for ((_, ray), (_, direction, count)) in rays(&camera, (96, 60)).into_iter().zip(last) {
        if count != 3 || (direction - ray).length() < 1e-3 {
            continue;
        }
        passed += 1;
        // The chord is accurate for small and large angles.
        found = found.min(2.0 * (0.5 * (direction - ray).length()).asin());
    }
    println!(
        "{passed} rays, least {:.6}°, closed form {:.6}°",
        found.to_degrees(),
        least.to_degrees()
    );
    assert!(passed > 2000);
    // Less by rounding; more because the next pixel may be 1/2 pixel away in both directions, and the angle
    // is a parabola there.
    let pixel = (5f64.to_radians() / 60.0) * 0.5;
    assert!(found > least - 32.0 * U && found < least + 4.0 * pixel * pixel, "{found} {least}");
    expected::hold(
        "27_glass/prism",
        json!({ "found": found.to_degrees(), "closed": least.to_degrees() }),
    );
}

#[test]
fn a_camera_within_the_ball_sees_what_refraction_lets_in() {
    let camera = Camera::new(DVec3::new(0.5, 0.0, 0.0), DVec3::new(0.5, 0.0, -1.0), 60.0);
    let sets = ["scene=ball", "camera eye=0.5,0,0", "camera target=0.5,0,-1", "field of view=60"];
    let mut worst = 0f64;
    let last = last_rays("32x20", &sets);
    for ((eye, ray), (_, direction, count)) in rays(&camera, (32, 20)).into_iter().zip(last) {
        assert_eq!(count, 2, "rays of {ray}");
        let along = eye.dot(ray);
        let place = eye + (-along + (along * along + 1.0 - eye.length_squared()).sqrt()) * ray;
        worst = worst.max((direction - bent(ray, -place, INDEX, 1.0)).length());
    }
    println!("off by {worst:.2e}");
    // The position is off by the sagitta, and so is the normal.
    assert!(worst < 8.0 * (std::f64::consts::TAU / 512.0).powi(2) / 4.0, "{worst}");
}

/// The sky by day, of common/shade.glsl: its mean over the colours.
fn sky(direction: DVec3) -> f64 {
    let mean = |color: [f64; 3]| color.iter().sum::<f64>() / 3.0;
    let (horizon, y) = (mean([0.84, 0.87, 0.90]), direction.y);
    let (other, part) = if y > 0.0 {
        (mean([0.23, 0.38, 0.62]), y.sqrt())
    } else {
        let x = (-y / 0.45).min(1.0);
        (mean([0.20, 0.245, 0.29]), x * x * (3.0 - 2.0 * x))
    };
    horizon + part * (other - horizon)
}

#[test]
fn a_pane_shows_the_sky_behind_it_and_mirrors_the_sky_above() {
    const FRAMES: u32 = 256;
    let camera = Camera::new(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, 40.0);
    let normal = DVec3::new(0.0, 1.2f64.sin(), 1.2f64.cos());
    let shown = chapter("64x40").frames(FRAMES).sets(&["scene=pane"]).picture();
    let (mut off, mut variance, mut mirrored, mut count) = (0.0, 0.0, 0.0, 0.0);
    for ((eye, ray), pixel) in rays(&camera, (64, 40)).into_iter().zip(&shown.pixels) {
        let cosine = -ray.dot(normal);
        let on = eye + ray * (eye.dot(normal) / cosine);
        // Not if the edge of the pane or the horizon goes through the pixel.
        if on.x.abs() > 4.8 || on.cross(normal).x.abs() > 4.8 || ray.y.abs() < 0.02 {
            continue;
        }
        let within = (1.0 - (1.0 - cosine * cosine) / (INDEX * INDEX)).sqrt();
        let across = (cosine - INDEX * within) / (cosine + INDEX * within);
        let along = (INDEX * cosine - within) / (INDEX * cosine + within);
        // Each polarisation bounces between the sides separately.
        let sheet = |one: f64| 2.0 * one / (1.0 + one);
        let part = 0.5 * (sheet(across * across) + sheet(along * along));
        let (behind, above) = (sky(ray), sky(ray + 2.0 * cosine * normal));
        let value = pixel[..3].iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0;
        off += value - (behind + part * (above - behind));
        // A sample follows one of the two.
        variance += part * (1.0 - part) * (above - behind).powi(2) / f64::from(FRAMES);
        mirrored += part;
        count += 1.0;
    }
    let (off, confidence) = (off / count, 4.0 * f64::sqrt(variance) / count);
    println!(
        "{count} pixels, {:.3} mirrored: off by {off:.6}, ± {confidence:.6}",
        mirrored / count
    );
    // The test would detect a sheet with only one side, whose part would be nearly half as large.
    assert!(count > 1000.0 && mirrored / count > 0.1, "{count} {mirrored}");
    assert!(off.abs() < confidence, "{off}, not within {confidence}");
}
