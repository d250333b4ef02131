//! Shadow rays to lights of all kinds, and from surfaces whose normals are smoother than their triangles.

use glam::DVec2;

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BLUE, BROWN, FAINT, GREEN, LINE, Point, RED, SEA, SOFT, Sheet, YOURS};

fn point(p: DVec2) -> Point {
    p.to_array()
}

/// The floor of a panel, starting at `x`.
fn floor(s: &mut Sheet, x: f64, y: f64, width: f64) {
    s.polygon(&[[x, y], [x + width, y], [x + width, y + 14.0], [x, y + 14.0]], GREEN, LINE);
}

/// Direction, strength and ray length for the sun and for a lamp.
pub fn two_lights() -> String {
    let mut s = Sheet::new([840, 350], "A light gives a direction, a strength and the ray's end");
    let ground = 250.0;
    floor(&mut s, 24.0, ground, 370.0);
    for x in [70.0, 160.0, 250.0] {
        s.arrow(&[[x, ground], [x + 118.0, ground - 150.0]]);
        s.dot([x, ground], 4.0, BROWN);
    }
    s.note([300.0, 88.0], Start, "no end");
    s.title([24.0, 292.0], Start, "The sun: parallel, as strong everywhere.");
    s.note([24.0, 311.0], Start, "direction: the same; strength: the radiance;");
    s.note([24.0, 328.0], Start, "the ray ends at 1e30");

    floor(&mut s, 440.0, ground, 376.0);
    let lamp = DVec2::new(600.0, 120.0);
    // Spheres of light: at twice the radius, the same light covers four times the area.
    for radius in [65.0, 130.0] {
        let at = |i: i32| {
            let angle = 0.32 + (std::f64::consts::PI - 0.64) * f64::from(i) / 40.0;
            let p = lamp + radius * DVec2::from_angle(angle);
            point(p)
        };
        s.line(&(0..=40).map(at).collect::<Vec<_>>(), FAINT, 1.4);
    }
    for x in [490.0, 600.0, 760.0] {
        let from = DVec2::new(x, ground);
        let end = lamp + 9.0 * (from - lamp).normalize();
        s.arrow(&[point(from), point(end)]);
        s.dot([x, ground], 4.0, BROWN);
    }
    s.circle(point(lamp), 9.0, YOURS, BROWN);
    s.polygon(&[[620.0, 66.0], [664.0, 66.0], [664.0, 80.0], [620.0, 80.0]], BLUE, LINE);
    s.dashes(&[point(lamp), [641.0, 72.0]], LINE, 1.2);
    s.note([674.0, 70.0], Start, "hides nothing:");
    s.note([674.0, 87.0], Start, "it is behind the lamp");
    s.say([534.0, 180.0], Middle, "r");
    s.say([612.0, 214.0], Start, "I / r²");
    s.title([440.0, 292.0], Start, "A lamp: from one place, weaker farther off.");
    s.note([440.0, 311.0], Start, "direction: the whole way; strength: I/r²;");
    s.note([440.0, 328.0], Start, "the ray ends at t = 1, where the lamp is");
    s.svg()
}

/// The part of a disk visible past an edge from three points.
pub fn penumbra() -> String {
    let mut s = Sheet::new([840, 360], "From the penumbra, a part of the disk is seen");
    let ground = 270.0;
    let (left, right) = (DVec2::new(150.0, 78.0), DVec2::new(290.0, 78.0));
    let edge = DVec2::new(330.0, 180.0);
    // The point of the floor on the line from an end of the disk over the edge.
    let lands = |from: DVec2| {
        let way = edge - from;
        from + way * ((ground - from.y) / way.y)
    };
    let (umbra, lit) = (lands(right), lands(left));
    floor(&mut s, 60.0, ground, 720.0);
    s.polygon(&[point(edge), [620.0, 180.0], [620.0, 194.0], [edge.x + 40.0, 194.0]], BLUE, LINE);
    s.polygon(&[point(edge), point(umbra), point(lit)], FAINT, "none");
    s.line(&[point(left), point(lit)], SOFT, 1.2);
    s.line(&[point(right), point(umbra)], SOFT, 1.2);
    s.line(&[point(left), point(right)], BROWN, 6.0);
    s.note([220.0, 64.0], Middle, "the disk that shines");
    s.note([500.0, 172.0], Middle, "what stands in the way");
    // Rays from one point in the middle of the penumbra: to the visible half, and to the hidden one.
    let from = 0.5 * (umbra + lit);
    for i in 0..8 {
        let to = left.lerp(right, (f64::from(i) + 0.5) / 8.0);
        let way = to - from;
        let above = from + way * ((edge.y - from.y) / way.y);
        if above.x < edge.x {
            s.line(&[point(from), point(to)], SEA, 1.4);
        } else {
            s.dashes(&[point(from), point(above)], RED, 1.2);
        }
    }
    s.dot(point(from), 5.0, BROWN);
    let y = ground + 34.0;
    s.say([160.0, y], Middle, "lit: 1");
    s.say([0.5 * (umbra.x + lit.x), y], Middle, "penumbra: 1/2 here");
    s.say([680.0, y], Middle, "shadow: 0");
    s.note(
        [24.0, 344.0],
        Start,
        "Rays to points of the disk (blue) count what is seen; the others (red) are stopped.",
    );
    s.svg()
}

