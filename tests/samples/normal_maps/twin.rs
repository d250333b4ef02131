//! The rules in f64: what one reflection sends above the surface, and the walk of a mirror's rays between two facets.

use std::f64::consts::TAU;

use glam::DVec3;

use super::rough_twin;

/// A mapped normal, turned from z by an angle, towards x.
pub fn mapped(tilt: f64) -> DVec3 {
    DVec3::new(tilt.sin(), 0.0, tilt.cos())
}

/// The bent normal: half way between the view and the mirrored ray, which is lifted above the surface.
pub fn bent(mapped: DVec3, view: DVec3, lift: f64) -> DVec3 {
    let mirrored = 2.0 * view.dot(mapped) * mapped - view;
    if mirrored.z > lift {
        return mapped;
    }
    (view + mirrored.with_z(lift).normalize()).normalize()
}

/// The light of a white sky above the surface that facets of one reflection around a normal send to the eye, by facets
/// chosen by their density, `steps` from the middle outwards and twice as many around.
pub fn reflected_from_above(alpha: f64, normal: DVec3, view: DVec3, steps: u32) -> f64 {
    let right = DVec3::Y.cross(normal).normalize();
    let up = normal.cross(right);
    let own = |v: DVec3| DVec3::new(v.dot(right), v.dot(up), v.dot(normal));
    let above = own(DVec3::Z);
    let view = own(view);
    if view.z <= 0.0 {
        return 0.0;
    }
    let mut sum = 0.0;
    for i in 0..steps {
        let u = (f64::from(i) + 0.5) / f64::from(steps);
        let tangent = alpha * (u / (1.0 - u)).sqrt();
        for k in 0..2 * steps {
            let angle = (f64::from(k) + 0.5) / f64::from(2 * steps) * TAU;
            let facet = DVec3::new(tangent * angle.cos(), tangent * angle.sin(), 1.0).normalize();
            let turned = view.dot(facet);
            let light = 2.0 * turned * facet - view;
            if turned > 0.0 && light.z > 0.0 && light.dot(above) > 0.0 {
                // BRDF times cosine, over the density of the light's direction, D cosine / (4 turned).
                let density = rough_twin::distribution(alpha, facet) * facet.z / (4.0 * turned);
                sum += rough_twin::reflected(alpha, view, light) / density;
            }
        }
    }
    sum / f64::from(2 * steps * steps)
}

/// Two facets, one mapped and one that stands up, by their areas.
pub struct TwoFacets {
    /// Normal and area.
    facets: [(DVec3, f64); 2],
}

impl TwoFacets {
    /// The mapped facet has the area 1 / cos, so that both together are as wide as the surface.
    pub fn new(tilt: f64) -> Self {
        Self { facets: [(mapped(tilt), 1.0 / tilt.cos()), (-DVec3::X, tilt.tan())] }
    }

    /// The sum of both areas, turned by their normals: the surface's own normal.
    pub fn whole(&self) -> DVec3 {
        self.facets.iter().map(|&(normal, area)| normal * area).sum()
    }

    /// The area of a facet that a direction sees.
    fn seen(&self, facet: usize, direction: DVec3) -> f64 {
        let (normal, area) = self.facets[facet];
        area * normal.dot(direction).max(0.0)
    }

    /// The part that leaves the surface in a direction.
    fn leaving(&self, direction: DVec3) -> f64 {
        let seen = self.seen(0, direction) + self.seen(1, direction);
        if direction.z <= 0.0 { 0.0 } else { (direction.z / seen).min(1.0) }
    }

    /// The light that leaves if both facets are mirrors: its sum, and its direction times that.
    pub fn mirrored(&self, view: DVec3) -> (f64, DVec3) {
        let first = self.seen(0, view) / (self.seen(0, view) + self.seen(1, view));
        let (mut sum, mut directions) = (0.0, DVec3::ZERO);
        for (facet, part) in [(0, first), (1, 1.0 - first)] {
            let (mut direction, mut facet, mut part) = (-view, facet, part);
            while part > 1e-9 {
                direction -= 2.0 * direction.dot(self.facets[facet].0) * self.facets[facet].0;
                // Light that comes from the wall first has not met the mapped facet yet: there is nowhere else to go.
                let leaving = self.leaving(direction);
                sum += part * leaving;
                directions += direction * part * leaving;
                part *= 1.0 - leaving;
                facet = 1 - facet;
            }
        }
        (sum, directions)
    }
}
