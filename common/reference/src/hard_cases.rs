//! The hard cases with their answers to 50 digits, compared with the exact and the f64 functions.

use glam::{DMat3, DVec3};
use serde_json::Value;

use super::aabb::Aabb;
use super::algebraic::{Algebraic, exponents};
use super::capsule::Capsule;
use super::cone::Cone;
use super::heightfield::Heightfield;
use super::instance::Ellipsoid;
use super::patch::Patch;
use super::plane::{Plane, PointPlane};
use super::quadric::Quadric;
use super::ray::Ray;
use super::sphere::Sphere;
use super::surd::Surd;
use super::surface::Surface;
use super::triangle;
use super::ulp::ulp_error;
use super::voxel::Voxel;

const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/hard_cases.json");

/// An input: exactly an f32, written as a decimal of f64.
fn number(value: &Value) -> f64 {
    f64::from(value.as_f64().unwrap_or_else(|| panic!("{value} is no number")) as f32)
}

fn vector(value: &Value) -> DVec3 {
    DVec3::new(number(&value[0]), number(&value[1]), number(&value[2]))
}

/// An answer: a decimal string, here rounded to the nearest f64.
fn answer(value: &Value) -> f64 {
    value.as_str().and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("{value}"))
}

fn ray(value: &Value) -> Ray {
    Ray {
        origin: vector(&value["origin"]),
        direction: vector(&value["dir"]),
        tmin: number(&value["tmin"]),
        tmax: number(&value["tmax"]),
    }
}

/// The results of both methods: (exact, f64), and the faces of a box.
struct Found {
    exact: Option<Surface>,
    plain: Option<Surface>,
    faces: Vec<DVec3>,
    /// The number of hits, for shapes that count them.
    count: Option<usize>,
}

fn trace(case: &Value) -> Option<Found> {
    let primitive = case["primitive"].as_str().expect("every case names its primitive");
    if ["secondary_origin", "accumulation"].contains(&primitive) {
        return None;
    }
    let (ray, shape) = (ray(&case["ray"]), &case["shape"]);
    let found = |exact: Option<super::ExactSurface>, plain| {
        Some(Found { exact: exact.map(|hit| hit.to_f64()), plain, faces: Vec::new(), count: None })
    };
    match primitive {
        "sphere" => {
            let sphere =
                Sphere { center: vector(&shape["center"]), radius: number(&shape["radius"]) };
            found(sphere.intersect_exact(&ray), sphere.intersect(&ray))
        }
        "box" => {
            let aabb = Aabb { low: vector(&shape["lo"]), high: vector(&shape["hi"]) };
            let exact = aabb.intersect_exact(&ray);
            let faces = exact.as_ref().map(|hit| hit.faces.clone()).unwrap_or_default();
            let exact =
                exact.map(|hit| Surface { t: Surd::from(hit.t).to_f64(), normal: hit.faces[0] });
            Some(Found { exact, plain: aabb.intersect(&ray), faces, count: None })
        }
        "plane" => {
            let plane = Plane { normal: vector(&shape["normal"]), distance: number(&shape["d"]) };
            found(plane.intersect_exact(&ray), plane.intersect(&ray))
        }
        "plane_point" => {
            let plane =
                PointPlane { point: vector(&shape["point"]), normal: vector(&shape["normal"]) };
            found(plane.intersect_exact(&ray), plane.intersect(&ray))
        }
        "triangle" => {
            let (mut exact, mut plain) = (Vec::new(), Vec::new());
            for vertices in shape["triangles"].as_array().unwrap() {
                let triangle = [0, 1, 2].map(|i| vector(&vertices[i]));
                exact.extend(triangle::intersect_exact(&ray, &triangle).map(|hit| hit.surface));
                plain.extend(triangle::intersect(&ray, &triangle).map(|hit| {
                    let [a, b, c] = triangle;
                    let side = if hit.counterclockwise { 1.0 } else { -1.0 };
                    Surface { t: hit.t, normal: (b - a).cross(c - a).normalize() * side }
                }));
            }
            let nearest = plain.into_iter().min_by(|p, q| p.t.total_cmp(&q.t));
            let exact = exact.into_iter().min_by(|p, q| p.t.to_f64().total_cmp(&q.t.to_f64()));
            found(exact, nearest)
        }
        "capsule" => {
            let (a, b) = (vector(&shape["a"]), vector(&shape["b"]));
            let hit = Capsule { a, b, radius: number(&shape["radius"]) }.intersect(&ray);
            Some(Found { exact: hit, plain: hit, faces: Vec::new(), count: None })
        }
        "instance" => {
            let at = |row: usize, column: usize| number(&shape["object_to_world"][row][column]);
            let column = |k| DVec3::new(at(0, k), at(1, k), at(2, k));
            let linear = DMat3::from_cols(column(0), column(1), column(2));
            let hit = Ellipsoid { linear, translation: column(3) }.intersect(&ray);
            Some(Found { exact: hit, plain: hit, faces: Vec::new(), count: None })
        }
        "heightfield" => {
            let [k, a, fx, fz] = ["k", "a", "fx", "fz"].map(|name| number(&shape[name]));
            let [b, gx, gz, lipschitz] =
                ["b", "gx", "gz", "lipschitz"].map(|name| number(&shape[name]));
            let hit = Heightfield { k, a, fx, fz, b, gx, gz, lipschitz }.intersect(&ray);
            Some(Found { exact: hit, plain: hit, faces: Vec::new(), count: None })
        }
        "cone" => {
            let radii = [0, 1].map(|i| number(&shape["radii"][i]));
            let is_closed = shape["closed"].as_bool().expect("closed or open");
            let cone = Cone { a: vector(&shape["a"]), b: vector(&shape["b"]), radii, is_closed };
            let (hit, count) = (cone.intersect(&ray), Some(cone.hits(&ray).len()));
            Some(Found { exact: hit, plain: hit, faces: Vec::new(), count })
        }
        "quadric" => {
            let part = |name: &str| vector(&shape[name]).to_array();
            let [[a, b, c], [d, e, f], [g, h, i]] = ["square", "mixed", "linear"].map(part);
            let quadric = Quadric([a, b, c, d, e, f, g, h, i, number(&shape["rest"])]);
            let (hit, count) = (quadric.intersect(&ray), Some(quadric.hits(&ray).len()));
            Some(Found { exact: hit, plain: hit, faces: Vec::new(), count })
        }
        "patch" => {
            let patch = Patch([0, 1, 2, 3].map(|i| vector(&shape["corners"][i])));
            let (hit, count) = (patch.intersect(&ray), Some(patch.hits(&ray).len()));
            Some(Found { exact: hit, plain: hit, faces: Vec::new(), count })
        }
        "voxel" => {
            let corners = std::array::from_fn(|i| number(&shape["corners"][i]));
            let voxel = Voxel { low: vector(&shape["lo"]), high: vector(&shape["hi"]), corners };
            let (hit, count) = (voxel.intersect(&ray), Some(voxel.hits(&ray).len()));
            Some(Found { exact: hit, plain: hit, faces: Vec::new(), count })
        }
        "algebraic" => {
            let given: Vec<f64> =
                shape["coefficients"].as_array().unwrap().iter().map(number).collect();
            let is_cubic = given.len() == 20;
            let mut given = given.into_iter();
            let mut coefficients = [0.0; 35];
            for (to, powers) in coefficients.iter_mut().zip(exponents()) {
                if !is_cubic || powers.iter().sum::<u32>() < 4 {
                    *to = given.next().expect("20 or 35");
                }
            }
            let (low, high) = (vector(&shape["lo"]), vector(&shape["hi"]));
            let surface = Algebraic { low, high, coefficients };
            let (hit, count) = (surface.intersect(&ray), Some(surface.hits(&ray).len()));
            Some(Found { exact: hit, plain: hit, faces: Vec::new(), count })
        }
        other => panic!("{other} is no primitive of this schema"),
    }
}

