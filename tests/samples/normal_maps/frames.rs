//! Tangent frames: mirrored texture coordinates, and those without an area.

use common::app::Picture;

use super::{NAME, WALK, chapter, evaluate};
use run::{Chapter, copy_of_shaders, replace_line, same_colors, shaders_with};

/// The mapped normals of the plate whose halves mirror each other, through the middle of each pixel.
fn halves(replaced: Option<[&str; 2]>) -> Picture {
    let folder = copy_of_shaders();
    replace_line(
        folder.path(),
        "47_normal_maps/camera.rgen",
        "vec2(id) + numbers(path, DIMENSION_PIXEL)",
        "vec2(id) + 0.5",
    );
    if let Some([from, to]) = replaced {
        replace_line(folder.path(), "common/tangents.glsl", from, to);
    }
    let sets = ["scene=halves", "show=normals"];
    chapter("96x60").sets(&sets).shaders(folder.path()).picture()
}

/// The largest difference of a picture of normals from its mirror image, whose x is the other way round.
fn asymmetry(picture: &Picture) -> f32 {
    let width = picture.width as usize;
    let mut most = 0f32;
    for (i, one) in picture.pixels.iter().enumerate() {
        let (x, y) = (i % width, i / width);
        let other = picture.pixels[y * width + width - 1 - x];
        let is_plate = |pixel: &[f32; 4]| pixel[..3] != [0.0; 3];
        if is_plate(one) && is_plate(&other) {
            let differences = [one[0] - (1.0 - other[0]), one[1] - other[1], one[2] - other[2]];
            most = differences.into_iter().map(f32::abs).fold(most, f32::max);
        }
    }
    most
}

#[test]
fn a_mirrored_half_is_the_mirror_image() {
    let right = asymmetry(&halves(None));
    let wrong = asymmetry(&halves(Some(["dot(across, up) < 0.0 ? -across : across", "across"])));
    println!("mirrored normals differ by {right}; without handedness by {wrong}");
    // Texture coordinates are rounded to 1/256 texel; the normals of neighbouring texels differ by less than 1.
    assert!(right < 2.0 / 256.0, "{right}");
    assert!(wrong > 0.2, "{wrong}");
}

#[test]
fn a_slope_follows_the_texture_around_the_triangle() {
    // A square in z = 0: u along x, v along -y, so that up in the image is y.
    let cases = [
        // The sides, the texture's steps, and the direction of a slope to the right and up.
        ("mat2x3(1, 0, 0, 0, 1, 0)", "mat2(1, 0, 0, -1)", [1.0, 1.0, 0.0]),
        ("mat2x3(1, 0, 0, 0, 1, 0)", "mat2(-1, 0, 0, -1)", [-1.0, 1.0, 0.0]),
        ("mat2x3(1, 0, 0, 0, 1, 0)", "mat2(1, 0, 0, 1)", [1.0, -1.0, 0.0]),
        // A quarter turn.
        ("mat2x3(1, 0, 0, 0, 1, 0)", "mat2(0, -1, -1, 0)", [1.0, -1.0, 0.0]),
        // Very small and very large.
        ("mat2x3(1e-18, 0, 0, 0, 1e-18, 0)", "mat2(1e-30, 0, 0, -1e-30)", [1.0, 1.0, 0.0]),
        ("mat2x3(1e18, 0, 0, 0, 1e18, 0)", "mat2(1e30, 0, 0, -1e30)", [1.0, 1.0, 0.0]),
        // No area.
        ("mat2x3(1, 0, 0, 0, 1, 0)", "mat2(1, 1, 2, 2)", [0.0, 0.0, 0.0]),
        ("mat2x3(1, 0, 0, 0, 1, 0)", "mat2(0, 0, 0, 0)", [0.0, 0.0, 0.0]),
        ("mat2x3(1, 0, 0, 2, 0, 0)", "mat2(1, 0, 0, -1)", [1.0, 0.0, 0.0]),
        ("mat2x3(0, 0, 0, 0, 0, 0)", "mat2(1, 0, 0, -1)", [0.0, 0.0, 0.0]),
    ];
    let list = |texts: [&str; 10]| texts.join(", ");
    let body = format!(
        "mat2x3 sides[10] = {{ {} }};
        mat2 steps[10] = {{ {} }};
        mat2x3 axes = texture_axes(sides[at.x], steps[at.x], vec3(0.0, 0.0, 1.0));
        answer = vec4(axes * vec2(1.0), 0.0);",
        list(cases.map(|(sides, ..)| sides)),
        list(cases.map(|(_, steps, _)| steps)),
    );
    let shown = evaluate("#include \"common/tangents.glsl\"", &body, "10x1", &[]);
    for ((sides, steps, expected), pixel) in cases.into_iter().zip(&shown.pixels) {
        if steps == "mat2(1, 0, 0, -1)" && sides == "mat2x3(1, 0, 0, 2, 0, 0)" {
            // A triangle without an area is hit by no ray.
            assert!(pixel.iter().all(|part| part.is_finite()), "{pixel:?}");
            continue;
        }
        for k in 0..3 {
            assert!((pixel[k] - expected[k]).abs() < 1e-6, "{sides}, {steps}: {pixel:?}");
        }
    }
}

