//! Tori, compared with chapter 33 and with what is known of them.

use std::fs;
use std::path::Path;

use common::app::Picture;
use effects::Effect::*;
use effects::findings;
use glam::{DVec3, Vec3};
use run::{Chapter, bits};

use super::rough::{estimate, green, picture_in};
use super::{check_stages, differing, same_by_both, set_of};

/// The ring of chapter 33 from five of its radii away.
fn ring() -> String {
    let DVec3 { x, y, z } = DVec3::new(1.0, 2.2, 3.0).normalize() * 5.0;
    let field_of_view = (2.0 * (1.3f64 / 5.0).atan()).to_degrees();
    format!(
        "[camera]\neye = [{x}, {y}, {z}]\ntarget = [0, 0, 0]\nfield_of_view = {field_of_view}\n[[light]]\n\
         kind = \"directional\"\nazimuth = 60\nelevation = 38\nradiance = [4, 3.5, 2.8]\n[[material]]\n\
         name = \"red\"\ncolor = [0.55, 0.06, 0.035]\nspecular = [0.04, 0.04, 0.04]\nshininess = 90\n[[torus]]\n\
         center = [0, 0, 0]\naxis = [0.25, 1, 0.125]\nradius = 1\ntube = 0.25\nmaterial = \"red\"\n"
    )
}

#[test]
fn a_ring_looks_as_in_33() {
    let folder = tempfile::tempdir().unwrap();
    let own = picture_in(folder.path(), "96x96", &ring());
    let sets = ["scene=ring", "distance=5", "tube=0.25"];
    let other = Chapter::new("33_roots").size("96x96").sets(&sets).picture();
    let (differ, largest) = differing(&own, &other);
    println!("{} pixels differ, by {largest:e} at most", differ.len());
    // The normals are the same. The light's direction is off by a few roundings, by which it is made a unit vector; the
    // highlight, a power of 90 times a radiance of 4, makes 90·4·4u of four of them.
    assert!(largest < 9e-5, "{} pixels differ, by {largest:e} at most", differ.len());
    let sky = picture_in(folder.path(), "96x96", &ring().replace("tube = 0.25", "tube = 0.0025"));
    assert!(differing(&own, &sky).0.len() > 2000, "the ring is in the picture");
}

/// A torus lit and seen along its axis: light reaches each point that is seen.
fn lit_along_axis(center: Vec3, size: f32, tube: f32, shadows: bool) -> String {
    let towards = Vec3::new(0.48, 0.6, 0.64);
    let (azimuth, elevation) =
        (towards.x.atan2(towards.z).to_degrees(), towards.y.asin().to_degrees());
    let Vec3 { x, y, z } = center + 20.0 * size * towards;
    format!(
        "[camera]\neye = [{x:?}, {y:?}, {z:?}]\ntarget = [{:?}, {:?}, {:?}]\nfield_of_view = 13\n[[light]]\n\
         kind = \"directional\"\nazimuth = {azimuth:?}\nelevation = {elevation:?}\nradiance = [3, 3, 3]\n\
         shadows = {shadows}\n[[material]]\nname = \"a\"\ncolor = [0.7, 0.7, 0.7]\nspecular = [0, 0, 0]\n[[torus]]\n\
         center = [{:?}, {:?}, {:?}]\naxis = [0.48, 0.6, 0.64]\nradius = {size:?}\ntube = {:?}\nmaterial = \"a\"\n",
        center.x,
        center.y,
        center.z,
        center.x,
        center.y,
        center.z,
        tube * size
    )
}

#[test]
fn no_torus_casts_a_shadow_on_itself_where_light_reaches() {
    let folder = tempfile::tempdir().unwrap();
    let away = Vec3::new(3.0, -2.0, 5.0);
    for (center, size, tube) in [
        (Vec3::ZERO, 1.0, 0.25),
        (Vec3::ZERO, 1e-3, 1.0),
        (away, 1.0, 0.9),
        (1e3 * away, 1e3, 0.5),
        (30.0 * away, 1.0, 0.1),
        (away, 1.0, 0.0026),
    ] {
        // A wire is thinner than a pixel.
        let pixels = if tube < 0.01 { "480x480" } else { "96x96" };
        let picture = |shadows: bool| -> Picture {
            picture_in(folder.path(), pixels, &lit_along_axis(center, size, tube, shadows))
        };
        let [lit, shadowed] = [false, true].map(picture);
        let (differ, _) = differing(&lit, &shadowed);
        assert!(differ.is_empty(), "{center}, {size}, {tube}: {} pixels", differ.len());
        let bright = lit.pixels.iter().filter(|pixel| pixel[0] > 0.6).count();
        assert!(bright > 100, "{center}, {size}, {tube}: {bright} pixels are lit");
    }
}

