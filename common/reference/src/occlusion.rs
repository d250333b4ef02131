//! The part of the sky that an object hides from a point on the ground, in closed form: form factors.
//!
//! The sky's part behind a polygon is weighted by the cosine of its direction, as a surface weighs what it
//! receives; the whole sky counts 1. Lambert's formula (Photometria, 1760; Baum, Rushmeier and Winget,
//! SIGGRAPH 1989, equation 6) sums the angles under which the point sees the polygon's edges.

use std::f64::consts::PI;

use glam::DVec3;

/// The part of the sky above `normal`, a unit vector, that a polygon hides from a point. None of its corners may
/// be below the point's ground, nor at the point.
pub fn polygon(point: DVec3, normal: DVec3, corners: &[DVec3]) -> f64 {
    let ends = corners.iter().zip(corners.iter().cycle().skip(1));
    let edges = ends.map(|(&a, &b)| {
        let (a, b) = (a - point, b - point);
        let across = a.cross(b);
        // An edge in line with the point subtends no angle, or hides nothing.
        let turned = across.try_normalize().map_or(0.0, |axis| axis.dot(normal));
        turned * across.length().atan2(a.dot(b))
    });
    edges.sum::<f64>().abs() / (2.0 * PI)
}

/// The part of the sky that a box standing on the ground, y = 0, hides from a point of the ground beside it: that
/// of its upright faces that face the point. The top is not visible from there.
pub fn standing_box(point: DVec3, low: DVec3, high: DVec3) -> f64 {
    let upright = |a: DVec3, b: DVec3| [a, b, b.with_y(high.y), a.with_y(high.y)];
    let corner = |x, z| DVec3::new(x, 0.0, z);
    let [near_left, near_right] = [corner(low.x, low.z), corner(high.x, low.z)];
    let [far_left, far_right] = [corner(low.x, high.z), corner(high.x, high.z)];
    let faces = [
        (point.x < low.x, upright(near_left, far_left)),
        (point.x > high.x, upright(near_right, far_right)),
        (point.z < low.z, upright(near_left, near_right)),
        (point.z > high.z, upright(far_left, far_right)),
    ];
    let seen = faces.iter().filter(|(looks, _)| *looks);
    seen.map(|(_, corners)| polygon(point, DVec3::Y, corners)).sum()
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::*;

    /// A wall that begins at the foot of the point and is so wide to one side (Howell, A Catalog of Radiation
    /// Heat Transfer Configuration Factors, B-4).
    fn wall(width: f64, height: f64, distance: f64) -> f64 {
        let slant = height.hypot(distance);
        ((width / distance).atan() - distance / slant * (width / slant).atan()) / (2.0 * PI)
    }

    #[test]
    fn a_wall_hides_what_the_catalog_says() {
        for (width, height, distance) in [(1.0, 1.0, 1.0), (0.2, 3.0, 0.7), (40.0, 0.1, 2.0)] {
            let corner = |x, y| DVec3::new(x, y, distance);
            let corners =
                [corner(0.0, 0.0), corner(width, 0.0), corner(width, height), corner(0.0, height)];
            let (own, known) =
                (polygon(DVec3::ZERO, DVec3::Y, &corners), wall(width, height, distance));
            assert!((own - known).abs() < 1e-14, "{own} {known}");
        }
    }

    #[test]
    fn an_endless_wall_hides_half_of_the_sky() {
        let corner = |x, y| DVec3::new(x, y, 1.0);
        let corners = [corner(-1e7, 0.0), corner(1e7, 0.0), corner(1e7, 1e7), corner(-1e7, 1e7)];
        assert!((polygon(DVec3::ZERO, DVec3::Y, &corners) - 0.5).abs() < 1e-6);
    }

    /// Against directions that are spread by the cosine: 4 standard deviations.
    #[test]
    fn a_box_hides_what_random_directions_find() {
        let (low, high) = (DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 1.5, 1.0));
        let mut random = Random(17);
        for point in [DVec3::new(1.5, 0.0, 0.2), DVec3::new(-1.3, 0.0, 1.9)] {
            let hidden = standing_box(point, low, high);
            let n = 40_000;
            let blocked = (0..n).filter(|_| {
                let (square, turn) = (random.between(0.0, 1.0), random.between(0.0, 2.0 * PI));
                let radius = square.sqrt();
                let way =
                    DVec3::new(radius * turn.cos(), (1.0 - square).sqrt(), radius * turn.sin());
                let (a, b) = ((low - point) / way, (high - point) / way);
                a.min(b).max_element() < a.max(b).min_element() && a.max(b).min_element() > 0.0
            });
            let found = blocked.count() as f64 / f64::from(n);
            let deviation = (hidden * (1.0 - hidden) / f64::from(n)).sqrt();
            assert!((found - hidden).abs() < 4.0 * deviation, "{found} {hidden} {deviation}");
        }
    }
}
