//! 12_infinite_plane: every rung held to the exact plane, and a plane that takes part in everything.

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
use serde_json::{Map, json};

use run::primary_hits::{rays, reference};
use run::{Chapter, bits, expected, same_colors, shaders_with};

const NAME: &str = "12_infinite_plane";
const SIZE: &str = "120x75";
/// The value of `show=hit` for the plane, instead of an instance.
const PLANE: f32 = -2.0;
/// Bound of one rounding error, relative.
const U: f64 = 1.0 / (1 << 24) as f64;

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

/// A model of one material that mirrors: an octahedron around `middle`. It loads faster than the pieces.
struct Octahedron(tempfile::TempDir);

impl Octahedron {
    fn new(middle: Vec3) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mtl = "newmtl a\nKd 0.3 0.5 0.2\nKs 0.4 0.3 0.2\nNs 50\nillum 3\nmap_Kd a.png\n";
        std::fs::write(folder.path().join("a.mtl"), mtl).unwrap();
        let white = image::RgbaImage::from_pixel(2, 2, image::Rgba([255; 4]));
        white.save(folder.path().join("a.png")).unwrap();
        let mut obj = "mtllib a.mtl\no a\nusemtl a\n".to_owned();
        for corner in [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| [axis, -axis]) {
            let Vec3 { x, y, z } = corner + middle;
            obj += &format!("v {x} {y} {z}\n");
        }
        obj += "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
        std::fs::write(folder.path().join("a.obj"), obj).unwrap();
        Self(folder)
    }

    /// Beyond what a camera sees, so that the plane is alone.
    fn out_of_sight() -> Self {
        Self::new(Vec3::new(0.0, 0.0, 1e9))
    }

    fn path(&self) -> String {
        self.0.path().join("a.obj").display().to_string()
    }

    fn picture(&self, sets: &[&str]) -> Picture {
        chapter().sets(sets).scene(self.path()).picture()
    }

    /// The picture that a sample makes of it by other shaders.
    fn picture_by(&self, shaders: &Path, sample: &str, sets: &[&str]) -> Picture {
        let chapter = Chapter::new(sample).size(SIZE).shaders(shaders);
        chapter.sets(sets).scene(self.path()).picture()
    }
}

/// Something for each rung.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct ByRung<T> {
    pov: T,
    point: T,
    cut_off: T,
    compensated: T,
}

/// The result of each rung for a ray that meets no plane.
const MISSED: ByRung<f32> = ByRung { pov: -1.0, point: -1.0, cut_off: -1.0, compensated: -1.0 };

/// A plane, an eye, and a look along its horizon.
struct View {
    plane: Plane,
    eye: DVec3,
    /// The middle of the picture.
    direction: DVec3,
}

/// A ray, what each rung made of it, and the truth.
struct Judged {
    ray: Ray,
    /// t, or -1.
    found: ByRung<f32>,
    exact: Option<Surface>,
    /// The sine of the angle between ray and plane.
    sine: f64,
}

impl View {
    /// From `height` above a plane, down at a slope (up, if negative), all in f32 numbers.
    fn above(plane: Plane, height: f64, slope: f64) -> Self {
        let n = plane.normal.normalize();
        let along = n.any_orthonormal_vector();
        let eye = (n * (plane.distance + height) + along * 0.3).as_vec3().as_dvec3();
        Self { plane, eye, direction: along - n * slope * height.signum() }
    }

    /// The rays of a picture whose middle row is the given direction and its neighbours to the sides.
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
        let (directions, found) = (show("show=ray direction"), show("show=rungs"));
        let camera = Camera::new(self.eye, self.eye + self.direction, 60.0);
        let rays = rays(&camera, &directions).zip(&found.pixels);
        let judged = rays.map(|(ray, found)| {
            let exact = self.plane.intersect_exact(&ray).map(|hit| hit.to_f64());
            let along = ray.direction.normalize().dot(normal.normalize());
            let [pov, point, cut_off, compensated] = *found;
            let found = ByRung { pov, point, cut_off, compensated };
            Judged { ray, found, exact, sine: along.abs() }
        });
        judged.collect()
    }
}

fn level(distance: f64) -> Plane {
    Plane { normal: DVec3::Y, distance }
}

fn tilted(distance: f64) -> Plane {
    // Any length will do: the square of this one is 0 in 32 bits.
    Plane { normal: DVec3::new(1.0, -3.0, 2.5) * 2f64.powi(-90), distance }
}

