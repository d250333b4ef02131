//! Ray against triangle: watertight in f64, and exactly.

use dashu::rational::RBig;

use super::crossing::{Crossing, Shear};
use super::rational::sign;
use super::ray::Ray;
use super::surd::Surd;
use super::surface::ExactSurface;
use super::vector::Vector;

pub use super::crossing::Triangle;

/// The hit of a ray with a triangle, exactly.
#[derive(Clone, Debug)]
pub struct ExactTriangleHit {
    /// t, which is rational, and the normal that faces the ray's origin.
    pub surface: ExactSurface,
    /// Weights of the three vertices: none negative, sum 1.
    pub weights: [RBig; 3],
}

/// The hit of a ray with a closed triangle in f64, from either side.
pub fn intersect(ray: &Ray, triangle: &Triangle) -> Option<Crossing> {
    let crossing = Shear::new(ray).cross(triangle);
    (crossing.inside && ray.contains(crossing.t)).then_some(crossing)
}

/// Distance of the ray's line inside each edge: [`Crossing::margins`].
pub fn edge_margins(ray: &Ray, triangle: &Triangle) -> [f64; 3] {
    Shear::new(ray).cross(triangle).margins
}

/// The hit of a ray with a closed triangle, from either side, exactly.
///
/// Triangles without area and triangles seen edge-on are not hit.
///
/// # Panics
/// If a coordinate of the triangle or of the ray is not finite.
pub fn intersect_exact(ray: &Ray, triangle: &Triangle) -> Option<ExactTriangleHit> {
    let d = Vector::from(ray.direction);
    let o = Vector::from(ray.origin);
    let [a, b, c] = triangle.map(|v| &Vector::from(v) - &o);
    // Six times the volume spanned by the direction and each edge, seen from the ray's origin.
    let volumes = [(&b, &c), (&c, &a), (&a, &b)].map(|(p, q)| d.dot(&p.cross(q)));
    let sum = &volumes[0] + &volumes[1] + &volumes[2];
    let side = sign(&sum);
    if side.is_eq() || volumes.iter().any(|volume| sign(volume) == side.reverse()) {
        return None;
    }
    let normal = (&b - &a).cross(&(&c - &a));
    let t = Surd::from(a.dot(&normal) / &sum);
    let facing = if side.is_gt() { -RBig::ONE } else { RBig::ONE };
    t.within(ray).then(|| ExactTriangleHit {
        surface: ExactSurface { t, normal: normal.normalized(&facing) },
        weights: volumes.map(|volume| volume / &sum),
    })
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, towards};
    use super::super::rational::to_f64;
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    const UNIT: Triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];

    fn down(x: f64, y: f64) -> Ray {
        Ray { direction: DVec3::NEG_Z, ..towards(DVec3::new(x, y, 5.0), DVec3::ZERO) }
    }

    #[test]
    fn margins_are_distances_to_the_edges() {
        let crossing = intersect(&down(0.2, 0.3), &UNIT).unwrap();
        let [x, y] = [0.2f32, 0.3].map(f64::from);
        let expected = [(1.0 - x - y) / 2f64.sqrt(), x, y];
        for (margin, expected) in crossing.margins.into_iter().zip(expected) {
            assert!((margin - expected).abs() < 1e-15, "{crossing:?}");
        }
        assert!(crossing.counterclockwise);
        // Seen at an angle, a distance shrinks: the ray crosses y = 0 at 30 degrees.
        let d = DVec3::new(0.0, 3f64.sqrt(), -1.0);
        let ray =
            Ray { origin: DVec3::new(0.2, 0.25, 0.0) - d, direction: d, tmin: 0.0, tmax: 9.0 };
        let slanted = intersect(&ray, &UNIT).unwrap();
        assert!((slanted.margins[2] - 0.125).abs() < 1e-15, "{slanted:?}");
        assert!((slanted.t - 1.0).abs() < 1e-15);
        let outside = edge_margins(&down(0.25, -0.125), &UNIT);
        assert!(outside[2] == -0.125 && outside[0] > 0.0 && outside[1] > 0.0);
    }

    #[test]
    fn back_faces_turn_clockwise_and_have_the_same_margins() {
        let [a, b, c] = UNIT;
        let (front, back) = (edge_margins(&down(0.2, 0.3), &UNIT), [a, c, b]);
        let crossing = intersect(&down(0.2, 0.3), &back).unwrap();
        assert!(!crossing.counterclockwise);
        assert_eq!(crossing.margins, [front[0], front[2], front[1]]);
    }

    #[test]
    fn edges_vertices_and_one_ulp_beside_them() {
        for (x, y, hit) in [
            (0.5, 0.0, true),
            (0.5, 0.5, true),
            (0.0, 0.0, true),
            (1.0, 0.0, true),
            (0.5, -1e-45, false),
            (0.5, 0.5 + 2f64.powi(-24), false),
            (-1e-45, -1e-45, false),
        ] {
            let ray = down(x, y);
            assert_eq!(intersect_exact(&ray, &UNIT).is_some(), hit, "{x} {y}");
            assert_eq!(intersect(&ray, &UNIT).is_some(), hit, "{x} {y}");
        }
    }

    #[test]
    fn edge_on_and_collinear_triangles_are_not_hit() {
        let along =
            Ray { direction: DVec3::X, ..towards(DVec3::new(-1.0, 0.25, 0.0), DVec3::ZERO) };
        let collinear = [DVec3::ZERO, DVec3::X, DVec3::X * 3.0];
        for (ray, triangle) in [(along, UNIT), (down(0.5, 0.0), collinear)] {
            assert!(intersect(&ray, &triangle).is_none());
            assert!(intersect_exact(&ray, &triangle).is_none());
            assert!(edge_margins(&ray, &triangle).iter().all(|&margin| margin <= 0.0));
        }
    }

    /// f64 against exact: random triangles at every scale, rays at the inside, edges and vertices.
    #[test]
    fn f64_agrees_with_exact() {
        let mut random = Random(8);
        let mut hits = 0;
        for round in 0..2000 {
            let scale = random.scale(1e-6, 1e6);
            let shift = random.in_cube() * random.scale(1e-3, 1e3) * scale;
            let triangle = [0; 3].map(|_| f32s(shift + random.in_cube() * scale));
            let [p, q] = [random.between(-0.2, 1.2), random.between(-0.2, 1.2)];
            let weights = match round % 4 {
                0 => [1.0 - p - q, p, q],
                1 => [1.0 - p, p, 0.0],
                2 => [1.0, 0.0, 0.0],
                _ => [1.0 - p, p, 1e-7 * q],
            };
            let target: DVec3 = (0..3).map(|k| triangle[k] * weights[k]).sum();
            let origin = target + random.unit() * random.scale(1e-2, 1e3) * scale;
            let ray = towards(origin, target);
            // Each sheared vertex is off by a few eps times its distance from the ray's origin.
            let farthest =
                triangle.map(|v| (v - ray.origin).length()).into_iter().fold(0.0, f64::max);
            let noise = 8.0 * f64::EPSILON * farthest;
            let crossing = Shear::new(&ray).cross(&triangle);
            let nearest = crossing.margins.into_iter().fold(f64::INFINITY, f64::min);
            match (intersect_exact(&ray, &triangle), intersect(&ray, &triangle)) {
                (Some(exact), Some(plain)) => {
                    hits += 1;
                    let surface = exact.surface.to_f64();
                    let steep = surface.normal.dot(ray.direction).abs();
                    assert!((plain.t - surface.t).abs() <= noise / steep + 1e-15 * surface.t);
                    assert!(surface.normal.dot(ray.direction) < 0.0);
                    let [a, b, c] = triangle;
                    let n = (b - a).cross(c - a);
                    assert_eq!(plain.counterclockwise, n.dot(surface.normal) > 0.0);
                    for k in 0..3 {
                        let height =
                            n.length() / (triangle[(k + 1) % 3] - triangle[(k + 2) % 3]).length();
                        let bound = noise / height / steep * ray.direction.length() * 4.0;
                        let error = (plain.weights[k] - to_f64(&exact.weights[k])).abs();
                        assert!(error <= bound, "{error} {bound}");
                    }
                }
                (None, None) => {}
                _ => assert!(nearest.abs() <= noise, "{ray:?} {triangle:?} {crossing:?}"),
            }
        }
        assert!((600..1800).contains(&hits), "{hits}");
    }

    /// Rays at the edges and vertices of a fan around one vertex: at least one triangle is hit.
    #[test]
    fn no_ray_passes_between_neighbours() {
        let mut random = Random(9);
        for _ in 0..20_000 {
            let hub = f32s(random.in_cube() * 100.0);
            let rim: [DVec3; 5] = std::array::from_fn(|i| {
                let (sin, cos) = (i as f64 * std::f64::consts::TAU / 5.0).sin_cos();
                f32s(hub + DVec3::new(cos, sin, random.between(-0.2, 0.2)))
            });
            let along = random.between(0.0, 0.9) * random.below(2) as f64;
            let target = hub.lerp(rim[random.below(5)], along);
            let away = DVec3::new(0.0, 0.0, random.scale(1.0, 1e3)) + random.in_cube();
            let ray = towards(target + away, target);
            let fan = (0..5).map(|i| [hub, rim[i], rim[(i + 1) % 5]]);
            assert!(
                fan.into_iter().any(|triangle| intersect(&ray, &triangle).is_some()),
                "{ray:?}"
            );
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]
        /// Small integers: rays through vertices, along edges and in the plane turn up all the time.
        #[test]
        fn exact_points_are_the_same_from_both_ends(
            v in prop::array::uniform9(-2i8..3), o in prop::array::uniform3(-3i8..4), d in prop::array::uniform3(-2i8..3),
        ) {
            let v = v.map(f64::from);
            let triangle = [0, 3, 6].map(|i| DVec3::new(v[i], v[i + 1], v[i + 2]));
            let [o, d] = [o, d].map(|v| DVec3::from_array(v.map(f64::from)));
            prop_assume!(d != DVec3::ZERO);
            let ray = Ray { origin: o, direction: d, tmin: 0.0, tmax: f64::INFINITY };
            let exact = intersect_exact(&ray, &triangle);
            // d[z] is 1 or 2, so f64 makes no error that could matter at these sizes.
            prop_assert_eq!(intersect(&ray, &triangle).is_some(), exact.is_some());
            if let Some(hit) = exact {
                let [a, b, c] = triangle.map(Vector::from);
                let point = &(&(&a * &hit.weights[0]) + &(&b * &hit.weights[1])) + &(&c * &hit.weights[2]);
                let t = hit.surface.t.to_f64();
                prop_assert!((point.to_f64() - ray.at(t)).length() <= 1e-13);
                prop_assert_eq!(hit.weights.iter().fold(RBig::ZERO, |sum, w| sum + w), RBig::ONE);
            }
        }
    }
}