#[test]
fn no_texel_gives_a_slope_that_is_no_number() {
    let body = "float values[6] = { 0.0, 0.25, 0.498, 0.502, 0.75, 1.0 };
        float scales[6] = { 0.0, 1.0, -1.0, 1e-30, 1e6, -1e6 };
        uint i = at.x;
        vec3 texel = vec3(values[i % 6], values[i / 6 % 6], values[i / 36]);
        vec2 slope = texel_slope(texel, scales[at.y]);
        answer = vec4(any(isnan(slope)) || any(isinf(slope)) ? 1.0 : 0.0, length(slope), 0.0, 0.0);";
    let shown = evaluate("#include \"common/tangents.glsl\"", body, "216x6", &[]);
    assert!(shown.pixels.iter().all(|pixel| pixel[0] == 0.0));
    let most = shown.pixels.iter().map(|pixel| pixel[1]).fold(0.0, f32::max);
    assert!(most > 1.0 && most < 20.001, "{most}");
}

#[test]
fn nothing_is_negative_or_no_number() {
    let body = "float slopes[8] = { 0.0, 1e-30, 1e-7, 1e-3, 0.5, 1.0, 5.0, 20.0 };
        float cosines[8] = { -0.3, 0.0, 1e-30, 1e-7, 1e-3, 0.5, 0.9999999, 1.0 };
        float roughnesses[4] = { 0.0, 1.1e-3, 0.3, 1.0 };
        float cosine = cosines[at.x / 8];
        vec3 view = vec3(sqrt(max(1.0 - cosine * cosine, 0.0)), 0.0, cosine);
        uint bad = 0;
        for (uint i = 0; i < 256; i++) {
            float angle = 0.3926991 * float(i % 16) - 3.141592;
            vec2 slope = slopes[at.x % 8] * vec2(cos(angle), sin(angle));
            float c = cosines[i / 16 % 8];
            vec3 light = vec3(0.0, sqrt(max(1.0 - c * c, 0.0)), c);
            Walk next = walk(slope, view, roughnesses[at.y], light, at, i);
            bool is_wrong = any(isnan(next.sun)) || any(isinf(next.sun)) || any(lessThan(next.sun, vec3(0.0)));
            is_wrong = is_wrong || any(isnan(next.weight)) || any(lessThan(next.weight, vec3(0.0)));
            is_wrong = is_wrong || abs(length(next.direction) - 1.0) > 1e-3;
            bad += is_wrong ? 1 : 0;
        }
        answer = vec4(bad);";
    // The worst arithmetic takes half a minute to compile: the rule that uses all functions is enough.
    let worst = run::has_worst_arithmetic().then_some(("two facets", "worst"));
    for (rule, arithmetic) in
        super::energy::RULES.map(|rule| (rule, "driver")).into_iter().chain(worst)
    {
        let rule = format!("rule={rule}");
        let shown = evaluate(WALK, body, "64x4", &["--set", &rule, "--arithmetic", arithmetic]);
        for (i, pixel) in shown.pixels.iter().enumerate() {
            assert!(pixel[0] == 0.0, "{rule}, {arithmetic}, {i}: {} wrong", pixel[0]);
        }
    }
}

#[test]
fn a_map_without_strength_looks_as_in_45() {
    let sets = ["sun azimuth=150", "camera eye=3,4,7"];
    let other = Chapter::new("45_rough_metal").size("64x40").frames(2).sets(&sets).picture();
    for rule in ["flipped", "two facets"] {
        let sets = ["strength=0", &format!("rule={rule}")].map(str::to_owned);
        let own =
            chapter("64x40").frames(2).sets(&["sun azimuth=150", "camera eye=3,4,7"]).sets(&sets);
        same_colors("45 and 47 without a map", NAME, &other, &own.picture());
    }
    let shaders = shaders_with(
        "47_normal_maps/relief.glsl",
        "vec3(slope * inverse, inverse)",
        "vec3(0.01, 0.0, 1.0)",
    );
    let turned =
        chapter("64x40").frames(2).sets(&["sun azimuth=150", "camera eye=3,4,7", "strength=0"]);
    assert!(turned.shaders(shaders.path()).picture() != other);
}
