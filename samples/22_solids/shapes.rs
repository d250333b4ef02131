//! The solids of this chapter.

use glam::{Vec2, Vec3, Vec3Swizzles};

use super::pieces;
use super::solid::{Bound, Solid, ball, block, plane};

/// The names of the solids, in the order of their numbers.
pub const SHAPES: [&str; 26] = [
    "tetrahedron",
    "cube",
    "octahedron",
    "dodecahedron",
    "icosahedron",
    "crystal",
    "lens",
    "die",
    "bitten cube",
    "cube and no ball",
    "tower",
    "bishop",
    "king",
    "shell",
    "wedge",
    "room",
    "halves",
    "overlap of halves",
    "slotted cube",
    "overcut cube",
    "grazed cube",
    "tilted cube",
    "all but a cube",
    "thirds",
    "half-space",
    "sunk room",
];

/// The solid of a number; the crystal has so many planes.
pub fn shape(number: u32, planes: u32) -> Solid {
    let ivory = |bounds| Solid::Convex(bounds, "ivory");
    let unit_block = || block(Vec3::NEG_ONE, Vec3::ONE);
    match SHAPES[number as usize] {
        "tetrahedron" => Solid::Convex(tetrahedron(0.5), "red"),
        "cube" => ivory(unit_block()),
        "octahedron" => Solid::Convex(octahedron(0.85), "blue"),
        "dodecahedron" => Solid::Convex(dodecahedron(1.0), "gold"),
        "icosahedron" => Solid::Convex(icosahedron(1.0), "silver"),
        "crystal" => Solid::Convex(crystal(planes), "blue"),
        "lens" => pieces::lens("gold"),
        "die" => pieces::die(),
        "bitten cube" => ivory(unit_block()).difference(bite()),
        "cube and no ball" => ivory(unit_block()).intersection(bite().inverse()),
        "tower" => pieces::tower("ivory"),
        "bishop" => pieces::bishop("blue"),
        "king" => pieces::king("ivory"),
        "shell" => {
            let [outer, inner] = [1.0, 0.8].map(|radius| vec![ball(Vec3::ZERO, radius)]);
            Solid::Convex(outer, "blue").difference(Solid::Convex(inner, "red"))
        }
        "wedge" => {
            ivory(vec![plane(Vec3::new(1.0, 2.0, 0.0), 0.3), plane(Vec3::new(-2.0, 3.0, 0.5), 0.3)])
        }
        "room" => ivory(dodecahedron(1.0)),
        "halves" => half(1.0, "ivory").union(half(-1.0, "ivory")),
        "overlap of halves" => half(1.0, "ivory").intersection(half(-1.0, "ivory")),
        "slotted cube" => tilted_cube().difference(slot(1.0)),
        "overcut cube" => tilted_cube().difference(slot(1.5)),
        "grazed cube" => grazed(),
        "all but a cube" => ivory(unit_block()).inverse(),
        "half-space" => ivory(vec![plane(Vec3::Y, -0.6)]),
        "sunk room" => ivory(dodecahedron(1.0)).union(ivory(vec![plane(Vec3::Y, -0.6)])),
        "thirds" => third(0, 1).union(third(1, 2)).union(third(2, 0)),
        _ => tilted_cube(),
    }
}

/// The number of a name.
pub fn number(name: &str) -> u32 {
    SHAPES.iter().position(|shape| *shape == name).expect("a solid of this chapter") as u32
}

/// Four half-spaces, towards every second corner of a cube.
fn tetrahedron(distance: f32) -> Vec<Bound> {
    let normals = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    normals.map(|normal| plane(Vec3::from_array(normal), distance)).into()
}

/// Eight half-spaces, one for each way to choose three signs.
fn octahedron(distance: f32) -> Vec<Bound> {
    let signs = (0..8)
        .map(|i| Vec3::from_array([1, 2, 4].map(|bit| if i & bit == 0 { 1.0 } else { -1.0 })));
    signs.map(|normal| plane(normal, distance)).collect()
}

