//! Judging a GPU's answer to one ray: right, excused by a derived bound, or wrong.
//!
//! The set of triangles that a renderer in f32 finds hit is not free: it holds every triangle that
//! *must* be hit ([`Candidate::must_hit`]) and none that it *may not* hit ([`Candidate::may_hit`]). Of
//! that set it answers the nearest by its own t, each off by its bound at most. So
//! - a miss is allowed if there is nothing that must be hit;
//! - a hit is allowed if it may be hit, its t is within the bound, and nothing that must be hit lies
//!   nearer by more than its own bound.
//!
//! Everything else is wrong. What is allowed but differs from the exact answer is named and carries
//! its margin and bound, so that tests can count and print it.

use super::hit::{Candidate, Hit};
use super::ray::Ray;
use super::scene::Scene;

/// The GPU's answer for a ray that hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// `gl_InstanceID`.
    pub instance: u32,
    /// The primitive's original number, before any reordering.
    pub primitive: u32,
    /// `gl_HitTEXT`.
    pub t: f32,
}

/// The judgement on one answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The exact closest hit with t within its bound, or rightly a miss.
    Agrees,
    /// Another triangle that the ray also hits, at the same distance within the bounds on t.
    Tie {
        /// Its distance beyond the exact closest hit, in t.
        distance: f64,
        /// The two bounds on t together.
        bound: f64,
    },
    /// The difference is explained by an edge that the ray grazes.
    WithinEdgeBound {
        /// Distance from that edge in world units, seen along the ray; negative outside.
        margin: f64,
        /// The bound on it.
        bound: f64,
    },
    /// The difference is explained by a hit at the very end of the ray's interval.
    WithinIntervalBound {
        /// t of that hit.
        t: f64,
        /// The bound on it.
        bound: f64,
    },
    /// Nothing explains the answer.
    Wrong {
        /// The exact answer.
        expected: Option<Hit>,
        /// The fault in the GPU's answer.
        fault: Fault,
    },
}

impl Verdict {
    /// True if the answer is right or excused.
    pub fn is_allowed(&self) -> bool {
        !matches!(self, Self::Wrong { .. })
    }
}

/// The reason why an answer cannot be right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// The scene has no such instance or primitive.
    Unknown,
    /// The filter excludes the answered triangle.
    Excluded,
    /// The ray passes the answered triangle by more than the bound.
    Outside {
        /// Distance to the deciding edge in world units, seen along the ray; negative outside.
        margin: f64,
        /// The bound on it.
        bound: f64,
    },
    /// The right triangle with a wrong t; also if that t is outside the ray's interval.
    Distance {
        /// t of the answered triangle.
        t: f64,
        /// The bound on it.
        bound: f64,
    },
    /// This triangle must be hit, and nearer, or at all.
    Overlooked(Hit),
}

