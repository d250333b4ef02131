//! Light at a surface, computed by the shader's own functions.

use std::f64::consts::PI;

use common::app::Picture;
use glam::DVec3;
use serde_json::json;

use super::NAME;
use run::{command, copy_of_shaders, expected, render_by};

/// The results of this chapter's files, one per pixel: `body` reads the pixel from `uvec2 at` and sets `vec4
/// answer`.
fn evaluate(body: &str, size: &str) -> Picture {
    let folder = copy_of_shaders();
    let file = folder.path().join(NAME).join("camera.rgen");
    let text = std::fs::read_to_string(&file).expect("it is there");
    let (head, _) = text.split_once("void main() {").expect("a main");
    let text = format!(
        "{head}void main() {{ uvec2 at = pixel_id(); vec4 answer = vec4(0.0);\n{body}\n\
         imageStore(picture, ivec2(at), answer); }}"
    );
    std::fs::write(&file, text).expect("a copy can be written");
    render_by(command(NAME).env("SHADERS", folder.path()), size, &[]).picture
}

#[test]
fn directions_are_as_likely_as_their_cosine() {
    // One point of the square per pixel, and a normal that turns through all directions.
    let body = "vec2 u = (vec2(at) + 0.5) / 64.0;
        vec2 v = fract(vec2(at) * vec2(0.7548777, 0.5698403));
        float z = at == uvec2(0) ? -1.0 : at == uvec2(1) ? 1.0 : 2.0 * v.x - 1.0;
        float r = sqrt(max(1.0 - z * z, 0.0));
        vec3 n = vec3(r * cos(6.283185 * (v.y - 0.5)), r * sin(6.283185 * (v.y - 0.5)), z);
        vec3 d = cosine_direction(u, n);
        answer = vec4(d, dot(d, n));";
    let shown = evaluate(body, "64x64");
    for (i, pixel) in shown.pixels.iter().enumerate() {
        let u = (f64::from(i as u32 % 64) + 0.5) / 64.0;
        let d = DVec3::new(pixel[0].into(), pixel[1].into(), pixel[2].into());
        assert!((d.length() - 1.0).abs() < 1e-6, "{d}");
        // The fraction of all directions below a cosine c is c^2: 1 - u is uniform, and so is the squared
        // cosine.
        let cosine = f64::from(pixel[3]);
        assert!((cosine - (1.0 - u).sqrt()).abs() < 2e-6, "{i}: {cosine} {u}");
    }
}

#[test]
fn around_the_normal_no_direction_is_preferred() {
    // In the frame of one normal per pixel, the mean over a whole turn points along it.
    let body = "vec2 v = (vec2(at) + 0.5) / 16.0;
        float z = 2.0 * v.x - 1.0, r = sqrt(1.0 - z * z);
        vec3 n = vec3(r * cos(6.283185 * (v.y - 0.5)), r * sin(6.283185 * (v.y - 0.5)), z);
        vec3 sum = vec3(0.0);
        for (uint i = 0; i < 64; i++) { sum += cosine_direction(vec2(0.75, (i + 0.5) / 64.0), n) / 64.0; }
        answer = vec4(sum - 0.5 * n, 0.0);";
    for pixel in &evaluate(body, "16x16").pixels {
        let off = pixel[..3].iter().fold(0f32, |most, c| most.max(c.abs()));
        assert!(off < 2e-6, "{pixel:?}");
    }
}

/// The light of a white sky that a polished surface scatters and reflects, by the midpoint rule over cosines,
/// with the shader's functions, for every view and head-on reflectance.
#[test]
fn what_polish_does_not_mirror_it_scatters() {
    let body = "float to_eye = (at.x + 0.5) / 32.0, head_on = at.y / 16.0;
        MaterialRecord material;
        material.specular = vec3(head_on);
        material.illumination = ILLUMINATION_MIRROR;
        float total = fresnel(material.specular, to_eye).r;
        for (uint i = 0; i < 512; i++) {
            float c = (i + 0.5) / 512.0;
            total += scattered(material, vec3(1.0), to_eye, c).r * 2.0 * c / 512.0;
        }
        float there = scattered(material, vec3(1.0), to_eye, 0.3).r;
        float back = scattered(material, vec3(1.0), 0.3, to_eye).r;
        answer = vec4(total, there - back, 0.0, 0.0);";
    for pixel in &evaluate(body, "32x16").pixels {
        assert!((pixel[0] - 1.0).abs() < 2e-5, "{pixel:?}");
        assert!(pixel[1].abs() < 1e-6, "it is not the same back: {pixel:?}");
    }
}

/// Reflection of light from all sides by a highlight, in f64: views from head-on to grazing.
#[test]
fn a_highlight_creates_no_energy() {
    // As in `reflect_light` and `kept_of_highlight`, with specular 1.
    let kept = |n: f64| (n + 2.0) * (n + 4.0) / ((n + 8.0) * (n + (-0.5 * n).exp2()));
    let reflected = |n: f64, view: DVec3| {
        let steps = 400;
        let mut sum = 0.0;
        for i in 0..steps {
            // Half vectors with a density of the cosine to the power n + 1: few far from the normal matter.
            let u = (f64::from(i) + 0.5) / f64::from(steps);
            let cosine = u.powf(1.0 / (n + 1.0));
            let sine = (1.0 - cosine * cosine).sqrt();
            for k in 0..64 {
                let angle = (f64::from(k) + 0.5) / 64.0 * 2.0 * PI;
                let half = DVec3::new(sine * angle.cos(), sine * angle.sin(), cosine);
                let light = 2.0 * view.dot(half) * half - view;
                if view.dot(half) > 0.0 && light.z > 0.0 {
                    sum += 4.0 * view.dot(half) * light.z;
                }
            }
        }
        // The density of the half vectors is (n + 1) / (2 pi) cos^n.
        (n + 8.0) / (8.0 * PI) * sum / f64::from(steps * 64) * 2.0 * PI / (n + 1.0)
    };
    let mut most = 0f64;
    for n in [1.0, 5.0, 20.0, 60.0, 220.0, 1000.0, 1e5] {
        for degrees in [0.0f64, 20.0, 40.0, 60.0, 75.0, 85.0] {
            let view = DVec3::new(degrees.to_radians().sin(), 0.0, degrees.to_radians().cos());
            let plain = reflected(n, view);
            most = most.max(plain);
            assert!(plain * kept(n) < 1.002, "n {n}, {degrees}: {}", plain * kept(n));
        }
    }
    expected::hold_exact("11_path_tracing/highlight", json!({ "more": most - 1.0 }));
    println!("05's highlight reflects up to {most:.4} of the light");
    assert!(most > 1.02, "the correction is for nothing: {most}");
}
