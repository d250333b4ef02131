//! The light of a sky, by four samplers and by an integral in f64.

use common::app::Picture;
use common::model::panorama::Panorama;
use glam::DVec3;

use super::sky::solid_angle;
use super::{Estimate, SAMPLERS, chapter, difference, evaluate, set, twin, write_sky};
use run::shaders_with;

/// Rough spheres in the evening: on smooth ones, uniform directions find so much in so few samples that their scatter
/// says nothing of their error.
fn evening(sampler: &str, seed: u32, shaders: Option<&std::path::Path>) -> Picture {
    let run = chapter("64x32").frames(128).sets(&[
        "scene=spheres",
        "sky=evening",
        "depth=3",
        "roughness=0.6",
    ]);
    let run = run.set("sampling", sampler).set("seed", seed);
    match shaders {
        Some(folder) => run.shaders(folder).picture(),
        None => run.picture(),
    }
}

/// 2^20 samples in all.
#[test]
fn four_samplers_have_one_mean() {
    let both = evening("both", 0, None);
    for (seed, sampler) in (1..).zip(&SAMPLERS[..3]) {
        let other = evening(sampler, seed, None);
        let Estimate { mean, confidence } = difference(&other, &both);
        println!("{sampler} - both: {mean:.6} ± {confidence:.6}");
        assert!(mean.abs() < confidence, "{sampler} - both: {mean} ± {confidence}");
    }
    // The mistake of the page: the sine of the angle from the pole is forgotten.
    let shaders = shaders_with(
        "common/sky_map.glsl",
        "texel.radiance, texel.density);",
        "texel.radiance, texel.density * push.sky.rows.at[chosen / sky.size.x].height * float(sky.size.y) / 3.14159);",
    );
    let wrong = evening("map", 3, Some(shaders.path()));
    let Estimate { mean, confidence } = difference(&wrong, &both);
    println!("without the sine - both: {mean:.6} ± {confidence:.6}");
    assert!(mean.abs() > confidence, "a wrong density passes: {mean} ± {confidence}");
}

const WIDTH: u32 = 32;
const HEIGHT: u32 = 16;
/// The texel that shines, in front (z > 0) and above.
const SHINES: [u32; 2] = [30, 5];

/// The direction of a place in the picture.
fn direction(u: f64, v: f64) -> DVec3 {
    let ((x, z), (flat, y)) =
        ((std::f64::consts::TAU * (u - 0.5)).sin_cos(), (std::f64::consts::PI * v).sin_cos());
    DVec3::new(x * flat, y, -z * flat)
}

/// The light that white facets reflect from the texel: midpoints of 64 by 64 parts.
fn integral(sky: &Panorama, alpha: f64, view: DVec3) -> f64 {
    const STEPS: u32 = 64;
    let [x, y] = SHINES;
    let mut sum = 0.0;
    for i in 0..STEPS * STEPS {
        let place = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
        let [u, v] = [
            (f64::from(x) + place(i % STEPS)) / f64::from(WIDTH),
            (f64::from(y) + place(i / STEPS)) / f64::from(HEIGHT),
        ];
        let light = direction(u, v);
        // Parts of a texel that are even in angle differ in solid angle as the sine.
        let part = (std::f64::consts::PI * v).sin();
        sum += part * twin::reflected(alpha, view, light);
    }
    let parts = (0..STEPS).map(|i| {
        let v = (f64::from(y) + (f64::from(i) + 0.5) / f64::from(STEPS)) / f64::from(HEIGHT);
        (std::f64::consts::PI * v).sin()
    });
    let mean = parts.sum::<f64>() / f64::from(STEPS);
    sum / f64::from(STEPS * STEPS) / mean * solid_angle(sky, y)
}

