//! Footprints that are NaN, infinite or zero.

use common::app::Picture;

use super::{FOOTPRINTS, NAME};
use run::{evaluate, render};

/// Hostile values of a width, a cosine, an edge or a coordinate.
const BAD: &str = "
    const float BAD[12] = float[](0.0, -0.0, 1.0, -1.0, 1e-30, 1e30, -1e30, 3e-39, 1e9, 0.3,
        uintBitsToFloat(0x7fc00000u), uintBitsToFloat(0x7f800000u));
    float bad(int i) { return BAD[i % 12]; }
    bool good(float x, float low, float high) { return x >= low && x <= high; }
";

/// The chapter's two files, before those of 02.
fn declared() -> String {
    let nonuniform = "#extension GL_EXT_nonuniform_qualifier : require
        layout(set = 1, binding = 0) uniform sampler2D textures[];";
    let [hit, footprint, lookup] =
        ["common/hit.glsl", "common/footprint.glsl", "common/lookup.glsl"]
            .map(|file| std::fs::read_to_string(run::root().join("shaders").join(file)).unwrap());
    format!("{nonuniform}\n{hit}{footprint}{lookup}{BAD}")
}

fn all_good(picture: &Picture) {
    for (i, pixel) in picture.pixels.iter().enumerate() {
        assert_eq!(pixel, &[1.0; 4], "pixel {i}");
    }
}

#[test]
fn a_row_of_lookups_is_finite_whatever_the_axes() {
    let body = "
        vec2 a = vec2(bad(at.x), bad(at.x / 12));
        vec2 b = vec2(bad(at.y), bad(at.y / 12));
        Row row = row_of(a, b, vec2(256.0, 64.0));
        answer.x = good(row.level, 0.0, 30.0) ? 1.0 : 0.0;
        answer.y = row.count >= 1 && row.count <= 16 ? 1.0 : 0.0;
        answer.z = good(row.between.x, -1e9, 1e9) && good(row.between.y, -1e9, 1e9) ? 1.0 : 0.0;
        answer.w = 1.0;";
    all_good(&evaluate(&declared(), body, "144x144"));
}

#[test]
fn a_level_is_finite_whatever_the_cone_and_the_mapping() {
    let body = "
        vec3 e1 = vec3(bad(at.x), 0.0, bad(at.x / 12));
        vec3 e2 = vec3(0.0, bad(at.y), 0.3);
        Mapping mapping = mapping_of(e1, e2, vec2(bad(at.y / 12), 0.5), vec2(0.0, bad(at.x)));
        float level = level_of(texels_of_cone(bad(at.x + at.y), bad(at.y), mapping, vec2(256.0)));
        answer.x = good(level, 0.0, 30.0) ? 1.0 : 0.0;
        Axes axes = ellipse(bad(at.x + at.y), vec3(0.6, -0.8, 0.0), vec3(bad(at.x), bad(at.y), 0.0));
        Row row = row_of(on_texture(mapping, axes.a), on_texture(mapping, axes.b), vec2(256.0));
        answer.y = good(row.level, 0.0, 30.0) && row.count >= 1 && row.count <= 16 ? 1.0 : 0.0;
        axes = differentials(bad(at.y), vec3(0.6, -0.8, 0.0), vec3(0.8, 0.6, 0.0), e1, e2);
        row = row_of(on_texture(mapping, axes.a), on_texture(mapping, axes.b), vec2(256.0));
        answer.z = good(row.level, 0.0, 30.0) && row.count >= 1 && row.count <= 16 ? 1.0 : 0.0;
        answer.w = 1.0;";
    all_good(&evaluate(&declared(), body, "144x144"));
}

/// A ray perpendicular to a triangle, and one along it.
#[test]
fn an_ellipse_is_as_wide_as_the_cone_and_as_long_as_its_slant() {
    let body = "
        float angle = 1.5707963 * float(at.x) / 31.0;
        vec3 direction = vec3(cos(angle) * 0.8, -sin(angle), cos(angle) * 0.6);
        Axes axes = ellipse(0.25, direction, vec3(0.0, 1.0, 0.0));
        answer = vec4(length(axes.a), length(axes.b), dot(axes.a, axes.b), axes.a.y);";
    let found = evaluate(&declared(), body, "32x1");
    for (x, &[long, wide, dot, up]) in found.pixels.iter().enumerate() {
        let slant = (std::f64::consts::FRAC_PI_2 * x as f64 / 31.0).sin().max(1e-4);
        let ratio = f64::from(long) / (0.25 / slant);
        // sin and cos are off by 2^-11 at most, a twentieth of the second smallest slant.
        assert!((ratio - 1.0).abs() < if x == 0 { 5.0 } else { 0.02 }, "{x}: {long}");
        assert!((wide - 0.25).abs() < 1e-6 && dot.abs() < 1e-4 * long, "{x}: {wide} {dot}");
        assert!(up.abs() <= 2e-3 * long, "{x}: {up}");
    }
}

/// Triangles with a degenerate mapping: collapsed to a point or a line, mirrored, huge, on a texture with odd
/// sides.
#[test]
fn a_model_of_degenerate_mappings_is_drawn_without_a_message() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let texels =
        image::RgbImage::from_fn(5, 3, |x, y| image::Rgb([(50 * x) as u8, 200, (80 * y) as u8]));
    texels.save(path("odd.png")).unwrap();
    std::fs::write(path("odd.mtl"), "newmtl odd\nKd 1 1 1\nmap_Kd odd.png\n").unwrap();
    let mappings = [
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]],
        [[0.5, 0.5]; 3],
        [[0.0, 0.0], [0.5, 0.5], [1.0, 1.0]],
        [[0.0, 0.0], [0.0, 9.0], [9.0, 0.0]],
        [[0.0, 0.0], [1e6, 0.0], [0.0, 1e6]],
        [[1e-20, 0.0], [0.0, 1e-20], [0.0, 0.0]],
    ];
    let mut obj = String::from("mtllib odd.mtl\nusemtl odd\n");
    for (i, mapping) in mappings.iter().enumerate() {
        let x = i as f32;
        // The last vertex is far away, so that the triangle is seen at every angle.
        for [px, pz] in [[x, 0.0], [x + 0.9, 0.0], [x + 0.4, -40.0]] {
            obj += &format!("v {px} 0 {pz}\n");
        }
        for [u, v] in mapping {
            obj += &format!("vt {u} {v}\n");
        }
        let k = 3 * i;
        obj += &format!("f {0}/{0} {1}/{1} {2}/{2}\n", k + 1, k + 2, k + 3);
    }
    std::fs::write(path("odd.obj"), obj).unwrap();
    let file = path("odd.obj");
    let file = file.to_str().unwrap();
    for footprint in FOOTPRINTS {
        for eye in ["camera eye=3,0.4,2", "camera eye=3,0,9", "camera eye=3,1e6,0"] {
            let footprint = format!("footprint={footprint}");
            let sets = ["--set", &footprint, "--set", eye, "--set", "camera target=3,0,-1"];
            let arguments = [&["--scene", file], &sets[..]].concat();
            let picture = render(NAME, "64x40", &arguments).picture;
            let is_color = |x: &f32| x.is_finite() && *x >= 0.0;
            let all = picture.pixels.iter().all(|pixel| pixel.iter().all(is_color));
            assert!(all, "{footprint} {eye}");
        }
    }
}
