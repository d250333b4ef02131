//! Spheres so large that a ray which leaves one starts above what stands on it.

use std::cmp::Reverse;

use glam::Vec3;

use crate::Sphere;

/// The part of a thing's height that its shadow may lose.
const PART: f32 = 1.0 / 16.0;

/// Spheres that are looked at: the largest.
const LARGEST: usize = 16;

/// A thing that may stand on a sphere, with a ball around it.
#[derive(Clone, Copy)]
pub(super) struct Thing {
    pub center: Vec3,
    pub radius: f32,
    /// From end to end.
    pub size: f32,
}

impl Thing {
    /// The thing in a box.
    pub fn within((low, high): (Vec3, Vec3)) -> Self {
        let radius = low.distance(high) / 2.0;
        Self { center: (low + high) / 2.0, radius, size: (high - low).max_element() }
    }
}

/// The number of a sphere from which rays start too high for a thing that stands on it, and what is wrong.
pub(super) fn too_high(spheres: &[Sphere], things: &[Thing]) -> Option<(usize, String)> {
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
        let what = format!(
            "rays that leave this sphere start up to {} above it, to be safe from rounding in 32 bits; a thing of size \
             {} on it loses its shadow there; a radius of at most {most} is right",
            brief(height),
            brief(thing.size)
        );
        Some((number, what))
    })
}

/// The height above a sphere's surface, in direction `normal`, at which a ray starts, as in
/// `shaders/25_scene_effects/report.glsl`: the sum of the bounds on what rounds. It grows with the radius, and with
/// the distance from the origin.
fn departure(sphere: &Sphere, normal: Vec3) -> f32 {
    const ROUNDING: f32 = f32::EPSILON / 2.0;
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
