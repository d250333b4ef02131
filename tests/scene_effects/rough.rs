//! Rough metal, compared with chapter 45 and with light that is known.

use std::fs;
use std::path::Path;

use common::app::Picture;
use run::Chapter;

use super::run;

/// The picture of a scene whose file is in a folder.
pub fn picture_in(folder: &Path, size: &str, text: &str) -> Picture {
    let file = folder.join("s.toml");
    fs::write(&file, format!("version = 1\n{text}")).unwrap();
    run(size, &["--scene", file.to_str().unwrap()], &[]).picture
}

/// The mean of values, and four standard errors, which are exceeded at random once in 16,000 times.
pub fn estimate(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, 4.0 * (squares / (count - 1.0) / count).sqrt())
}

pub fn green(picture: &Picture) -> impl Iterator<Item = f64> {
    picture.pixels.iter().map(|pixel| f64::from(pixel[1]))
}

#[test]
fn a_floor_of_lacquer_looks_as_in_45() {
    let folder = tempfile::tempdir().unwrap();
    let model =
        "mtllib floor.mtl\nv -9 0 9\nv 9 0 9\nv 9 0 -9\nv -9 0 -9\nusemtl lacquer\nf 1 2 3 4\n";
    let model_file = folder.path().join("floor.obj");
    fs::write(&model_file, model).unwrap();
    for (roughness, metallic) in [(0.3, 0.0), (0.6, 0.7)] {
        let material = format!("newmtl lacquer\nKd 0.2 0.5 0.3\nPr {roughness}\nPm {metallic}\n");
        fs::write(folder.path().join("floor.mtl"), material).unwrap();
        let sets = [
            "camera eye=0,2,3",
            "camera target=0,0,0",
            "field of view=20",
            "light size=0",
            "sun azimuth=300",
            "sun elevation=35",
            "seed=1",
        ];
        let other = Chapter::new("45_rough_metal").size("64x40").frames(64).sets(&sets);
        let other = other.scene(model_file.to_str().unwrap()).picture();
        let text = "model = \"floor.obj\"\n[picture]\nsamples = 64\nbounces = 1\n[camera]\n\
                    eye = [0, 2, 3]\ntarget = [0, 0, 0]\nfield_of_view = 20\n[[light]]\n\
                    kind = \"directional\"\nazimuth = 300\nelevation = 35\nradiance = [4.4, 3.5, 2.4]\n";
        let own = picture_in(folder.path(), "64x40", text);
        let differences: Vec<f64> =
            green(&own).zip(green(&other)).map(|(own, other)| own - other).collect();
        let (mean, error) = estimate(&differences);
        let bright = green(&other).sum::<f64>() / differences.len() as f64;
        println!("{roughness}, {metallic}: {mean:.6} ± {error:.6} of {bright:.4}");
        // So few samples would also tell a roughness that is wrong by a tenth.
        assert!(error < 0.01 * bright, "{error} is too much noise for {bright}");
        assert!(mean.abs() < error, "{mean} ± {error}");
    }
}

#[test]
fn white_metal_in_a_white_room_cannot_be_seen() {
    // The walls shine and are black, so every path ends there. Facets and what they pass on to each other
    // reflect all light together, whichever part has rays of its own.
    for roughness in [0.0, 0.3, 1.0] {
        let folder = tempfile::tempdir().unwrap();
        let text = format!(
            "sky = 0\n[picture]\nsamples = 64\ndepth = 32\nbounces = 8\n[camera]\neye = [0, 0, 5]\n\
             target = [0, 0, 0]\nfield_of_view = 14\n[[material]]\nname = \"wall\"\ncolor = [0, 0, 0]\n\
             emission = [1, 1, 1]\n[[box]]\nlow = [-9, -9, -9]\nhigh = [9, 9, 9]\nmaterial = \"wall\"\n\
             [[material]]\nname = \"metal\"\ncolor = [1, 1, 1]\nroughness = {roughness}\nmetallic = 1\n\
             [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"metal\"\n"
        );
        let seen: Vec<f64> = green(&picture_in(folder.path(), "32x20", &text)).collect();
        let (mean, error) = estimate(&seen);
        println!("{roughness}: {mean:.6} ± {error:.6}");
        // The table is interpolated: by at most 0.003 wrong (chapter 45).
        assert!((mean - 1.0).abs() < error + 0.003, "{roughness}: {mean} ± {error}");
    }
}

#[test]
fn a_lamp_lights_lacquer_alike_by_bounces_and_by_shadow_rays() {
    // Shadow rays go to the plate of triangles, and not to the same plate as a box.
    let folder = tempfile::tempdir().unwrap();
    let model = "o plate\nv -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 1\nf 1 2 3 4\n";
    fs::write(folder.path().join("plate.obj"), model).unwrap();
    let floor = |model: &str, lamp: &str| {
        let text = format!(
            "sky = 0\n{model}[picture]\nsamples = 64\nbounces = 1\n[camera]\neye = [0, 3, 9]\n\
             target = [0, 0, 0]\nfield_of_view = 3\n[[material]]\nname = \"floor\"\n\
             color = [0.8, 0.6, 0.4]\nroughness = 0.6\nmetallic = 0.5\n[[box]]\nlow = [-9, -1, -9]\n\
             high = [9, 0, 9]\nmaterial = \"floor\"\n[[material]]\nname = \"lamp\"\ncolor = [0, 0, 0]\n\
             emission = [5, 5, 5]\n{lamp}"
        );
        let seen: Vec<f64> = green(&picture_in(folder.path(), "64x40", &text)).collect();
        estimate(&seen)
    };
    let by_bounces =
        floor("", "[[box]]\nlow = [-1, 2, -1]\nhigh = [1, 2.002, 1]\nmaterial = \"lamp\"\n");
    let piece = "[[piece]]\nmesh = \"plate\"\nat = [0, 0, 0]\nmaterial = \"lamp\"\n";
    let by_both = floor("model = \"plate.obj\"\n", piece);
    println!("by bounces {by_bounces:?}, by both {by_both:?}");
    let error = by_bounces.1.hypot(by_both.1);
    assert!(error < 0.05 * by_both.0, "{error} is too much noise");
    assert!((by_bounces.0 - by_both.0).abs() < error, "{by_bounces:?}, {by_both:?}");
}
