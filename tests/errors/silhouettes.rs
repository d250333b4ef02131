//! Compares the silhouettes of foreign models with a rasteriser that shares no code with the samples: it has
//! its own OBJ reader, camera and polygon filling, all in 64 bits.

use std::fs;
use std::path::Path;
use std::process::Output;

use common::app::Picture;

use crate::testmodels::{FOLDER, objects};

const SIZE: [usize; 2] = [240, 150];
/// The vertical field of view, in degrees.
const FIELD: f64 = 40.0;
/// Within this part of a pixel from an edge, rounding decides whether the pixel is covered.
const EDGE: f64 = 0.02;
/// The part of its length by which a polygon may be bent; beyond that, coverage depends on how it is
/// triangulated.
const BENT: f64 = 1e-6;

type Point = [f64; 3];

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn scaled(a: Point, by: f64) -> Point {
    a.map(|part| part * by)
}

fn unit(a: Point) -> Point {
    scaled(a, 1.0 / dot(a, a).sqrt())
}

/// The polygons of a file; faces with a missing corner or a coordinate that is not a number are left out.
fn polygons(bytes: &[u8]) -> Vec<Vec<Point>> {
    let text = String::from_utf8_lossy(bytes).replace("\\\r\n", " ").replace("\\\n", " ");
    let (mut points, mut found): (Vec<Option<Point>>, _) = (Vec::new(), Vec::new());
    for line in text.split(['\n', '\r']) {
        let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
        match words.next() {
            Some("v" | "V") => {
                let numbers: Vec<f64> = words.map_while(|word| word.parse().ok()).collect();
                let w = if numbers.len() == 4 { numbers[3] } else { 1.0 };
                let point = numbers.get(..3).map(|p| [p[0] / w, p[1] / w, p[2] / w]);
                let is_small = |point: &Point| point.iter().all(|part| part.abs() < 3e38);
                points.push(point.filter(is_small));
            }
            Some("f" | "F") => {
                let corner = |word: &str| {
                    let index: i64 = word.split('/').next()?.parse().ok()?;
                    let from_end = points.len() as i64 + index;
                    let at = if index < 0 { from_end } else { index - 1 };
                    *points.get(usize::try_from(at).ok()?)?
                };
                let corners: Option<Vec<Point>> = words.map(corner).collect();
                found.extend(corners.filter(|corners| corners.len() > 2));
            }
            _ => {}
        }
    }
    found
}

/// The camera: its position, its target and its axes.
struct View {
    eye: Point,
    target: Point,
    right: Point,
    up: Point,
    forward: Point,
}

impl View {
    /// A view from outside of all polygons.
    fn of(polygons: &[Vec<Point>]) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for point in polygons.iter().flatten() {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let size = sub(high, low);
        let target = std::array::from_fn(|axis| (low[axis] + high[axis]) / 2.0);
        let radius = dot(size, size).sqrt() / 2.0;
        let away = 1.02 * radius / (FIELD.to_radians() / 2.0).sin();
        let from = scaled(unit([0.47, 0.38, 0.79]), away);
        let eye = std::array::from_fn(|axis| target[axis] + from[axis]);
        let forward = unit(sub(target, eye));
        let right = unit(cross(forward, [0.0, 1.0, 0.0]));
        Self { eye, target, right, up: cross(right, forward), forward }
    }

    /// A point in pixels from the upper left corner.
    fn pixel(&self, point: Point) -> [f64; 2] {
        let away = sub(point, self.eye);
        let scale =
            SIZE[1] as f64 / 2.0 / (FIELD.to_radians() / 2.0).tan() / dot(away, self.forward);
        let [width, height] = SIZE.map(|side| side as f64 / 2.0);
        [width + scale * dot(away, self.right), height - scale * dot(away, self.up)]
    }
}

/// The winding number of an outline around a point: 0 outside.
fn winding(outline: &[[f64; 2]], [x, y]: [f64; 2]) -> i32 {
    let mut turns = 0;
    for (at, a) in outline.iter().enumerate() {
        let b = outline[(at + 1) % outline.len()];
        if (a[1] <= y) != (b[1] <= y) {
            let meets = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            turns += if meets <= x {
                0
            } else if b[1] > a[1] {
                1
            } else {
                -1
            };
        }
    }
    turns
}

