//! Solids suitable for the board: a die, a lens, and three chess pieces.

use glam::{Vec2, Vec3};

use super::solid::{Bound, Solid, ball, block, plane};

/// The intersection of two balls, standing on its rim.
pub fn lens(material: &'static str) -> Solid {
    let side = |x: f32| Solid::Convex(vec![ball(Vec3::X * x, 1.7)], material);
    side(1.3).intersection(side(-1.3))
}

/// A cube that a ball has rounded, and 21 dents.
pub fn die() -> Solid {
    let mut body = block(Vec3::NEG_ONE, Vec3::ONE);
    body.push(ball(Vec3::ZERO, 1.42));
    // The places on a face: middle, two diagonals, and between the sides.
    let (near, far) = (Vec2::splat(0.48), Vec2::new(0.48, -0.48));
    let side = Vec2::new(0.48, 0.0);
    let faces: [(Vec3, &[Vec2]); 6] = [
        (Vec3::Y, &[near, -near, far, -far, side, -side]),
        (Vec3::NEG_Y, &[Vec2::ZERO]),
        (Vec3::Z, &[near, -near, Vec2::ZERO]),
        (Vec3::NEG_Z, &[near, -near, far, -far]),
        (Vec3::X, &[near, -near, far, -far, Vec2::ZERO]),
        (Vec3::NEG_X, &[far, -far]),
    ];
    let mut solid = Solid::Convex(body, "ivory");
    for (out, dents) in faces {
        let across = Vec3::new(out.y, out.z, out.x).abs();
        let along = out.cross(across);
        for dent in dents {
            let center = out * 1.09 + across * dent.x + along * dent.y;
            solid = solid.difference(Solid::Convex(vec![ball(center, 0.2)], "red"));
        }
    }
    solid
}

/// A column of eight sides, from one height to another.
fn column(radius: f32, low: f32, high: f32, stretch: f32) -> Vec<Bound> {
    let walls = (0..8).map(|i| {
        let n = Vec2::from_angle((i as f32 + 0.5) * std::f32::consts::FRAC_PI_4);
        plane(Vec3::new(n.x, 0.0, n.y) * stretch, radius)
    });
    let ends = [plane(Vec3::Y * stretch, high), plane(Vec3::NEG_Y * stretch, -low)];
    walls.chain(ends).collect()
}

/// A rook of planes alone. What is cut from its head ends just where the head ends: the tops coincide,
/// and each says so with a normal of its own length.
pub fn tower(material: &'static str) -> Solid {
    let part = |bounds| Solid::Convex(bounds, material);
    let cut = |bounds| Solid::Convex(bounds, "red");
    let low = part(column(0.9, -1.4, -1.0, 1.0)).union(part(column(0.62, -1.0, 0.7, 1.0)));
    let head = part(column(0.8, 0.7, 1.4, 1.0)).difference(cut(column(0.52, 1.0, 1.4, 3.0)));
    let notch = |size: Vec3| {
        let mut bounds = block(Vec3::new(-size.x, 1.1, -size.z), Vec3::new(size.x, 2.0, size.z));
        bounds.push(plane(Vec3::Y * 5.0, 1.4));
        cut(bounds)
    };
    let notches = notch(Vec3::new(0.17, 0.0, 1.0)).union(notch(Vec3::new(1.0, 0.0, 0.17)));
    low.union(head.difference(notches))
}

/// A pyramid of eight sides without its top: from a radius at one height to another at another.
fn taper(from: [f32; 2], to: [f32; 2]) -> Vec<Bound> {
    let [[low_radius, low], [high_radius, high]] = [from, to];
    let slope = (low_radius - high_radius) / (high - low);
    let walls = (0..8).map(|i| {
        let n = Vec2::from_angle((i as f32 + 0.5) * std::f32::consts::FRAC_PI_4);
        let normal = Vec3::new(n.x, slope, n.y);
        plane(normal, (low_radius + slope * low) / normal.length())
    });
    walls.chain([plane(Vec3::Y, high), plane(Vec3::NEG_Y, -low)]).collect()
}

/// A slice of a ball between two heights.
fn slice(middle: f32, radius: f32, low: f32, high: f32) -> Vec<Bound> {
    vec![ball(Vec3::Y * middle, radius), plane(Vec3::Y, high), plane(Vec3::NEG_Y, -low)]
}

/// The lower part of bishop and king: a foot, a stem and a collar.
fn stem(material: &'static str, collar: f32) -> Solid {
    let part = |bounds| Solid::Convex(bounds, material);
    part(slice(-1.55, 0.85, -1.4, -1.05))
        .union(part(taper([0.6, -1.05], [0.27, collar])))
        .union(part(slice(collar, 0.46, collar - 0.07, collar + 0.07)))
}

/// Its head is a ball under a pyramid; what is cut from that has no end but the head's.
pub fn bishop(material: &'static str) -> Solid {
    let part = |bounds| Solid::Convex(bounds, material);
    let head = part(vec![ball(Vec3::Y * 0.66, 0.42), plane(Vec3::NEG_Y, -0.35)])
        .union(part(taper([0.355, 0.86], [0.06, 1.25])));
    let across = Vec3::new(2.0, 3.0, 0.0);
    let slot = vec![plane(across, 0.72), plane(-across, -0.62), plane(Vec3::NEG_X, -0.02)];
    let bead = part(vec![ball(Vec3::Y * 1.31, 0.11)]);
    stem(material, 0.35).union(head.difference(Solid::Convex(slot, "gold"))).union(bead)
}

/// His cross is a plate from which four balls have been taken.
pub fn king(material: &'static str) -> Solid {
    let part = |bounds| Solid::Convex(bounds, material);
    let crown = part(taper([0.3, 0.4], [0.52, 1.0])).union(part(slice(0.72, 0.54, 1.0, 1.5)));
    let middle = Vec3::Y * 1.64;
    let half = Vec3::new(0.42, 0.42, 0.1);
    let mut cross = part(block(middle - half, middle + half));
    for (x, y) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let corner = middle + 0.29 * Vec3::new(x, y, 0.0);
        cross = cross.difference(Solid::Convex(vec![ball(corner, 0.225)], "gold"));
    }
    stem(material, 0.4).union(crown).union(cross)
}
