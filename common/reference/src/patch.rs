//! Ray against a bilinear patch: exactly.

use dashu::base::SquareRoot;
use dashu::integer::{IBig, UBig};
use dashu::rational::RBig;
use glam::DVec3;

use super::rational::{rational, to_f64};
use super::ray::Ray;
use super::surd::Surd;
use super::surface::Surface;
use super::vector::Vector;

/// The corners at (u, v) = (0, 0), (1, 0), (0, 1) and (1, 1). Edges and corners belong to the patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch(pub [DVec3; 4]);

/// A hit: t, u and v.
type Hit = [Surd; 3];

impl Patch {
    /// The t of all hits within the ray's interval, in order, correctly rounded. Hits at the same point count once; a ray
    /// that lies in the surface has none.
    ///
    /// # Panics
    /// If a number is not finite.
    pub fn hits(&self, ray: &Ray) -> Vec<f64> {
        self.points(ray).iter().map(|[t, ..]| t.to_f64()).collect()
    }

    /// The first hit: t exactly and then rounded, the normal in f64, across the directions of u and v in this order.
    ///
    /// # Panics
    /// If a number is not finite.
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let points = self.points(ray);
        let [t, u, v] = points.first()?.each_ref().map(Surd::to_f64);
        let [a, b, c, d] = self.0;
        let along_u = (b - a).lerp(d - c, v);
        let along_v = (c - a).lerp(d - b, u);
        Some(Surface { t, normal: along_u.cross(along_v).normalize_or_zero() })
    }

    fn points(&self, ray: &Ray) -> Vec<Hit> {
        let (o, d) = (Vector::from(ray.origin), Vector::from(ray.direction));
        let corners = self.0.map(|corner| &Vector::from(corner) - &o);
        let mut found: Vec<Hit> = Vec::new();
        let mut add = |hit: Option<Hit>| {
            let Some([t, u, v]) = hit else { return };
            let is_within = |x: &Surd| x.sign().is_ge() && x.compare(&RBig::ONE).is_le();
            if t.within(ray) && is_within(&u) && is_within(&v) {
                found.push([t, u, v]);
            }
        };
        let [a, b, c, e] = corners.each_ref();
        match roots(&d, [a, b, c, e]) {
            Some(roots) => {
                roots.into_iter().for_each(|u| add(on_line(&d, [a, b, c, e], &u)));
            }
            // All lines of one kind meet the ray; those of the other kind decide.
            None => {
                for v in roots(&d, [a, c, b, e]).unwrap_or_default() {
                    add(on_line(&d, [a, c, b, e], &v).map(|[t, v, u]| [t, u, v]));
                }
            }
        }
        found.sort_by(|a, b| a[0].to_f64().total_cmp(&b[0].to_f64()));
        // Of a flat patch, two pairs of u and v may be one point, which is where the ray meets the plane.
        let volume = (b - a).cross(&(c - a)).dot(&(e - a));
        if volume.is_zero() {
            found.truncate(1);
        }
        found
    }
}

/// A number p + q·√D of one D, as p and q: such numbers are a field.
#[derive(Clone, Debug)]
struct Number {
    p: RBig,
    q: RBig,
    square: RBig,
}

impl Number {
    /// The number without q if √D is rational, so that zero has one form.
    fn new(p: RBig, q: RBig, square: &RBig) -> Self {
        let (numerator, denominator) = square.clone().into_parts();
        let numerator = UBig::try_from(numerator).expect("a square is not negative");
        let (over, under) = (numerator.sqrt(), denominator.sqrt());
        if &over * &over == numerator && &under * &under == denominator {
            let root = RBig::from_parts(IBig::from(over), under);
            return Self { p: p + q * root, q: RBig::ZERO, square: RBig::ZERO };
        }
        Self { p, q, square: square.clone() }
    }

    fn with(&self, p: RBig, q: RBig) -> Self {
        Self { p, q, square: self.square.clone() }
    }

    /// start + self·(end - start).
    fn between(&self, start: &RBig, end: &RBig) -> Self {
        let step = end - start;
        self.with(start + &self.p * &step, &self.q * &step)
    }

    fn minus(&self, other: &Self) -> Self {
        self.with(&self.p - &other.p, &self.q - &other.q)
    }

    fn times(&self, other: &Self) -> Self {
        let p = &self.p * &other.p + &self.q * &other.q * &self.square;
        self.with(p, &self.p * &other.q + &self.q * &other.p)
    }

    fn is_zero(&self) -> bool {
        self.p.is_zero() && self.q.is_zero()
    }