/// True if the corners are not in one plane.
fn is_bent(corners: &[Point]) -> bool {
    let normals =
        corners.windows(2).map(|two| cross(sub(two[0], corners[0]), sub(two[1], corners[0])));
    let normal = normals.fold([0.0; 3], |sum, normal| sub(sum, scaled(normal, -1.0)));
    let size = dot(normal, normal).sqrt().sqrt();
    let normal = unit(normal);
    let far = |corner: &Point| dot(normal, sub(*corner, corners[0])).abs() > BENT * size;
    corners.len() > 3 && corners.iter().any(far)
}

/// The coverage of a pixel.
#[derive(Clone, Copy, PartialEq)]
enum Pixel {
    Free,
    Edge,
    Covered,
}

/// The pixels covered by polygons.
fn covered(polygons: &[Vec<Point>], view: &View) -> Vec<Pixel> {
    let [width, height] = SIZE;
    let mut pixels = vec![Pixel::Free; width * height];
    for corners in polygons {
        let outline: Vec<_> = corners.iter().map(|corner| view.pixel(*corner)).collect();
        let bent = is_bent(corners);
        let range = |axis: usize| {
            let sides = outline.iter().map(|point| point[axis]);
            let low = sides.clone().fold(f64::INFINITY, f64::min).floor().max(0.0);
            let high = sides.fold(f64::NEG_INFINITY, f64::max).ceil();
            low as usize..(high.max(0.0) as usize + 1).min(SIZE[axis])
        };
        for y in range(1) {
            for x in range(0) {
                let pixel = &mut pixels[y * width + x];
                let at = |dx: f64, dy: f64| [x as f64 + 0.5 + dx, y as f64 + 0.5 + dy];
                let around = [
                    at(0.0, 0.0),
                    at(EDGE, EDGE),
                    at(-EDGE, EDGE),
                    at(EDGE, -EDGE),
                    at(-EDGE, -EDGE),
                ];
                let is_in = |point: [f64; 2]| {
                    let fan = || {
                        outline[1..]
                            .windows(2)
                            .any(|two| winding(&[outline[0], two[0], two[1]], point) != 0)
                    };
                    let whole = winding(&outline, point) != 0;
                    [whole, if bent { fan() } else { whole }]
                };
                let sides = around.map(is_in);
                let is = |inside: bool| sides.as_flattened().iter().all(|&side| side == inside);
                *pixel = match *pixel {
                    _ if is(true) => Pixel::Covered,
                    Pixel::Free if !is(false) => Pixel::Edge,
                    known => known,
                };
            }
        }
    }
    pixels
}

/// Renders a picture of hits; `moved` is the model's translation.
fn rendered(file: &Path, view: &View, moved: Point, out: &Path) -> Output {
    let point = |name: &str, at: Point| {
        let [x, y, z] = sub(at, scaled(moved, -1.0));
        format!("{name}={x},{y},{z}")
    };
    let mut command = run::command("05_shadow_miss");
    command
        .args(["--headless", "--size", &format!("{}x{}", SIZE[0], SIZE[1]), "--scene"])
        .arg(file);
    let (eye, target) = (point("camera eye", view.eye), point("camera target", view.target));
    for set in ["show=hit", &eye, &target, &format!("field of view={FIELD}")] {
        command.args(["--set", set]);
    }
    command.arg("--out").arg(out).output().expect("the sample starts")
}

/// The translation of a model, from its warning.
fn moved(said: &str) -> Option<Point> {
    let (_, rest) = said.split_once("it was moved by (")?;
    let numbers = rest.split(')').next()?.split(", ").map(|word| word.parse().expect("a number"));
    numbers.collect::<Vec<f64>>().try_into().ok()
}

