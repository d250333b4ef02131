//! 11_path_tracing: the mean of the paths equals the light in closed form, and choices that only save time do
//! not change it.

mod by_hand;
pub mod closed_forms;
mod plots;
mod surfaces;

use common::app::Picture;

use run::{Chapter, bits, render, shaders_with};

const NAME: &str = "11_path_tracing";
const SIZE: &str = "64x40";

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// A picture with random numbers instead of Sobol's points: the samples of a pixel are independent.
fn picture_by_chance(size: &str, frames: u32, sets: &[&str]) -> Picture {
    let points = "uvec2 point = sobol(owen(sample_index, key.z));\n    \
                  return vec2(to_unit(owen(point.x, key.x)), to_unit(owen(point.y, key.y)));";
    let chance = "uvec2 bits = hash(uvec4(key.xy, sample_index, 0)).xy;\n    \
                  return vec2(to_unit(bits.x), to_unit(bits.y));";
    let shaders = shaders_with("common/path_numbers.glsl", points, chance);
    chapter(size).shaders(shaders.path()).frames(frames).sets(sets).picture()
}

/// All colours of all pixels.
fn colors(picture: &Picture) -> impl Iterator<Item = f64> {
    picture.pixels.iter().flat_map(|pixel| [0, 1, 2].map(|k| f64::from(pixel[k])))
}

/// The mean of independent values, and its confidence interval: four standard errors, which are exceeded at
/// random once in 16,000 times.
struct Estimate {
    mean: f64,
    deviation: f64,
    confidence: f64,
}

impl Estimate {
    fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let deviation = (squares / (count - 1.0)).sqrt();
        Self { mean, deviation, confidence: 4.0 * deviation / count.sqrt() }
    }

    #[track_caller]
    fn is(&self, expected: f64, what: &str) {
        let Self { mean, deviation, confidence } = self;
        println!(
            "{what}: {mean:.6} ± {confidence:.6}, not {expected:.6}? deviation {deviation:.4}"
        );
        assert!((mean - expected).abs() <= *confidence, "{what}: {mean} is not {expected}");
    }
}

/// One number per pixel: the mean of its colours, which are not independent.
fn brightness(picture: &Picture) -> Vec<f64> {
    let mean = |pixel: &[f32; 4]| pixel[..3].iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0;
    picture.pixels.iter().map(mean).collect()
}

/// The root of the mean squared difference, over all pixels and colours.
fn error(a: &Picture, b: &Picture) -> f64 {
    let squares = colors(a).zip(colors(b)).map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / (3 * a.pixels.len()) as f64).sqrt()
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).frames(16).repeats();
}

#[test]
#[ignore = "nightly: 64 samples per pixel; quick: path_tracing::closed_forms::roulette_ends_a_path_that_has_no_end_and_keeps_its_mean"]
fn roulette_changes_no_mean() {
    // With other seeds, so that the errors are independent.
    let on = chapter(SIZE).frames(64).sets(&["depth=256"]).picture();
    let off = chapter(SIZE).frames(64).sets(&["depth=64", "roulette=off", "seed=1"]).picture();
    let differences: Vec<f64> =
        brightness(&on).iter().zip(brightness(&off)).map(|(on, off)| on - off).collect();
    let estimate = Estimate::of(&differences);
    estimate.is(0.0, "on - off");
    // The test is sensitive enough: a hundredth of the light from bounces exceeds that confidence interval.
    let bounced =
        Estimate::of(&brightness(&chapter(SIZE).frames(64).sets(&["show=bounced"]).picture())).mean;
    assert!(estimate.confidence < 0.02 * bounced, "{} of {bounced}", estimate.confidence);
}

#[test]
fn each_further_bounce_only_adds_light() {
    let of = |depth: &str| chapter(SIZE).frames(4).sets(&["roulette=off", depth]).picture();
    let depths = ["depth=0", "depth=1", "depth=2", "depth=4", "depth=8", "depth=16"].map(of);
    for pair in depths.windows(2) {
        let brighter = colors(&pair[0]).zip(colors(&pair[1])).all(|(less, more)| less <= more);
        assert!(brighter, "a longer path has taken light away");
        let [less, more] = [&pair[0], &pair[1]].map(|p| Estimate::of(&brightness(p)).mean);
        assert!(less < more, "{less} {more}");
    }
}

#[test]
fn direct_and_bounced_light_make_the_picture() {
    let of = |show: &str| chapter(SIZE).frames(4).sets(&[show]).picture();
    let [whole, direct, bounced] = ["show=picture", "show=direct", "show=bounced"].map(of);
    for (i, whole) in colors(&whole).enumerate() {
        let [direct, bounced] = [&direct, &bounced].map(|part| colors(part).nth(i).unwrap());
        // Each is rounded as a float, once.
        assert!((direct + bounced - whole).abs() <= 2e-7 * whole, "{direct} {bounced} {whole}");
        assert!(bounced >= 0.0);
    }
}

#[test]
fn a_clamp_takes_light_and_adds_none() {
    let [all, clamped] =
        ["clamp=0", "clamp=0.5"].map(|clamp| chapter(SIZE).frames(8).sets(&[clamp]).picture());
    let darker = colors(&all).zip(colors(&clamped)).all(|(all, clamped)| clamped <= all);
    assert!(darker && bits(&all) != bits(&clamped));
}

#[test]
fn a_changed_control_starts_again() {
    let arguments = ["--compare", "depth=1|3", "--frames", "2"];
    let after = render(NAME, SIZE, &arguments).picture;
    let depths =
        ["depth=1", "depth=3"].map(|depth| chapter(SIZE).frames(1).sets(&[depth]).picture());
    assert_ne!(bits(&depths[0]), bits(&depths[1]));
    assert!(depths.iter().any(|fresh| bits(fresh) == bits(&after)), "the old sum shines through");
}

#[test]
fn sums_of_integers_and_of_floats_begin_alike() {
    // The mean of one sample is the sample, however it is added up. Only digits below 2^-32 are lost.
    let [integers, floats] =
        ["sum=integers", "sum=floats"].map(|sum| chapter(SIZE).frames(1).sets(&[sum]).picture());
    assert!(colors(&integers).zip(colors(&floats)).all(|(a, b)| (a - b).abs() < 0.5f64.powi(31)));
    // The means of many samples differ in the last digits, by no more than the rounding of each sum.
    let [integers, floats] =
        ["sum=integers", "sum=floats"].map(|sum| chapter(SIZE).frames(32).sets(&[sum]).picture());
    assert_ne!(bits(&integers), bits(&floats));
    let bound = 34.0 * 0.5f64.powi(24);
    assert!(colors(&integers).zip(colors(&floats)).all(|(a, b)| (a - b).abs() <= bound * a + 1e-9));
}
