//! The counts of a picture's answers.

use std::fmt;

use reference::Ray;
use reference::solid::Solid as ReferenceSolid;
use reference::solid::bound::{SolidAnswer, SolidVerdict, Stray};
use reference::ulp::ulp_error;
use serde_json::Value;

/// The counts of a picture's answers.
#[derive(Default)]
pub struct Tally {
    pub hits: usize,
    pub misses: usize,
    /// Explained by two surfaces, or an outline, closer than f32 can resolve.
    pub near: usize,
    pub wrong: Vec<String>,
    /// Errors of t in ULP.
    pub planes: Vec<f64>,
    pub balls: Vec<f64>,
}

impl Tally {
    /// `hit` is a pixel of `show=hit`: instance, face, t, and whether the ray was inside.
    pub fn judge(
        &mut self,
        [solid, clip]: &[ReferenceSolid; 2],
        ray: &Ray,
        stray: Stray,
        hit: &[f32; 4],
    ) {
        let found = (hit[0] >= 0.0).then(|| SolidAnswer {
            t: hit[2].into(),
            member: hit[1] as usize,
            enters: hit[3] == 0.0,
        });
        match solid.judge(clip, ray, stray, found) {
            SolidVerdict::Agrees(None) => self.misses += 1,
            SolidVerdict::Agrees(Some(t)) => {
                self.hits += 1;
                let errors = if is_ball(solid, hit[1] as usize) {
                    &mut self.balls
                } else {
                    &mut self.planes
                };
                errors.push(ulp_error(hit[2], t));
            }
            SolidVerdict::Near => self.near += 1,
            SolidVerdict::Wrong => {
                let first = solid.intersect_within(clip, ray);
                self.wrong.push(format!("{ray:?} {found:?}, exactly {first:?}"));
            }
        }
    }

    pub fn add(&mut self, other: Self) {
        self.hits += other.hits;
        self.misses += other.misses;
        self.near += other.near;
        self.wrong.extend(other.wrong);
        self.planes.extend(other.planes);
        self.balls.extend(other.balls);
    }
}

/// The errors' median, 99th percentile and maximum, as figures for a page.
pub fn values(name: &str, errors: &[f64]) -> [(String, Value); 3] {
    let part = |(figure, part)| (format!("{name}.{figure}"), at(errors, part).into());
    [("p50", 0.5), ("p99", 0.99), ("max", 1.0)].map(part)
}

/// The error below which this fraction stays.
pub fn at(errors: &[f64], part: f64) -> f64 {
    let mut sorted = errors.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = (sorted.len() as f64 * part) as usize;
    sorted.get(place).or(sorted.last()).copied().unwrap_or(0.0)
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { hits, misses, near, wrong, planes, balls } = self;
        write!(f, "{hits} hits, {misses} misses, {near} near, {} wrong", wrong.len())?;
        for (name, errors) in [("planes", planes), ("balls", balls)] {
            let [half, most, worst] = [0.5, 0.99, 1.0].map(|part| at(errors, part));
            write!(f, "; {name} {half:.2} / {most:.2} / {worst:.1} ULP")?;
        }
        Ok(())
    }
}

fn is_ball(solid: &ReferenceSolid, member: usize) -> bool {
    let mut simple = Vec::new();
    solid.each(&mut |solid| simple.push(matches!(solid, ReferenceSolid::Ball(_))));
    simple[member]
}
