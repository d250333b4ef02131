//! 27's ray through glass, compared with Snell's and Fresnel's laws in textbook form, and with exact balls.

use glam::DVec2;
use reference::Ray;
use reference::sphere::Sphere;
use serde_json::Value;

use super::{found, shown};
use crate::browser::Browser;
use crate::reading::address;

pub const PAGE: &str = "27_glass.html";

/// The length of a ray that leaves the glass.
const FAR: f64 = 1000.0;

/// A body in the figure: its corners, or a ball's middle and radius.
struct Body {
    corners: Vec<DVec2>,
    middle: DVec2,
    radius: f64,
}

impl Body {
    /// The point where a ray hits the body, and the normal on the ray's side; for an edge, by crossing lines.
    fn met(&self, origin: DVec2, d: DVec2, inside: bool) -> Option<(f64, DVec2)> {
        // No ray hits the surface it leaves.
        let far = |t: f64| t > 1e-6;
        if self.radius > 0.0 {
            let sphere = Sphere { center: self.middle.extend(0.0), radius: self.radius };
            // A ray from inside starts on the ball, so the exact one starts farther back.
            let back = if inside { -FAR } else { 0.0 };
            let origin = (origin + back * d).extend(0.0);
            let ray = Ray { origin, direction: d.extend(0.0), tmin: 0.0, tmax: f64::INFINITY };
            let first = sphere.intersect_exact(&ray)?.to_f64().t;
            let foot = (self.middle.extend(0.0) - origin).dot(d.extend(0.0));
            let t = back + if inside { 2.0 * foot - first } else { first };
            let normal = (ray.origin + (t - back) * ray.direction - sphere.center).normalize();
            return far(t).then(|| (t, DVec2::new(normal.x, normal.y)));
        }
        let edges = (0..self.corners.len()).filter_map(|i| {
            let from = self.corners[i];
            let edge = self.corners[(i + 1) % self.corners.len()] - from;
            let (area, away) = (d.perp_dot(edge), from - origin);
            let along = away.perp_dot(d) / area;
            let t = away.perp_dot(edge) / area;
            let normal = edge.perp().normalize();
            (far(t) && (0.0..=1.0).contains(&along))
                .then(|| (t, normal * normal.dot(from - self.middle).signum()))
        });
        edges.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// The angle behind a surface and the reflected fraction, by sines and angles, which the chapter avoids.
fn divided(angle: f64, from: f64, to: f64) -> (Option<f64>, f64) {
    let sine = from * angle.sin() / to;
    if sine >= 1.0 {
        return (None, 1.0);
    }
    let behind = sine.asin();
    let across =
        (from * angle.cos() - to * behind.cos()) / (from * angle.cos() + to * behind.cos());
    let within =
        (to * angle.cos() - from * behind.cos()) / (to * angle.cos() + from * behind.cos());
    (Some(behind), 0.5 * (across * across + within * within))
}

/// The faults of the figure's ray `n` and of all rays that follow from it; the number of correct ones is
/// added to `count`.
fn held(
    rays: &[Value],
    n: usize,
    body: &Body,
    index: f64,
    ray: (DVec2, DVec2, bool, f64),
    count: &mut [usize; 2],
) {
    let Some(told) = rays.get(n) else { return };
    let (origin, d, inside, light) = ray;
    let number = |of: &Value| of.as_f64().unwrap();
    let to = DVec2::new(number(&told["to"][0]), number(&told["to"][1]));
    assert!((number(&told["light"]) - light).abs() < 1e-4, "{n}: {light} {told}");
    if light < 1e-3 {
        return;
    }
    count[0] += 1;
    let Some((t, outward)) = body.met(origin, d, inside) else {
        assert!(
            number(&told["cosine"]) == 2.0 && to.distance(origin + FAR * d) < 0.5,
            "{n}: {told}"
        );
        return;
    };
    let at = origin + t * d;
    assert!(to.distance(at) < 0.05, "{n}: {at} {told}");
    let normal = if inside { -outward } else { outward };
    let angle = (-d.dot(normal)).clamp(-1.0, 1.0).acos();
    assert!((number(&told["cosine"]) - angle.cos()).abs() < 1e-3, "{n}: {angle} {told}");
    let (from, to) = if inside { (index, 1.0) } else { (1.0, index) };
    let (behind, reflected) = divided(angle, from, to);
    let mirrored = d - 2.0 * d.dot(normal) * normal;
    held(rays, 2 * n, body, index, (at, mirrored, inside, light * reflected), count);
    let Some(behind) = behind else {
        count[1] += 1;
        return;
    };
    // Turned from the normal's other side, in the plane of the ray.
    let aside = (d + angle.cos() * normal).normalize_or_zero();
    let bent = behind.sin() * aside - behind.cos() * normal;
    held(rays, 2 * n + 1, body, index, (at, bent, !inside, light * (1.0 - reflected)), count);
}

#[test]
#[ignore = "nightly only: in a browser"]
fn each_part_of_a_ray_goes_where_snell_says_with_the_light_that_fresnel_says() {
    let mut browser = Browser::with_webgl();
    shown(&mut browser, &address(PAGE), "glass");
    let (mut count, mut misses) = ([0, 0], 0);
    for (body, index, start, aim) in [
        ("prism", "1.5 glass", 170, 142),
        ("prism", "1.5 glass", 30, 60),
        ("prism", "1.5 glass", 220, 190),
        ("prism", "2.42 diamond", 70, 110),
        ("prism", "1.33 water", 150, 120),
        ("slab", "1.5 glass", 20, 140),
        ("slab", "1.7 flint", 260, 190),
        ("ball", "1.5 glass", 150, 170),
        ("ball", "1.33 water", 110, 90),
        ("ball", "2.42 diamond", 262, 220),
        ("ball", "1.5 glass", 20, 290),
    ] {
        let (from, to) = (start.to_string(), aim.to_string());
        let controls = [("body", body), ("index", index), ("start", &*from), ("aim", &*to)];
        let told = found(&mut browser, &controls, "found");
        let point =
            |of: &Value| DVec2::from(serde_json::from_value::<[f64; 2]>(of.clone()).unwrap());
        let corners = told["body"]["corners"].as_array().unwrap().iter().map(point).collect();
        let drawn = Body {
            corners,
            middle: point(&told["middle"]),
            radius: told["body"]["radius"].as_f64().unwrap(),
        };
        let number: f64 = index.split(' ').next().unwrap().parse().unwrap();
        let (from, to) = (point(&told["start"]), point(&told["aim"]));
        let rays = told["rays"].as_array().unwrap();
        held(rays, 1, &drawn, number, (from, (to - from).normalize(), false, 1.0), &mut count);

        // The brightest path, in words.
        let said = browser.run("figure.said.textContent");
        let said = said.as_str().unwrap();
        let surfaces = told["surfaces"].as_array().unwrap();
        misses += usize::from(surfaces.is_empty());
        assert_eq!(surfaces.is_empty(), said.contains("misses the glass"), "{said}");
        let total = surfaces.iter().take(4).filter(|surface| surface["reflected"] == 1.0).count();
        assert_eq!(said.matches("total reflection").count(), total, "{said}");
        // A ray that enters a slab or a ball leaves it at the next surface.
        assert!(body == "prism" || total == 0, "{said}");
        if body == "slab" {
            let direction = |n: usize| {
                let [from, to] = ["from", "to"].map(|end| point(&rays[n][end]));
                (to - from).normalize()
            };
            assert!(
                direction(1).distance(direction(7)) < 1e-4,
                "{} {}",
                direction(1),
                direction(7)
            );
        }
        // The chart: the reflected fraction at 256 angles, into the glass and out of it.
        let curves: Vec<f64> = serde_json::from_value(told["curves"].clone()).unwrap();
        for (i, both) in curves.chunks(4).enumerate() {
            let angle = std::f64::consts::FRAC_PI_2 * i as f64 / 255.0;
            for (part, (from, to)) in both.iter().zip([(1.0, number), (number, 1.0)]) {
                let (behind, reflected) = divided(angle, from, to);
                let near = behind.is_some_and(|behind| behind > 1.2);
                assert!(near || (part - reflected).abs() < 1e-3, "{angle}: {part} {reflected}");
            }
        }
    }
    assert!(count[0] > 80 && count[1] > 5 && misses == 1, "{count:?} {misses}");
}
