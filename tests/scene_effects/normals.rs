//! Normal maps, compared with chapter 47 and with surfaces that have none.

use std::fs;
use std::path::Path;

use common::app::Picture;
use effects::Effect::*;
use effects::findings;
use run::{Chapter, bits, root};

use super::rough::{estimate, green, picture_in};
use super::{check_stages, same_by_both, set_of};

/// A floor of lacquer with a normal map of 16 × 16 texels, repeated once per unit.
fn floor(folder: &Path, look: &str, texel: impl Fn(u32, u32) -> [u8; 3]) {
    let model = "mtllib floor.mtl\nv -9 0 9\nv 9 0 9\nv 9 0 -9\nv -9 0 -9\nvt -9 -9\nvt 9 -9\nvt 9 9\nvt -9 9\n\
                 usemtl lacquer\nf 1/1 2/2 3/3 4/4\n";
    fs::write(folder.join("floor.obj"), model).unwrap();
    fs::write(folder.join("floor.mtl"), format!("newmtl lacquer\nKd 0.2 0.5 0.3\n{look}")).unwrap();
    let map = image::RgbImage::from_fn(16, 16, |x, y| image::Rgb(texel(x, y)));
    map.save(folder.join("map.png")).unwrap();
}

/// Slopes to all sides, of up to 20 degrees.
fn waves(x: u32, y: u32) -> [u8; 3] {
    let side = |i: u32| (127.5 + 31.0 * (f64::from(i) * std::f64::consts::TAU / 16.0).sin()) as u8;
    [side(x), side(y), 247]
}

const VIEW: &str = "[camera]\neye = [0, 2, 3]\ntarget = [0, 0, 0]\nfield_of_view = 20\n";

/// The floor under a sun, with so many rays.
fn floor_in(folder: &Path, samples: u32) -> Picture {
    let text = format!(
        "model = \"floor.obj\"\n[picture]\nsamples = {samples}\nbounces = 1\n{VIEW}[[light]]\n\
         kind = \"directional\"\nazimuth = 300\nelevation = 35\nradiance = [4.4, 3.5, 2.4]\n"
    );
    picture_in(folder, "64x40", &text)
}

#[test]
fn a_floor_with_a_map_looks_as_in_47() {
    let folder = tempfile::tempdir().unwrap();
    for (roughness, metallic) in [(0.3, 0.0), (0.5, 0.7)] {
        let look = |more: &str| format!("Pr {roughness}\nPm {metallic}\n{more}");
        floor(folder.path(), &look("norm map.png\n"), waves);
        let sets = [
            "rule=flipped",
            "camera eye=0,2,3",
            "camera target=0,0,0",
            "field of view=20",
            "light size=0",
            "sun azimuth=300",
            "sun elevation=35",
            "seed=1",
        ];
        let other = Chapter::new("47_normal_maps").size("64x40").frames(64).sets(&sets);
        let other = other.scene(folder.path().join("floor.obj").to_str().unwrap()).picture();
        let own = floor_in(folder.path(), 64);
        floor(folder.path(), &look(""), waves);
        let smooth = floor_in(folder.path(), 64);
        let difference = |a: &Picture| {
            let both = green(a).zip(green(&other));
            estimate(&both.map(|(a, b)| a - b).collect::<Vec<_>>())
        };
        let bright = green(&other).sum::<f64>() / other.pixels.len() as f64;
        let (mean, error) = difference(&own);
        println!("{roughness}, {metallic}: {mean:.6} ± {error:.6} of {bright:.4}");
        assert!(error < 0.01 * bright, "{error} is too much noise for {bright}");
        assert!(mean.abs() < error, "{mean} ± {error}");
        // Dents are where they are in 47: pixel by pixel, the difference is noise, and without a map it is not.
        let spread = |a: &Picture| {
            let both = green(a).zip(green(&other));
            (both.map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.pixels.len() as f64).sqrt()
        };
        let (own, smooth) = (spread(&own), spread(&smooth));
        println!("{own:.5} per pixel, {smooth:.5} without a map");
        assert!(4.0 * own < smooth, "{own}, {smooth}");
    }
}

