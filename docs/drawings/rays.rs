//! Rays and triangles.

use glam::{DVec2, DVec3};

use crate::sheet::Anchor::{End, Middle, Start};
use crate::sheet::{BROWN, FAINT, GREEN, LINE, Point, RED, SEA, Sheet, WHITE, YOURS};

fn cross(a: DVec2, b: DVec2) -> f64 {
    a.x * b.y - a.y * b.x
}

fn point(p: DVec2) -> Point {
    p.to_array()
}

/// The barycentric weights of `p`.
fn weights(p: DVec2, [a, b, c]: [DVec2; 3]) -> [f64; 3] {
    let all = cross(b - a, c - a);
    [cross(b - p, c - p) / all, cross(c - p, a - p) / all, cross(a - p, b - p) / all]
}

/// The first intersection of a ray with a triangle's outline, as t.
fn meets(origin: DVec2, direction: DVec2, corners: [DVec2; 3]) -> Option<f64> {
    let edge = |k: usize| {
        let (from, along) = (corners[k], corners[(k + 1) % 3] - corners[k]);
        let both = cross(direction, along);
        let (t, s) = (cross(from - origin, along) / both, cross(from - origin, direction) / both);
        (t > 0.0 && (0.0..=1.0).contains(&s)).then_some(t)
    };
    (0..3).filter_map(edge).reduce(f64::min)
}

/// A triangle and the pixels it covers; a pixel and the triangle its ray meets.
pub fn from_raster() -> String {
    let mut s = Sheet::new([840, 330], "Two questions");
    let (left, top, side) = (40.0, 60.0, 22.0);
    let corners = [DVec2::new(58.0, 76.0), DVec2::new(322.0, 126.0), DVec2::new(136.0, 246.0)];
    for row in 0..9 {
        for column in 0..14 {
            let corner = DVec2::new(left + side * f64::from(column), top + side * f64::from(row));
            let middle = corner + 0.5 * side;
            let covered = weights(middle, corners).iter().all(|weight| *weight >= 0.0);
            let (right, down) = (DVec2::new(side, 0.0), DVec2::new(0.0, side));
            let square = [corner, corner + right, corner + right + down, corner + down].map(point);
            s.polygon(&square, if covered { YOURS } else { WHITE }, FAINT);
            s.dot(point(middle), 1.4, LINE);
        }
    }
    s.polygon(&corners.map(point), "none", BROWN);
    s.title([left, 286.0], Start, "Which pixels does this triangle cover?");
    s.note([left, 306.0], Start, "A rasteriser asks for each triangle.");

    let eye = DVec2::new(452.0, 160.0);
    let film = 515.0;
    for row in 0..9 {
        let y = top + side * f64::from(row);
        let fill = if row == 3 { YOURS } else { WHITE };
        s.polygon(
            &[[film - 5.0, y], [film + 5.0, y], [film + 5.0, y + side], [film - 5.0, y + side]],
            fill,
            LINE,
        );
    }
    let direction = DVec2::new(film, top + 3.5 * side) - eye;
    let at = |x: f64, y: f64| DVec2::new(440.0 + x, y);
    let triangles = [
        [at(170.0, 70.0), at(230.0, 200.0), at(150.0, 190.0)],
        [at(250.0, 60.0), at(300.0, 150.0), at(240.0, 180.0)],
        [at(330.0, 66.0), at(370.0, 190.0), at(300.0, 210.0)],
    ];
    let hits = triangles.map(|corners| meets(eye, direction, corners).unwrap_or(f64::INFINITY));
    let nearest = hits.into_iter().fold(f64::INFINITY, f64::min);
    for (corners, hit) in triangles.iter().zip(hits) {
        s.polygon(&corners.map(point), if hit == nearest { YOURS } else { WHITE }, BROWN);
    }
    let hit = eye + nearest * direction;
    s.dashes(&[point(hit), point(eye + 5.8 * direction)], LINE, 1.2);
    s.arrow(&[point(eye), point(hit)]);
    s.dot(point(eye), 5.0, LINE);
    s.dot(point(hit), 4.0, BROWN);
    s.note([eye.x, eye.y + 22.0], Middle, "eye");
    s.title([440.0, 286.0], Start, "Which triangle does this ray meet first?");
    s.note([440.0, 306.0], Start, "A ray tracer asks for each pixel.");
    s.svg()
}

