//! Three points of the picture, compared with exact answers: in the sun, in the shadow, and in the mirror.

use std::path::Path;
use std::process::Command;

use raybook::app::Picture;
use raybook::prelude::*;

/// The color of a point as the eye sees it: a picture of one pixel, whose camera looks at the point.
fn seen(eye: DVec3, point: DVec3) -> Vec3 {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("my_tracer.exr");
    let status = Command::new(env!("CARGO_BIN_EXE_my_tracer"))
        .args(["--headless", "--size", "1x1", "--out"])
        .arg(&file)
        .args(["--set", "sun azimuth=90", "--set", "sun elevation=45"])
        .args(["--set", &format!("camera eye={},{},{}", eye.x, eye.y, eye.z)])
        .args(["--set", &format!("camera target={},{},{}", point.x, point.y, point.z)])
        .status();
    assert!(status.unwrap().success());
    let [red, green, blue, _] = Picture::open_exr(&file).unwrap().pixels[0];
    Vec3::new(red, green, blue)
}

#[test]
fn sun_shadow_and_mirror_are_right() {
    let eye = DVec3::new(0.0, 1.0, 4.0);
    let light = Sun { azimuth: 90.0, elevation: 45.0, ..Sun::default() }.light();
    // The ground reflects half of the sky's light, and of the sun's by Lambert's law.
    let sky = 0.5 * Vec3::new(0.42, 0.47, 0.55);
    let lit = sky + 0.5 * light.radiance * light.direction.y / std::f32::consts::PI;
    // The mirror stands at z = -1.8. In it the point appears at the same distance behind, darker by Schlick's formula.
    let point = DVec3::new(0.0, 0.0, 1.0);
    let image = DVec3::new(0.0, 0.0, -4.6);
    let cosine = (eye - image).normalize().z as f32;
    let mirrored = (0.9 + 0.1 * (1.0 - cosine).powi(5)) * lit;
    for (what, at, exact) in [
        ("in the sun", point, lit),
        // The cube ends at x = -1.6. It is 1 high, so with the sun at 45 degrees its shadow is 1 long.
        ("in the shadow", DVec3::new(-2.1, 0.0, 0.0), sky),
        ("in the mirror", image, mirrored),
    ] {
        let color = seen(eye, at);
        assert!(color.abs_diff_eq(exact, 1e-5), "{what}: {color} instead of {exact}");
    }
}
