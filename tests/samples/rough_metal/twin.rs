//! The BRDF in f64, for metal without compensation: as Walter and others 2007 write it, with heights correlated.

use std::f64::consts::PI;

use glam::DVec3;

/// GGX's density of facets around a direction of any length.
pub fn distribution(alpha: f64, facet: DVec3) -> f64 {
    let DVec3 { x, y, z } = facet.normalize();
    let spread = x * x + y * y + alpha * alpha * z * z;
    alpha * alpha / (PI * spread * spread)
}

/// Smith's lambda: the hidden part over the seen part of the facets.
fn lambda(alpha: f64, direction: DVec3) -> f64 {
    let tangent = (direction.x * direction.x + direction.y * direction.y) / direction.z.powi(2);
    0.5 * ((1.0 + alpha * alpha * tangent).sqrt() - 1.0)
}

/// The part of the light that reaches the eye, BRDF times cosine, of facets that reflect all.
pub fn reflected(alpha: f64, view: DVec3, light: DVec3) -> f64 {
    let seen = 1.0 / (1.0 + lambda(alpha, view) + lambda(alpha, light));
    distribution(alpha, view + light) * seen / (4.0 * view.z)
}

/// The directional albedo, from facets chosen by their density alone: slow, and unlike the table's way.
pub fn albedo(alpha: f64, cosine: f64, steps: u32) -> [f64; 2] {
    let view = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let mut sum = [0.0; 2];
    for i in 0..steps {
        let u = (f64::from(i) + 0.5) / f64::from(steps);
        let tangent = alpha * (u / (1.0 - u)).sqrt();
        for k in 0..steps {
            let angle = (f64::from(k) + 0.5) / f64::from(steps) * PI;
            let facet = DVec3::new(tangent * angle.cos(), tangent * angle.sin(), 1.0).normalize();
            let turned = view.dot(facet);
            let light = 2.0 * turned * facet - view;
            if turned > 0.0 && light.z > 0.0 {
                let seen = 1.0 / (1.0 + lambda(alpha, view) + lambda(alpha, light));
                let part = seen * turned / (view.z * facet.z) / f64::from(steps).powi(2);
                sum[0] += part;
                sum[1] += part * (1.0 - turned).powi(5);
            }
        }
    }
    sum
}