    fn over(&self, other: &Self) -> Self {
        let norm = &other.p * &other.p - &other.q * &other.q * &other.square;
        let product = self.times(&other.with(other.p.clone(), -other.q.clone()));
        self.with(product.p / &norm, product.q / norm)
    }

    fn surd(&self) -> Surd {
        Surd::new(self.p.clone(), self.q.clone(), self.square.clone())
    }
}

/// The u for which the line from a–b to c–e at u and the ray through 0 are in one plane; `None` if all are.
fn roots(d: &Vector, [a, b, c, e]: [&Vector; 4]) -> Option<Vec<Number>> {
    // d · ((a + u·(b - a)) × (c + u·(e - c))), by the powers of u.
    let (low, high) = (b - a, e - c);
    let square = d.dot(&low.cross(&high));
    let half = (d.dot(&a.cross(&high)) + d.dot(&low.cross(c))) / RBig::from(2);
    let rest = d.dot(&a.cross(c));
    if square.is_zero() {
        if half.is_zero() {
            return if rest.is_zero() { None } else { Some(Vec::new()) };
        }
        return Some(vec![Number::new(-rest / (RBig::from(2) * half), RBig::ZERO, &RBig::ZERO)]);
    }
    let discriminant = &half * &half - &square * &rest;
    if discriminant < RBig::ZERO {
        return Some(Vec::new());
    }
    let root = |sign: i32| Number::new(-&half / &square, RBig::from(sign) / &square, &discriminant);
    Some(if discriminant.is_zero() { vec![root(1)] } else { vec![root(-1), root(1)] })
}