/// A scene with a ring of one material in a white room, without other light.
fn in_white_room(material: &str, eye: &str) -> String {
    format!(
        "sky = 0\n[picture]\nsamples = 16\ndepth = 32\nbounces = 8\n[camera]\neye = {eye}\ntarget = [0, 0, 0]\n\
         field_of_view = 60\n[[material]]\nname = \"wall\"\ncolor = [0, 0, 0]\nemission = [1, 1, 1]\n[[box]]\n\
         low = [-9, -9, -9]\nhigh = [9, 9, 9]\nmaterial = \"wall\"\n[[material]]\nname = \"a\"\n{material}[[torus]]\n\
         center = [0, 0, 0]\naxis = [0.3, 1, 0.2]\nradius = 1\ntube = 0.4\nmaterial = \"a\"\n"
    )
}

#[test]
fn a_ring_that_takes_no_light_cannot_be_seen_in_a_white_room() {
    let folder = tempfile::tempdir().unwrap();
    for (material, bias) in [
        ("color = [1, 1, 1]\nspecular = [0, 0, 0]\n", 0.0),
        ("color = [0, 0, 0]\nspecular = [1, 1, 1]\nmirror = true\n", 0.0),
        ("glass = \"thick\"\nspecular = [0, 0, 0]\n", 0.0),
        // The table is interpolated: by at most 0.003 wrong (chapter 45).
        ("color = [1, 1, 1]\nroughness = 0.4\nmetallic = 1\n", 0.003),
    ] {
        // From outside, and for glass also from inside the tube.
        let eyes: &[&str] = if material.starts_with("glass") {
            &["[0, 1.6, 2.5]", "[0, 0, 1]"]
        } else {
            &["[0, 1.6, 2.5]"]
        };
        for eye in eyes {
            let picture = picture_in(folder.path(), "24x15", &in_white_room(material, eye));
            let seen: Vec<f64> = green(&picture).collect();
            let (mean, error) = estimate(&seen);
            println!("{material:?}, {eye}: {mean:.6} ± {error:.6}");
            // Paths that are cut off, by depth or number of bounces, lose what they carry.
            assert!((mean - 1.0).abs() <= error + bias + 0.005, "{material:?}: {mean} ± {error}");
        }
    }
}

/// Writes a scene, and compares both pipelines.
fn same(folder: &Path, text: &str) -> run::Run {
    let file = folder.join("s.toml");
    fs::write(&file, format!("version = 1\n{text}")).unwrap();
    same_by_both("48x30", &["--scene", file.to_str().unwrap()])
}

#[test]
fn rings_of_rough_metal_and_of_glass_are_the_same_by_both() {
    let folder = tempfile::tempdir().unwrap();
    for (look, effect) in
        [("roughness = 0.3\nmetallic = 1\n", RoughMetal), ("glass = \"thick\"\n", Glass)]
    {
        let text = ring().replace("specular = [0.04, 0.04, 0.04]\nshininess = 90\n", look);
        let own = same(folder.path(), &text);
        let stages = ["common/shadow.rmiss", "torus.rint", "torus.rchit"];
        check_stages(&own.report, set_of(&[Tori, DirectionalShadows, effect]), &stages, look);
        assert!(own.picture.pixels.iter().flatten().all(|part| part.is_finite()), "{look}");
    }
}

#[test]
fn a_ring_of_glass_knows_who_is_inside() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("s.toml");
    let text = ring().replace("shininess = 90\n", "glass = \"thick\"\n");
    fs::write(&file, format!("version = 1\n{text}")).unwrap();
    let scene = effects::open(&file).unwrap();
    let axis = DVec3::new(0.25, 1.0, 0.125).normalize();
    let ring = axis.any_orthonormal_vector();
    let air = scene.media_at(DVec3::ZERO);
    for (point, is_in) in [
        (ring, true),
        (0.76 * ring, true),
        (0.74 * ring, false),
        (1.24 * ring, true),
        (1.26 * ring, false),
        (ring + 0.24 * axis, true),
        (ring - 0.26 * axis, false),
    ] {
        assert_eq!(scene.media_at(point) != air, is_in, "{point}");
    }
    let found = findings(&scene);
    let found = found.iter().find(|finding| finding.effect == Tori).unwrap();
    assert!(found.needed && found.why == "1 torus", "{found:?}");
}

#[test]
fn a_ring_may_turn_and_still_be_the_same() {
    // The axis has no length and no sign.
    let folder = tempfile::tempdir().unwrap();
    let own = picture_in(folder.path(), "48x48", &ring());
    let turned = ring().replace("axis = [0.25, 1, 0.125]", "axis = [-0.5, -2, -0.25]");
    let other = picture_in(folder.path(), "48x48", &turned);
    assert_eq!(bits(&own), bits(&other));
}
