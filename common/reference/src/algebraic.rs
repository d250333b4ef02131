//! Ray against an algebraic surface, a polynomial of degree four in x, y and z, and its roots exactly.

use dashu::rational::RBig;
use glam::DVec3;

use super::clipped::{roots_within, span};
use super::rational::rational;
use super::ray::Ray;
use super::surface::Surface;

/// The points of a closed box where a polynomial is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Algebraic {
    /// The low corner.
    pub low: DVec3,
    /// The high corner, above the low one in every axis.
    pub high: DVec3,
    /// The coefficients in POV-Ray's order: x⁴, x³y, x³z, x³, x²y², x²yz, …, z, 1. Powers of x fall first, then those
    /// of y, then those of z.
    pub coefficients: [f64; 35],
}

/// The exponents of x, y and z of each coefficient.
pub fn exponents() -> impl Iterator<Item = [u32; 3]> {
    let of_x = |i: u32| (0..=4 - i).rev().map(move |j| [i, j]);
    let of_z = |[i, j]: [u32; 2]| (0..=4 - i - j).rev().map(move |k| [i, j, k]);
    (0..=4).rev().flat_map(of_x).flat_map(of_z)
}

impl Algebraic {
    /// The t of all hits within the ray's interval, in order, to f64. A multiple root counts once; a ray along which the
    /// polynomial is 0 everywhere has none.
    ///
    /// # Panics
    /// If a number is not finite (but `tmax`).
    pub fn hits(&self, ray: &Ray) -> Vec<f64> {
        let Some(span) = span(self.low, self.high, ray) else { return Vec::new() };
        roots_within(&self.along(ray), &span, ray)
    }

