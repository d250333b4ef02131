//! Directions and solid angles from the shader's own functions, compared with 64 bits.

use std::f64::consts::PI;

use common::app::Picture;
use glam::DVec3;
use serde_json::json;

use super::{NAME, U};
use crate::glass::equations::hash;
use run::{command, copy_of_shaders, expected, render_by};

/// The results of this chapter's files, one per pixel: `body` reads the pixel from `uvec2 at` and sets `vec4
/// answer`.
fn evaluate(body: &str, size: &str) -> Picture {
    let folder = copy_of_shaders();
    let file = folder.path().join(NAME).join("camera.rgen");
    let text = std::fs::read_to_string(&file).expect("it is there");
    let (head, _) = text.split_once("void main() {").expect("a main");
    let text = format!(
        "{head}void main() {{ uvec2 at = pixel_id(); vec4 answer = vec4(0.0);\n{body}\n\
         imageStore(picture, ivec2(at), answer); }}"
    );
    std::fs::write(&file, text).expect("a copy can be written");
    render_by(command(NAME).env("SHADERS", folder.path()), size, &[]).picture
}

fn vector(pixel: &[f32; 4]) -> DVec3 {
    DVec3::new(pixel[0].into(), pixel[1].into(), pixel[2].into())
}

/// Spheres at distance 7, of radius 7·2^-k and 7·(1 - 2^-k) alternately, k from 1 to 20: all numbers are
/// exact.
const SPHERE: &str = "
    int k = int(at.x) / 2 + 1;
    float small = ldexp(1.0, -k);
    float radius = 7.0 * (at.x % 2 == 0 ? small : 1.0 - small);
    vec2 u = vec2(at.y % 8 + 0.5, at.y / 8 + 0.5) / 8.0;
    Emitter ball = Emitter(vec3(2.0, -3.0, 6.0), radius, vec3(0.0), 0.0, vec3(0.0), 0u, 0.0, 0.0);
";

fn radius(x: usize) -> f64 {
    let small = 0.5f64.powi(x as i32 / 2 + 1);
    7.0 * if x.is_multiple_of(2) { small } else { 1.0 - small }
}

/// 1 - cosine of half the cone's opening, without cancellation even in 64 bits.
fn exact_cone(radius: f64) -> f64 {
    let cosine = ((7.0 - radius) * (7.0 + radius)).sqrt() / 7.0;
    (radius / 7.0).powi(2) / (1.0 + cosine)
}

#[test]
fn a_cone_keeps_its_digits_far_away_and_close_by() {
    let body = "
        float sine = radius / 7.0;
        answer = vec4(cone(radius, 7.0), 1.0 - sqrt(1.0 - sine * sine), 0.0, 0.0);
    ";
    let shown = evaluate(&format!("{SPHERE}{body}"), "40x1");
    let (mut here, mut by_the_book) = (0f64, 0f64);
    for (x, pixel) in shown.pixels.iter().enumerate() {
        let exact = exact_cone(radius(x));
        here = here.max((f64::from(pixel[0]) / exact - 1.0).abs() / U);
        by_the_book = by_the_book.max((f64::from(pixel[1]) / exact - 1.0).abs());
    }
    println!("1 - cosine: off by {here:.1} u, by the book by {by_the_book:.3} of it");
    // Half a dozen roundings; Vulkan allows a division an error of 5 u.
    assert!(here < 16.0, "{here}");
    assert!(by_the_book > 0.5, "the textbook's form would do: {by_the_book}");
    expected::hold("29_emitters/cone", json!({ "here": here, "textbook": by_the_book }));
}

#[test]
fn directions_to_a_ball_are_uniform_in_its_cone_and_meet_it() {
    let body = "Aim aim = aim_at(ball, vec3(0.0), u); answer = vec4(aim.to, aim.angle);";
    let shown = evaluate(&format!("{SPHERE}{body}"), "40x64");
    let center = DVec3::new(2.0, -3.0, 6.0);
    for (i, pixel) in shown.pixels.iter().enumerate() {
        let (x, y) = (i % 40, i / 40);
        let (radius, to) = (radius(x), vector(pixel));
        let direction = to.normalize();
        // The fraction of the cone closer to the axis: the first number.
        let u = ((y % 8) as f64 + 0.5) / 8.0;
        let expected = (2.0 * u * exact_cone(radius)).sqrt();
        let chord = (direction - center / 7.0).length();
        assert!((chord - expected).abs() < 16.0 * U, "{x} {y}: {chord} {expected}");
        let aside = center.cross(direction).length();
        assert!(aside < radius + 7.0 * 16.0 * U, "{x} {y}: {aside} passes {radius}");
        // And the point is where the ray first hits the ball.
        let off = ((to - center).length() - radius).abs();
        assert!(off < 7.0 * 32.0 * U, "{x} {y}: {off} off the ball");
        assert!((to - center).dot(direction) < 7.0 * 32.0 * U, "{x} {y}: behind");
        let angle = 2.0 * PI * exact_cone(radius);
        assert!((f64::from(pixel[3]) / angle - 1.0).abs() < 20.0 * U, "{x} {y}");
    }
}