/// The ray of one pixel of 01, from the eye through the picture plane to the triangle.
pub fn camera_ray() -> String {
    let mut s = Sheet::new([840, 350], "One ray through one pixel");
    // Seen from the side and a little from above: the view goes to the right, along -z.
    let eye = DVec3::new(0.0, 0.0, 3.0);
    let shown =
        |p: DVec3| [70.0 + 150.0 * (3.0 - p.z) + 76.0 * p.x, 196.0 - 122.0 * p.y + 34.0 * p.x];
    // The camera and the triangle are those of the chapter.
    let (half, aspect) = (0.4, 1.6);
    let placed =
        |p: DVec3| DVec3::new(0.8 * p.x + 0.6 * p.z + 0.12, p.y + 0.05, -0.6 * p.x + 0.8 * p.z);
    let corners = [(-1.1, -0.75), (1.1, -0.75), (0.0, 0.9)];
    let [a, b, c] = corners.map(|(x, y)| placed(DVec3::new(x, y, 0.0)));
    s.polygon(&[a, b, c].map(shown), YOURS, BROWN);
    let (columns, rows) = (8, 5);
    let on_picture = |column: f64, row: f64| {
        let (x, y) = (2.0 * column / f64::from(columns) - 1.0, 1.0 - 2.0 * row / f64::from(rows));
        DVec3::new(x * aspect * half, y * half, 2.0)
    };
    let pixel = (4.0, 1.0);
    let direction = (on_picture(pixel.0 + 0.5, pixel.1 + 0.5) - eye).normalize();
    let normal = (b - a).cross(c - a);
    let t = normal.dot(a - eye) / normal.dot(direction);
    let hit = eye + t * direction;
    s.dashes(&[hit, eye + (t + 0.9) * direction].map(shown), LINE, 1.2);
    s.line(&[eye + direction, hit].map(shown), LINE, 1.6);
    for row in 0..rows {
        for column in 0..columns {
            let (x, y) = (f64::from(column), f64::from(row));
            let chosen = (x, y) == pixel;
            let square = [(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0)];
            let square = square.map(|(x, y)| shown(on_picture(x, y)));
            s.polygon(
                &square,
                if chosen { YOURS } else { WHITE },
                if chosen { RED } else { FAINT },
            );
        }
    }
    let frame = [(0.0, 0.0), (8.0, 0.0), (8.0, 5.0), (0.0, 5.0)];
    s.polygon(&frame.map(|(x, y)| shown(on_picture(x, y))), "none", LINE);
    let chosen = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let chosen = chosen.map(|(x, y)| shown(on_picture(pixel.0 + x, pixel.1 + y)));
    s.polygon(&chosen, YOURS, RED);
    s.arrow(&[eye, eye + direction].map(shown));
    s.dot(shown(eye), 5.0, LINE);
    s.dot(shown(hit), 5.0, BROWN);
    let at = shown(eye);
    s.strong([at[0], at[1] - 30.0], Middle, "eye");
    s.note([at[0], at[1] - 13.0], Middle, "o = (0, 0, 3)");
    let middle = shown(eye + 0.5 * direction);
    s.strong([middle[0], middle[1] - 12.0], Middle, "d");
    let foot = shown(on_picture(4.0, 5.0));
    s.strong([foot[0], foot[1] + 44.0], Middle, "picture plane");
    s.note([foot[0], foot[1] + 61.0], Middle, "at distance 1");
    let top = shown(on_picture(pixel.0 + 0.5, 0.0));
    s.strong([top[0] + 4.0, top[1] - 30.0], Middle, "pixel");
    s.line(
        &[[top[0] + 4.0, top[1] - 24.0], shown(on_picture(pixel.0 + 0.5, pixel.1 + 0.2))],
        RED,
        1.2,
    );
    // The distance, beside the ray.
    let end = shown(hit);
    let below = |[x, y]: Point, down: f64| [x + 0.1 * down, y + down];
    s.line(&[below(at, 16.0), below(end, 16.0)], SEA, 1.6);
    for tip in [at, end] {
        s.line(&[below(tip, 11.0), below(tip, 21.0)], SEA, 1.6);
    }
    let half_way = below(shown(eye + 0.6 * t * direction), 34.0);
    s.strong(half_way, Middle, "t");
    s.strong([end[0] + 70.0, end[1] - 64.0], Start, "the hit: o + t·d");
    s.note([end[0] + 70.0, end[1] - 47.0], Start, &format!("t = {t:.2} here"));
    s.line(&[[end[0] + 66.0, end[1] - 62.0], [end[0] + 5.0, end[1] - 6.0]], BROWN, 1.2);
    let low = shown(b);
    s.strong([low[0] + 14.0, low[1] + 4.0], Start, "triangle");
    let after = shown(eye + (t + 0.9) * direction);
    s.note([after[0] + 8.0, after[1] + 4.0], Start, "on, to tmax");
    s.svg()
}

