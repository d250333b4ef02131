//! Results of shaders where Vulkan promises less than a reader may expect: "Precision and Operation of SPIR-V
//! Instructions" in the specification's appendix "Vulkan Environment for SPIR-V".
//!
//! The functions run on the device, exactly as in the book.

use std::fs;

use common::app::Picture;
use common::gpu::shader::Shader;
use common::gpu::{Gpu, GpuOptions, Requirements};

use super::files;

/// Half the distance from 1 to the next float: the relative error of one rounding.
const U: f64 = 1.0 / 16777216.0;

/// All lines of code of all shaders, with their places.
fn lines() -> impl Iterator<Item = (String, String)> {
    files().into_iter().flat_map(|file| {
        let text = fs::read_to_string(run::root().join("shaders").join(&file)).expect("a shader");
        let code = |line: &str| line.split("//").next().unwrap_or_default().to_owned();
        let lines: Vec<String> = text.lines().map(code).collect();
        lines.into_iter().enumerate().map(move |(i, line)| (format!("{file}:{}", i + 1), line))
    })
}

/// The files that call a function, each once.
fn callers(function: &str) -> Vec<String> {
    let calls = |line: &str| {
        line.match_indices(&format!("{function}("))
            .any(|(at, _)| !line[..at].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_'))
    };
    let places = lines().filter(|(_, line)| calls(line)).map(|(place, _)| place);
    let mut files: Vec<String> =
        places.map(|place| place.split(':').next().expect("a file").to_owned()).collect();
    files.dedup();
    files
}

#[test]
fn no_shader_raises_to_a_power_whose_base_may_be_zero() {
    // pow(0, 0) is undefined, and pow() inherits log2's error, which for a base near 1 is 2^-21 times the
    // exponent.
    assert_eq!(callers("pow"), [""; 0]);
}

/// The tested exponents: no highlight at all, those of materials, roughness 0.05, and beyond.
const EXPONENTS: [f64; 8] = [0.0, 0.5, 1.0, 10.0, 200.0, 5e3, 319_998.0, 3e6];

#[test]
fn highlights_are_as_exact_as_their_bound_says() {
    // One column per angle between the normal and the vector half-way between eye and light, one row per
    // exponent. The result is the sum of 02_basic for a white highlight, and the vector.
    let exponents = EXPONENTS.map(|n| format!("{n:.1}")).join(", ");
    let body = format!(
        "float n = float[]({exponents})[at.y];\n\
         float angle = 1.5707963 * exp2(-float(at.x) / 8.0);\n\
         vec3 half_way = at.x == 0 ? vec3(1.0, 0.0, 0.0) : vec3(sin(angle), 0.0, cos(angle));\n\
         vec3 color = reflect_light(vec3(0.0), vec3(1.0), n, vec3(0.0, 0.0, 1.0), half_way, half_way);\n\
         answer = vec4(color.r, half_way);"
    );
    let picture = run::evaluate("", &body, &format!("128x{}", EXPONENTS.len()));
    let mut worst = [0.0f64; EXPONENTS.len()];
    for (at, pixel) in picture.pixels.iter().enumerate() {
        let row = at / 128;
        let n = EXPONENTS[row];
        let [color, x, _, z] = pixel.map(f64::from);
        assert!(color.is_finite(), "exponent {n}, cosine {z}: {color}");
        let lambert = z / std::f64::consts::PI;
        // The highlight is e^-E times its peak; if E is above 20, it is too dark to be visible.
        let e = n * 0.5 * (x / z).powi(2).ln_1p();
        if lambert == 0.0 || e > 20.0 {
            continue;
        }
        let highlight = color / lambert * 8.0 / (n + 8.0);
        let error = (highlight / (-e).exp() - 1.0).abs();
        // As derived in shade.glsl.
        let bound = 4.0 * U * (2.0 * e * n).sqrt() + e / 2f64.powi(18) + 64.0 * U;
        assert!(error <= bound, "exponent {n}, cosine {z}: off by {error:e}, above {bound:e}");
        worst[row] = worst[row].max(error);
    }
    println!("largest relative errors for {EXPONENTS:?}: {worst:?}");
}

#[test]
fn eye_and_light_on_opposite_sides_have_a_finite_middle() {
    // Their sum is 0, which has no direction: 0 / 0.
    let noting = "float least = 1.0;\n\
                  vec3 noted(vec3 v) { least = min(least, dot(v, v)); return v; }\n\
                  float noted(float square) { least = min(least, square); return square; }\n\
                  #define normalize(v) normalize(noted(v))\n\
                  #define inversesqrt(x) inversesqrt(noted(x))\n";
    let body = "vec3 up = vec3(0.0, 0.0, 1.0);\n\
                answer = vec4(reflect_light(vec3(0.5), vec3(0.5), 20.0, up, -up, up), least);";
    let picture = run::evaluate(noting, body, "1x1");
    let [red, _, _, least] = picture.pixels[0];
    assert!(red.is_finite() && least > 0.0, "{red} of a vector whose square is {least}");
}

/// Macros that make `sin` and `cos` record the largest of their angles in `widest`.
const NOTING_ANGLES: &str = "float widest = 0.0;\n\
                             float noted(float angle) { widest = max(widest, abs(angle)); return angle; }\n\
                             #define cos(angle) cos(noted(angle))\n\
                             #define sin(angle) sin(noted(angle))\n";

/// Checks that angles come close to π and never exceed it; the red channel of `picture` is the largest in
/// each pixel.
fn reaches_pi_at_most(picture: &Picture) {
    let widest = picture.pixels.iter().map(|pixel| f64::from(pixel[0])).fold(0.0, f64::max);
    println!("widest angle: {widest}");
    assert!(widest > 3.0 && widest <= std::f64::consts::PI, "{widest}");
}

#[test]
fn no_angle_is_beyond_pi() {
    // Beyond it, Vulkan promises nothing about sin() and cos(). The shaders that call them are tested below.
    let known = [
        "14_animation/flag.comp",
        "common/aperture.glsl",
        "common/disk.glsl",
        // The modules of 45 and 46 test this one and `sky_map.glsl`.
        "common/microfacet.glsl",
        "common/sky_map.glsl",
        "common/sphere_light.glsl",
        "common/surface.glsl",
    ];
    assert_eq!(callers("sin"), known);
    // Cardano's formula needs an arc cosine and keeps its angles within π.
    let cardano = "24_accuracy/cardano.glsl";
    assert_eq!(callers("cos"), [&known[..1], &[cardano], &known[1..]].concat());
    assert_eq!(callers("acos"), [cardano]);
    for function in ["tan", "asin", "atan"] {
        assert_eq!(callers(function), [""; 0]);
    }
    let noting = format!("{NOTING_ANGLES}#include \"common/disk.glsl\"\n");
    // All starts that complete a turn, and some between; for 64 points, every one.
    let body = "float start = at.y < 32 ? float(16777215 - at.y) / 16777216.0 : float(at.y - 32) / 96.0;\n\
                vec2 point = disk_point(at.x, 64, vec2(0.5, start));\n\
                answer = vec4(widest, point, 0.0);";
    let picture = run::evaluate(&noting, body, "64x128");
    reaches_pi_at_most(&picture);
    assert!(picture.pixels.iter().all(|[_, x, y, _]| x.hypot(*y) < 1.0));
}

#[test]
fn no_corner_of_a_blade_has_an_angle_beyond_pi() {
    let noting = format!("{NOTING_ANGLES}#include \"common/aperture.glsl\"\n");
    // All polygons and the disk; the first and the last number of a turn, and some between.
    let body = "uint last = 16777215u;\n\
                float turn = float(at.y < 8 ? last - at.y : at.y < 16 ? at.y - 8 : at.y * (last / 64u));\n\
                vec2 u = vec2(turn / 16777216.0, 1.0 - 1.0 / 16777216.0);\n\
                uint corners = uint(at.x) % 17;\n\
                vec2 point = corners < 3 ? concentric_point(at.x < 17 ? u : u.yx)\n\
                                         : polygon_point(corners, at.x < 17 ? 0.0 : u.x, u);\n\
                answer = vec4(widest, point, 0.0);";
    let picture = run::evaluate(&noting, body, "34x64");
    reaches_pi_at_most(&picture);
    assert!(picture.pixels.iter().all(|[_, x, y, _]| x.hypot(*y) < 1.000001));
}

#[test]
fn no_aim_at_a_sphere_has_an_angle_beyond_pi() {
    let noting = format!(
        "{NOTING_ANGLES}#include \"common/emitter.glsl\"\n\
         #include \"common/sphere_light.glsl\"\n"
    );
    // The numbers that complete a turn, and some between, from outside and from inside.
    let body = "float u = at.y < 32 ? float(16777215 - at.y) / 16777216.0 : float(at.y - 32) / 96.0;\n\
                Emitter ball;\n\
                ball.corner = vec3(0.0, 0.0, at.x < 32 ? 5.0 : 0.5);\n\
                ball.radius = 1.0;\n\
                ball.offset = ball.slack = 0.0;\n\
                Aim aim = aim_at_sphere(ball, vec3(0.0), vec2(float(at.x % 32) / 32.0, u));\n\
                answer = vec4(widest, aim.to);";
    let picture = run::evaluate(&noting, body, "64x128");
    reaches_pi_at_most(&picture);
    assert!(picture.pixels.iter().flatten().all(|value| value.is_finite()));
}

#[test]
fn no_direction_by_chance_has_an_angle_beyond_pi() {
    // Materials do not matter here; they are declared by files included later.
    let noting = format!(
        "{NOTING_ANGLES}struct Other {{ uint illumination; vec3 specular; }};\n\
         #define MaterialRecord Other\n\
         #include \"common/surface.glsl\"\n\
         #undef MaterialRecord\n"
    );
    // The numbers that complete a turn, and some between.
    let body = "float u = at.y < 32 ? float(16777215 - at.y) / 16777216.0 : float(at.y - 32) / 96.0;\n\
                vec3 way = cosine_direction(vec2(float(at.x) / 64.0, u), vec3(0.0, 0.0, 1.0));\n\
                answer = vec4(widest, way);";
    let picture = run::evaluate(&noting, body, "64x128");
    reaches_pi_at_most(&picture);
    assert!(picture.pixels.iter().all(|[_, _, _, z]| *z >= 0.0));
}

#[test]
fn no_wave_of_the_flag_has_an_angle_beyond_pi() {
    // Its shader is one function. Half a turn there is the largest angle of a wave, in 32 bits.
    let text = std::fs::read_to_string(run::root().join("shaders/14_animation/flag.comp")).unwrap();
    let (_, rest) = text.split_once("const float TURN = ").expect("the flag knows a turn");
    let turn: f32 = rest.split(';').next().and_then(|number| number.parse().ok()).unwrap();
    assert!(f64::from(turn) / 2.0 <= std::f64::consts::PI && turn > 6.2, "{turn}");
    assert!(text.contains("float wave = TURN * (fract(") && text.contains(" + 0.5) - 0.5);"));
    // The others are `swing` times a sine.
    let swing = run::root().join("samples/14_animation/flag.rs");
    let swing = std::fs::read_to_string(swing).unwrap();
    assert!(
        swing.contains("[(1.9 + (gust - 1.9) * open) as f32")
            && text.contains("cloth.swing * sin(wave);")
    );
}

#[test]
fn error_free_sums_demand_rounding_to_nearest() {
    for function in ["two_sum", "two_product", "quick_two_sum", "dot_compensated"] {
        for file in callers(function) {
            // 24 declares the mode itself, in exact.glsl; 25 takes the plane from common.
            let known = [
                "12_infinite_plane",
                "18_swept_spheres",
                "22_solids",
                "24_accuracy",
                "30_own_tree",
                "33_roots",
                "43_filtered_checker",
                "common",
            ];
            let folder = file.split('/').next().expect("a folder");
            assert!(known.contains(&folder), "{file} calls {function}");
        }
    }
    let requirements = Requirements::ray_tracing();
    let gpu = Gpu::new(&GpuOptions { requirements, ..GpuOptions::default() }).expect("a device");
    for name in [
        "12_infinite_plane",
        "18_swept_spheres",
        "22_solids",
        "25_scene_effects",
        "30_own_tree",
        "33_roots",
        "43_filtered_checker",
    ] {
        // A copy that does not compile with the mode enabled.
        let shaders = run::copy_of_shaders();
        let file = shaders.path().join("common/error_free.glsl");
        let text = fs::read_to_string(&file).expect("a shader");
        let told = text.replace("spirv_execution_mode(", "#error demanded\n");
        assert_ne!(told, text);
        fs::write(file, told).expect("a copy can be written");
        let mut command = run::command(name);
        command.env("SHADERS", shaders.path()).args(["--headless", "--size", "8x8"]);
        let output = command.output().expect("the sample starts");
        let errors = String::from_utf8_lossy(&output.stderr);
        let demanded = errors.contains("demanded");
        assert_eq!(
            demanded,
            gpu.limits.vulkan12.shader_rounding_mode_rte_float32 == ash::vk::TRUE,
            "{name}: {errors}"
        );
    }
    // And the compiler has added it to the module: OpExecutionMode, RoundingModeRTE, 32 bits.
    let define = [("ROUNDING_MODE_RTE", "1".to_owned())];
    let stages =
        ["12_infinite_plane/camera.rgen", "22_solids/solid.rint", "25_scene_effects/camera.rgen"];
    for stage in stages {
        let words = Shader::of(stage, &define, |stage| stage.words()).expect("it compiles").spirv;
        assert!(words.windows(4).any(|w| w[0] == 4 << 16 | 16 && w[2..] == [4462, 32]), "{stage}");
    }
}

/// Where a device promises an fma that rounds once, products are computed by it: `OpFmaKHR`, with its capability and
/// extension. Elsewhere the module has neither.
#[test]
fn products_use_the_promised_fma_only_where_it_is_promised() {
    for stage in ["24_accuracy/direct_exact.rgen", "24_accuracy/view.rgen", "22_solids/solid.rint"]
    {
        let words = |defines: &[(&str, String)]| {
            Shader::of(stage, defines, |stage| stage.words()).expect("it compiles").spirv
        };
        let has = |words: &[u32]| {
            let has = |start: &[u32]| words.windows(start.len()).any(|w| w == start);
            [has(&[2 << 16 | 17, 6030]), words.contains(&(6 << 16 | 4427))]
        };
        assert_eq!(has(&words(&[("FMA_KHR", "1".to_owned())])), [true, true], "{stage}");
        assert_eq!(has(&words(&[])), [false, false], "{stage}");
    }
}