#[test]
fn each_rung_is_as_good_as_it_promises() {
    let model = Octahedron::out_of_sight();
    let mut views = Vec::new();
    for (level_height, tilted_height) in [(1e-6, 1e6), (-1e6, -1e-6)] {
        views.push(View::above(level(0.0), level_height, 1e-7));
        views.push(View::above(tilted(0.0), tilted_height, 1e-5));
    }
    views.push(View::above(level(-1e6), 2.0, 1e-7));
    views.push(View::above(tilted(1e6), 2.0, 1e-3));
    let mut lost = 0;
    let mut worst_pov: f64 = 0.0;
    let mut anchored = Vec::new();
    // Of a ray: ULP, and the sine. The cut-off's are the point's.
    let mut errors = ByRung::<Vec<(f64, f64)>>::default();
    let (mut hits, mut grazing) = (0, 0);
    for view in &views {
        for Judged { ray, found, exact, sine } in view.judged(&model) {
            let reach = view.plane.distance.abs().max(ray.origin.length());
            let Some(Surface { t, .. }) = exact else {
                // The plane is behind, parallel, or farther than rays reach: no rung may find it. A rung that
                // gets the side wrong would find it; the textbook's height may even change its sign.
                assert_eq!(ByRung { pov: -1.0, ..found }, MISSED, "{ray:?}");
                continue;
            };
            hits += 1;
            grazing += usize::from(sine < 1e-5);
            let height = t * sine * ray.direction.length();
            // Cut off is cut off, and otherwise the point's.
            if found.cut_off < 0.0 {
                assert!(sine < 1.001e-3, "{ray:?} {sine}");
                lost += 1;
            } else {
                assert_eq!(found.point, found.cut_off);
                assert!(sine > 0.999e-3, "{ray:?} {sine}");
            }
            errors.pov.push((ulp_error(found.pov, t), sine));
            errors.point.push((ulp_error(found.point, t), sine));
            errors.compensated.push((ulp_error(found.compensated, t), sine));
            let relative = (f64::from(found.pov) - t).abs() / t;
            let bar = (reach / height).max(1.0) * (10.0 + 8.0 / sine) * U;
            worst_pov = worst_pov.max(relative / bar);
            assert!(relative <= bar || bar > 1.0, "{ray:?}: {} for {t}", found.pov);
            // The point is near; what is left is the slope of a ray that grazes a tilted plane.
            let level = view.plane.normal == DVec3::Y;
            let relative = (f64::from(found.point) - t).abs() / t;
            assert!(relative <= (6.0 + 3.0 / sine) * U, "{ray:?}: {} for {t}", found.point);
            if level || sine > 0.1 {
                anchored.push(ulp_error(found.point, t));
            }
        }
    }
    let mut table = Map::new();
    for (rung, errors) in
        [("pov", &errors.pov), ("point", &errors.point), ("compensated", &errors.compensated)]
    {
        for (name, from, to) in
            [("below 1e-5", 0.0, 1e-5), ("to 0.05", 1e-5, 0.05), ("above", 0.05, 2.0)]
        {
            let band = errors.iter().filter(|(_, sine)| (from..to).contains(sine));
            let mut band: Vec<f64> = band.map(|(error, _)| *error).collect();
            band.sort_by(f64::total_cmp);
            let at = |part: f64| band.get((band.len() as f64 * part) as usize).unwrap_or(&0.0);
            let worst = band.last().unwrap_or(&0.0);
            println!(
                "{rung:12} sine {name:10}: {} rays, {:.2} ULP median, {:.1} p99, {worst:.1} most",
                band.len(),
                at(0.5),
                at(0.99)
            );
            for (figure, value) in [("p50", at(0.5)), ("p99", at(0.99)), ("max", worst)] {
                let name = format!("{rung}.{name}.{figure}").replace(' ', "-");
                table.insert(name, (*value).into());
            }
        }
    }
    expected::hold("12_infinite_plane/errors", table.into());
    expected::hold("12_infinite_plane/rays", json!({ "hits": hits }));
    println!("{hits} hits, {grazing} below 1e-5, {lost} cut off; pov at {worst_pov:.2} of its bar");
    assert!(grazing > 50 && lost > 50, "{grazing} {lost}");
    anchored.sort_by(f64::total_cmp);
    let p99 = anchored[anchored.len() * 99 / 100];
    assert!(p99 <= 4.0, "point: {p99} ULP");
    let worst = errors.compensated.iter().fold(0.0f64, |worst, (error, _)| worst.max(*error));
    assert!(worst <= 4.0, "compensated: {worst} ULP");
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
            assert_eq!(found, MISSED, "{ray:?}");
        }
    }
    // Just above, the middle row goes along the plane, and misses; those below hit.
    let judged = View { plane: level(0.0), eye: DVec3::Y, direction: DVec3::Z }.judged(&model);
    let level: Vec<_> = judged.iter().filter(|judged| judged.sine == 0.0).collect();
    assert_eq!(level.len(), 25);
    assert!(level.iter().all(|judged| judged.found == MISSED));
    assert_eq!(judged.iter().filter(|judged| judged.found.point > 0.0).count(), 12 * 25);
}

#[test]
fn testing_before_and_after_give_the_same_bits() {
    let (near, far) = (Octahedron::new(Vec3::Y), Octahedron::new(Vec3::new(6e3, 4801.0, 6.4e3)));
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
    let model = Octahedron::new(Vec3::new(0.2, 1.1, 0.0));
    // The preset's sun has a strength of its own: here it gets that of 06.
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

/// The board preset as the reference sees it.
fn pieces() -> reference::scene::Scene {
    let mut scene = Scene::chess().unwrap();
    let Scene { model, instances, .. } = &mut scene;
    instances.retain(|instance| {
        let name = &model.meshes[instance.mesh].name;
        !name.starts_with("board") && !name.starts_with("screen")
    });
    reference(&scene)
}
