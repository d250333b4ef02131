//! Blended surfaces, compared with their alpha; masked ones, with a cutoff.

use std::fs;
use std::path::Path;

use run::set_arguments;

use super::run;

/// A layer of a model: a square across the view, so far from the origin.
fn square(name: &str, z: f64) -> String {
    format!("o {name}\nv -9 -9 {z}\nv 9 -9 {z}\nv 9 9 {z}\nv -9 9 {z}\nf -4 -3 -2 -1\n")
}

/// The mean brightness of a scene of squares that shine, in front of a black sky, and of how many rays.
fn mean_of_squares(pieces: &str, more: &[&str]) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("m.obj"), square("near", 0.0) + &square("far", -1.0)).unwrap();
    let text = format!(
        "version = 1\nmodel = \"m.obj\"\nsky = 0\n[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\n\
         field_of_view = 20\n[[material]]\nname = \"veil\"\ncolor = [0, 0, 0]\nopacity = 0.3\n\
         emission = [1, 1, 1]\n{pieces}"
    );
    let file = folder.path().join("s.toml");
    fs::write(&file, text).unwrap();
    let scene = ["--scene", file.to_str().unwrap()];
    let picture = run("64x40", &[&scene, more].concat(), &[]).picture;
    let sum: f64 = picture.pixels.iter().map(|pixel| f64::from(pixel[1])).sum();
    sum / picture.pixels.len() as f64
}

/// Checks a part of so many rays: four standard errors are exceeded at random once in 16,000 times.
fn check(found: f64, expected: f64, rays: f64, what: &str) {
    let error = 4.0 * (expected * (1.0 - expected) / rays).sqrt();
    println!("{what}: {found:.5}, not {expected} ± {error:.5}?");
    assert!((found - expected).abs() < error, "{what}: {found}, not {expected} ± {error}");
}

#[test]
fn layers_cover_as_their_alpha_says() {
    let piece =
        |mesh: &str| format!("[[piece]]\nmesh = \"{mesh}\"\nat = [0, 0, 0]\nmaterial = \"veil\"\n");
    let rays = 64.0 * 40.0 * 16.0;
    let one = piece("near");
    let two = piece("near") + &piece("far");
    let samples = set_arguments(&["samples=16"]);
    check(mean_of_squares(&one, &samples), 0.3, rays, "one layer");
    // Two layers are independent, or this would be 0.3 or 0.6.
    check(mean_of_squares(&two, &samples), 0.51, rays, "two layers");
    // A single ray per pixel goes through its middle in each frame.
    check(mean_of_squares(&two, &["--samples", "0..16"]), 0.51, rays, "two layers, in frames");
}

#[test]
fn shadows_are_as_dark_as_alpha_says() {
    let floor = |opacity: f64| {
        let folder = tempfile::tempdir().unwrap();
        let model = "o roof\nv -9 3 9\nv 9 3 9\nv 9 3 -9\nv -9 3 -9\nf -4 -3 -2 -1\n";
        fs::write(folder.path().join("m.obj"), model).unwrap();
        let text = format!(
            "version = 1\nmodel = \"m.obj\"\nsky = 0\n[picture]\nsamples = 16\n[camera]\n\
             eye = [0, 1, 4]\ntarget = [0, 0, 0]\nfield_of_view = 10\n[[light]]\n\
             kind = \"directional\"\nazimuth = 0\nelevation = 80\nradiance = [3, 3, 3]\n\
             [[material]]\nname = \"veil\"\ncolor = [0, 0, 0]\nopacity = {opacity}\n\
             [[material]]\nname = \"floor\"\ncolor = [0.5, 0.5, 0.5]\n\
             [[piece]]\nmesh = \"roof\"\nat = [0, 0, 0]\nmaterial = \"veil\"\n\
             [[box]]\nlow = [-9, -1, -9]\nhigh = [9, 0, 9]\nmaterial = \"floor\"\n"
        );
        let file = folder.path().join("s.toml");
        fs::write(&file, text).unwrap();
        let picture = run("64x40", &["--scene", file.to_str().unwrap()], &[]).picture;
        picture.pixels.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>()
    };
    let part = floor(0.4) / floor(0.0001);
    check(part, 0.6, 64.0 * 40.0 * 16.0, "the sun through a veil");
}

/// A square of four stripes with alphas of their own, and a cutoff between the second and the third.
fn stripes(folder: &Path) {
    let alphas = [90u8, 25, 64, 230];
    let stripe = |x: u32, _: u32| image::Rgba([255, 255, 255, alphas[x as usize / 16]]);
    image::RgbaImage::from_fn(64, 4, stripe).save(folder.join("stripes.png")).unwrap();
    let corners = [[-1f32, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let places = [[0f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let mut bytes: Vec<u8> = corners.iter().flatten().flat_map(|part| part.to_le_bytes()).collect();
    bytes.extend(places.iter().flatten().flat_map(|part| part.to_le_bytes()));
    bytes.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|index| index.to_le_bytes()));
    fs::write(folder.join("stripes.bin"), bytes).unwrap();
    let text = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "buffers": [{"uri": "stripes.bin", "byteLength": 92}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 32},
            {"buffer": 0, "byteOffset": 80, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                "min": [-1, -1, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}],
        "images": [{"uri": "stripes.png"}], "textures": [{"source": 0}],
        "materials": [{"alphaMode": "MASK", "alphaCutoff": 0.3, "emissiveFactor": [1, 1, 1],
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1},
            "indices": 2, "material": 0}]}]}"#;
    fs::write(folder.join("stripes.gltf"), text).unwrap();
}

#[test]
fn a_mask_is_cut_at_the_cutoff_of_its_material() {
    let folder = tempfile::tempdir().unwrap();
    stripes(folder.path());
    // The square fills the height of the picture, and 96 of its 160 columns.
    let view = ["camera eye=0,0,5", "camera target=0,0,0", "field of view=22.61986"];
    let file = folder.path().join("stripes.gltf");
    let shown = run("160x96", &["--scene", file.to_str().unwrap()], &view).picture;
    // The sky is darker than what shines.
    let row = &shown.pixels[48 * 160..49 * 160];
    let is_there: Vec<bool> = row.iter().map(|pixel| pixel[0] >= 1.0).collect();
    let stripe = |number: usize| &is_there[32 + 24 * number + 1..32 + 24 * (number + 1) - 1];
    for (number, expected) in [true, false, false, true].into_iter().enumerate() {
        assert!(stripe(number).iter().all(|&there| there == expected), "stripe {number}: {row:?}");
    }
    let count = is_there.iter().filter(|&&there| there).count();
    assert!((46..=50).contains(&count), "{count} columns are there, of 48");
}