/// A round surface, its triangles, and the start of a shadow ray for each.
pub fn lift() -> String {
    let mut s = Sheet::new([840, 350], "Two normals: one to leave by, one to shade by");
    let (middle, radius) = (DVec2::new(224.0, 470.0), 290.0);
    let on = |degrees: f64| middle + radius * DVec2::from_angle(degrees.to_radians());
    let corners: Vec<DVec2> = [-122.0, -98.0, -74.0, -50.0].map(on).into();
    let arc: Vec<Point> = (-122..=-50).map(|i| point(on(f64::from(i)))).collect();
    s.line(&arc, SOFT, 1.2);
    s.line(&corners.iter().copied().map(point).collect::<Vec<_>>(), BROWN, 2.6);
    for corner in &corners {
        let normal = (*corner - middle).normalize();
        s.arrow(&[point(*corner), point(*corner + 52.0 * normal)]);
        s.dot(point(*corner), 3.0, BROWN);
    }
    s.title([24.0, 66.0], Start, "The normals at the corners");
    s.note([24.0, 84.0], Start, "are those of the round surface (grey) that");
    s.note([24.0, 101.0], Start, "flat triangles (brown) stand for.");

    // One triangle from close by, with the planes through its corners.
    let (a, b) = (DVec2::new(500.0, 262.0), DVec2::new(790.0, 262.0));
    let [na, nb] = [DVec2::new(-0.34, -0.94), DVec2::new(0.34, -0.94)].map(DVec2::normalize);
    s.line(&[point(a), point(b)], BROWN, 3.0);
    for (corner, normal) in [(a, na), (b, nb)] {
        let along = normal.perp() * if normal.x < 0.0 { 1.0 } else { -1.0 };
        s.dashes(&[point(corner), point(corner + 185.0 * along)], SOFT, 1.2);
        s.arrow(&[point(corner), point(corner + 56.0 * normal)]);
    }
    let w = 0.36;
    let p = a.lerp(b, w);
    let onto = |corner: DVec2, normal: DVec2| p - (p - corner).dot(normal) * normal;
    let [qa, qb] = [onto(a, na), onto(b, nb)];
    let lifted = qa.lerp(qb, w);
    for q in [qa, qb] {
        s.line(&[point(p), point(q)], FAINT, 1.2);
        s.dot(point(q), 3.0, SEA);
    }
    s.line(&[point(qa), point(qb)], SEA, 1.2);
    s.dot(point(p), 4.5, RED);
    s.dot(point(lifted), 5.0, SEA);
    s.arrow(&[point(lifted), point(lifted + DVec2::new(160.0, 22.0))]);
    s.note([p.x, p.y + 22.0], Middle, "the hit, on the triangle");
    s.note([690.0, 184.0], Start, "to a light that is low");
    s.title([500.0, 66.0], Start, "The start is lifted");
    s.note([500.0, 84.0], Start, "to the mean of its places on the corners' planes.");
    s.note([500.0, 306.0], Start, "From the hit itself, the light is below");
    s.note([500.0, 323.0], Start, "the triangle, which hides it.");
    s.svg()
}
