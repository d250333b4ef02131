//! Ray against swept sphere: all balls between two, their centre and radius changing evenly, exactly.

use dashu::rational::RBig;
use glam::DVec3;

use super::rational::rational;
use super::ray::Ray;
use super::sphere::roots;
use super::surd::Surd;
use super::surface::Surface;
use super::vector::Vector;

/// The convex hull of two balls: a cone with round ends; if one holds the other, that one alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swept {
    /// The centres of both ends.
    pub ends: [DVec3; 2],
    /// Their radii: not negative, and not both 0.
    pub radii: [f64; 2],
}

impl Swept {
    /// The first hit: t exactly and then rounded, the outward normal in f64.
    ///
    /// With u from end to end, δ what the radius grows by, and k = u² - δ² above 0, the ball that touches the
    /// surface at p is the one at s(p) = (p·u + δ·r) / k, taken to 0 or 1. So a root of an end's sphere counts
    /// where s is not beyond the end within the shape, and one of the body, k·(p² - r²) = (p·u + δ·r)², where
    /// s is from 0 to 1. All of these are signs of surds.
    ///
    /// # Panics
    /// If a number is not finite.
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        self.intersect_grown(ray, 1.0)
    }

    /// The same with both radii times a factor: whether a ray that grazes the shape hits it or not is then
    /// decided otherwise.
    ///
    /// # Panics
    /// If a number is not finite.
    pub fn intersect_grown(&self, ray: &Ray, factor: f64) -> Option<Surface> {
        let d = Vector::from(ray.direction);
        let [a, b] = self.ends.map(Vector::from);
        let [r, q] = self.radii.map(|radius| rational(radius) * rational(factor));
        let (u, delta) = (&b - &a, &q - &r);
        let k = u.length_squared() - &delta * &delta;
        let o = Vector::from(ray.origin);
        let (from_a, from_b) = (&o - &a, &o - &b);
        let rate = d.dot(&u);
        // k·s at the ray's origin; it grows by `rate`.
        let start = from_a.dot(&u) + &delta * &r;
        let place = |t: &Surd| t.affine(&rate, &start);
        let is_hull = k > RBig::ZERO;

        let mut found: Vec<Surd> = Vec::new();
        let mut keep = |t: Surd, counts: bool| {
            if counts && t.within(ray) {
                found.push(t);
            }
        };
        for (from, radius, is_b) in [(&from_a, &r, false), (&from_b, &q, true)] {
            let c = from.length_squared() - radius * radius;
            for t in roots(&d.length_squared(), &from.dot(&d), &c).into_iter().flatten() {
                let counts = match (is_hull, is_b) {
                    (false, _) => is_b == (q > r),
                    (true, false) => place(&t).sign().is_le(),
                    (true, true) => place(&t).compare(&k).is_ge(),
                };
                keep(t, counts);
            }
        }
        if is_hull {
            let qa = &k * d.length_squared() - &rate * &rate;
            let qb = &k * from_a.dot(&d) - &start * &rate;
            let qc = &k * (from_a.length_squared() - &r * &r) - &start * &start;
            let straight = (qa.is_zero() && !qb.is_zero()).then(|| Surd::from(-&qc / (&qb + &qb)));
            for t in roots(&qa, &qb, &qc).into_iter().flatten().chain(straight) {
                let counts = place(&t).sign().is_ge() && place(&t).compare(&k).is_le();
                keep(t, counts);
            }
        }
        let t = found.iter().map(Surd::to_f64).min_by(f64::total_cmp)?;
        Some(Surface { t, normal: self.normal(ray.at(t)) })
    }

    /// The outward normal at a point of the surface, in f64: away from the centre of the ball that touches there.
    pub fn normal(&self, point: DVec3) -> DVec3 {
        let [a, b] = self.ends;
        let [r, q] = self.radii;
        let (u, delta) = (b - a, q - r);
        let k = u.length_squared() - delta * delta;
        let p = point - a;
        if k <= 0.0 {
            return if q > r { point - b } else { p }.normalize();
        }
        let s = (p.dot(u) + delta * r) / k;
        if s <= 0.0 {
            return p.normalize();
        }
        if s >= 1.0 {
            return (point - b).normalize();
        }
        // Across the axis as the point is, and leaning by the cone's angle.
        let across = p - p.dot(u) / u.length_squared() * u;
        let lean = delta / u.length();
        (1.0 - lean * lean).sqrt() * across.normalize() - lean * u.normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::super::capsule::Capsule;
    use super::super::random::{Random, f32s, towards};
    use super::super::sphere::Sphere;
    use super::*;

    /// The distance of a point from the surface: the least of |p - c(s)| - r(s), sought among many s.
    fn distance(swept: &Swept, point: DVec3) -> f64 {
        let at = |s: f64| {
            let center = swept.ends[0].lerp(swept.ends[1], s);
            let radius = swept.radii[0] + s * (swept.radii[1] - swept.radii[0]);
            (point - center).length() - radius
        };
        // It is convex in s, so thirds close in on the least.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..200 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if at(a) < at(b) { high = b } else { low = a }
        }
        at(0.0).min(at(1.0)).min(at(0.5 * (low + high)))
    }

    fn random_swept(random: &mut Random) -> Swept {
        let ends = [0, 1].map(|_| f32s(random.in_cube()));
        let radii = [0, 1].map(|_| f64::from(random.between(0.0, 0.6) as f32));
        Swept { ends, radii }
    }

    #[test]
    fn hits_lie_on_the_surface_and_misses_stay_away() {
        let mut random = Random(18);
        let (mut hits, mut misses) = (0, 0);
        for round in 0..400 {
            let swept = random_swept(&mut random);
            let from = if round % 4 == 0 { random.in_cube() } else { random.unit() * 6.0 };
            let target = swept.ends[0].lerp(swept.ends[1], random.between(0.0, 1.0));
            let ray = towards(from, target + 0.6 * random.in_cube());
            let Some(hit) = swept.intersect(&ray) else {
                misses += 1;
                // By sampling the ray: every point is outside.
                for step in 1..400 {
                    let point = ray.at(f64::from(step) * 0.01);
                    assert!(distance(&swept, point) > 0.0, "{swept:?} {ray:?}");
                }
                continue;
            };
            hits += 1;
            let point = ray.at(hit.t);
            assert!(distance(&swept, point).abs() < 1e-9, "{swept:?} {ray:?} {hit:?}");
            // Along the normal, and by no other way of that length, does one leave the surface fastest.
            let away = distance(&swept, point + 1e-3 * hit.normal);
            assert!((away - 1e-3).abs() < 1e-8, "{swept:?} {ray:?}: {away}");
            // Nothing is nearer.
            let outside = distance(&swept, ray.origin) > 0.0;
            let between = ray.at(0.5 * hit.t);
            assert_eq!(distance(&swept, between) > 0.0, outside, "{swept:?} {ray:?}");
        }
        println!("{hits} hits, {misses} misses");
        assert!(hits > 100 && misses > 50, "{hits} {misses}");
    }

    #[test]
    fn with_one_radius_it_is_a_capsule() {
        let mut random = Random(19);
        let mut hits = 0;
        for _ in 0..200 {
            let ends = [0, 1].map(|_| f32s(random.in_cube()));
            let ray = towards(random.unit() * 9.0, ends[0] + 0.4 * random.in_cube());
            let swept = Swept { ends, radii: [0.25; 2] };
            let capsule = Capsule { a: ends[0], b: ends[1], radius: 0.25 };
            let (one, other) = (swept.intersect(&ray), capsule.intersect(&ray));
            assert_eq!(one.map(|hit| hit.t), other.map(|hit| hit.t));
            hits += usize::from(one.is_some());
        }
        assert!((50..200).contains(&hits), "{hits}");
    }

    #[test]
    fn an_end_that_holds_the_other_is_a_sphere() {
        let ray = towards(DVec3::new(2.0, 3.0, 9.0), DVec3::new(0.1, 0.2, 0.0));
        let sphere = Sphere { center: DVec3::ZERO, radius: 0.5 };
        let exact = sphere.intersect_exact(&ray).map(|hit| hit.to_f64().t);
        for (end, radius) in [(DVec3::ZERO, 0.5), (DVec3::X * 0.25, 0.25), (DVec3::X * 0.25, 0.0)] {
            for order in [[0, 1], [1, 0]] {
                let (ends, radii) = ([DVec3::ZERO, end], [0.5, radius]);
                let swept = Swept { ends: order.map(|i| ends[i]), radii: order.map(|i| radii[i]) };
                assert_eq!(swept.intersect(&ray).map(|hit| hit.t), exact, "{swept:?}");
            }
        }
    }

    #[test]
    fn tips_tangents_and_rays_along_the_axis() {
        // A cone from a ball of radius 3 at -5 to a tip at 0: its body leans by the sine 3/5.
        let cone = Swept { ends: [DVec3::NEG_X * 5.0, DVec3::ZERO], radii: [3.0, 0.0] };
        let down = |x: f64| towards(DVec3::new(x, 8.0, 0.0), DVec3::new(x, 0.0, 0.0));
        // Touching circle at x = -5 + 3·3/5, where y = 3·4/5; the slope from there is 3/4.
        let hit = cone.intersect(&down(-2.0)).unwrap();
        assert!((hit.t * 8.0 - (8.0 - 1.5)).abs() < 1e-15, "{hit:?}");
        assert!((hit.normal - DVec3::new(0.6, 0.8, 0.0)).length() < 1e-15);
        // The tip itself, and just beyond.
        assert!(cone.intersect(&down(0.0)).is_some() && cone.intersect(&down(1e-30)).is_none());
        // Along the axis from both sides, and from inside.
        let axis = |from: f64, to: f64| towards(DVec3::X * from, DVec3::X * to);
        assert_eq!(cone.intersect(&axis(2.0, 1.0)).unwrap().t, 2.0);
        assert_eq!(cone.intersect(&axis(-10.0, -9.0)).unwrap().t, 2.0);
        assert_eq!(cone.intersect(&axis(-5.0, -6.0)).unwrap().t, 3.0);
        // Parallel to a line of the body the quadratic is a line: a = 0.
        let along = towards(DVec3::new(0.0, 1.0, 0.0), DVec3::new(-4.0, 4.0, 0.0));
        let line = towards(DVec3::new(4.0, -4.0, 0.0), DVec3::new(0.0, -1.0, 0.0));
        assert!(cone.intersect(&along).is_none());
        assert!(cone.intersect(&line).is_some());
    }

    #[test]
    fn a_grown_one_is_hit_by_more() {
        let swept = Swept { ends: [DVec3::ZERO, DVec3::X], radii: [0.5, 0.25] };
        let above = towards(DVec3::new(0.0, 0.5 + 1e-6, 3.0), DVec3::new(0.0, 0.5 + 1e-6, 0.0));
        assert!(swept.intersect(&above).is_none() || swept.intersect_grown(&above, 0.9).is_none());
        assert!(swept.intersect_grown(&above, 1.1).is_some());
    }
}
