//! The cone's width compared with 64 rays of a pixel, traced in 64-bit floats.
//!
//! Rays from a point, one of them the axis, hit a sphere at distance `before`, and then a surface at distance
//! `behind` from it. The pixel's rays there have a covariance, whose determinant is that of an area; the
//! width is its root. For a width w and a spread s, with curvature k, cosine c and distance t behind the
//! mirror, a mirror gives
//!
//! - within the plane of incidence w + (s + 2kw/c)·t,
//! - across it w + (s + 2kwc)·t,
//!
//! and for the cone w + (s + 2kw)·t. With A = w + st and B = 2kwt, the product of the first two is (A + B)² +
//! AB·(1/c + c - 2). So the cone is exact head-on. If A and B are positive it is too narrow, but by no more
//! than a quarter of (1/c + c - 2) of the area, because AB is at most a quarter of (A + B)².

use glam::{DVec2, DVec3};
use run::evaluate;

use super::bent;

/// The spread of the pixel's rays per unit of length.
const SPREAD: f64 = 1.0 / 65536.0;
const INDEX: f64 = 1.5;

const WIDE: i32 = 28;
const HIGH: i32 = 160;
const SIZE: &str = "28x160";

/// The same cases as in `Case::of`.
const CASES: &str = "
    float cosine = 1.0 - float(at.x) / 32.0;
    int row = at.y;
    float curvature = 0.75 * exp2(float(row % 5) - 3.0) * (row / 5 % 2 == 0 ? 1.0 : -1.0);
    float before = exp2(float(row / 10 % 4) - 1.0);
    float behind = exp2(float(row / 40) * 2.0 - 2.0);
    Cone cone = Cone(0.0, 1.0 / 65536.0);
";

#[derive(Clone, Copy, Debug)]
struct Case {
    cosine: f64,
    curvature: f64,
    before: f64,
    behind: f64,
}

impl Case {
    fn of(pixel: usize) -> Self {
        let (x, row) = (pixel as i32 % WIDE, pixel as i32 / WIDE);
        let sign = if row / 5 % 2 == 0 { 1.0 } else { -1.0 };
        Self {
            cosine: 1.0 - f64::from(x) / 32.0,
            curvature: sign * 0.75 * 2f64.powi(row % 5 - 3),
            before: 2f64.powi(row / 10 % 4 - 1),
            behind: 2f64.powi(row / 40 * 2 - 2),
        }
    }

    fn sine(&self) -> f64 {
        ((1.0 - self.cosine) * (1.0 + self.cosine)).sqrt()
    }

    /// The point where the axis hits the surface, and the normal there.
    fn middle(&self) -> (DVec3, DVec3) {
        (self.before * DVec3::Z, DVec3::new(self.sine(), 0.0, -self.cosine))
    }

    /// The point where a ray hits the surface, and the normal there. For an offset u from the middle, whose
    /// normal is n, the surface is n·u + k/2 u² = 0: a plane if k is 0.
    fn met(&self, origin: DVec3, along: DVec3) -> (DVec3, DVec3) {
        let (middle, normal) = self.middle();
        let from = origin - middle;
        let a = 0.5 * self.curvature;
        let b = along.dot(normal) + self.curvature * along.dot(from);
        let c = from.dot(normal) + a * from.length_squared();
        let t = 2.0 * c / ((b * b - 4.0 * a * c).sqrt() - b);
        let at = origin + t * along;
        (at, (normal + self.curvature * (at - middle)).normalize())
    }