/// A point of a triangle and its three weights.
pub fn barycentrics() -> String {
    let mut s = Sheet::new([840, 330], "Barycentric coordinates: three weights that add up to 1");
    let corners = [DVec2::new(70.0, 270.0), DVec2::new(420.0, 250.0), DVec2::new(220.0, 80.0)];
    let mix = |[a, b, c]: [f64; 3]| a * corners[0] + b * corners[1] + c * corners[2];
    let hit = [0.2, 0.3, 0.5];
    let p = mix(hit);
    let [a, b, c] = corners;
    for (part, fill) in [([p, b, c], YOURS), ([p, c, a], WHITE), ([p, a, b], GREEN)] {
        s.polygon(&part.map(point), fill, LINE);
    }
    s.polygon(&corners.map(point), "none", BROWN);
    s.dot(point(p), 5.0, BROWN);
    let names = ["a", "b", "c"];
    let places = [DVec2::new(-14.0, 16.0), DVec2::new(14.0, 16.0), DVec2::new(0.0, -10.0)];
    for k in 0..3 {
        s.title(point(corners[k] + places[k]), Middle, names[k]);
    }
    for (part, weight) in [([p, b, c], hit[0]), ([p, c, a], hit[1]), ([p, a, b], hit[2])] {
        let middle = (part[0] + part[1] + part[2]) / 3.0;
        s.say([middle.x, middle.y + 4.0], Middle, &format!("{weight:.1}"));
    }
    let lines = [
        ("The weight of a corner is the part of the", ""),
        ("triangle’s area that lies opposite it.", ""),
        ("", ""),
        ("1 − u − v = 0.2", "weight of a"),
        ("u = 0.3", "weight of b: the first hit attribute"),
        ("v = 0.5", "weight of c: the second"),
        ("", ""),
        ("p = 0.2 a + 0.3 b + 0.5 c, and normals and texture", ""),
        ("coordinates are mixed alike.", ""),
    ];
    for (row, (text, meaning)) in lines.into_iter().enumerate() {
        let y = 84.0 + 22.0 * row as f64;
        s.say([450.0, y], Start, text);
        s.note([570.0, y], Start, meaning);
    }
    s.svg()
}

/// Three starting points of a shadow ray.
pub fn acne_and_leak() -> String {
    let mut s = Sheet::new([840, 330], "Where a shadow ray may start");
    let panels = [
        (
            24.0,
            "too low: acne",
            "The rounded point lies below",
            "the surface, which hides the light.",
            22.0,
            RED,
        ),
        (296.0, "just above", "No rounding puts the start", "below the surface.", -10.0, BROWN),
        (
            568.0,
            "too high: a leak",
            "The ray starts above what",
            "should have stopped it.",
            -74.0,
            RED,
        ),
    ];
    for (x, title, first, second, lift, color) in panels {
        let floor = 220.0;
        s.title([x, 66.0], Start, title);
        s.polygon(
            &[[x, floor], [x + 248.0, floor], [x + 248.0, floor + 34.0], [x, floor + 34.0]],
            GREEN,
            LINE,
        );
        // A thin piece close by.
        s.polygon(
            &[
                [x + 118.0, floor - 52.0],
                [x + 128.0, floor - 52.0],
                [x + 128.0, floor],
                [x + 118.0, floor],
            ],
            YOURS,
            LINE,
        );
        let hit = DVec2::new(x + 80.0, floor);
        let start = hit + DVec2::new(0.0, lift);
        let to_light = DVec2::new(0.62, -0.5);
        let end = match title {
            "too low: acne" => start + 44.0 * to_light,
            "just above" => start + 61.0 * to_light,
            _ => start + 150.0 * to_light,
        };
        s.arrow(&[point(start), point(end)]);
        s.dot(point(hit), 3.0, LINE);
        s.dot(point(start), 4.5, color);
        s.note([x, 278.0], Start, first);
        s.note([x, 296.0], Start, second);
    }
    s.note([816.0, 318.0], End, "Heights are exaggerated.");
    s.svg()
}

