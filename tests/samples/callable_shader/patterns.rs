//! The patterns of `pattern.glsl` on the host: the same operations in the same order.

/// A pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Marble,
    Wood,
    Checker,
}

/// A material's pattern, and the cells of its lattice per unit.
pub fn of(material: &str) -> Option<(Kind, f32)> {
    Some(match material {
        "white" => (Kind::Marble, 4.0),
        "black" => (Kind::Wood, 3.0),
        "board_light" => (Kind::Wood, 1.5),
        "board_dark" => (Kind::Marble, 1.5),
        "frame" => (Kind::Wood, 1.0),
        "fretwork" => (Kind::Checker, 4.0),
        _ => return None,
    })
}

/// The weight of the second colour at a place in cells, moved by `far` cells along x.
pub fn weight(kind: Kind, place: [f32; 3], far: i32) -> f32 {
    match kind {
        Kind::Marble => marble(place, far),
        Kind::Wood => wood(place, far),
        Kind::Checker => checker(place, far),
    }
}

/// The first number of `random.glsl`'s hash of a cell, in [0, 1).
fn lattice(cell: [i32; 3]) -> f32 {
    let mut v = [cell[0] as u32, cell[1] as u32, cell[2] as u32, 0]
        .map(|x| x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    let mix = |v: &mut [u32; 4]| {
        for (to, a, b) in [(0, 1, 3), (1, 2, 0), (2, 0, 1), (3, 1, 2)] {
            v[to] = v[to].wrapping_add(v[a].wrapping_mul(v[b]));
        }
    };
    mix(&mut v);
    v = v.map(|x| x ^ x >> 16);
    mix(&mut v);
    (v[0] >> 8) as f32 * (1.0 / 16_777_216.0)
}

fn between(a: f32, b: f32, t: f32) -> f32 {
    a + t * (b - a)
}

/// Clamps a place to the region whose cells have numbers.
fn within(place: [f32; 3]) -> [f32; 3] {
    place.map(|x| x.clamp(-1e9, 1e9))
}

fn noise(place: [f32; 3], far: i32) -> f32 {
    let place = within(place);
    let corner = place.map(f32::floor);
    let t = [0, 1, 2].map(|k| place[k] - corner[k]).map(|t| t * t * (3.0 - 2.0 * t));
    let cell = corner.map(|x| x as i32);
    let edge = |k: i32| {
        let at = [cell[0] + far, cell[1] + (k & 1), cell[2] + (k >> 1)];
        between(lattice(at), lattice([at[0] + 1, at[1], at[2]]), t[0])
    };
    between(between(edge(0), edge(1), t[1]), between(edge(2), edge(3), t[1]), t[2])
}

fn turbulence(mut place: [f32; 3], mut far: i32) -> f32 {
    let (mut sum, mut strength) = (0.0, 0.5);
    for _ in 0..4 {
        sum += strength * noise(place, far);
        place = place.map(|x| 2.0 * x);
        far *= 2;
        strength *= 0.5;
    }
    sum
}

fn ridge(x: f32) -> f32 {
    (2.0 * (x - x.floor()) - 1.0).abs()
}

fn marble(place: [f32; 3], far: i32) -> f32 {
    let vein = ridge(place[0] + 0.5 * place[1] + 2.5 * turbulence(place, far));
    vein * vein * vein
}

fn wood([x, y, z]: [f32; 3], far: i32) -> f32 {
    let layer = ridge(5.0 * noise([x, 0.125 * y, z], far));
    let fibre = noise([16.0 * x, y, 16.0 * z], 16 * far);
    0.75 * layer + 0.25 * fibre
}

fn checker(place: [f32; 3], far: i32) -> f32 {
    let cell = within(place).map(|x| x.floor() as i32);
    ((cell[0] + far + cell[1] + cell[2]) & 1) as f32
}
