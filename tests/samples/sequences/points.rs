//! The expected points of 37_sequences, each computed from its definition in the literature.
//!
//! The shader works with integer multiples of 2^-32; this copy works with fractions in f64, and uses integers
//! only where the definition is in terms of bits: the hash, and Owen's scrambling by it.

/// A sequence, as the control names it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sequence {
    Random,
    Halton,
    R2,
    Sobol,
}

/// The rule by which the points of two pixels differ, as the control names it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scrambling {
    None,
    Rotation,
    Owen,
}

/// The purpose of a random number: the place within the pixel, as in `shaders/common/random.glsl`.
const DIMENSION_PIXEL: u32 = 1;

/// The point of a pixel that the ray of frame `i` passes through, in [0, 1)².
pub fn sample_point(
    sequence: Sequence,
    scrambling: Scrambling,
    pixel: [u32; 2],
    seed: u32,
    i: u32,
) -> [f64; 2] {
    let [x, y] = if scrambling == Scrambling::None { [0; 2] } else { pixel };
    let key = hash([x, y, seed, DIMENSION_PIXEL]);
    let point = match sequence {
        Sequence::Random => {
            let [x, y, ..] = hash([key[2], key[3], i, 0]);
            [fraction(x), fraction(y)]
        }
        Sequence::Halton => [mirrored(i, 2), mirrored(i, 3)],
        Sequence::R2 => r2(i),
        Sequence::Sobol => [mirrored(i, 2), sobol_second(i)],
    };
    [0, 1].map(|axis| match scrambling {
        Scrambling::None => point[axis],
        Scrambling::Rotation => (point[axis] + fraction(key[axis])).fract(),
        Scrambling::Owen => fraction(owen((point[axis] * 2f64.powi(32)) as u32, key[axis])),
    })
}

/// The digits of `i` in a base, reflected about the point (van der Corput 1935; Halton 1960).
pub fn mirrored(mut i: u32, base: u32) -> f64 {
    let (mut digits, mut scale) = (0u64, 1u64);
    while i > 0 {
        digits = digits * u64::from(base) + u64::from(i % base);
        scale *= u64::from(base);
        i /= base;
    }
    digits as f64 / scale as f64
}

/// Multiples of the powers of 1/g, the generalised golden ratio of two dimensions (Roberts 2018).
pub fn r2(i: u32) -> [f64; 2] {
    let mut g: f64 = 1.0;
    for _ in 0..100 {
        g = (g + 1.0).cbrt();
    }
    [(f64::from(i) / g).fract(), (f64::from(i) / (g * g)).fract()]
}

/// The second dimension of Sobol': digit j after the point is the parity of the bits k of `i` for which the
/// binomial coefficient of k over j is odd, which is the case if k has all bits of j (Lucas).
pub fn sobol_second(i: u32) -> f64 {
    let digit = |j: u32| (0..32).filter(|&k| i >> k & 1 == 1 && j & !k == 0).count() % 2;
    (0..32).map(|j| digit(j) as f64 * 0.5f64.powi(j as i32 + 1)).sum()
}

/// Hash-based Owen scrambling (Burley 2020).
pub fn owen(x: u32, key: u32) -> u32 {
    let mut x = x.reverse_bits().wrapping_add(key.reverse_bits());
    for factor in [0x6c50_b47c_u32, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6] {
        x ^= x.wrapping_mul(factor);
    }
    x.reverse_bits()
}

/// pcg4d (Jarzynski and Olano 2020), as in `shaders/common/random.glsl`.
pub fn hash(v: [u32; 4]) -> [u32; 4] {
    let mix = |v: [u32; 4]| {
        let [mut x, mut y, mut z, mut w] = v;
        x = x.wrapping_add(y.wrapping_mul(w));
        y = y.wrapping_add(z.wrapping_mul(x));
        z = z.wrapping_add(x.wrapping_mul(y));
        w = w.wrapping_add(y.wrapping_mul(z));
        [x, y, z, w]
    };
    let v = v.map(|x| x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    mix(mix(v).map(|x| x ^ x >> 16))
}

fn fraction(x: u32) -> f64 {
    f64::from(x) * 0.5f64.powi(32)
}
