//! The functions of the shaders, called with lists of inputs.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::{NAME, evaluate, evaluate_in, set, twin};
use run::{copy_of_shaders, expected, replace_line};

/// Pairs of view and light, unit vectors above a surface, as constants of a shader.
fn pairs_in_glsl(pairs: &[[Vec3; 2]]) -> String {
    let number = |value: f32| format!("uintBitsToFloat({}u)", value.to_bits());
    let vector = |v: Vec3| format!("vec3({}, {}, {})", number(v.x), number(v.y), number(v.z));
    let list = |k: usize| pairs.iter().map(|pair| vector(pair[k])).collect::<Vec<_>>().join(",\n");
    let count = pairs.len();
    format!(
        "const vec3 VIEWS[{count}] = {{ {} }};\nconst vec3 LIGHTS[{count}] = {{ {} }};",
        list(0),
        list(1)
    )
}

/// The fractional part of a multiple of an irrational number: evenly spread and never the same.
fn spread(i: usize, step: f64) -> f64 {
    (i as f64 * step + 0.5).fract()
}

/// A unit vector above the surface.
fn direction(cosine: f64, angle: f64) -> DVec3 {
    let sine = (1.0 - cosine * cosine).sqrt();
    DVec3::new(sine * angle.cos(), sine * angle.sin(), cosine)
}

fn pairs(count: usize) -> Vec<[Vec3; 2]> {
    let unit = |i: usize, a: f64, b: f64| {
        direction(0.02 + 0.98 * spread(i, a), TAU * spread(i, b)).as_vec3()
    };
    let pair = |i: usize| [unit(i, 0.618034, 0.754878), unit(i, 0.569840, 0.819173)];
    (0..count).map(pair).collect()
}

#[test]
fn the_brdf_is_that_of_f64_and_the_same_both_ways() {
    let pairs = pairs(128);
    let body = "vec3 view = VIEWS[at.x], light = LIGHTS[at.x];
        float roughness = 0.1 * float(1 + at.y % 10);
        float metallic = at.y < 10 ? 1.0 : 0.5;
        vec3 color = vec3(1.0, 0.6, 0.2);
        Microfacets there = microfacets(push.rough, color, roughness, metallic, view);
        Microfacets back = microfacets(push.rough, color, roughness, metallic, light);
        vec3 one = reflected_from(there, light) / light.z;
        vec3 other = reflected_from(back, view) / view.z;
        Microfacets white = microfacets(push.rough, vec3(1.0), roughness, 1.0, view);
        vec3 unlike = abs(one - other) / one;
        answer = vec4(largest(unlike), reflected_from(white, light).r, roughness, largest(one));";
    let declarations = pairs_in_glsl(&pairs);
    for compensation in ["on", "off"] {
        let sets = set(&[&format!("compensation={compensation}")]);
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let shown = evaluate(&declarations, body, "128x20", &sets);
        let (mut unlike, mut off) = (0f64, 0f64);
        let is_single = compensation == "off";
        for (i, pixel) in shown.pixels.iter().enumerate() {
            let [view, light] = pairs[i % 128].map(|v| v.as_dvec3());
            unlike = unlike.max(pixel[0].into());
            if !is_single {
                continue;
            }
            let [brdf, roughness] = [pixel[1], pixel[2]].map(f64::from);
            let expected = twin::reflected(roughness * roughness, view, light);
            off = off.max((brdf / expected - 1.0).abs());
        }
        println!("compensation {compensation}: unlike by {unlike:.1e}, off by {off:.1e}");
        // About 60 roundings; the directions are unit to 2^-24 and the terms are sums of positive parts.
        assert!(unlike < 1e-5, "it is not the same back: {unlike}");
        assert!(off < 1e-5, "not that of f64: {off}");
    }
}