#[test]
fn a_flat_map_changes_no_bit() {
    let folder = tempfile::tempdir().unwrap();
    for look in ["Pr 0.4\nPm 0.5\n", "Ks 0.5 0.5 0.5\nillum 3\n", "Ks 0 0 0\nillum 1\n"] {
        floor(folder.path(), look, waves);
        let without = floor_in(folder.path(), 4);
        for texel in [[127, 128, 255], [128, 127, 255]] {
            floor(folder.path(), &format!("{look}norm map.png\n"), |_, _| texel);
            let flat = floor_in(folder.path(), 4);
            assert_eq!(bits(&flat), bits(&without), "{look:?}, {texel:?}");
        }
        floor(folder.path(), &format!("{look}norm map.png\n"), waves);
        assert_ne!(bits(&floor_in(folder.path(), 4)), bits(&without), "{look:?}");
    }
}

#[test]
fn the_chess_board_in_gltf_needs_its_map_and_looks_the_same_by_both() {
    let file = root().join("samples/assets/chess.gltf");
    let scene = effects::open(&file).unwrap();
    let found = findings(&scene);
    let found = found.iter().find(|finding| finding.effect == NormalMaps).unwrap();
    assert!(found.needed && found.why == "material \"board_light\" has a normal map", "{found:?}");
    let warnings = &scene.scene.model.warnings;
    assert!(!warnings.iter().any(|line| line.contains("normal map")), "{warnings:?}");
    let own = same_by_both("96x60", &["--scene", file.to_str().unwrap()]);
    let effects =
        [Triangles, Textures, NormalMaps, CutOut, PointShadows, DirectionalShadows, RoughMetal];
    let stages = ["common/shadow.rmiss", "mesh.rchit", "cut_out.rahit"];
    check_stages(&own.report, set_of(&effects), &stages, "chess.gltf");
}

/// A piece with dents in a box; `text` is the rest.
fn hammered(text: &str) -> String {
    format!(
        "sky = 0\n[camera]\neye = [0, 1.2, 5]\ntarget = [0, 0.75, 0]\nfield_of_view = 12\n[[material]]\n\
         name = \"dented\"\ncolor = [1, 1, 1]\nnormal_map = \"hammered\"\nnormal_scale = 2\n{text}[[piece]]\n\
         mesh = \"king\"\nat = [0, 0, 0]\nmaterial = \"dented\"\n"
    )
}

#[test]
fn dents_of_every_look_are_the_same_by_both() {
    let looks = [
        "specular = [0.5, 0.5, 0.5]\nmirror = true\n",
        "specular = [0.3, 0.3, 0.3]\nshininess = 60\n",
        "roughness = 0.3\nmetallic = 1\n",
        "glass = \"thick\"\n",
        "pattern = \"marble\"\nsecond = [0.1, 0.1, 0.2]\n",
    ];
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("s.toml");
    for look in looks {
        let lights = "[picture]\nsamples = 2\nbounces = 1\n[plane]\nnormal = [0, 1, 0]\nlight = [0.6, 0.5, 0.3]\n\
                      dark = [0.1, 0.1, 0.1]\n[[light]]\nkind = \"directional\"\nazimuth = 80\nelevation = 20\n\
                      radiance = [3, 3, 3]\nsize = 0.1\n";
        fs::write(&file, format!("version = 1\n{}", hammered(&format!("{look}{lights}")))).unwrap();
        let own = same_by_both("48x30", &["--scene", file.to_str().unwrap()]);
        let effects = own.report["chapter"]["pipeline"]["effects"].as_array().unwrap();
        assert!(effects.iter().any(|effect| effect == "normal maps"), "{look}");
        assert!(own.picture.pixels.iter().flatten().all(|part| part.is_finite()), "{look}");
    }
}

#[test]
fn dents_of_white_metal_in_a_white_room_cannot_be_seen() {
    // As without dents: neither views nor rays below the surface lose any light.
    for roughness in [0.0, 0.3, 1.0] {
        let folder = tempfile::tempdir().unwrap();
        let text = format!(
            "roughness = {roughness}\nmetallic = 1\n[picture]\nsamples = 64\ndepth = 32\nbounces = 8\n\
             [[material]]\nname = \"wall\"\ncolor = [0, 0, 0]\nemission = [1, 1, 1]\n[[box]]\n\
             low = [-9, -9, -9]\nhigh = [9, 9, 9]\nmaterial = \"wall\"\n"
        );
        let seen: Vec<f64> = green(&picture_in(folder.path(), "32x20", &hammered(&text))).collect();
        let (mean, error) = estimate(&seen);
        println!("{roughness}: {mean:.6} ± {error:.6}");
        // The table is interpolated: by at most 0.003 wrong (chapter 45).
        assert!((mean - 1.0).abs() < error + 0.003, "{roughness}: {mean} ± {error}");
    }
}
