//! A ray that leaves a surface, in exact arithmetic: the surfaces it may hit, and those it must.

use std::fmt;

use glam::DVec3;
use reference::Ray;
use reference::hit::Hit;
use reference::scene::Scene;
use reference::verdict::Answer;
use serde_json::{Value, json};

/// The outcome of a ray that left a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The same as in exact arithmetic.
    Right,
    /// Different, but closer to an edge or to the surface than [`Leaving::gap`].
    Close,
    /// The ray hit the surface it left, or something behind the plane of that triangle.
    SelfHit,
    /// The ray missed a surface that exact arithmetic hits.
    Lost,
    /// The ray hit a surface that exact arithmetic misses.
    Astray,
}

/// A ray that the GPU traced from a triangle, and the exact one: the same direction, but from the exact point
/// where the previous ray hit the triangle.
#[derive(Clone, Copy)]
pub struct Leaving<'a> {
    scene: &'a Scene,
    own: (u32, u32),
    traced: Ray,
    ray: Ray,
    corner: DVec3,
    up: DVec3,
    /// 64 units in the last place of the largest coordinate involved: an occluder this low may be missed, and
    /// one whose edge is this close may be missed or hit.
    gap: f64,
}

impl<'a> Leaving<'a> {
    /// `traced` is the GPU's ray, bit for bit; the previous one was `arriving` and had this hit.
    ///
    /// # Panics
    /// If the scene has no such triangle.
    pub fn new(scene: &'a Scene, arriving: &Ray, hit: &Answer, traced: &Ray) -> Self {
        let (instance, primitive) = (hit.instance, hit.primitive);
        let [a, b, c] = *scene.triangle(instance, primitive).expect("a triangle of the scene");
        let exact = scene.candidate_at(arriving, instance, primitive).expect("the same triangle");
        let origin = arriving.at(exact.hit.t);
        let normal = (b - a).cross(c - a).normalize();
        let up = if normal.dot(arriving.direction) > 0.0 { -normal } else { normal };
        let largest =
            [origin, a, b, c].into_iter().map(|v| v.abs().max_element()).fold(0.0, f64::max);
        let ulp = 2f64.powi(largest.log2().floor() as i32 - 23);
        let ray = Ray { origin, tmin: 0.0, ..*traced };
        let own = (instance, primitive);
        Self { scene, own, traced: *traced, ray, corner: a, up, gap: 64.0 * ulp }
    }

    /// Sine of the angle between the ray and the surface; negative if the ray enters it.
    pub fn steepness(&self) -> f64 {
        self.up.dot(self.ray.direction) / self.ray.direction.length()
    }

    /// Judges the nearest hit found by the GPU, `None` for a miss.
    pub fn nearest(&self, answer: Option<Answer>) -> Outcome {
        if let Some(must) = self.must_hit() {
            let reached = |answer: &Answer| {
                let along =
                    (self.traced.at(answer.t.into()) - self.ray.origin).dot(self.ray.direction);
                let t = along / self.ray.direction.length_squared();
                (answer.instance, answer.primitive) == (must.0.instance, must.0.primitive)
                    || t <= must.0.t + must.1
            };
            if !answer.as_ref().is_some_and(reached) {
                return Outcome::Lost;
            }
        }
        let exact = self.scene.closest_hit(&self.ray, |hit| self.id(hit) != self.own);
        match answer {
            None if exact.is_none() => Outcome::Right,
            None => Outcome::Close,
            Some(answer) => match self.explain(answer.instance, answer.primitive) {
                Some(fault) => fault,
                None if exact
                    .is_some_and(|hit| self.id(&hit) == (answer.instance, answer.primitive)) =>
                {
                    Outcome::Right
                }
                None => Outcome::Close,
            },
        }
    }

    /// Judges whether the GPU's ray hit anything at all.
    pub fn any(&self, blocked: bool) -> Outcome {
        let exact = self.scene.closest_hit(&self.ray, |hit| self.id(hit) != self.own).is_some();
        if !blocked {
            return match (self.must_hit(), exact) {
                (Some(_), _) => Outcome::Lost,
                (None, true) => Outcome::Close,
                (None, false) => Outcome::Right,
            };
        }
        if exact {
            return Outcome::Right;
        }
        // The GPU does not report which triangle it was, so any possible one is an excuse.
        let faults = self.scene.near_candidates(&self.traced).into_iter();
        let faults = faults.map(|c| self.explain(c.hit.instance, c.hit.primitive));
        let faults: Vec<_> = faults.collect();
        if faults.contains(&None) {
            return Outcome::Close;
        }
        if faults.contains(&Some(Outcome::SelfHit)) { Outcome::SelfHit } else { Outcome::Astray }
    }

    /// The same ray if the triangle it left is a hundred times as long as wide. Rounding in the test of such
    /// a triangle may exceed the gap, so that the ray starts higher: a ray that passes closer to an edge than
    /// the start was moved may then miss or hit it.
    pub fn of_sliver(&self) -> Option<Self> {
        let (length, width) = self.left();
        (length > 100.0 * width).then(|| Self { gap: self.gap * self.moved().max(1.0), ..*self })
    }