    /// The width of 64 rays behind the surface, where `turn` gives their new directions: the root of the
    /// area.
    fn width(&self, is_parallel: bool, turn: impl Fn(DVec3, DVec3) -> DVec3) -> f64 {
        let (middle, normal) = self.middle();
        let axis = turn(DVec3::Z, normal);
        let side = axis.cross(DVec3::Y);
        let ends = (0..64).map(|i| {
            let part = (DVec2::new(f64::from(i % 8), f64::from(i / 8)) - 3.5) / 8.0;
            let aside = (SPREAD * part).extend(0.0);
            let (origin, along) = if is_parallel {
                (self.before * aside, DVec3::Z)
            } else {
                (DVec3::ZERO, (DVec3::Z + aside).normalize())
            };
            let (at, normal) = self.met(origin, along);
            let along = turn(along, normal);
            let t = (self.behind - (at - middle).dot(axis)) / along.dot(axis);
            let end = at + t * along - middle;
            DVec2::new(end.dot(side), end.y)
        });
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        let ends: Vec<DVec2> = ends.collect();
        let mean = ends.iter().sum::<DVec2>() / 64.0;
        for end in ends.iter().map(|end| *end - mean) {
            (xx, xy, yy) = (xx + end.x * end.x, xy + end.x * end.y, yy + end.y * end.y);
        }
        // For the parts themselves: the mean square of (i - 3.5) / 8, times 64.
        let parts = 64.0 * 5.25 / 64.0;
        ((xx * yy - xy * xy).max(0.0).sqrt() / parts).sqrt()
    }

    fn mirrored(&self) -> f64 {
        self.width(false, |along, normal| along - 2.0 * along.dot(normal) * normal)
    }

    fn refracted(&self, is_parallel: bool, ratio: f64) -> f64 {
        self.width(is_parallel, |along, normal| {
            let before = -along.dot(normal);
            ratio * along + (ratio * before - after(before, ratio)) * normal
        })
    }

    /// The width at the surface.
    fn arriving(&self) -> f64 {
        SPREAD * self.before
    }

    /// The relative error bound of a width: third-order terms, of the size of the squared angle by which
    /// normals turn across the slanted pixel; and 16 roundings of 32-bit floats.
    fn rounding(&self) -> f64 {
        let turn = self.curvature * self.arriving() / (self.cosine * self.cosine);
        8.0 * turn * turn + 16.0 * 2f64.powi(-24)
    }
}

fn after(before: f64, ratio: f64) -> f64 {
    (1.0 - ratio * ratio * (1.0 - before * before)).sqrt()
}

/// The shader's result for each case.
fn shader(body: &str) -> Vec<(Case, f64)> {
    let picture = evaluate(&bent(), &format!("{CASES}{body}"), SIZE);
    assert_eq!(picture.pixels.len(), (WIDE * HIGH) as usize);
    let found = picture.pixels.iter().enumerate();
    found.map(|(i, pixel)| (Case::of(i), f64::from(pixel[0]))).collect()
}

/// Returns whether a cone's width is possible for a convex mirror: not wider than the rays, and narrower by
/// no more than the amount derived above.
fn is_of_mirror(case: Case, width: f64) -> bool {
    let area = (case.mirrored() / width).powi(2) - 1.0;
    let most = (1.0 / case.cosine + case.cosine - 2.0) / 4.0;
    (-4.0 * case.rounding()..=most + 4.0 * case.rounding()).contains(&area)
}

#[test]
fn behind_a_mirror_that_bulges_the_cone_is_as_wide_as_the_rays() {
    let found = shader("answer.x = width_at(after_mirror(cone, before, curvature), behind);");
    for (case, width) in found.into_iter().filter(|(case, _)| case.curvature > 0.0) {
        assert!(is_of_mirror(case, width), "{case:?}: {width}, rays {}", case.mirrored());
    }
}

#[test]
fn without_curvature_the_cone_is_not_as_wide_as_the_rays() {
    let found = shader("answer.x = width_at(after_mirror(cone, before, 0.0), behind);");
    let bulging = found.into_iter().filter(|(case, _)| case.curvature > 0.0);
    let (mut tried, mut least) = (0, f64::INFINITY);
    for (case, width) in bulging {
        // Head-on, the cone of a flat mirror is narrower by B / (A + B), and at a slant by at least as much.
        let gained = 2.0 * case.curvature * case.arriving() * case.behind;
        if gained > 0.5 * width && case.cosine > 0.5 {
            least = least.min(case.mirrored() / width);
            assert!(!is_of_mirror(case, width), "{case:?}: {width}, rays {}", case.mirrored());
            tried += 1;
        }
    }
    println!("{tried} cases, narrower by a factor of {least:.2} at least");
    assert!(tried > 300, "{tried}");
}

