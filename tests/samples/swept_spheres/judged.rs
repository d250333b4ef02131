//! The results of a rung on a family, compared with the exact answers.

use glam::DVec3;
use reference::Surface;
use reference::swept::Swept;
use reference::ulp::ulp_error;

use super::direct::{Case, Found};

/// A ray counts as a tangent, which no arithmetic has to decide, within this relative change of the radii.
const TANGENT: f64 = 1.0 / (1u64 << 40) as f64;

/// Cases and their exact answers.
pub struct Exact {
    pub cases: Vec<Case>,
    pub hits: Vec<Option<Surface>>,
}

impl Exact {
    pub fn new(cases: Vec<Case>) -> Self {
        let hits = cases.iter().map(|case| case.swept.intersect(&case.ray)).collect();
        Self { cases, hits }
    }
}

#[derive(Default)]
pub struct Tally {
    pub hits: usize,
    pub misses: usize,
    pub false_hits: usize,
    pub false_misses: usize,
    pub tangents: usize,
    /// The errors of t of the right hits, in units of the last place, sorted.
    pub ulp: Vec<f64>,
    /// The errors of the normal: the length of the difference, sorted.
    pub normals: Vec<f64>,
    pub first_wrong: Option<String>,
}

impl Tally {
    pub fn new(exact: &Exact, found: &[Option<Found>]) -> Self {
        let mut tally = Self::default();
        for ((case, hit), found) in exact.cases.iter().zip(&exact.hits).zip(found) {
            match (hit, found) {
                (None, None) => tally.misses += 1,
                (Some(hit), Some(found)) => {
                    tally.hits += 1;
                    tally.ulp.push(ulp_error(found.t, hit.t));
                    // A normal turns by the error of the point over the radius there: near a tip, by any
                    // angle.
                    let [r, q] = case.swept.radii;
                    if r + f64::from(found.s) * (q - r) > 1e-4 * r.max(q) {
                        tally.normals.push((found.normal - hit.normal).length());
                    }
                }
                _ => {
                    let grown = |factor| case.swept.intersect_grown(&case.ray, factor).is_some();
                    if grown(1.0 + TANGENT) != grown(1.0 - TANGENT)
                        || hit.is_some() && touches_tip(case)
                    {
                        tally.tangents += 1;
                        continue;
                    }
                    let is_hit = found.is_some();
                    *(if is_hit { &mut tally.false_hits } else { &mut tally.false_misses }) += 1;
                    tally.first_wrong.get_or_insert(format!("{case:?}: {found:?}, exact {hit:?}"));
                }
            }
        }
        tally.ulp.sort_by(f64::total_cmp);
        tally.normals.sort_by(f64::total_cmp);
        tally
    }

    pub fn wrong(&self) -> usize {
        self.false_hits + self.false_misses
    }

    /// The fraction of the hits whose t is off by less than this.
    pub fn ulp_at(&self, part: f64) -> f64 {
        at(&self.ulp, part)
    }

    pub fn normal_at(&self, part: f64) -> f64 {
        at(&self.normals, part)
    }
}

/// Returns whether a ray that hits the shape only hits a tip, a ball of radius 0.
fn touches_tip(case: &Case) -> bool {
    let [a, b] = case.swept.ends;
    let radii = case.swept.radii;
    let shorter =
        |end: f64, from, to: DVec3| if end == 0.0 { to.lerp(from, 1.0 - TANGENT) } else { from };
    let ends = [shorter(radii[0], a, b), shorter(radii[1], b, a)];
    ends != [a, b] && Swept { ends, radii }.intersect(&case.ray).is_none()
}

fn at(sorted: &[f64], part: f64) -> f64 {
    let place = (sorted.len() as f64 * part) as usize;
    sorted.get(place).or(sorted.last()).copied().unwrap_or_default()
}