impl Scene {
    /// Judges the GPU's closest hit, `None` for a miss, of the ray whose bits it wrote.
    ///
    /// `accept` stands for culling and any-hit shaders, as in [`Scene::closest_hit`].
    pub fn judge(
        &self,
        ray: &Ray,
        answer: Option<Answer>,
        accept: impl Fn(&Hit) -> bool,
    ) -> Verdict {
        let accept = &accept;
        let expected = self.closest_hit(ray, accept);
        let wrong = |fault| Verdict::Wrong { expected, fault };
        let musts = || {
            let hits = self.all_hits(ray).into_iter().filter(accept);
            hits.map(|hit| self.candidate(ray, hit)).filter(|candidate| candidate.must_hit(ray))
        };
        let Some(answer) = answer else {
            let Some(expected) = expected else { return Verdict::Agrees };
            return match musts().next() {
                Some(must) => wrong(Fault::Overlooked(must.hit)),
                None => excuse(ray, self.candidate(ray, expected)),
            };
        };

        let Some(answered) = self.candidate_at(ray, answer.instance, answer.primitive) else {
            return wrong(Fault::Unknown);
        };
        let t = f64::from(answer.t);
        let (margin, bound) = (answered.graze.margin, answered.graze.bound);
        if !accept(&answered.hit) {
            return wrong(Fault::Excluded);
        }
        if !answered.graze.may_hit() {
            return wrong(Fault::Outside { margin, bound });
        }
        // Edge-on the exact t is NaN and its bound infinite: any t will do, but not NaN.
        if t.is_nan() || (t - answered.hit.t).abs() > answered.t_bound || !answered.may_hit(ray) {
            return wrong(Fault::Distance { t: answered.hit.t, bound: answered.t_bound });
        }
        let same = |hit: &Hit| (hit.instance, hit.primitive) == (answer.instance, answer.primitive);
        if expected.as_ref().is_some_and(same) {
            return Verdict::Agrees;
        }
        if let Some(must) = musts().find(|must| !same(&must.hit) && must.hit.t + must.t_bound < t) {
            return wrong(Fault::Overlooked(must.hit));
        }
        let truly_hit = answered.hit.crossing.inside && ray.contains(answered.hit.t);
        match expected.filter(|_| truly_hit) {
            None => excuse(ray, answered),
            Some(expected) => {
                let expected = self.candidate(ray, expected);
                let distance = answered.hit.t - expected.hit.t;
                let bound = answered.t_bound + expected.t_bound;
                if distance <= bound {
                    Verdict::Tie { distance, bound }
                } else {
                    excuse(ray, expected)
                }
            }
        }
    }
}

