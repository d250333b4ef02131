//! Lines along edges: with the requested width in pixels, as in chapter 20, and also in a mirror.

use std::fs;

use super::run;

/// Two triangles with an upright edge in common.
const SHEET: &str = "v 0 -2 0\nv 0 2 0\nv -2 0 0\nv 2 0 0\no sheet\nf 1 2 3\nf 2 1 4\n";

/// The ink in the middle row of a picture, in pixels: on a white sheet at a position, lit only by the sky.
fn ink(lines: f32, z: f32, mirror: &str) -> f32 {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("model.obj"), SHEET).unwrap();
    let text = format!(
        "version = 1\nmodel = \"model.obj\"\n[picture]\ndepth = 1\n[camera]\neye = [0, 0, 3]\n\
         target = [0, 0, 0]\nfield_of_view = 20\n[[material]]\nname = \"white\"\ncolor = [1, 1, 1]\n\
         lines = {lines}\n[[piece]]\nmesh = \"sheet\"\nat = [0, 0, {z}]\nmaterial = \"white\"\n{mirror}"
    );
    let file = folder.path().join("s.toml");
    fs::write(&file, text).unwrap();
    let picture = run("64x21", &["--scene", file.to_str().unwrap()], &[]).picture;
    let row: Vec<f32> = (0..64).map(|x| picture.pixels[10 * 64 + x][1]).collect();
    // Beyond these are the left and right ends of the sheet.
    let row = &row[22..42];
    row.iter().map(|green| 1.0 - green / row[0]).sum()
}

#[test]
fn a_line_is_as_wide_as_asked_for() {
    for lines in [0.25, 1.0, 3.0, 7.5] {
        let ink = ink(lines, 0.0, "");
        println!("{lines} pixels: {ink}");
        // As in chapter 20. The edge goes through the picture's middle, where cone and pixel agree.
        assert!((ink - lines).abs() < 0.001, "{lines}: {ink}");
    }
}

#[test]
fn a_flat_mirror_shows_a_line_as_wide() {
    let mirror =
        "[plane]\nnormal = [0, 0, 1]\nlight = [0, 0, 0]\ndark = [0, 0, 0]\nreflection = 1\n";
    let ink = ink(3.0, 6.0, mirror);
    println!("3 pixels in the mirror: {ink}");
    assert!((ink - 3.0).abs() < 0.001, "{ink}");
}