/// Directions around the mirror's, so that the facets between them are within three alphas of the normal.
fn highlight(roughness: f64, count: usize) -> Vec<[Vec3; 2]> {
    let alpha = roughness * roughness;
    let pair = |i: usize| {
        let view = direction(0.2 + 0.8 * spread(i, 0.618034), TAU * spread(i, 0.754878));
        let tilt = (3.0 * alpha * spread(i, 0.569840)).atan();
        let facet = direction(tilt.cos(), TAU * spread(i, 0.819173));
        [view.as_vec3(), (2.0 * view.dot(facet) * facet - view).as_vec3()]
    };
    (0..count).map(pair).collect()
}

#[test]
fn the_textbook_form_loses_its_digits_and_the_stable_one_does_not() {
    // In units of 2^-24: h is off by 11 (sum 2, its length 7, the product 2), the squares and their sum by 28,
    // alpha^2 by 6, so the spread by 36 with its own roundings; its square by 74; with pi, the quotient and
    // alpha^2 by 88.
    let bound = 88.0 / 16_777_216.0;
    let body = "vec3 facet = half_way(VIEWS[at.x], LIGHTS[at.x]);
        float roughness = ROUGHNESS;
        answer = vec4(min(distribution(roughness * roughness, facet), 1e30));";
    let mut held = serde_json::Map::new();
    for roughness in [0.01f32, 0.02, 0.05, 0.1, 0.2] {
        let pairs = highlight(roughness.into(), 64);
        for form in ["textbook", "stable"] {
            let declarations = format!(
                "{}\nconst float ROUGHNESS = uintBitsToFloat({}u);",
                pairs_in_glsl(&pairs),
                roughness.to_bits()
            );
            let sets = set(&[&format!("form={form}")]);
            let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
            let shown = evaluate(&declarations, body, "64x1", &sets);
            let offs = shown.pixels.iter().zip(&pairs).map(|(pixel, pair)| {
                let [view, light] = pair.map(|v| v.as_dvec3());
                let alpha = f64::from(roughness).powi(2);
                let expected = twin::distribution(alpha, view + light);
                (f64::from(pixel[0]) / expected - 1.0).abs()
            });
            let offs: Vec<f64> = offs.collect();
            let most = offs.iter().copied().fold(0.0, f64::max);
            println!("roughness {roughness}, {form}: off by up to {most:.2e}");
            if form == "stable" {
                assert!(most < bound, "roughness {roughness}: {most} above {bound}");
            } else if roughness <= 0.02 {
                assert!(most > 0.5, "roughness {roughness}: the textbook is off by {most} only");
            }
            let mut sorted = offs.clone();
            sorted.sort_by(f64::total_cmp);
            held.insert(format!("{roughness}.{form}.median"), sorted[32].into());
            held.insert(format!("{roughness}.{form}.most"), most.into());
        }
    }
    expected::hold("45_rough_metal/digits", held.into());
}

/// Counts what is no number or negative, in all views and at the ends of the random numbers.
const COUNT: &str = "
    const float ROUGHNESSES[8] = { 0.0, 1e-4, 1e-3, 1.1e-3, 0.02, 0.1, 0.5, 1.0 };
    const float COSINES[8] = { -0.3, 0.0, 1e-30, 1e-7, 1e-3, 0.5, 0.9999999, 1.0 };
    const float ENDS[4] = { 0.0, 5.9604645e-8, 0.5, 0.99999994 };
    float roughness = ROUGHNESSES[at.x % 8], cosine = COSINES[at.x / 8];
    vec3 view = vec3(sqrt(max(1.0 - cosine * cosine, 0.0)), 0.0, cosine);
    uint bad = 0;
    float most = 0.0;
    for (uint kind = 0; kind < 6; kind++) {
        Microfacets surface = microfacets(push.rough, vec3(kind % 2), roughness, 0.5 * float(kind / 2), view);
        for (uint i = 0; i < 64; i++) {
            float c = COSINES[i / 8], a = 0.7853982 * float(i % 8);
            float s = sqrt(max(1.0 - c * c, 0.0));
            vec3 seen = reflected_from(surface, vec3(s * cos(a - 3.14159), s * sin(a - 3.14159), c));
            bad += is_wrong(seen) ? 1 : 0;
            Bounce next = bounce(surface, ENDS[i / 16], vec2(ENDS[i / 4 % 4], ENDS[i % 4]));
            bad += is_wrong(next.weight) || any(isnan(next.direction)) ? 1 : 0;
            most = max(most, largest(next.weight) * (next.is_mirrored ? 0.0 : 1.0));
        }
    }
    answer = vec4(bad, most, 0.0, 0.0);";