#[test]
fn from_inside_a_ball_every_direction_is_as_likely() {
    // From the middle, from near the surface, and from the surface itself.
    let body = "
        float inside[4] = float[](7.0, 14.0, 7.0 + 7.0 / 1024.0, 700.0);
        ball.radius = inside[at.x];
        Aim aim = aim_at(ball, vec3(0.0), u);
        answer = vec4(aim.to, aim.angle);
    ";
    let shown = evaluate(&format!("{SPHERE}{body}"), "4x64");
    let center = DVec3::new(2.0, -3.0, 6.0);
    let radii = [7.0, 14.0, 7.0 + 7.0 / 1024.0, 700.0];
    for (i, pixel) in shown.pixels.iter().enumerate() {
        let (radius, y, to) = (radii[i % 4], i / 4, vector(pixel));
        let u = ((y % 8) as f64 + 0.5) / 8.0;
        let off = ((to - center).length() - radius).abs();
        assert!(off < 32.0 * U * radius, "{radius} {y}: {off} off the ball");
        assert_eq!(pixel[3], (4.0 * PI) as f32);
        // If the point is on the ball itself, the direction is along the chord, or there is none.
        if radius > 7.0 {
            let direction = to.normalize();
            assert!((direction.z - (1.0 - 2.0 * u)).abs() < 1e-4, "{radius} {y}: {direction}");
        }
    }
}

/// A corner and two edges, all exact: sixteenths, and edges up to 2^-11 times those.
const TRIANGLE: &str = "
    #define PICK(s) (float(int(hash(uvec4(at, s, 7)).x % 33u) - 16) / 16.0)
    float size = ldexp(1.0, -int(at.y % 12u));
    vec3 a = vec3(PICK(1), PICK(2), PICK(3));
    vec3 across = size * vec3(PICK(4), PICK(5), PICK(6));
    vec3 along = size * vec3(PICK(7), PICK(8), PICK(9));
";

/// The same number: a multiple of 1/16 from -1 to 1.
fn pick(x: u32, y: u32, salt: u32) -> f64 {
    (f64::from(hash([x, y, salt, 7])[0] % 33) - 16.0) / 16.0
}

struct Triangle {
    corners: [DVec3; 3],
    edges: [DVec3; 2],
}

impl Triangle {
    fn of(pixel: usize, width: usize) -> Self {
        let (x, y) = ((pixel % width) as u32, (pixel / width) as u32);
        let pick = |s: u32| pick(x, y, s);
        let size = 0.5f64.powi((y % 12) as i32);
        let of = |s: u32| DVec3::new(pick(s), pick(s + 1), pick(s + 2));
        let (a, across, along) = (of(1), size * of(4), size * of(7));
        Self { corners: [a, a + across, a + along], edges: [across, along] }
    }

    fn angle(&self) -> f64 {
        let [a, b, c] = self.corners;
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let sum = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(self.edges[0].cross(self.edges[1])).abs().atan2(sum)
    }

    /// Returns whether its edges are shorter than 1/64 of its distance.
    fn is_far(&self) -> bool {
        let longer = self.edges.map(DVec3::length).into_iter().fold(0.0, f64::max);
        longer < self.corners[0].length() / 64.0
    }

    /// The factor by which an error of a coordinate, relative to the distance, is enlarged: the larger, the
    /// flatter the triangle is seen, and the closer a corner is.
    fn condition(&self) -> f64 {
        let [a, b, c] = self.corners;
        let height = a.dot(self.edges[0].cross(self.edges[1])).abs();
        let far = a.length().max(b.length()).max(c.length());
        let near = a.length().min(b.length()).min(c.length());
        (a.length() * self.edges[0].length() * self.edges[1].length() / height) * (far / near)
    }
}

