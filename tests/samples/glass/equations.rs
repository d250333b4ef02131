//! Fresnel's equations, the refracted direction and the list of media, as computed by the GPU.

use glam::DVec2;
use reference::ulp::ulp_error;
use run::{evaluate, expected};
use serde_json::json;

use super::U;

const WIDTH: usize = 288;
const HEIGHT: usize = 32;
const SIZE: &str = "288x32";
const FILES: &str = "#include \"common/random.glsl\"\n#include \"common/glass.glsl\"\n#include \"common/media.glsl\"";

/// 256 cosines from 1/256 to 1 and 32 that are powers of two, each between two media: indices 1 and 1 + 2^-k,
/// into the denser one for the first 16 rows and out of it for the rest. All are exact.
const CASES: &str = "
    float cosine = at.x < 256 ? float(at.x + 1) / 256.0 : 1.0 / float(1u << uint(at.x - 256) / 2u);
    float dense = 1.0 + 1.0 / float(1u << uint(at.y % 16));
    float from = at.y < 16 ? 1.0 : dense;
    float to = at.y < 16 ? dense : 1.0;
";

struct Case {
    cosine: f64,
    from: f64,
    to: f64,
}

impl Case {
    fn of(pixel: usize) -> Self {
        let (x, y) = ((pixel % WIDTH) as i32, (pixel / WIDTH) as i32);
        let cosine = if x < 256 { f64::from(x + 1) / 256.0 } else { 0.5f64.powi((x - 256) / 2) };
        let dense = 1.0 + 0.5f64.powi(y % 16);
        let (from, to) = if y < 16 { (1.0, dense) } else { (dense, 1.0) };
        Self { cosine, from, to }
    }

    /// The squared product of index and cosine behind the surface.
    fn behind(&self) -> f64 {
        (self.to - self.from) * (self.to + self.from) + (self.from * self.cosine).powi(2)
    }

    /// The reflected and the refracted fraction of light polarised perpendicular to the plane of incidence,
    /// and of light polarised parallel to it; `None` for total reflection.
    fn polarised(&self) -> Option<[(f64, f64); 2]> {
        let (q, p) = (self.from * self.cosine, Some(self.behind()).filter(|p2| *p2 > 0.0)?.sqrt());
        let (s, t) = (self.to * self.to * q, self.from * self.from * p);
        let across = ((q - p) / (q + p)).powi(2);
        let within = ((s - t) / (s + t)).powi(2);
        let through = 4.0 * q * p / (q + p).powi(2);
        let through_within = 4.0 * q * p * (self.from * self.to / (s + t)).powi(2);
        Some([(across, through), (within, through_within)])
    }

    /// The reflected and the refracted fraction of unpolarised light; `None` for total reflection.
    fn split(&self) -> Option<(f64, f64)> {
        let [(r_across, t_across), (r_within, t_within)] = self.polarised()?;
        Some((0.5 * (r_across + r_within), 0.5 * (t_across + t_within)))
    }

    /// The factor by which an error of the cosine affects the cosine behind the surface: 1, and more near
    /// total reflection.
    fn condition(&self) -> f64 {
        1.0 + (self.from * self.cosine).powi(2) / self.behind()
    }
}