    /// The first hit, with the normal in f64, to where the polynomial grows; 0 at a singular point.
    ///
    /// # Panics
    /// If a number is not finite (but `tmax`).
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let t = *self.hits(ray).first()?;
        Some(Surface { t, normal: self.gradient(ray.at(t)).normalize_or_zero() })
    }

    /// The polynomial's value.
    pub fn value(&self, point: DVec3) -> f64 {
        let term = |(c, [i, j, k]): (&f64, [u32; 3])| {
            c * point.x.powi(i as i32) * point.y.powi(j as i32) * point.z.powi(k as i32)
        };
        self.coefficients.iter().zip(exponents()).map(term).sum()
    }

    /// The direction in which the polynomial grows, and how fast.
    pub fn gradient(&self, point: DVec3) -> DVec3 {
        let mut gradient = DVec3::ZERO;
        for (c, powers) in self.coefficients.iter().zip(exponents()) {
            for k in 0..3 {
                let mut term = c * f64::from(powers[k]);
                for (axis, power) in powers.into_iter().enumerate() {
                    let lower = u32::from(axis == k);
                    term *= point[axis].powi(power.saturating_sub(lower) as i32);
                }
                gradient[k] += term;
            }
        }
        gradient
    }

    /// The polynomial along the ray, by the powers of t.
    fn along(&self, ray: &Ray) -> [RBig; 5] {
        let mut sum = [RBig::ZERO, RBig::ZERO, RBig::ZERO, RBig::ZERO, RBig::ZERO];
        for (c, powers) in self.coefficients.iter().zip(exponents()) {
            if *c == 0.0 {
                continue;
            }
            let mut product = vec![rational(*c)];
            for (k, power) in powers.into_iter().enumerate() {
                let (o, d) = (rational(ray.origin[k]), rational(ray.direction[k]));
                for _ in 0..power {
                    product.push(RBig::ZERO);
                    for i in (0..product.len()).rev() {
                        let lower = i.checked_sub(1).map(|below| &product[below] * &d);
                        product[i] = &product[i] * &o + lower.unwrap_or_default();
                    }
                }
            }
            for (to, x) in sum.iter_mut().zip(product) {
                *to += x;
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, towards};
    use super::*;

    /// Within two units of the origin.
    fn surface(terms: &[([u32; 3], f64)]) -> Algebraic {
        let of = |powers| terms.iter().find(|(own, _)| *own == powers).map_or(0.0, |(_, c)| *c);
        let mut coefficients = [0.0; 35];
        for (to, powers) in coefficients.iter_mut().zip(exponents()) {
            *to = of(powers);
        }
        Algebraic { low: DVec3::splat(-2.0), high: DVec3::splat(2.0), coefficients }
    }

    fn hits(surface: &Algebraic, origin: [f64; 3], direction: [f64; 3]) -> Vec<f64> {
        let [origin, direction] = [origin, direction].map(DVec3::from);
        surface.hits(&Ray { origin, direction, tmin: 0.0, tmax: 1e30 })
    }

    #[test]
    fn coefficients_are_in_the_order_of_pov_ray() {
        let names: Vec<String> = exponents().map(|[i, j, k]| format!("{i}{j}{k}")).collect();
        let first = ["400", "310", "301", "300", "220", "211", "210", "202", "201", "200", "130"];
        assert_eq!((names.len(), &names[..11]), (35, &first.map(str::to_owned)[..]));
        // Its cubic has the same order, without the terms of degree four.
        let cubic: Vec<_> = exponents().filter(|powers| powers.iter().sum::<u32>() < 4).collect();
        assert_eq!((cubic.len(), cubic[4], cubic[10]), (20, [1, 2, 0], [0, 3, 0]));
    }

    /// A torus with both radii 1 and 1/2, around z: POV-Ray's documentation has one like it.
    #[test]
    fn known_rays_have_their_known_hits() {
        let rest = [([4, 0, 0], 1.0), ([0, 4, 0], 1.0), ([0, 0, 4], 1.0), ([2, 2, 0], 2.0)];
        let mixed = [([2, 0, 2], 2.0), ([0, 2, 2], 2.0), ([2, 0, 0], -2.5), ([0, 2, 0], -2.5)];
        let last = [([0, 0, 2], 1.5), ([0, 0, 0], 0.5625)];
        let torus = surface(&[&rest[..], &mixed, &last].concat());
        let along_x = hits(&torus, [-4.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        assert_eq!(along_x, [2.5, 3.5, 4.5, 5.5]);
        assert_eq!(hits(&torus, [-4.0, 0.0, 0.5], [1.0, 0.0, 0.0]), [3.0, 5.0], "two touches");
        assert!(hits(&torus, [0.0, 0.0, -4.0], [0.0, 0.0, 1.0]).is_empty());
        let cube = surface(&[([3, 0, 0], 1.0), ([0, 1, 0], -1.0)]);
        assert_eq!(hits(&cube, [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), [1.0], "three roots at once");
        assert_eq!(hits(&cube, [-3.0, -1.0, 0.0], [1.0, 0.0, 0.0]), [2.0]);
        let wall = surface(&[([1, 0, 0], 1.0), ([0, 0, 0], -2.0)]);
        assert_eq!(hits(&wall, [-4.0, 0.0, 0.0], [1.0, 0.0, 0.0]), [6.0], "in a face of the box");
        assert_eq!(hits(&wall, [4.0, 0.0, 0.0], [-1.0, 0.0, 0.0]), [2.0], "and from outside");
        assert!(hits(&cube, [-4.0, -8.5, 0.0], [1.0, 0.0, 0.0]).is_empty(), "beyond the box");
    }

    #[test]
    fn hits_are_on_the_surface_and_signs_alternate() {
        let mut random = Random(3);
        let mut found = [0; 5];
        for _ in 0..200 {
            let mut coefficients = [0.0; 35];
            coefficients.iter_mut().for_each(|c| *c = f64::from(random.between(-1.0, 1.0) as f32));
            let shape = Algebraic { low: DVec3::NEG_ONE, high: DVec3::ONE, coefficients };
            let ray = towards(f32s(random.unit() * 4.0), f32s(random.in_cube() * 0.5));
            let hits = shape.hits(&ray);
            for &t in &hits {
                let point = ray.at(t);
                assert!(
                    shape.value(point).abs() < 1e-12 && point.abs().max_element() < 1.0 + 1e-12
                );
            }
            for pair in hits.windows(2) {
                let slope = |t: f64| shape.gradient(ray.at(t)).dot(ray.direction);
                assert!(slope(pair[0]) * slope(pair[1]) < 0.0);
            }
            found[hits.len()] += 1;
        }
        assert!(found[0] > 20 && found[1] > 40 && found[2] > 10, "{found:?}");
    }
}