/// Before the focus, at it, and behind it, where the width is negative.
#[test]
fn head_on_a_hollow_mirror_s_cone_is_as_wide_as_the_rays_beyond_its_focus_too() {
    let found = shader("answer.x = width_at(after_mirror(cone, before, curvature), behind);");
    let mut negative = 0;
    for (case, width) in found.into_iter().filter(|(case, _)| case.cosine == 1.0) {
        let flat = SPREAD * (case.before + case.behind);
        let gained = (2.0 * case.curvature * case.arriving() * case.behind).abs();
        let off = (width.abs() - case.mirrored()).abs();
        assert!(off <= case.rounding() * (flat + gained), "{case:?}: {width}, off by {off:e}");
        negative += usize::from(width < 0.0);
    }
    assert!(negative > 20, "{negative}");
}

const GLASS: &str = "
    float after = sqrt(1.0 - ratio * ratio * (1.0 - cosine) * (1.0 + cosine));
";

/// Into glass: the area is too small by no more than a quarter of (q² + 1/q² - 2) of itself, with q² = after
/// / before, for the same reason as behind a mirror.
#[test]
fn behind_flat_glass_the_cone_is_as_wide_as_the_rays() {
    let body = "answer.x = width_at(after_glass(cone, before, 0.0, cosine, after, ratio), behind);";
    let ratio = 1.0 / INDEX;
    let found = shader(&format!("float ratio = 1.0 / {INDEX:?};{GLASS}{body}"));
    for (case, width) in found {
        let flat = Case { curvature: 0.0, ..case };
        let wider = after(case.cosine, ratio) / case.cosine;
        let most = (wider + 1.0 / wider - 2.0) / 4.0;
        let area = (flat.refracted(false, ratio) / width).powi(2) - 1.0;
        let rounding = 4.0 * flat.rounding();
        assert!((-rounding..=most + rounding).contains(&area), "{case:?}: {width}, {area}");
    }
}

#[test]
fn head_on_the_cone_into_a_lens_and_out_of_it_is_as_wide_as_the_rays() {
    let body =
        "answer.x = width_at(after_glass(cone, before, curvature, cosine, after, ratio), behind);";
    for ratio in [1.0 / INDEX, INDEX] {
        let found = shader(&format!("float ratio = {ratio:?};{GLASS}{body}"));
        for (case, width) in found.into_iter().filter(|(case, _)| case.cosine == 1.0) {
            let flat = SPREAD * (case.before + ratio * case.behind);
            let gained = (case.curvature * case.arriving() * case.behind).abs();
            let off = (width.abs() - case.refracted(false, ratio)).abs();
            let rounding = case.rounding() * (flat + gained);
            assert!(off <= rounding, "{case:?}: {width}, off by {off:e}");
        }
    }
}

/// Parallel rays at a slant: far behind the surface, only the spread it gave them matters.
#[test]
fn a_lens_spreads_slanting_rays_by_the_root_of_what_it_does_along_and_across() {
    let body = "Cone parallel = Cone(before * cone.spread, 0.0);
        parallel = after_glass(parallel, 0.0, curvature, cosine, after, ratio);
        answer.x = width_at(parallel, 1048576.0) / 1048576.0;";
    let ratio = 1.0 / INDEX;
    for (case, spread) in shader(&format!("float ratio = 1.0 / {INDEX:?};{GLASS}{body}")) {
        // A ray that starts at the far side of a concave sphere, or beyond it, hits that side first.
        if 2.0 * case.cosine + case.curvature * case.before < 0.1 {
            continue;
        }
        let far = Case { behind: 1_048_576.0, ..case };
        let rays = far.refracted(true, ratio) / far.behind;
        // The widths at the surface, relative to those behind it: at most 1 / (0.3·k·2^20), along and across.
        let near = 2.0 / (0.3 * case.curvature.abs() * far.behind);
        let off = (spread.abs() / rays - 1.0).abs();
        assert!(off <= near / case.cosine + 4.0 * case.rounding(), "{case:?}: {spread:e} {rays:e}");
    }
}