#[test]
fn what_is_reflected_and_what_goes_through_is_all() {
    let body = "
        Split split = fresnel_exact(cosine, from, to);
        // As in textbooks.
        float ratio = from / to;
        float other = sqrt(max(1.0 - ratio * ratio * (1.0 - cosine * cosine), 0.0));
        float across = (from * cosine - to * other) / (from * cosine + to * other);
        float within = (to * cosine - from * other) / (to * cosine + from * other);
        answer = vec4(unpolarised(split.reflected), unpolarised(split.through),
            0.5 * (across * across + within * within), 0.0);
    ";
    let answers = evaluate(FILES, &format!("{CASES}{body}"), SIZE);
    let (mut reflected, mut through, mut textbook, mut sum) = (0f64, 0f64, 0f64, 0f64);
    let mut total = 0;
    for (i, &[r, t, by_the_book, _]) in answers.pixels.iter().enumerate() {
        let case = Case::of(i);
        let Some((exact_r, exact_t)) = case.split() else {
            assert_eq!((r, t), (1.0, 0.0), "all is reflected");
            total += 1;
            continue;
        };
        let condition = case.condition();
        let off = (f64::from(r) + f64::from(t) - 1.0).abs() / U;
        sum = sum.max(off / condition.sqrt());
        reflected = reflected.max(ulp_error(r, exact_r) / condition);
        through = through.max(ulp_error(t, exact_t) / condition);
        textbook = textbook.max(ulp_error(by_the_book, exact_r) / condition);
    }
    println!(
        "R {reflected:.1}, T {through:.1}, textbook {textbook:.0} ULP; R + T off by {sum:.1} u; {total} total"
    );
    assert!(total > 1000 && answers.pixels.len() == WIDTH * HEIGHT);
    // A dozen roundings, and p and q are squared twice in R.
    assert!(reflected < 16.0 && through < 16.0, "{reflected} {through} ULP");
    assert!(sum < 16.0, "R + T is off by {sum} u");
    assert!(textbook > 1000.0, "the textbook's form would do: {textbook}");
    expected::hold(
        "27_glass/fresnel",
        json!({ "reflected": reflected, "through": through, "textbook": textbook, "sum": sum }),
    );
}

#[test]
fn a_refracted_ray_keeps_its_digits() {
    let body = "
        vec3 d = vec3(sqrt((1.0 - cosine) * (1.0 + cosine)), -cosine, 0.0);
        vec3 n = vec3(0.0, 1.0, 0.0);
        answer = vec4(refracted(d, n, from, to).xy, refract(d, n, from / to).xy);
    ";
    let answers = evaluate(FILES, &format!("{CASES}{body}"), SIZE);
    let (mut bend, mut by_the_book, mut length, mut book_length) = (0f64, 0f64, 0f64, 0f64);
    for (i, &[x, y, bx, by]) in answers.pixels.iter().enumerate() {
        let case = Case::of(i);
        if case.behind() <= 0.0 {
            continue;
        }
        // The shader's ray: its sine is rounded.
        let sine = (((1.0 - case.cosine) * (1.0 + case.cosine)) as f32).sqrt();
        let down = case.behind().sqrt();
        let exact = DVec2::new(case.from * f64::from(sine), -down).normalize();
        let error = |x: f32, y: f32| {
            let other = DVec2::new(x.into(), y.into());
            (exact.perp_dot(other.normalize()).abs() / U, (other.length() - 1.0).abs() / U)
        };
        // Near total reflection, an error of the cosine is divided by the cosine behind the surface.
        let condition = 1.0 + case.from * case.cosine / down;
        let (mine, books) = (error(x, y), error(bx, by));
        bend = bend.max(mine.0 / condition);
        by_the_book = by_the_book.max(books.0 / condition);
        length = length.max(mine.1);
        book_length = book_length.max(books.1);
    }
    println!(
        "off by {bend:.1} u, refract() {by_the_book:.1} u; length {length:.1} u, {book_length:.1} u"
    );
    assert!(bend < 8.0 && length < 4.0, "{bend} {length}");
    assert!(by_the_book > 16.0, "refract() would do: {by_the_book}");
    expected::hold(
        "27_glass/refracted",
        json!({
            "direction": bend, "length": length,
            "textbook": by_the_book, "textbook_length": book_length,
        }),
    );
}

/// The fractions of light that a pane with such sides reflects and transmits: light reflected 1, 3, 5, …
/// times between the sides comes back, and the rest goes through.
fn to_and_fro((reflected, through): (f64, f64)) -> (f64, f64) {
    let (mut within, mut comes, mut goes) = (through, reflected, 0.0);
    for turn in 0..10_000_000 {
        if within < 1e-12 {
            break;
        }
        match turn % 2 {
            0 => goes += within * through,
            _ => comes += within * through,
        }
        within *= reflected;
    }
    (comes, goes)
}