#[test]
fn the_solid_angle_of_a_triangle_keeps_its_digits() {
    let body = "
        vec3 A = normalize(a), B = normalize(a + across), C = normalize(a + along);
        float by_the_book = 2.0 * atan(abs(dot(A, cross(B, C))), 1.0 + dot(A, B) + dot(B, C) + dot(C, A));
        answer = vec4(solid_angle(a, across, along), by_the_book, 0.0, 0.0);
    ";
    let shown = evaluate(&format!("{TRIANGLE}{body}"), "96x96");
    let (mut here, mut by_the_book, mut tried) = (0f64, 0f64, 0);
    for (i, pixel) in shown.pixels.iter().enumerate() {
        let triangle = Triangle::of(i, 96);
        let condition = triangle.condition();
        if condition.is_nan() || condition >= 1e3 {
            continue;
        }
        tried += 1;
        let exact = triangle.angle();
        here = here.max((f64::from(pixel[0]) / exact - 1.0).abs() / U / condition);
        by_the_book = by_the_book.max((f64::from(pixel[1]) / exact - 1.0).abs() / U / condition);
    }
    println!("{tried} triangles: off by {here:.1} u, by the book {by_the_book:.0} u");
    assert!(tried > 5000, "{tried}");
    assert!(here < 16.0, "{here}");
    assert!(by_the_book > 100.0, "the textbook's form would do: {by_the_book}");
    expected::hold(
        "29_emitters/solid_angle",
        json!({ "here": here, "textbook": by_the_book, "triangles": tried }),
    );
}

#[test]
fn the_sides_of_a_cube_fill_the_whole_sphere() {
    let body = "
        vec3 from = vec3(PICK(1), PICK(2), PICK(3)) * 0.4375;
        answer.x = 0.0;
        for (uint side = 0; side < 6; side++) {
            vec3 outward = vec3(0.0);
            outward[side / 2] = side % 2 == 0 ? 0.5 : -0.5;
            vec3 right = outward.yzx * 2.0, up = outward.zxy * 2.0;
            vec3 corner = outward - 0.5 * right - 0.5 * up - from;
            answer.x += solid_angle(corner, right, right + up) + solid_angle(corner, right + up, up);
        }
    ";
    let (picks, _) = TRIANGLE.split_once("float size").expect("the macro");
    let shown = evaluate(&format!("{picks}{body}"), "32x32");
    let most = shown.pixels.iter().map(|p| (f64::from(p[0]) - 4.0 * PI).abs()).fold(0.0, f64::max);
    println!("twelve triangles around a point: off by {:.1} u of 4 pi", most / U / (4.0 * PI));
    assert!(most < 32.0 * U * 4.0 * PI, "{most}");
}

#[test]
fn directions_to_a_triangle_are_uniform_in_its_solid_angle() {
    let body = "
        vec2 u = vec2(PICK(11) + 1.03125, PICK(12) + 1.03125) / 2.0625;
        float whole = solid_angle(a, across, along);
        answer = vec4(direction_to(a, across, along, whole, u), whole);
    ";
    let shown = evaluate(&format!("{TRIANGLE}{body}"), "96x96");
    let (mut worst, mut tried) = ([0f64; 2], 0);
    for (i, pixel) in shown.pixels.iter().enumerate() {
        let triangle = Triangle::of(i, 96);
        let condition = triangle.condition();
        // As in the shader: others are sampled by area.
        if condition.is_nan() || condition >= 1e2 || triangle.is_far() {
            continue;
        }
        tried += 1;
        let pick = |s: u32| (pick((i % 96) as u32, (i / 96) as u32, s) + 1.03125) / 2.0625;
        let [a, b, c] = triangle.corners.map(DVec3::normalize);
        let p = vector(pixel).normalize();
        // The reverse mapping: the intersection of the arc from b through p with that from a to c.
        let mut e = b.cross(p).cross(a.cross(c)).normalize();
        if e.dot(a + c) < 0.0 {
            e = -e;
        }
        let part = Triangle { corners: [a, b, e], edges: [b - a, e - a] };
        let found =
            [part.angle() / triangle.angle(), (p - b).length_squared() / (e - b).length_squared()];
        // An error of a direction moves a point by at least this fraction of the triangle's width.
        let width = triangle.angle().min(1.0);
        for (k, salt) in [11, 12].into_iter().enumerate() {
            worst[k] = worst[k].max((found[k] - pick(salt)).abs() * width / U / condition);
        }
    }
    println!("{tried} directions: numbers come back but for {worst:.1?} u over the solid angle");
    assert!(tried > 3000, "{tried}");
    assert!(worst[0] < 16.0 && worst[1] < 16.0, "{worst:?}");
}