/// Where the ray meets the line at u: t, u, and the place on the line from 0 to 1.
fn on_line(d: &Vector, [a, b, c, e]: [&Vector; 4], u: &Number) -> Option<Hit> {
    let start: Vec<Number> = (0..3).map(|k| u.between(&a.0[k], &b.0[k])).collect();
    let end: Vec<Number> = (0..3).map(|k| u.between(&c.0[k], &e.0[k])).collect();
    let k = (0..3).max_by(|&i, &j| to_f64(&d.0[i]).abs().total_cmp(&to_f64(&d.0[j]).abs()))?;
    // Across the direction, with its component k for a unit.
    let across = |p: &[Number], i: usize| {
        let number = |x: &RBig| u.with(x.clone(), RBig::ZERO);
        p[i].times(&number(&d.0[k])).minus(&p[k].times(&number(&d.0[i])))
    };
    let others = [(k + 1) % 3, (k + 2) % 3];
    let from = others.map(|i| across(&start, i));
    let to = others.map(|i| across(&end, i));
    let step = [0, 1].map(|i| from[i].minus(&to[i]));
    let along = |point: &Number| u.with(&point.p / &d.0[k], &point.q / &d.0[k]);
    let Some(i) = step.iter().position(|x| !x.is_zero()) else {
        // Parallel to the ray. Only a line without length can still be met.
        let is_point = (0..3).all(|k| start[k].minus(&end[k]).is_zero());
        let is_met = is_point && from.iter().all(Number::is_zero);
        let half = Surd::from(rational(0.5));
        return is_met.then(|| [along(&start[k]).surd(), u.surd(), half]);
    };
    let v = from[i].over(&step[i]);
    let other = 1 - i;
    if !from[other].minus(&v.times(&step[other])).is_zero() {
        return None;
    }
    let point = start[k].minus(&v.times(&start[k].minus(&end[k])));
    Some([along(&point).surd(), u.surd(), v.surd()])
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, towards};
    use super::super::triangle;
    use super::*;

    fn hits(corners: [[f64; 3]; 4], origin: [f64; 3], direction: [f64; 3]) -> Vec<f64> {
        let [origin, direction] = [origin, direction].map(DVec3::from);
        let ray = Ray { origin, direction, tmin: 0.0, tmax: 1e30 };
        Patch(corners.map(DVec3::from)).hits(&ray)
    }

    const FLAT: [[f64; 3]; 4] =
        [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, 1.0, 0.0]];
    /// z = xy for x and y from -1 to 1.
    const SADDLE: [[f64; 3]; 4] =
        [[-1.0, -1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, 1.0]];

    #[test]
    fn known_rays_have_their_known_hits() {
        assert_eq!(hits(FLAT, [0.5, 0.5, 4.0], [0.0, 0.0, -2.0]), [2.0]);
        assert_eq!(hits(FLAT, [2.0, 1.0, 4.0], [0.0, 0.0, -1.0]), [4.0]);
        assert!(hits(FLAT, [2.0, 1.5, 4.0], [0.0, 0.0, -1.0]).is_empty());
        assert!(hits(FLAT, [-1.0, 0.5, 0.0], [1.0, 0.0, 0.0]).is_empty());
        assert_eq!(hits(SADDLE, [0.5, 0.5, 4.0], [0.0, 0.0, -1.0]), [3.75]);
        // z = x² along the diagonal: two hits, a tangent, none.
        assert_eq!(hits(SADDLE, [-2.0, -2.0, 0.25], [1.0, 1.0, 0.0]), [1.5, 2.5]);
        assert_eq!(hits(SADDLE, [-2.0, -2.0, 0.0], [1.0, 1.0, 0.0]), [2.0]);
        assert!(hits(SADDLE, [-2.0, -2.0, -0.25], [1.0, 1.0, 0.0]).is_empty());
        assert_eq!(hits(SADDLE, [-2.0, -2.0, 1.0], [1.0, 1.0, 0.0]), [1.0, 3.0]);
        // In a line of the surface, and beside it.
        assert!(hits(SADDLE, [-2.0, 0.5, -1.0], [1.0, 0.0, 0.5]).is_empty());
        assert!(hits(SADDLE, [-2.0, 0.5, -0.75], [1.0, 0.0, 0.5]).is_empty());
        assert_eq!(hits(SADDLE, [-2.0, 0.5, -0.5], [1.0, 0.0, 0.25]), [2.0]);
        assert_eq!(hits(SADDLE, [-2.0, 0.5, -0.75], [1.0, 0.0, 0.25]), [1.0]);
    }

    #[test]
    fn an_edge_may_be_a_point_and_a_flat_patch_may_be_folded() {
        let tip = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [-1.0, 2.0, 0.0], [1.0, 2.0, 1.0]];
        assert_eq!(hits(tip, [0.0, 0.0, 4.0], [0.0, 0.0, -1.0]), [4.0]);
        assert!(hits(tip, [0.0, -0.001, 4.0], [0.0, 0.0, -1.0]).is_empty());
        // Two edges cross: the halves meet in a point, and so does every line of one kind there.
        let bow = [[0.0, 0.0, 0.0], [2.0, 2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        assert_eq!(hits(bow, [1.0, 0.5, 3.0], [0.0, 0.0, -1.0]), [3.0]);
        assert_eq!(hits(bow, [1.0, 1.0, 3.0], [0.0, 0.0, -1.0]), [3.0]);
        assert!(hits(bow, [0.5, 1.0, 3.0], [0.0, 0.0, -1.0]).is_empty());
        // A corner inside the triangle of the others: some points have two pairs of u and v.
        let dart = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 0.0]];
        assert_eq!(hits(dart, [1.25, 1.25, 3.0], [0.0, 0.0, -1.0]), [3.0]);
    }

    #[test]
    fn a_flat_convex_patch_is_its_two_triangles() {
        let mut random = Random(22);
        let mut met = 0;
        for _ in 0..200 {
            let [u, v] = [random.in_cube(), random.in_cube()].map(f32s);
            let o = f32s(random.in_cube());
            // A trapezium, whose corners are exactly in one plane.
            let corners = [o, o + u, o + v, o + v + u * 0.5];
            let ray = towards(random.unit() * 4.0, o + (u + v) * random.between(-0.5, 1.0));
            let halves = [[0, 1, 2], [3, 1, 2]].map(|half| half.map(|i| corners[i]));
            let exact = halves.iter().find_map(|half| triangle::intersect_exact(&ray, half));
            let expected = exact.map(|hit| hit.surface.to_f64().t);
            assert_eq!(Patch(corners).hits(&ray).first().copied(), expected);
            met += usize::from(expected.is_some());
        }
        assert!(met > 50, "{met}");
    }

    #[test]
    fn hits_are_on_the_patch_and_turn_with_it() {
        let mut random = Random(64);
        let mut met = [0; 3];
        for _ in 0..400 {
            let corners = [(); 4].map(|()| f32s(random.in_cube()));
            let patch = Patch(corners);
            let ray = towards(f32s(random.unit() * 3.0), random.in_cube() * 0.6);
            let found = patch.points(&ray);
            met[found.len()] += 1;
            for [t, u, v] in &found {
                let [t, u, v] = [t, u, v].map(Surd::to_f64);
                let [a, b, c, d] = corners;
                let point = a.lerp(b, u).lerp(c.lerp(d, u), v);
                assert!((point - ray.at(t)).length() < 1e-12, "{corners:?} {ray:?}");
            }
            let [a, b, c, d] = corners;
            for turned in [[b, d, a, c], [a, c, b, d], [d, c, b, a]] {
                assert_eq!(Patch(turned).hits(&ray), patch.hits(&ray));
            }
        }
        assert!(met[1] > 50 && met[2] > 2, "{met:?}");
    }
}