/// Three ways to choose facets, with and without compensation.
const WAYS: [[&str; 2]; 3] = [
    ["sampling=distribution", "compensation=on"],
    ["sampling=visible", "compensation=off"],
    ["sampling=bounded", "compensation=on"],
];

/// The last way also in the worst arithmetic, which takes seconds to compile.
#[test]
fn nothing_is_negative_or_no_number() {
    for way in WAYS {
        is_a_number(way, "driver");
    }
    if run::has_worst_arithmetic() {
        is_a_number(WAYS[2], "worst");
    }
}

#[test]
#[ignore = "nightly: each way in the worst arithmetic; quick: rough_metal::functions::nothing_is_negative_or_no_number"]
fn nothing_is_negative_or_no_number_in_any_way_in_the_worst_arithmetic() {
    if run::has_worst_arithmetic() {
        WAYS.iter().for_each(|way| is_a_number(*way, "worst"));
    }
}

/// Checks the weights and directions of the rays that a surface reflects.
fn is_a_number(way: [&str; 2], arithmetic: &str) {
    let declarations = "bool is_wrong(vec3 v) {
        return any(isnan(v)) || any(isinf(v)) || any(lessThan(v, vec3(0.0)));
    }";
    let sets = set(&way);
    let mut arguments: Vec<&str> = sets.iter().map(String::as_str).collect();
    arguments.extend(["--arithmetic", arithmetic]);
    let shown = evaluate(declarations, COUNT, "64x1", &arguments);
    for (i, pixel) in shown.pixels.iter().enumerate() {
        assert!(pixel[0] == 0.0, "{arithmetic}, {way:?}, {i}: {} wrong", pixel[0]);
    }
}

#[test]
fn no_facet_by_chance_has_an_angle_beyond_pi() {
    // Beyond it, Vulkan promises nothing about sin() and cos(): these macros record the largest of their angles.
    let noting = "float widest = 0.0;
        float noted(float angle) { widest = max(widest, abs(angle)); return angle; }
        #define cos(angle) cos(noted(angle))
        #define sin(angle) sin(noted(angle))
        #include \"common/microfacet.glsl\"";
    let folder = copy_of_shaders();
    let file = "45_rough_metal/camera.rgen";
    replace_line(folder.path(), file, "#include \"common/microfacet.glsl\"", noting);
    // The numbers that complete a turn, and some between.
    let body = "float u = at.y < 32 ? float(16777215 - at.y) / 16777216.0 : float(at.y - 32) / 96.0;
        vec2 numbers = vec2(float(at.x) / 64.0, u);
        vec3 view = vec3(0.8, 0.0, 0.6);
        vec3 facet = at.x % 2 == 0 ? random_facet(0.5, numbers) : visible_facet(0.5, view, 1.0, numbers);
        answer = vec4(widest, facet);";
    let shown = evaluate_in((NAME, &folder), "", body, "64x128", &[]);
    let widest = shown.pixels.iter().map(|pixel| f64::from(pixel[0])).fold(0.0, f64::max);
    println!("widest angle: {widest}");
    assert!(widest > 3.0 && widest <= std::f64::consts::PI, "{widest}");
    assert!(shown.pixels.iter().all(|[_, _, _, z]| *z > 0.0));
}