/// Names what makes this triangle doubtful: its edge, or else the end of the interval.
fn excuse(ray: &Ray, doubtful: Candidate) -> Verdict {
    let graze = doubtful.graze;
    let edge = graze.margin < 0.0 || ray.contains(doubtful.hit.t);
    if edge && graze.may_miss() {
        Verdict::WithinEdgeBound { margin: graze.margin, bound: graze.bound }
    } else {
        Verdict::WithinIntervalBound { t: doubtful.hit.t, bound: doubtful.t_bound }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::random::{Random, towards};
    use super::super::scene::Instance;
    use super::super::simulated::{Test, meshes, moller_trumbore, render, woop};
    use super::super::transform::Transform;
    use super::*;

    fn scene() -> Scene {
        Scene::new(meshes().into_iter().map(|(rows, triangles)| Instance {
            transform: Transform::from_rows(rows).unwrap(),
            triangles,
        }))
    }

    /// Half the rays through points of the lattice of edges, half anywhere.
    fn rays(seed: u64, n: usize) -> impl Iterator<Item = Ray> {
        let mut random = Random(seed);
        let scene = scene();
        (0..n).map(move |round| {
            let origin = random.in_cube() * 2.0 + DVec3::Z * 5.0;
            let mut target = random.in_cube() * DVec3::new(1.1, 1.1, 0.0);
            if round % 2 == 0 {
                let [a, b, _] =
                    *scene.triangle(random.below(2) as u32, random.below(128) as u32).unwrap();
                target = a.lerp(b, random.between(0.0, 1.0));
            }
            towards(origin, target)
        })
    }

    fn judge_all(test: Test) {
        let scene = scene();
        let (mut agree, mut excused) = (0, 0);
        for ray in rays(40, 3000) {
            let answer = render(&ray, test);
            match scene.judge(&ray, answer, |_| true) {
                Verdict::Agrees => agree += 1,
                Verdict::Wrong { expected, fault } => {
                    panic!("{ray:?}: {answer:?}, expected {expected:?}: {fault:?}")
                }
                _ => excused += 1,
            }
        }
        // The rays at edges must have made use of the excuses, or they are not tested.
        assert!(agree > 2000 && excused > 200, "{agree} {excused}");
    }

    #[test]
    fn a_renderer_in_f32_is_never_wrong() {
        judge_all(woop);
        judge_all(moller_trumbore);
    }

    #[test]
    fn every_fault_is_seen() {
        let scene = scene();
        let (mut overlooked, mut outside, mut distance) = (0, 0, 0);
        let fault = |ray: &Ray, answer| match scene.judge(ray, answer, |_| true) {
            Verdict::Wrong { fault, .. } => Some(fault),
            _ => None,
        };
        for ray in rays(41, 1000) {
            let Some(answer) = render(&ray, woop) else { continue };
            // At random a ray misses all borders by more than the bound; the rest is passed over.
            let all = scene.near_candidates(&ray);
            if all.iter().any(|candidate| !candidate.must_hit(&ray)) {
                continue;
            }
            if let Some(Fault::Overlooked(_)) = fault(&ray, None) {
                overlooked += 1;
            }
            let other = Answer { primitive: (answer.primitive + 1) % 128, ..answer };
            if let Some(Fault::Outside { margin, bound }) = fault(&ray, Some(other)) {
                assert!(margin < -bound);
                outside += 1;
            }
            for factor in [1.0 + 1e-4, 1.0 - 1e-4, f32::NAN, f32::INFINITY] {
                let moved = Answer { t: answer.t * factor, ..answer };
                assert!(matches!(fault(&ray, Some(moved)), Some(Fault::Distance { .. })));
                distance += 1;
            }
            for hit in scene.all_hits(&ray).into_iter().skip(1) {
                let Hit { instance, primitive, t, .. } = hit;
                let farther = Answer { instance, primitive, t: t as f32 };
                assert!(matches!(fault(&ray, Some(farther)), Some(Fault::Overlooked(_))));
            }
            let unknown = Answer { instance: 2, ..answer };
            assert_eq!(fault(&ray, Some(unknown)), Some(Fault::Unknown));
            let verdict = scene.judge(&ray, Some(answer), |hit| hit.instance != answer.instance);
            assert!(matches!(verdict, Verdict::Wrong { fault: Fault::Excluded, .. }));
        }
        assert!(overlooked > 300 && outside == overlooked && distance == 4 * overlooked);
    }

    /// Two triangles that share an edge, one in front of the other, and rays at it.
    #[test]
    fn ties_edges_and_interval_ends_are_told_apart() {
        let triangle = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let neighbour = [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, -1.0, 0.0]];
        let transform = Transform::identity();
        let triangles = vec![triangle, triangle, neighbour];
        let scene = Scene::new([Instance { transform, triangles }]);
        let down = |x: f64, y: f64| Ray {
            direction: DVec3::NEG_Z,
            ..towards(DVec3::new(x, y, 5.0), DVec3::ZERO)
        };
        let judge = |ray: &Ray, primitive: u32| {
            scene.judge(ray, Some(Answer { instance: 0, primitive, t: 5.0 }), |_| true)
        };
        assert_eq!(judge(&down(0.25, 0.25), 0), Verdict::Agrees);
        assert!(matches!(judge(&down(0.25, 0.25), 1), Verdict::Tie { distance: 0.0, .. }));
        assert!(matches!(judge(&down(0.25, 0.25), 2), Verdict::Wrong { .. }));
        let verdict = judge(&down(0.25, 1e-7), 2);
        assert!(matches!(verdict, Verdict::WithinEdgeBound { margin, .. } if margin < 0.0));
        assert!(matches!(judge(&down(0.25, 1e-4), 2), Verdict::Wrong { .. }));
        // At the outer edge a miss is as good as a hit.
        let outer = down(0.5, 0.5);
        assert!(scene.judge(&outer, None, |_| true).is_allowed());
        assert!(!scene.judge(&down(0.5, 0.499), None, |_| true).is_allowed());

        // tmax at the hit: a hit by this room's convention, none by Vulkan's.
        let end = Ray { tmax: 5.0, ..down(0.25, 0.25) };
        let verdict = scene.judge(&end, None, |_| true);
        assert!(matches!(verdict, Verdict::WithinIntervalBound { t: 5.0, .. }));
        let start = Ray { tmin: 5.0, ..down(0.25, 0.25) };
        assert_eq!(scene.judge(&start, None, |_| true), Verdict::Agrees);
        assert!(matches!(judge(&start, 0), Verdict::WithinIntervalBound { .. }));
        let before = Ray { tmin: 4.99, ..down(0.25, 0.25) };
        assert!(!scene.judge(&before, None, |_| true).is_allowed());
        let after = Ray { tmin: 5.01, ..down(0.25, 0.25) };
        assert!(!judge(&after, 0).is_allowed());
    }
}
