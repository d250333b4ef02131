//! The results of a method on a family, compared with the exact answers.

use reference::polynomial::Polynomial;
use reference::torus::Torus;
use reference::ulp::ulp_error;

use super::direct::{Case, Found};

/// A wrong answer is excused if it is right for a torus whose polynomial is this much higher or lower, in units of
/// 4·R·r·(R + r)². On a torus with a hole that moves the surface by about R·2^-41.
///
/// In torus_two_float() each of Q's terms is at most (R + r)² and off by 2^-46 of that, five of them; Q itself is at
/// most 2·R·r near the tube, so Q² is off by 2^-42·R·r·(R + r)²; the products of two-floats add less.
pub const LIFT: f64 = 1.0 / (1u64 << 42) as f64;

/// Cases and the exact t of the first hit of each.
pub struct Exact {
    pub cases: Vec<Case>,
    pub first: Vec<Option<f64>>,
}

impl Exact {
    pub fn new(cases: Vec<Case>) -> Self {
        let hit = |case: &Case| case.torus.roots(&case.ray, 0.0).first().copied();
        let first = cases.iter().map(hit).collect();
        Self { cases, first }
    }
}

#[derive(Default)]
pub struct Tally {
    pub hits: usize,
    pub misses: usize,
    /// A hit where the ray misses.
    pub false_hits: usize,
    /// A miss where the ray hits.
    pub false_misses: usize,
    /// A hit elsewhere than the first: off by more than a thousandth of the torus, or a quarter of the tube's radius.
    pub other: usize,
    /// Wrong, but right for a tube that is thinner or thicker by less than any input's rounding.
    pub excused: usize,
    /// The errors of t of the right hits, in units of the last place.
    pub ulp: Vec<f64>,
    /// The errors of the normal: the length of the difference.
    pub normals: Vec<f64>,
    pub first_wrong: Option<String>,
}

impl Tally {
    pub fn new(exact: &Exact, found: &[Option<Found>]) -> Self {
        let mut tally = Self::default();
        for ((case, first), found) in exact.cases.iter().zip(&exact.first).zip(found) {
            tally.add(case, *first, found);
        }
        tally
    }

    /// Adds the result for a case whose first exact hit is at `exact`.
    pub fn add(&mut self, case: &Case, exact: Option<f64>, found: &Option<Found>) {
        let near = near_in_t(case);
        match (exact, found) {
            (None, None) => self.misses += 1,
            (Some(t), Some(found)) if ulp_error(found.t, t) <= 1.0 => self.add_hit(case, t, found),
            _ if is_excused(case, found) => self.excused += 1,
            // From far away that may be less than the gaps between floats.
            (Some(t), Some(found))
                if (f64::from(found.t) - t).abs() <= near || ulp_error(found.t, t) <= 8.0 =>
            {
                self.add_hit(case, t, found);
            }
            _ => {
                *match (exact, found) {
                    (None, _) => &mut self.false_hits,
                    (_, None) => &mut self.false_misses,
                    _ => &mut self.other,
                } += 1;
                self.first_wrong.get_or_insert(format!("{case:?}: {found:?}, exact {exact:?}"));
            }
        }
    }

    fn add_hit(&mut self, case: &Case, t: f64, found: &Found) {
        self.hits += 1;
        self.ulp.push(ulp_error(found.t, t));
        self.normals.push((found.normal - case.torus.normal(case.ray.at(t))).length());
    }

    pub fn wrong(&self) -> usize {
        self.false_hits + self.false_misses + self.other
    }

    /// The error below which this fraction of the hits stays, in units of t.
    pub fn ulp_at(&self, part: f64) -> f64 {
        at(&self.ulp, part)
    }

    pub fn normal_at(&self, part: f64) -> f64 {
        at(&self.normals, part)
    }
}

/// The largest difference of t from the first hit at which an answer counts as that hit. The next hit of a thin tube
/// is nearly always farther away.
fn near_in_t(case: &Case) -> f64 {
    let Torus { major, minor, .. } = case.torus;
    (1e-3 * (major + minor)).min(0.25 * minor) / case.ray.direction.length()
}

/// Returns whether a result is right for a torus whose tube is thicker or thinner by no more than [`LIFT`].
///
/// Between the surfaces of the thicker and of the thinner torus a ray may be outside or inside. So it has surely hit
/// the torus only once it has crossed both, and a hit may be reported wherever it is between the two, but for a unit
/// of t.
fn is_excused(case: &Case, found: &Option<Found>) -> bool {
    let roots = [-LIFT, LIFT].map(|lift| case.torus.roots(&case.ray, lift));
    let Some(Found { t, .. }) = *found else {
        return roots.iter().any(Vec::is_empty);
    };
    if !t.is_finite() {
        return false;
    }
    let [low, high] = [t.next_down(), t.next_up()].map(f64::from);
    if roots.iter().all(|roots| roots.iter().any(|&root| root < low)) {
        return false;
    }
    let [thick, thin] = [-LIFT, LIFT].map(|lift| case.torus.polynomial(&case.ray, lift));
    let is_within = |polynomial: &Polynomial, t: f64| polynomial.sign_at(&t.into()).is_le();
    // Outside the thinner and inside the thicker, or on different sides of one of them within a unit.
    let near = [low, t.into(), high].map(|t| [is_within(&thick, t), is_within(&thin, t)]);
    near.contains(&[true, false]) || near[0] != near[1] || near[1] != near[2]
}

fn at(errors: &[f64], part: f64) -> f64 {
    let mut sorted = errors.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = (sorted.len() as f64 * part) as usize;
    sorted.get(place).or(sorted.last()).copied().unwrap_or_default()
}