fn check(case: &Value, found: &Found) {
    let (id, expect) = (&case["id"], &case["expect"]);
    if let Some(count) = found.count {
        assert_eq!(expect["count"].as_u64(), Some(count as u64), "{id}: the number of hits");
    }
    match expect["hit"].as_str().unwrap() {
        "yes" => {}
        "no" => {
            assert!(found.exact.is_none() && found.plain.is_none(), "{id}: a hit");
            return;
        }
        // Denormals may be flushed: the reference never does, and outside is outside.
        "either" => {
            assert!(found.exact.is_none(), "{id}: outside by a denormal, yet a hit");
            return;
        }
        other => panic!("{id}: {other} is no hit"),
    }
    let exact = found.exact.unwrap_or_else(|| panic!("{id}: the exact function misses"));
    let plain = found.plain.unwrap_or_else(|| panic!("{id}: the f64 function misses"));
    // Correctly rounded, so the very bits of the 50 digits rounded to f64.
    let t = answer(&expect["t"]);
    let is_bisected = case["primitive"] == "heightfield";
    assert!(exact.t == t || is_bisected && (exact.t - t).abs() < 1e-12 * t, "{id}: t {}", exact.t);
    assert!(ulp_error(plain.t as f32, t) <= 0.501, "{id}: {} for {t}", plain.t);
    if let Some(normal) = expect.get("normal") {
        let normal = DVec3::from_array([0, 1, 2].map(|i| answer(&normal[i])));
        // These compute the normal in f64, from the exact t.
        let primitive = case["primitive"].as_str().unwrap();
        let allowed = match primitive {
            "capsule" | "cone" | "instance" | "heightfield" | "patch" | "quadric" => 1e-9,
            _ => 0.0,
        };
        assert!((exact.normal - normal).length() <= allowed, "{id}: normal {}", exact.normal);
        assert!((plain.normal - normal).length() <= 1e-7, "{id}: {} for {normal}", plain.normal);
    }
    if let Some(faces) = expect.get("faces") {
        let named = |name: &str| {
            let sign = if name.starts_with('+') { 1.0 } else { -1.0 };
            DVec3::AXES["xyz".find(&name[1..]).unwrap()] * sign
        };
        let faces: Vec<_> = faces.as_array().unwrap().iter().filter_map(Value::as_str).collect();
        assert_eq!(faces.len(), found.faces.len(), "{id}: {:?}", found.faces);
        for face in faces {
            assert!(found.faces.contains(&named(face)), "{id}: {:?}", found.faces);
        }
        assert!(found.faces.contains(&plain.normal), "{id}: {}", plain.normal);
    }
}

#[test]
fn every_hard_case_of_the_primitives_here() {
    let text = std::fs::read_to_string(CASES).unwrap_or_else(|error| panic!("{CASES}: {error}"));
    let file: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(file["schema"], "rt-hard-cases/2");
    let mut run = 0;
    for case in file["cases"].as_array().unwrap() {
        if let Some(found) = trace(case) {
            check(case, &found);
            run += 1;
        }
    }
    assert!(run >= 105, "only {run} cases");
}