/// Twelve half-spaces, towards the corners of an icosahedron. No normal has unit length.
fn dodecahedron(distance: f32) -> Vec<Bound> {
    let golden = 0.5 + 1.25f32.sqrt();
    let faces = [[1.0, golden], [1.0, -golden], [-1.0, golden], [-1.0, -golden]];
    let normals = faces.into_iter().map(|[y, z]| Vec3::new(0.0, y, z));
    normals.flat_map(|n| [n, n.yzx(), n.zxy()]).map(|n| plane(n, distance)).collect()
}

/// Twenty half-spaces, towards the corners of a dodecahedron: eight of them are a cube's.
fn icosahedron(distance: f32) -> Vec<Bound> {
    let golden = 0.5 + 1.25f32.sqrt();
    let [y, z] = [golden - 1.0, golden];
    let three = [[y, z], [y, -z], [-y, z], [-y, -z]].map(|[y, z]| Vec3::new(0.0, y, z));
    let normals = three.into_iter().flat_map(|n| [n, n.yzx(), n.zxy()]);
    octahedron(distance).into_iter().chain(normals.map(|n| plane(n, distance))).collect()
}

/// Any list of planes is a solid: normals all around along a spiral, each of another length.
fn crystal(planes: u32) -> Vec<Bound> {
    let normals = (0..planes).map(|i| {
        let y = 1.0 - (2 * i + 1) as f32 / planes as f32;
        let angle = 2.399_963_2 * i as f32;
        let around = Vec2::from_angle(angle) * (1.0 - y * y).sqrt();
        (Vec3::new(around.x, y, around.y) * 1.37f32.powi(i as i32 - 9), 0.9 + 0.04 * (i % 4) as f32)
    });
    normals.map(|(normal, distance)| plane(normal, distance)).collect()
}

/// Three directions at right angles, each of length 3 and along no axis of the world.
const TILTED: [Vec3; 3] =
    [Vec3::new(1.0, 2.0, 2.0), Vec3::new(2.0, 1.0, -2.0), Vec3::new(2.0, -2.0, 1.0)];

/// A tilted box: how far it goes both ways in each direction. Its normals are stretched.
fn tilted(reach: [[f32; 2]; 3], stretch: f32) -> Vec<Bound> {
    let walls = TILTED.into_iter().zip(reach);
    let walls =
        walls.flat_map(|(n, [low, high])| [plane(n * stretch, high), plane(n * -stretch, low)]);
    walls.collect()
}

/// A slot through the tilted cube that is open above and to both sides, as far as the cube goes or,
/// with a larger `end`, beyond that.
fn slot(end: f32) -> Solid {
    Solid::Convex(tilted([[0.3, end], [0.4, 0.4], [end, end]], 3.0), "red")
}

fn tilted_cube() -> Solid {
    Solid::Convex(tilted([[1.0; 2]; 3], 1.0), "ivory")
}

/// The part taken from the cube.
fn bite() -> Solid {
    Solid::Convex(vec![ball(Vec3::new(0.75, 0.7, 0.8), 0.95)], "red")
}

/// The part of the tilted cube on one side of a plane.
fn half(side: f32, material: &'static str) -> Solid {
    let stretch = if side > 0.0 { 1.0 } else { 0.75 };
    let mut bounds = tilted([[1.0; 2]; 3], stretch);
    bounds.push(plane(Vec3::new(3.0, 1.0, -2.0) * side * stretch, 0.25 * side));
    Solid::Convex(bounds, material)
}

/// The part of a cube between two of three planes that share the vertical line through its middle.
fn third(from: usize, to: usize) -> Solid {
    let normals = [Vec3::new(1.0, 0.0, 0.3), Vec3::new(-0.4, 0.0, 0.9), Vec3::new(-0.6, 0.0, -1.2)];
    let mut bounds = block(Vec3::NEG_ONE, Vec3::ONE);
    bounds.extend([plane(normals[from], 0.0), plane(-normals[to], 0.0)]);
    Solid::Convex(bounds, "ivory")
}

/// The tilted cube without a box that only touches it.
fn grazed() -> Solid {
    let above = Solid::Convex(tilted([[-1.0, 2.0], [0.5; 2], [0.5; 2]], 5.0), "red");
    let beside = Solid::Convex(tilted([[1.0; 2], [1.0; 2], [2.0, -1.0]], 0.75), "red");
    tilted_cube().difference(above).difference(beside)
}
