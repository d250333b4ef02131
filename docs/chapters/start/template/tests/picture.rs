//! The picture is held to exact answers: which rays meet the sphere.

use std::path::Path;
use std::process::Command;

use raybook::app::Picture;
use raybook::prelude::*;

#[test]
fn the_sphere_is_where_it_should_be() {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("sphere.exr");
    let status = Command::new(env!("CARGO_BIN_EXE_my_tracer"))
        .args(["--headless", "--size", "64x40", "--set", "radius=0.8", "--out"])
        .arg(&file)
        .args(["--set", "camera eye=1,2,6", "--set", "camera target=0,0.8,0"])
        .args(["--set", "field of view=30"])
        .status();
    assert!(status.unwrap().success());
    let picture = Picture::open_exr(&file).unwrap();

    let camera = Camera::new(DVec3::new(1.0, 2.0, 6.0), DVec3::new(0.0, 0.8, 0.0), 30.0);
    let [right, up, forward] = camera.axes();
    let (center, radius, half) = (DVec3::new(0.0, 0.8, 0.0), 0.8, 15f64.to_radians().tan());
    let mut seen = 0;
    for (i, [red, green, ..]) in (0u32..).zip(picture.pixels) {
        let x = (2.0 * f64::from(i % 64) + 1.0) / 64.0 - 1.0;
        let y = 1.0 - (2.0 * f64::from(i / 64) + 1.0) / 40.0;
        let ray = (forward + x * half * 1.6 * right + y * half * up).normalize();
        // How near the ray comes to the centre; at the very edge, rounding may decide.
        let near = (center - camera.eye).cross(ray).length();
        if (near - radius).abs() > 1e-4 {
            // Of all there is, the sphere alone is red.
            assert_eq!(red > 2.0 * green, near < radius, "pixel {}, {}", i % 64, i / 64);
            seen += u32::from(near < radius);
        }
    }
    assert!(seen > 200, "{seen} pixels");
}
