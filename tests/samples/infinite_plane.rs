//! 12_infinite_plane: hits compared with the exact plane, which shades, mirrors and casts shadows like other
//! objects.

mod looks;
mod mirrors;
mod shadows;

use std::path::Path;

use common::app::Picture;
use common::scene::{Camera, Scene};
use glam::{DVec3, Vec3};
use reference::plane::Plane;
use reference::ulp::ulp_error;
use reference::{Ray, Surface};
use serde_json::json;

use run::primary_hits::{rays, reference};
use run::{Chapter, bits, expected, same_colors, shaders_with};

const NAME: &str = "12_infinite_plane";
const SIZE: &str = "120x75";
/// The value of `show=hit` for the plane, in place of an instance.
pub const PLANE: f32 = -2.0;

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

/// A model of one mirroring material: an octahedron around `middle`. It loads faster than the pieces.
pub struct Octahedron(tempfile::TempDir);

impl Octahedron {
    fn new(middles: &[Vec3]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mtl = "newmtl a\nKd 0.3 0.5 0.2\nKs 0.4 0.3 0.2\nNs 50\nillum 3\nmap_Kd a.png\n";
        std::fs::write(folder.path().join("a.mtl"), mtl).unwrap();
        let white = image::RgbaImage::from_pixel(2, 2, image::Rgba([255; 4]));
        white.save(folder.path().join("a.png")).unwrap();
        let mut obj = "mtllib a.mtl\no a\nusemtl a\nvt 0 0\n".to_owned();
        for &middle in middles {
            for corner in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]) {
                let Vec3 { x, y, z } = corner + middle;
                obj += &format!("v {x} {y} {z}\n");
            }
            for [a, b, c] in [
                [1, 3, 5],
                [3, 2, 5],
                [2, 4, 5],
                [4, 1, 5],
                [3, 1, 6],
                [2, 3, 6],
                [4, 2, 6],
                [1, 4, 6],
            ] {
                obj += &format!("f {}/1 {}/1 {}/1\n", a - 7, b - 7, c - 7);
            }
        }
        std::fs::write(folder.path().join("a.obj"), obj).unwrap();
        Self(folder)
    }

    /// Out of the camera's view, so that only the plane is visible. On two sides, because otherwise it would
    /// be moved to the origin.
    pub fn out_of_sight() -> Self {
        Self::new(&[Vec3::new(0.0, 0.0, 1e9), Vec3::new(0.0, 0.0, -1e9)])
    }

    pub fn path(&self) -> String {
        self.0.path().join("a.obj").display().to_string()
    }

    fn picture(&self, sets: &[&str]) -> Picture {
        chapter().sets(sets).scene(self.path()).picture()
    }

    /// A sample's picture of it with the shaders of a folder.
    fn picture_by(&self, shaders: &Path, sample: &str, sets: &[&str]) -> Picture {
        let chapter = Chapter::new(sample).size(SIZE).shaders(shaders);
        chapter.sets(sets).scene(self.path()).picture()
    }
}

/// A plane, an eye, and a view along its horizon.
struct View {
    plane: Plane,
    eye: DVec3,
    /// The middle of the picture.
    direction: DVec3,
}

/// A ray, the shader's hit with the plane, and the exact hit.
struct Judged {
    ray: Ray,
    /// t, if the plane is hit.
    found: Option<f32>,
    exact: Option<Surface>,
    /// The sine of the angle between ray and plane.
    sine: f64,
}

impl View {
    /// From `height` above a plane, downwards at a slope (upwards if negative), all in f32 numbers.
    fn above(plane: Plane, height: f64, slope: f64) -> Self {
        let n = plane.normal.normalize();
        let along = n.any_orthonormal_vector();
        let eye = (n * (plane.distance + height) + along * 0.3).as_vec3().as_dvec3();
        Self { plane, eye, direction: along - n * slope * height.signum() }
    }

    /// The rays of a picture whose middle row contains the given direction and its neighbours to the sides.
    fn judged(&self, model: &Octahedron) -> Vec<Judged> {
        let text = |v: DVec3| format!("{:?},{:?},{:?}", v.x, v.y, v.z);
        let Plane { normal, distance } = self.plane;
        let sets = [
            format!("plane normal={}", text(normal)),
            format!("plane distance={distance}"),
            format!("camera eye={}", text(self.eye)),
            format!("camera target={}", text(self.eye + self.direction)),
            "field of view=60".to_owned(),
        ];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let show =
            |view| chapter().size("25x25").sets(&sets).sets(&[view]).scene(model.path()).picture();
        let (directions, found) = (show("show=ray direction"), show("show=hit"));
        let camera = Camera::new(self.eye, self.eye + self.direction, 60.0);
        let rays = rays(&camera, &directions).zip(&found.pixels);
        let judged = rays.map(|(ray, found)| {
            let exact = self.plane.intersect_exact(&ray).map(|hit| hit.to_f64());
            let along = ray.direction.normalize().dot(normal.normalize());
            let found = (found[0] == PLANE).then_some(found[2]);
            Judged { ray, found, exact, sine: along.abs() }
        });
        judged.collect()
    }
}

fn level(distance: f64) -> Plane {
    Plane { normal: DVec3::Y, distance }
}

