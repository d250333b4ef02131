//! Surfaces so large or so far away that a ray leaving one starts above the objects on it.

mod flat;

use std::cmp::Reverse;

use glam::Vec3;

use crate::{Composition, Sphere, Torus};

/// The error of one rounding in 32 bits, relative.
const ROUNDING: f32 = f32::EPSILON / 2.0;

/// The part of an object's height that its shadow may lose.
const PART: f32 = 1.0 / 16.0;

/// The number of surfaces of a kind that are checked: the largest, or those that reach farthest.
const LARGEST: usize = 16;

/// An object that may be on a surface, with a bounding sphere.
#[derive(Clone, Copy)]
struct Thing {
    center: Vec3,
    radius: f32,
    /// The diameter.
    size: f32,
}

impl Thing {
    /// The thing in a box.
    fn within((low, high): (Vec3, Vec3)) -> Self {
        let radius = low.distance(high) / 2.0;
        Self { center: (low + high) / 2.0, radius, size: (high - low).max_element() }
    }
}

/// The number of the first surface of each kind from which rays start too high, and the message.
pub(super) struct Told {
    pub sphere: Option<(usize, String)>,
    pub block: Option<(usize, String)>,
    pub solid: Option<(usize, String)>,
    /// For meshes, the message contains the name.
    pub mesh: Option<String>,
}

/// Checks all surfaces of a composition, and all objects that may be on them.
pub(super) fn told(of: &Composition) -> Told {
    let ball =
        |&Sphere { center, radius, .. }: &Sphere| Thing { center, radius, size: 2.0 * radius };
    let instances = of.scene.bounds_of_instances();
    let blocks = of.boxes.iter().map(|block| (block.low, block.high));
    let boxes = instances.iter().copied().chain(blocks).chain(of.solid_bounds.iter().copied());
    let boxes = boxes.chain(of.tori.iter().map(Torus::bounds));
    let things: Vec<Thing> = of.spheres.iter().map(ball).chain(boxes.map(Thing::within)).collect();
    Told {
        sphere: too_high(&of.spheres, &things),
        block: flat::block(&of.boxes, &things),
        solid: flat::solid(&of.solids, &of.faces, &of.solid_bounds, &things),
        mesh: flat::meshes(&of.scene, &instances, &things),
    }
}

/// The number of a sphere from which rays start too high for an object on it, and the message.
fn too_high(spheres: &[Sphere], things: &[Thing]) -> Option<(usize, String)> {
    let mut order: Vec<usize> = (0..spheres.len()).collect();
    order.sort_by_key(|&number| Reverse(spheres[number].radius.to_bits()));
    order.into_iter().take(LARGEST).find_map(|number| {
        let sphere = &spheres[number];
        let (height, thing) = things.iter().find_map(|thing| {
            let away = thing.center - sphere.center;
            let height = departure(sphere, away.try_normalize()?);
            let gap = (away.length() - sphere.radius).abs() - thing.radius;
            let stands = gap <= height && thing.radius < sphere.radius;
            (stands && height > PART * thing.size).then_some((height, thing))
        })?;
        let most = brief(sphere.radius * PART * thing.size / height);
        let what = lost("this sphere", height, thing);
        Some((number, format!("{what}; a radius of at most {most} is right")))
    })
}

/// The message about an object on a surface from which rays start at a height.
fn lost(surface: &str, height: f32, thing: &Thing) -> String {
    format!(
        "rays that leave {surface} start up to {} above it, to be safe from rounding in 32 bits; a thing of size {} \
         on it loses its shadow there",
        brief(height),
        brief(thing.size)
    )
}

/// The height above a sphere's surface, in direction `normal`, at which a ray starts, as in
/// `shaders/25_scene_effects/report.glsl`: the sum of the bounds on what rounds. It grows with the radius, and with
/// the distance from the origin.
fn departure(sphere: &Sphere, normal: Vec3) -> f32 {
    let point = (sphere.center + sphere.radius * normal).abs();
    ROUNDING * normal.abs().dot(31.0 * point + 46.0 * sphere.radius)
}

/// A number above 0 with two digits.
fn brief(number: f32) -> String {
    let power = number.log10().floor() as i32 - 1;
    let unit = 10f64.powi(power);
    let rounded = (f64::from(number) / unit).round() * unit;
    format!("{rounded:.0$}", power.min(0).unsigned_abs() as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(center: [f32; 3], radius: f32) -> Sphere {
        Sphere { center: center.into(), radius, material: 0, moves: Vec3::ZERO }
    }

    fn on_planet(radius: f32) -> Option<String> {
        let spheres = [ball([0.0, 1.0, 0.0], 1.0), ball([0.0, -radius, 0.0], radius)];
        let thing = |s: &Sphere| Thing { center: s.center, radius: s.radius, size: 2.0 * s.radius };
        let things: Vec<_> = spheres.iter().map(thing).collect();
        too_high(&spheres, &things).map(|(number, what)| {
            assert_eq!(number, 1);
            what
        })
    }

    #[test]
    fn a_planet_is_told_of_where_its_rays_start_above_what_stands_on_it() {
        for radius in [1e6, 5e5, 1e5, 5e4] {
            let what = on_planet(radius).unwrap();
            assert!(what.ends_with("a radius of at most 46000 is right"), "{what}");
        }
        for radius in [4.5e4, 1e4, 1000.0, 1.0] {
            assert_eq!(on_planet(radius), None);
        }
    }

    #[test]
    fn what_does_not_stand_on_a_planet_has_its_shadow() {
        let sky = [ball([0.0; 3], 1e6), ball([0.0, 1.0, 0.0], 1.0)];
        let thing = |s: &Sphere| Thing { center: s.center, radius: s.radius, size: 2.0 * s.radius };
        assert_eq!(too_high(&sky, &[thing(&sky[1])]), None);
        let high = Thing { center: Vec3::new(0.0, 1e6 + 100.0, 0.0), radius: 1.0, size: 2.0 };
        assert_eq!(too_high(&sky[..1], &[high]), None);
        assert!(too_high(&sky[..1], &[Thing { center: Vec3::Y * 1e6, ..high }]).is_some());
    }
}