/// The numbers of covered, uncertain and wrong pixels, and the warnings; `None` for a refused model.
fn compared(file: &Path) -> Option<([usize; 3], String)> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("out.exr");
    let polygons = polygons(&fs::read(file).expect("the file can be read"));
    let view = View::of(&polygons);
    let mut output = rendered(file, &view, [0.0; 3], &out);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    if let Some(by) = moved(&said) {
        output = rendered(file, &view, by, &out);
    }
    if !output.status.success() {
        assert_eq!((output.status.code(), said.lines().count()), (Some(1), 1), "{said}");
        println!("refused: {}", said.trim());
        return None;
    }
    let picture = Picture::open_exr(&out).expect("the picture is an EXR");
    let mut counts = [0; 3];
    for (own, hit) in covered(&polygons, &view).into_iter().zip(&picture.pixels) {
        let is_hit = hit[0] >= 0.0;
        counts[0] += usize::from(is_hit);
        counts[1] += usize::from(own == Pixel::Edge);
        counts[2] += usize::from(own != Pixel::Edge && is_hit != (own == Pixel::Covered));
    }
    Some((counts, said))
}

/// Compares all models below a folder.
fn all_compared(folder: &Path) {
    let mut differ = Vec::new();
    for file in objects(folder) {
        let Some(([covered, edge, wrong], said)) = compared(&file) else { continue };
        let name = file.strip_prefix(folder).unwrap_or(&file).display().to_string();
        let warnings = said.lines().count();
        println!("{name}: {covered} covered, {edge} uncertain, {wrong} wrong, {warnings} warnings");
        if wrong > 0 {
            differ.push((name, warnings));
        }
    }
    let silent: Vec<_> = differ.iter().filter(|(_, warnings)| *warnings == 0).collect();
    println!("{} differ: {differ:?}", differ.len());
    assert!(silent.is_empty(), "{silent:?}");
}

#[test]
#[ignore = "nightly: a package of files; quick: silhouettes::polygons_of_every_kind_have_the_silhouette_of_their_outline"]
fn silhouettes_of_another_reader_s_tests_are_those_of_an_independent_rasteriser() {
    let folder = Path::new(FOLDER);
    if !folder.is_dir() {
        println!(
            "not tried: there is no {FOLDER}: run ./setup --tests, where the system has the package"
        );
        return;
    }
    all_compared(folder);
}

#[test]
#[ignore = "by hand: the models below the folder MODELS"]
fn silhouettes_of_a_folder() {
    all_compared(Path::new(&std::env::var("MODELS").expect("MODELS names a folder")));
}

#[test]
fn polygons_of_every_kind_have_the_silhouette_of_their_outline() {
    let frame = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\n";
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("m.obj");
    for (model, warnings) in [
        (format!("{frame}f 1 2 3 4\n"), 0),
        // A hole with a bridge, a notch, both orientations.
        (format!("{frame}f 1 2 3 4 1 5 6 7 8 5\n"), 0),
        (format!("{frame}f 1 2 8 5 6 4\nf 4 6 7 3\n"), 0),
        (format!("{frame}f -1 -2 -6 -7\nf 6 5 1\n"), 0),
        // Faces that are left out; distant positions.
        (format!("{frame}v nan 0 0\nf 1 2 9\nf 1 2 3\n"), 1),
        (format!("{frame}f 1 2 12\nf 1 2\nf 3 4 1\n"), 1),
        (frame.replace("v ", "v 40000") + "f 1 2 3 4 1 5 6 7 8 5\n", 1),
    ] {
        fs::write(&file, &model).unwrap();
        let ([covered, _, wrong], said) = compared(&file).expect("it is shown");
        assert!(covered > 1000 && wrong == 0, "{covered}, {wrong}: {model}{said}");
        assert_eq!(said.lines().count(), warnings, "{said}");
    }
    // The comparison detects a filled notch.
    let view = View::of(&polygons(format!("{frame}f 1 2 3 4\n").as_bytes()));
    let count = |faces: &str| {
        let pixels = covered(&polygons(format!("{frame}{faces}").as_bytes()), &view);
        pixels.into_iter().filter(|pixel| *pixel == Pixel::Covered).count()
    };
    let (whole, hole) = (count("f 1 2 3 4\n"), count("f 1 2 3 4 1 5 6 7 8 5\n"));
    assert!((hole as f64 / whole as f64 - 0.75).abs() < 0.03, "{whole} {hole}");
}