fn tilted(distance: f64) -> Plane {
    // The length does not matter: the square of this one is 0 in 32 bits.
    Plane { normal: DVec3::new(1.0, -3.0, 2.5) * 2f64.powi(-90), distance }
}

#[test]
fn the_distance_is_right_near_and_far() {
    let model = Octahedron::out_of_sight();
    let mut views = Vec::new();
    for (level_height, tilted_height) in [(1e-6, 1e6), (-1e6, -1e-6)] {
        views.push(View::above(level(0.0), level_height, 1e-7));
        views.push(View::above(tilted(0.0), tilted_height, 1e-5));
    }
    views.push(View::above(level(-1e6), 2.0, 1e-7));
    views.push(View::above(tilted(1e6), 2.0, 1e-3));
    let (mut hits, mut grazing, mut worst) = (0, 0, 0.0f64);
    for Judged { ray, found, exact, sine } in views.iter().flat_map(|view| view.judged(&model)) {
        // The plane is behind, parallel, or out of reach; otherwise it is hit.
        let Some(Surface { t, .. }) = exact else {
            assert_eq!(found, None, "{ray:?}");
            continue;
        };
        let found = found.unwrap_or_else(|| panic!("{ray:?} meets the plane at {t}"));
        hits += 1;
        grazing += usize::from(sine < 1e-5);
        worst = worst.max(ulp_error(found, t));
    }
    println!("{hits} hits, {grazing} with a sine below 1e-5, off by {worst:.2} ULP at most");
    expected::hold("12_infinite_plane/errors", json!({ "hits": hits, "max": worst }));
    assert!(hits > 1500 && grazing > 50, "{hits} {grazing}");
    assert!(worst <= 4.0, "{worst} ULP");
}

#[test]
fn rays_in_the_plane_and_rays_that_begin_on_it_miss() {
    let model = Octahedron::out_of_sight();
    // 1·2 + 2·(-1) = 0: the eye is exactly on the tilted plane.
    let slanted = Plane { normal: DVec3::new(1.0, 2.0, 0.0), distance: 0.0 };
    let on_slanted = DVec3::new(2.0, -1.0, 3.0);
    // Along the plane in the middle row, above it and down through it in the others.
    for (plane, eye) in [(level(1.5), DVec3::Y * 1.5), (slanted, on_slanted)] {
        let judged = View { plane, eye, direction: DVec3::Z }.judged(&model);
        let crossing = judged.iter().filter(|judged| judged.sine > 0.0).count();
        assert!(crossing > 500, "{crossing}");
        for Judged { ray, found, exact, .. } in judged {
            assert!(exact.is_none());
            assert_eq!(found, None, "{ray:?}");
        }
    }
    // Just above, the middle row goes along the plane and misses; the rows below hit.
    let judged = View { plane: level(0.0), eye: DVec3::Y, direction: DVec3::Z }.judged(&model);
    let level: Vec<_> = judged.iter().filter(|judged| judged.sine == 0.0).collect();
    assert_eq!(level.len(), 25);
    assert!(level.iter().all(|judged| judged.found.is_none()));
    assert_eq!(judged.iter().filter(|judged| judged.found.is_some()).count(), 12 * 25);
}

#[test]
fn testing_before_and_after_give_the_same_bits() {
    let near = Octahedron::new(&[Vec3::Y]);
    // On two sides of the origin, because otherwise it would be moved there.
    let far = [Vec3::new(6e3, 4801.0, 6.4e3), Vec3::new(-6e3, 4801.0, -6.4e3)];
    let far = Octahedron::new(&far);
    let at_the_far_one = [
        "plane distance=4800",
        "camera eye=5996.6,4801.6,6407.2",
        "camera target=6000.6,4800.62,6400",
        "light=both",
    ];
    for (model, sets) in [
        (&near, &["preset=four spheres"][..]),
        (&near, &["preset=pov", "camera eye=-1,-3,2"]),
        (&far, &at_the_far_one),
    ] {
        let [before, after] = ["plane test=before", "plane test=after"]
            .map(|test| model.picture(&[sets, &[test]].concat()));
        same_colors(&format!("{sets:?}"), NAME, &before, &after);
    }
}

#[test]
fn without_the_plane_the_picture_is_that_of_06() {
    let model = Octahedron::new(&[Vec3::new(0.2, 1.1, 0.0)]);
    // The preset's sun has its own strength; here it gets that of 06.
    let strength = "return light.strength;";
    let shaders = shaders_with("common/light.glsl", strength, "return vec3(4.4, 3.5, 2.4);");
    let sets = ["sun azimuth=340", "sun elevation=20", "camera eye=2,3,4", "camera target=0,1,0"];
    let show =
        |sample, more: &[&str]| model.picture_by(shaders.path(), sample, &[&sets, more].concat());
    let before = show("06_reflection", &[]);
    let [after, with] = [&["plane=off"][..], &[]].map(|more| show(NAME, more));
    same_colors("12 and 06", NAME, &before, &after);
    let changed = bits(&after).iter().zip(bits(&with)).filter(|(a, b)| **a != *b).count();
    assert!(changed > 2000, "{changed}");
}

/// The reference's copy of the board preset.
fn pieces() -> reference::scene::Scene {
    let mut scene = Scene::chess().unwrap();
    scene.remove_board();
    reference(&scene)
}
