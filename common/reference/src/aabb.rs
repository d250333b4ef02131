//! Ray against axis-aligned box: three slabs.

use dashu::rational::RBig;
use glam::DVec3;

use super::rational::rational;
use super::ray::Ray;
use super::surd::Surd;
use super::surface::Surface;
use super::vector::Vector;

/// A closed axis-aligned box; its surface, not its interior, is what a ray hits.
///
/// It may be flat in any axis. Where `low > high` it is empty and never hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The corner with the least coordinates.
    pub low: DVec3,
    /// The corner with the greatest coordinates.
    pub high: DVec3,
}

/// The hit of a ray with a box, exactly.
#[derive(Clone, Debug)]
pub struct ExactBoxHit {
    /// Ray parameter of the hit, in lengths of the ray's direction.
    pub t: RBig,
    /// Outward unit normals of the faces hit: one, or two or three where an edge or corner is hit.
    pub faces: Vec<DVec3>,
}

/// The axis along which `sign` (±1) points.
fn face(axis: usize, sign: f64) -> DVec3 {
    let mut normal = DVec3::ZERO;
    normal[axis] = sign;
    normal
}

impl Aabb {
    /// The first hit in f64, with the outward normal of one of the faces hit.
    ///
    /// A ray that runs along an axis (d = 0) is compared with the slab instead of divided by zero,
    /// after Majercik et al., *A Ray-Box Intersection Algorithm and Efficient Dynamic Voxel Rendering*
    /// (JCGT 7:3, 2018). t is off by at most two roundings, and exact slabs in order stay in order.
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        let (mut near_face, mut far_face) = (DVec3::ZERO, DVec3::ZERO);
        for axis in 0..3 {
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            let (low, high) = (self.low[axis], self.high[axis]);
            if d == 0.0 {
                if !(low..=high).contains(&o) {
                    return None;
                }
                continue;
            }
            let (enter, leave) = if d > 0.0 { (low, high) } else { (high, low) };
            let (enter, leave) = ((enter - o) / d, (leave - o) / d);
            // Comparisons with NaN are false and would leave the slab out.
            if enter.is_nan() || leave.is_nan() {
                return None;
            }
            if enter > near {
                (near, near_face) = (enter, face(axis, -d.signum()));
            }
            if leave < far {
                (far, far_face) = (leave, face(axis, d.signum()));
            }
        }
        // A ray without a direction leaves both ends infinite, and no t contains them.
        if near > far || near == f64::NEG_INFINITY {
            return None;
        }
        let ends = [(near, near_face), (far, far_face)];
        let (t, normal) = ends.into_iter().find(|&(t, _)| ray.contains(t))?;
        Some(Surface { t, normal })
    }

    /// The first hit, exactly, with all the faces that meet there.
    ///
    /// # Panics
    /// If a number of the box or of the ray (but `tmin`, `tmax`) is not finite.
    pub fn intersect_exact(&self, ray: &Ray) -> Option<ExactBoxHit> {
        let [o, d, low, high] = [ray.origin, ray.direction, self.low, self.high].map(Vector::from);
        let mut enters = Vec::new();
        let mut leaves = Vec::new();
        for axis in 0..3 {
            let along = ray.direction[axis];
            if low.0[axis] > high.0[axis] {
                return None;
            }
            if along == 0.0 {
                if o.0[axis] < low.0[axis] || o.0[axis] > high.0[axis] {
                    return None;
                }
                continue;
            }
            let at = |wall: &Vector| (&wall.0[axis] - &o.0[axis]) / &d.0[axis];
            let (enter, leave) = if along > 0.0 { (&low, &high) } else { (&high, &low) };
            enters.push((at(enter), face(axis, -along.signum())));
            leaves.push((at(leave), face(axis, along.signum())));
        }
        let near = enters.iter().map(|(t, _)| t).max()?.clone();
        let far = leaves.iter().map(|(t, _)| t).min()?.clone();
        if near > far {
            return None;
        }
        let (t, walls) = [(near, enters), (far, leaves)]
            .into_iter()
            .find(|(t, _)| Surd::from(t.clone()).within(ray))?;
        let faces = walls.into_iter().filter(|wall| wall.0 == t).map(|wall| wall.1).collect();
        Some(ExactBoxHit { t, faces })
    }

    /// True if a point is in the closed box, exactly.
    ///
    /// # Panics
    /// If a coordinate of the box is not finite.
    pub fn contains_exact(&self, point: &Vector) -> bool {
        (0..3).all(|i| rational(self.low[i]) <= point.0[i] && point.0[i] <= rational(self.high[i]))
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, towards};
    use super::super::rational::to_f64;
    use super::*;
    use proptest::prelude::*;

    /// Compares both and returns whether they hit.
    fn agree(aabb: &Aabb, ray: &Ray) -> bool {
        match (aabb.intersect(ray), aabb.intersect_exact(ray)) {
            (Some(plain), Some(exact)) => {
                let t = to_f64(&exact.t);
                assert!((plain.t - t).abs() <= 2.0 * f64::EPSILON * t, "{plain:?} {exact:?}");
                assert!(exact.faces.contains(&plain.normal), "{plain:?} {exact:?}");
                true
            }
            (None, None) => false,
            (plain, exact) => panic!("{aabb:?} {ray:?}: f64 {plain:?}, exact {exact:?}"),
        }
    }

    #[test]
    fn f64_agrees_with_exact() {
        let mut random = Random(4);
        let mut hits = 0;
        for _ in 0..1000 {
            let scale = random.scale(1e-4, 1e4);
            let [a, b] = [0, 0].map(|_| f32s(random.in_cube() * scale));
            let aabb = Aabb { low: a.min(b), high: a.max(b) };
            let origin = random.in_cube() * random.scale(0.1, 1e4) * scale;
            let inside = aabb.low + (aabb.high - aabb.low) * (random.in_cube() * 0.6 + 0.5);
            hits += usize::from(agree(&aabb, &towards(origin, inside)));
        }
        assert!((500..1000).contains(&hits), "{hits}");
    }

    /// Rays within a face, an edge, or just outside, along every axis and both ways.
    #[test]
    fn rays_along_faces_and_edges() {
        let aabb = Aabb { low: DVec3::NEG_ONE, high: DVec3::ONE };
        let just_outside = f64::from(1f32.next_up());
        for axis in 0..3 {
            for way in [-1.0, 1.0] {
                for u in [-just_outside, -1.0, -0.5, 0.0, 1.0, just_outside] {
                    for v in [-just_outside, -1.0, 0.25, 1.0, just_outside] {
                        let mut origin = DVec3::ZERO;
                        origin[axis] = -way * 3.0;
                        origin[(axis + 1) % 3] = u;
                        origin[(axis + 2) % 3] = v;
                        let ray = Ray { direction: face(axis, way), ..towards(origin, origin) };
                        let inside = u.abs() <= 1.0 && v.abs() <= 1.0;
                        assert_eq!(agree(&aabb, &ray), inside, "{ray:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn edges_corners_and_flat_boxes() {
        let aabb = Aabb { low: DVec3::NEG_ONE, high: DVec3::ONE };
        // Through the corner, cutting across an edge at one point, and missing that edge by 1 ULP.
        let corner = aabb.intersect_exact(&towards(DVec3::splat(2.0), DVec3::ONE)).unwrap();
        assert_eq!(corner.faces.len(), 3);
        let graze = |x: f64| Ray {
            direction: DVec3::new(-1.0, 1.0, 0.0),
            ..towards(DVec3::new(x, 0.0, 0.0), DVec3::ZERO)
        };
        assert!(agree(&aabb, &graze(2.0)));
        assert!(!agree(&aabb, &graze(f64::from(2f32.next_up()))));
        let flat = Aabb { low: DVec3::new(-1.0, 0.0, -1.0), high: DVec3::new(1.0, 0.0, 1.0) };
        assert!(agree(&flat, &towards(DVec3::Y, DVec3::ZERO)));
        assert!(agree(&flat, &towards(DVec3::NEG_X * 2.0, DVec3::ZERO)));
        let empty = Aabb { low: DVec3::ONE, high: DVec3::NEG_ONE };
        assert!(!agree(&empty, &towards(DVec3::Y * 3.0, DVec3::ZERO)));
        let still = Ray { direction: DVec3::ZERO, ..towards(DVec3::ZERO, DVec3::X) };
        assert!(!agree(&aabb, &still));
        for origin in [DVec3::new(f64::NAN, 0.0, 5.0), DVec3::new(0.0, 0.0, f64::NAN)] {
            for direction in [DVec3::NEG_Z, DVec3::new(0.1, 0.0, -1.0)] {
                assert!(aabb.intersect(&Ray { origin, direction, ..still }).is_none());
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]
        /// The point hit lies in the closed box and on every face named.
        #[test]
        fn exact_hits_lie_on_their_faces(o in prop::array::uniform3(-4i8..4), d in prop::array::uniform3(-3i8..3)) {
            // Small integers, so that corners, edges and parallel rays turn up all the time.
            let [o, d] = [o, d].map(|v| DVec3::from_array(v.map(f64::from)));
            let ray = Ray { origin: o, direction: d, tmin: 0.0, tmax: f64::INFINITY };
            let aabb = Aabb { low: DVec3::NEG_ONE, high: DVec3::splat(2.0) };
            let exact = aabb.intersect_exact(&ray);
            prop_assert_eq!(agree(&aabb, &ray), exact.is_some());
            if let Some(hit) = exact {
                let point = &Vector::from(o) + &(&Vector::from(d) * &hit.t);
                prop_assert!(aabb.contains_exact(&point));
                for face in hit.faces {
                    let wall = if face.max_element() > 0.0 { 2.0 } else { 1.0 };
                    prop_assert_eq!(point.dot(&Vector::from(face)), rational(wall));
                }
            }
        }
    }
}
