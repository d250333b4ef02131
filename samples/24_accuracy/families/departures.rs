//! Rays that leave a sphere, and rays that cross a gap.

use glam::{DVec3, Vec3};
use reference::random::{Random, f32s};
use reference::sphere;

use super::{Draw, Family, on_disc};
use crate::query::Ray;
use crate::shape::{Gap, Leaving, Shape};

/// A ray that leaves a sphere where another one arrives, anywhere above the surface, often grazing;
/// `None` where that one misses.
fn leaving(
    random: &mut Random,
    sphere: &sphere::Sphere,
    origin: DVec3,
    direction: DVec3,
) -> Option<Shape> {
    let (origin, direction) = (origin.as_vec3(), direction.as_vec3());
    let arriving = Ray { origin, direction, tmin: 0.0, tmax: 1e30 }.exact();
    let hit = sphere.intersect(&arriving)?;
    // The device's point may lie a few ULP of t farther along the ray. There the surface has turned, and a
    // direction must be above that one, as a renderer's is: it has no other normal.
    let cosine = -hit.normal.dot(arriving.direction.normalize());
    let distance = (arriving.origin - sphere.center).length() / sphere.radius;
    let turned = 16.0 * 2f64.powi(-24) * distance / cosine;
    let sine = random.scale(turned.clamp(1e-4, 1.0), 1.0);
    let along = on_disc(random, DVec3::ZERO, hit.normal, 1.0).normalize();
    let direction = (along + sine * hit.normal).normalize().as_vec3();
    let (center, radius) = (sphere.center.as_vec3(), sphere.radius as f32);
    Some(Shape::Leaving(Leaving { center, radius, direction, gap: None }))
}

pub fn departures(draw: Draw) -> Vec<Family> {
    // Each ray has a sphere of its own, and a camera somewhere that sees it.
    let family = |name, make: &dyn Fn(&mut Random) -> (sphere::Sphere, f64, f64)| {
        let mut random = draw.random(13);
        let (mut shapes, mut rays) = (Vec::new(), Vec::new());
        while rays.len() < draw.rays {
            let (sphere, distance, speed) = make(&mut random);
            let axis = random.unit();
            let origin = f32s(sphere.center + axis * (distance * sphere.radius));
            let target = on_disc(&mut random, sphere.center, axis, sphere.radius);
            let direction = (target - origin).normalize() * speed;
            if let Some(shape) = leaving(&mut random, &sphere, origin, direction) {
                shapes.push(shape);
                rays.push((origin, direction));
            }
        }
        let mut family = Family::new(name, shapes, draw, &mut |_, number| {
            (number, rays[number].0, rays[number].1)
        });
        family.is_traced = false;
        family
    };
    let still = |name, center: DVec3, radius: f64, distance: f64| {
        let radius = f64::from(radius as f32);
        family(name, &move |_| (sphere::Sphere { center, radius }, distance, 1.0))
    };
    // Any size, any place (after pbrt-v4's FullSphere.Reintersect).
    let anywhere = |random: &mut Random| {
        let radius = f64::from(random.scale(1e-4, 1e4) as f32);
        let center = f32s(random.unit() * radius * random.scale(1e-4, 1e4));
        (sphere::Sphere { center, radius }, random.scale(1.1, 1e4), random.scale(1e-4, 1e4))
    };
    // A plane so many units in the last place above the top of a sphere.
    let gap = |name, radius: f32, units: f32| {
        let mut random = draw.random(17);
        let make = |_| {
            let center = Vec3::new(0.0, random.between(-4.0, 4.0) as f32 * radius, 0.0);
            let top = center.y + radius;
            let largest = top.abs().max(center.y.abs()).max(radius);
            let unit = largest.next_up() - largest;
            let gap = Gap {
                point: Vec3::new(0.0, top, 0.0),
                normal: Vec3::Y,
                occluder_y: top + units * unit,
            };
            let direction = Vec3::new(random.between(-0.5, 0.5) as f32, 1.0, 0.0);
            Shape::Leaving(Leaving { center, radius, direction, gap: Some(gap) })
        };
        let shapes: Vec<Shape> = (0..draw.rays).map(make).collect();
        let mut family =
            Family::new(name, shapes, draw, &mut |_, number| (number, DVec3::ZERO, DVec3::Y));
        family.is_traced = false;
        family
    };
    vec![
        still("leaving r=1 seen from 5", DVec3::ZERO, 1.0, 5.0),
        still("leaving r=1 seen from 1e3", DVec3::ZERO, 1.0, 1e3),
        still("leaving r=1 at 1e4", DVec3::new(6e3, 4.8e3, 6.4e3), 1.0, 5.0),
        still("leaving r=1e6", DVec3::ZERO, 1e6, 2.0),
        still("leaving r=1e-3", DVec3::ZERO, 1e-3, 5.0),
        family("leaving any sphere anywhere", &anywhere),
        gap("gap of 64 ULP, r=1", 1.0, 64.0),
        gap("gap of 64 ULP, r=1e-3", 1e-3, 64.0),
        gap("gap of 64 ULP, r=1e6", 1e6, 64.0),
    ]
}