    /// The length and width of the triangle that was left: its longest edge, and the height above it.
    pub fn left(&self) -> (f64, f64) {
        let [a, b, c] = *self.scene.triangle(self.own.0, self.own.1).expect("checked before");
        let length = [b - a, c - b, a - c].map(DVec3::length).into_iter().fold(0.0, f64::max);
        (length, (b - a).cross(c - a).length() / length)
    }

    /// The distance by which the start was moved, in gaps.
    pub fn moved(&self) -> f64 {
        (self.traced.origin - self.ray.origin).length() / self.gap
    }

    fn id(&self, hit: &Hit) -> (u32, u32) {
        (hit.instance, hit.primitive)
    }

    /// The first certain hit, at the gap's height or above, and the error bound of its t.
    fn must_hit(&self) -> Option<(Hit, f64)> {
        let sine = self.steepness();
        self.scene.all_hits(&self.ray).into_iter().find_map(|hit| {
            let candidate = self.scene.candidate(&self.ray, hit);
            let [a, b, c] = *self.scene.triangle(hit.instance, hit.primitive)?;
            let head_on = (b - a).cross(c - a).normalize().dot(self.ray.direction).abs();
            let slack = self.gap / head_on + candidate.t_bound;
            // The edge that decides has the largest bound for its margin; the other bounds are not larger.
            let inside = 1.0 - candidate.graze.bound / candidate.graze.margin;
            let height = hit.t * sine * self.ray.direction.length();
            let sure = self.id(&hit) != self.own
                && height >= self.gap
                && hit.t + slack < self.ray.tmax
                && hit.crossing.margins.iter().all(|margin| margin * inside > self.gap);
            sure.then_some((hit, slack))
        })
    }

    /// The reason why this triangle cannot be hit; `None` if it can, or nearly can.
    fn explain(&self, instance: u32, primitive: u32) -> Option<Outcome> {
        let triangle = self.scene.triangle(instance, primitive)?;
        // The accuracy of the reference's f64.
        let noise = self.gap * 1e-6;
        let behind = triangle.iter().all(|v| (*v - self.corner).dot(self.up) <= noise);
        if (instance, primitive) == self.own || behind {
            return Some(Outcome::SelfHit);
        }
        let candidate = self.scene.candidate_at(&self.ray, instance, primitive)?;
        let graze = candidate.graze;
        let moved = (self.traced.origin - self.ray.origin).length().min(self.gap);
        (graze.margin < -(graze.bound + moved)).then_some(Outcome::Astray)
    }
}

/// The numbers of rays that left a surface, by outcome.
#[derive(Default)]
pub struct Tally {
    pub rays: usize,
    pub close: usize,
    pub self_hits: usize,
    /// Rays that missed a surface, or hit one that exact arithmetic misses.
    pub lost: usize,
    /// Those of the lost that left a sliver, and passed an edge closer than they had to be moved.
    pub slivers: usize,
    /// The length and width of the last of these slivers, and the number of gaps by which the start was
    /// moved.
    sliver: [f64; 3],
    /// The first wrong ray without an excuse.
    pub first: Option<String>,
}

impl Tally {
    /// Judges one more ray.
    pub fn add(&mut self, leaving: &Leaving, ray: &Ray, judge: impl Fn(&Leaving) -> Outcome) {
        self.rays += 1;
        let outcome = judge(leaving);
        match outcome {
            Outcome::Right => return,
            Outcome::Close => self.close += 1,
            Outcome::SelfHit => self.self_hits += 1,
            Outcome::Lost | Outcome::Astray => {
                self.lost += 1;
                let again = leaving.of_sliver().map(|leaving| judge(&leaving));
                if matches!(again, Some(Outcome::Right | Outcome::Close)) {
                    self.slivers += 1;
                    let ((length, width), moved) = (leaving.left(), leaving.moved());
                    self.sliver = [length, width, moved];
                    return;
                }
            }
        }
        if outcome != Outcome::Close {
            self.first.get_or_insert_with(|| format!("{outcome:?}: {ray:?}"));
        }
    }
}

impl Tally {
    /// All counts as figures for a page.
    pub fn values(&self) -> Value {
        let Self { rays, close, self_hits, lost, slivers, sliver: [length, width, moved], .. } =
            self;
        json!({ "rays": rays, "self_hits": self_hits, "lost": lost, "close": close,
                "slivers": slivers, "length": length, "width": width, "moved": moved })
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { rays, close, self_hits, lost, slivers, sliver: [length, width, moved], .. } =
            self;
        write!(f, "{rays} rays, {self_hits} self-hits, {lost} lost, {close} close")?;
        if *slivers > 0 {
            write!(
                f,
                "; {slivers} of the lost on slivers, the last {length:.3e} by {width:.3e}, "
            )?;
            write!(f, "moved {moved:.2} gaps")?;
        }
        Ok(())
    }
}