/// A surface whose normal is z: estimates of its light, one per pixel; each row has a view of its own.
const ESTIMATE: &str = "
    float cosine = (float(at.y) + 0.5) / 8.0;
    vec3 view = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine);
    Microfacets surface = microfacets(push.rough, vec3(1.0), ROUGHNESS, 1.0, view);
    for (uint i = 0; i < 1024; i++) {
        vec4 u = random(at, i, 0, 9), w = random(at, i, 0, 10);
        float light = 0.0;
        if (SAMPLER != SAMPLER_BOUNCES) {
            SkySample found = sky_sample(push.sky, push.rotation, u.xy, u.zw);
            light = found.radiance.r * balanced(surface, found.direction, found.density, BOUNCES).r;
        }
        Bounce next = bounce(surface, w.x, w.yz);
        Texel texel = texel_at(push.sky, push.rotation, next.direction);
        Path path = Path(at, vec3(0.0), next.weight, 1, density_of(surface, w.x, next), 0);
        light += next.weight.r * part_by_bounce(path, texel.density) * texel.radiance.r;
        answer += vec4(light) / 1024.0;
    }";

#[test]
fn a_single_texel_lights_as_in_f64() {
    let mut sky = Panorama {
        width: WIDTH,
        height: HEIGHT,
        texels: vec![[0.0; 3]; (WIDTH * HEIGHT) as usize],
    };
    sky.texels[(SHINES[1] * WIDTH + SHINES[0]) as usize] = [100.0; 3];
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("texel.exr");
    write_sky(&file, &sky);
    let file = file.to_str().expect("plain letters");
    for roughness in [0.3f32, 0.8] {
        // From a smooth surface so few bounces meet the texel that their scatter says nothing of their error.
        let rare = usize::from(roughness < 0.5);
        for sampler in &SAMPLERS[rare..] {
            let sampler_set = format!("sampling={sampler}");
            let sets = set(&[&sampler_set]);
            let mut arguments: Vec<&str> = sets.iter().map(String::as_str).collect();
            arguments.extend(["--sky", file]);
            let declarations = format!("const float ROUGHNESS = {roughness};");
            let shown = evaluate(&declarations, ESTIMATE, "256x8", &arguments);
            for row in 0..8 {
                let cosine = (row as f64 + 0.5) / 8.0;
                let view = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
                let value = 100.0 * integral(&sky, f64::from(roughness).powi(2), view);
                let pixels = &shown.pixels[row * 256..(row + 1) * 256];
                let values: Vec<f64> = pixels.iter().map(|pixel| pixel[0].into()).collect();
                let Estimate { mean, confidence } = Estimate::of(&values);
                // 1024 additions in floats.
                let allowed = confidence + 1e-4 * value;
                println!(
                    "{roughness}, {sampler}, {cosine:.2}: {mean:.5} ± {confidence:.5}, {value:.5}"
                );
                assert!(
                    (mean - value).abs() < allowed,
                    "{roughness}, {sampler}, {cosine}: {mean} ± {allowed}, not {value}"
                );
            }
        }
    }
}

/// Each sampler in the driver's arithmetic, and the one that contains the others in the worst that Vulkan allows,
/// which takes seconds to compile.
#[test]
fn nothing_is_negative_or_no_number() {
    for sampler in SAMPLERS {
        is_light(sampler, "driver");
    }
    if run::has_worst_arithmetic() {
        is_light("both", "worst");
    }
}

#[test]
#[ignore = "nightly: each sampler in the worst arithmetic; quick: environment::light::nothing_is_negative_or_no_number"]
fn nothing_is_negative_or_no_number_with_any_sampler_in_the_worst_arithmetic() {
    if run::has_worst_arithmetic() {
        SAMPLERS.iter().for_each(|sampler| is_light(sampler, "worst"));
    }
}

/// Checks that no value of a picture is negative, infinite or no number.
fn is_light(sampler: &str, arithmetic: &str) {
    let picture = chapter("24x15").set("sampling", sampler).arithmetic(arithmetic).picture();
    let is_light = |pixel: &[f32; 4]| pixel.iter().all(|value| *value >= 0.0 && value.is_finite());
    assert!(picture.pixels.iter().all(is_light), "{arithmetic}, {sampler}");
}