/// A triangle of size 1 with an edge 2^-k away, seen so flat that its solid angle is below 2^-12; and one of
/// size 2^-7 at distance 1, at a slant.
/// at distance 1, at a slant.
#[test]
fn no_sample_of_a_triangle_stands_for_more_than_another() {
    let body = "
        vec2 u = vec2(PICK(11) + 1.03125, PICK(12) + 1.03125) / 2.0625;
        float away = ldexp(1.0, -int(at.y % 8u)), height = away / 16384.0;
        vec3 corner = vec3(away, -0.5, -height), across = vec3(0.0, 1.0, 0.0), along = vec3(1.0, 0.25, 0.0);
        if (at.x % 2u == 0u) {
            corner = vec3(0.75, 0.0, -0.75), across /= 128.0, along /= 128.0;
        }
        Emitter emitter = Emitter(corner, 0.0, across, 0.0, along, 0u, 0.0, 0.0);
        Aim aim = aim_at(emitter, vec3(0.0), u);
        answer = vec4(aim.angle, angle_of(emitter, vec3(0.0), aim.direction, length(aim.to)), aim.to.xy);
    ";
    let (picks, _) = TRIANGLE.split_once("float size").expect("the macro");
    let shown = evaluate(&format!("{picks}{body}"), "64x64");
    let mut most = [0f64; 2];
    for (i, pixel) in shown.pixels.iter().enumerate() {
        let (x, y) = (i % 64, i / 64);
        let away = 0.5f64.powi((y % 8) as i32);
        let (mut corner, mut edges) =
            (DVec3::new(away, -0.5, -away / 16_384.0), [DVec3::Y, DVec3::new(1.0, 0.25, 0.0)]);
        if x % 2 == 0 {
            (corner, edges) = (DVec3::new(0.75, 0.0, -0.75), edges.map(|edge| edge / 128.0));
        }
        let exact =
            Triangle { corners: [corner, corner + edges[0], corner + edges[1]], edges }.angle();
        assert!(exact < 1.0 / 4096.0, "{exact}");
        let angle = f64::from(pixel[0]);
        most[x % 2] = most[x % 2].max((angle / exact - 1.0).abs());
        // Finding it at random, the other way, has the same density.
        assert!((f64::from(pixel[1]) / angle - 1.0).abs() < 1e-4, "{x} {y}: {pixel:?}");
        if x % 2 == 1 {
            let (to, beyond) = (f64::from(pixel[2]) - away, 1.0 / 256.0);
            assert!(to > -beyond && to < 1.0 + beyond, "{x} {y}: {pixel:?} is beside the triangle");
        }
    }
    println!("weights differ from the mean by up to {most:?} of it, far away and edge on");
    assert!(most[0] < 0.1 && most[1] < 1e-3, "{most:?}");
}

#[test]
fn points_that_are_aimed_at_lie_above_their_triangle() {
    let body = "
        Emitter emitter = Emitter(a, 0.0, across, 0.0, along, 0u, 1e-4, 0.0);
        Aim aim = aim_at(emitter, vec3(0.0), vec2(0.3, 0.6));
        answer = vec4(aim.to, aim.angle);
    ";
    let shown = evaluate(&format!("{TRIANGLE}{body}"), "96x96");
    let mut tried = 0;
    for (i, pixel) in shown.pixels.iter().enumerate() {
        let triangle = Triangle::of(i, 96);
        let condition = triangle.condition();
        if condition.is_nan() || condition >= 1e2 {
            continue;
        }
        tried += 1;
        let (a, [across, along]) = (triangle.corners[0], triangle.edges);
        let normal = across.cross(along).normalize();
        let normal = if normal.dot(a) > 0.0 { -normal } else { normal };
        let height = (vector(pixel) - a).dot(normal);
        assert!((height - 1e-4).abs() < 2e-6, "{i}: {height}");
        // Its foot is inside: weights from 0 to 1.
        let foot = vector(pixel) - height * normal - a;
        let area = across.cross(along).dot(normal);
        let weights = [foot.cross(along).dot(normal) / area, across.cross(foot).dot(normal) / area];
        assert!(weights[0] > -1e-3 && weights[1] > -1e-3 && weights[0] + weights[1] < 1.001, "{i}");
    }
    assert!(tried > 4000, "{tried}");
}