#[test]
fn a_sheet_reflects_what_its_two_sides_do_together() {
    // Also sheets of air in glass, which may reflect everything.
    let body = "
        Split sheet = of_sheet(fresnel_exact(cosine, from, to));
        answer = vec4(unpolarised(sheet.reflected), unpolarised(sheet.through), 0.0, 0.0);
    ";
    let answers = evaluate(FILES, &format!("{CASES}{body}"), SIZE);
    let mut by_the_mean = 0f64;
    for (i, &[back, through, ..]) in answers.pixels.iter().enumerate() {
        let case = Case::of(i);
        let Some(sides) = case.polarised() else {
            assert_eq!((back, through), (1.0, 0.0), "all is reflected");
            continue;
        };
        // Each polarisation bounces separately, and unpolarised light is half of each.
        let [(b, t), (b_within, t_within)] = sides.map(to_and_fro);
        let (comes, goes) = (0.5 * (b + b_within), 0.5 * (t + t_within));
        // Twice as many roundings as for one side.
        let bound = 32.0 * U * case.condition();
        assert!(
            (f64::from(back) - comes).abs() < bound && (f64::from(through) - goes).abs() < bound,
            "{i}: {back} {through}, not {comes} {goes}"
        );
        // The error of averaging the two polarisations first.
        let one = case.split().unwrap().0;
        by_the_mean = by_the_mean.max(2.0 * one / (1.0 + one) / comes - 1.0);
    }
    println!("by the mean of both polarisations up to {:.1} % too much", 100.0 * by_the_mean);
    assert!(by_the_mean > 0.05, "the mean would do: {by_the_mean}");
}

#[test]
fn media_are_those_of_a_sorted_list() {
    let body = "
        uvec4 media = uvec4(AIR);
        for (uint i = 0; i < 8; i++) {
            uint bits = hash(uvec4(at, i, 7)).x;
            uint material = (bits >> 8u) % 5u;
            media = bits % 3u > 0u ? entered(media, material) : left(media, material);
        }
        // Small numbers are exact, and air is written as -1.
        answer = mix(vec4(media), vec4(-1.0), equal(media, uvec4(AIR)));
    ";
    let answers = evaluate(FILES, body, "64x64");
    for (i, pixel) in answers.pixels.iter().enumerate() {
        let mut media: Vec<u32> = Vec::new();
        for step in 0..8 {
            let bits = hash([(i % 64) as u32, (i / 64) as u32, step, 7])[0];
            let material = (bits >> 8) % 5;
            if !bits.is_multiple_of(3) {
                media.push(material);
                media.sort_unstable();
                // The fifth body is dropped: the one with the lowest priority.
                media.truncate(4);
            } else if let Some(found) = media.iter().position(|m| *m == material) {
                media.remove(found);
            }
        }
        let mut expected = [-1.0; 4];
        media.iter().enumerate().for_each(|(k, m)| expected[k] = *m as f32);
        assert_eq!(*pixel, expected, "pixel {i}");
    }
}

/// pcg4d, as in `shaders/common/random.glsl`.
pub fn hash(v: [u32; 4]) -> [u32; 4] {
    let [mut x, mut y, mut z, mut w] =
        v.map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    let mut mix = || {
        x = x.wrapping_add(y.wrapping_mul(w));
        y = y.wrapping_add(z.wrapping_mul(x));
        z = z.wrapping_add(x.wrapping_mul(y));
        w = w.wrapping_add(y.wrapping_mul(z));
        [x, y, z, w] = [x, y, z, w].map(|v| v ^ (v >> 16));
    };
    mix();
    // The second round has no last step.
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w]
}
