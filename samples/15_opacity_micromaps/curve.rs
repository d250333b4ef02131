//! The order of a triangle's micro-triangles, and how their states are packed: as a device takes them
//! (Vulkan specification, `VK_KHR_opacity_micromap`).

/// The finest level supported by the chapter.
pub const FINEST: u32 = 6;

/// The opacity state of a micro-triangle, by the specification's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// No point of it counts.
    Transparent = 0,
    /// Every point counts.
    Opaque = 1,
    /// The any-hit shader has to decide. Whoever must guess takes it for transparent.
    UnknownTransparent = 2,
    /// Likewise, and a guess takes it for opaque.
    UnknownOpaque = 3,
}

/// A point of a triangle: the weights of its three corners, in units of 2^-level.
pub type Weights = [i32; 3];

/// Number of micro-triangles in a triangle.
pub const fn count(level: u32) -> u32 {
    1 << (2 * level)
}

/// Bytes of a triangle's states, two bits each.
pub const fn bytes(level: u32) -> usize {
    count(level).div_ceil(4) as usize
}

/// The corners of a micro-triangle. Two binary digits of its number choose one of four parts, the next two a
/// part of that.
pub fn corners(index: u32, level: u32) -> [Weights; 3] {
    let side = 1 << level;
    let mut triangle = [[side, 0, 0], [0, side, 0], [0, 0, side]];
    for digit in (0..level).rev() {
        let [a, b, c] = triangle;
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        triangle = match index >> (2 * digit) & 3 {
            0 => [a, ab, ca],
            1 => [ca, bc, ab],
            2 => [ab, b, bc],
            _ => [bc, ca, c],
        };
    }
    triangle
}

/// Written out, as most of the time that states take is spent here: weights are no less than 0.
fn middle(a: Weights, b: Weights) -> Weights {
    [(a[0] + b[0]) >> 1, (a[1] + b[1]) >> 1, (a[2] + b[2]) >> 1]
}

/// Number of micro-triangles in each state, by the specification's numbers.
pub fn tally(states: &[State]) -> [u64; 4] {
    let mut counts = [0; 4];
    states.iter().for_each(|&state| counts[state as usize] += 1);
    counts
}

/// Two bits a state, from the lowest of each byte.
pub fn pack(states: &[State]) -> Vec<u8> {
    let byte = |four: &[State]| four.iter().rev().fold(0, |byte, &state| byte << 2 | state as u8);
    states.chunks(4).map(byte).collect()
}
