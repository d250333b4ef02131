//! Random numbers that belong to a thing: the same in every run.

/// Four numbers in [0, 1) for a thing and a purpose, both by number: the hash of
/// `shaders/common/random.glsl`.
pub fn unit(thing: u32, purpose: u32) -> [f64; 4] {
    let mut v = [thing, purpose, 0, 0]
        .map(|word: u32| word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    // One component after the other: each takes what the ones before it have become.
    let stir = |v: &mut [u32; 4]| {
        for (i, (a, b)) in [(1, 3), (2, 0), (0, 1), (1, 2)].into_iter().enumerate() {
            v[i] = v[i].wrapping_add(v[a].wrapping_mul(v[b]));
        }
    };
    stir(&mut v);
    v = v.map(|word| word ^ word >> 16);
    stir(&mut v);
    v.map(|word| f64::from(word >> 8) / f64::from(1 << 24))
}