/// The footprint of a pixel on a floor, near and far.
pub fn footprint() -> String {
    let mut s = Sheet::new(
        [840, 300],
        "The footprint of a pixel grows with the distance, and with the slant",
    );
    let eye = DVec2::new(50.0, 70.0);
    let floor = 230.0;
    s.polygon(
        &[[24.0, floor], [816.0, floor], [816.0, floor + 10.0], [24.0, floor + 10.0]],
        WHITE,
        LINE,
    );
    // Squares of a checker board.
    for square in 0..17 {
        let x = 24.0 + 48.0 * f64::from(square);
        let right = (x + 24.0).min(816.0);
        s.polygon(
            &[[x, floor], [right, floor], [right, floor + 10.0], [x, floor + 10.0]],
            LINE,
            LINE,
        );
    }
    // Two pixels of the same size.
    let half = 0.014_f64;
    for (slope, name) in [(0.95_f64, "near: less than a square"), (0.243, "far: several squares")] {
        let edge = |turn: f64| {
            let angle = slope.atan() + turn;
            eye + DVec2::new(angle.cos(), angle.sin()) * ((floor - eye.y) / angle.sin())
        };
        let (far, near) = (edge(-half), edge(half));
        s.polygon(&[point(eye), point(near), point(far)], YOURS, BROWN);
        s.line(&[[near.x, floor + 18.0], [far.x, floor + 18.0]], BROWN, 3.0);
        s.note([0.5 * (near.x + far.x), floor + 38.0], Middle, name);
    }
    s.dot(point(eye), 5.0, LINE);
    s.note([eye.x, eye.y - 12.0], Middle, "eye");
    s.svg()
}

/// The plane through the eye and a triangle's edge, and a pixel's distance from it in the picture.
pub fn edge_plane() -> String {
    let mut s = Sheet::new([840, 400], "The plane through the eye and an edge");
    // Seen from the side: the view goes to the right.
    let shown = |p: DVec3| [64.0 + 236.0 * p.z - 70.0 * p.x, 214.0 - 140.0 * p.y + 60.0 * p.x];
    let eye = DVec3::ZERO;
    let [b, c] = [DVec3::new(-1.0, 0.8, 2.2), DVec3::new(0.7, -0.75, 2.3)];
    let a = DVec3::new(-1.2, -0.5, 2.6);
    let normal = b.cross(c);
    let frame = [(-0.75, 0.5), (-0.75, -0.5), (0.75, -0.5), (0.75, 0.5)];
    s.polygon(&[a, b, c].map(shown), YOURS, BROWN);
    s.polygon(&frame.map(|(x, y)| shown(DVec3::new(x, y, 1.0))), WHITE, LINE);
    s.line(&[b, c].map(shown), RED, 4.0);
    for end in [b, c] {
        s.dashes(&[eye, end].map(shown), LINE, 1.2);
    }
    // In the picture the plane is a line; a pixel's distance from it is n·d over the length of n's part in
    // the picture.
    let [from, to] = [b, c].map(|end| end / end.z);
    s.line(&[from, to].map(shown), RED, 3.0);
    let pixel = DVec3::new(-0.33, -0.16, 1.0);
    let gradient = DVec3::new(normal.x, normal.y, 0.0);
    let foot = pixel - normal.dot(pixel) / gradient.length_squared() * gradient;
    let along = (b - a).cross(c - a);
    let hit = pixel * along.dot(a) / along.dot(pixel);
    s.line(&[pixel, foot].map(shown), SEA, 3.0);
    s.arrow(&[eye, hit].map(shown));
    s.dot(shown(pixel), 5.0, SEA);
    s.dot(shown(hit), 4.0, LINE);
    s.dot(shown(eye), 5.0, LINE);
    s.note([64.0, 240.0], Middle, "eye");
    s.note([300.0, 360.0], Middle, "the picture, at distance 1");
    s.title([704.0, 60.0], Start, "the edge");
    s.note([704.0, 78.0], Start, "It spans a plane");
    s.note([704.0, 95.0], Start, "with the eye: n·d = 0.");
    s.title([24.0, 72.0], Start, "In the picture");
    s.note([24.0, 90.0], Start, "the plane is a line (red).");
    s.note([24.0, 107.0], Start, "The pixel’s distance to it");
    s.note([24.0, 124.0], Start, "(blue) is what is asked.");
    s.svg()
}
