//! Seeded random numbers and rays: the same on every machine.

#[cfg(test)]
use glam::DMat3;
use glam::DVec3;

use super::ray::Ray;

/// SplitMix64 (Steele, Lea and Flood, *Fast Splittable Pseudorandom Number Generators*, 2014).
pub struct Random(pub u64);

impl Random {
    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number between two others, evenly spread.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 * 2f64.powi(-53)
    }

    /// A magnitude spread evenly over its exponents.
    pub fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// A point between -1 and 1 along each axis.
    pub fn in_cube(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A direction.
    pub fn unit(&mut self) -> DVec3 {
        loop {
            let v = self.in_cube();
            if v.length_squared() > 0.01 && v.length_squared() <= 1.0 {
                return v.normalize();
            }
        }
    }
}

/// Rounds to f32, as whatever reaches the GPU is.
pub fn f32s(v: DVec3) -> DVec3 {
    v.as_vec3().as_dvec3()
}

/// A ray of f32 numbers from `origin` towards `target`; t is about 1 at the target.
pub fn towards(origin: DVec3, target: DVec3) -> Ray {
    let origin = f32s(origin);
    Ray { origin, direction: f32s(target - origin), tmin: 0.0, tmax: 1e30 }
}

#[cfg(test)]
/// A shift and nothing else, or with it a random rotation, scale by up to 25 apart per axis,
/// mirroring and shear.
pub fn instance(random: &mut Random, turned: bool) -> [[f32; 4]; 3] {
    let shift = random.in_cube() * random.scale(1e-2, 1e3);
    let mut linear = DMat3::IDENTITY;
    if turned {
        let size = random.scale(0.03, 30.0);
        let stretch = DVec3::new(1.0, random.scale(0.2, 5.0), -random.scale(0.2, 5.0)) * size;
        linear = DMat3::from_axis_angle(random.unit(), random.between(0.0, 6.0))
            * DMat3::from_diagonal(stretch);
        linear.y_axis += linear.x_axis * random.between(-0.5, 0.5);
    }
    let rows = linear.transpose().to_cols_array_2d();
    std::array::from_fn(|i| {
        let [x, y, z] = rows[i].map(|entry| entry as f32);
        [x, y, z, shift[i] as f32]
    })
}

#[cfg(test)]
/// A crumpled sheet of `2·n²` triangles in the unit square, y up to `height`.
pub fn sheet(n: usize, height: f32) -> Vec<[[f32; 3]; 3]> {
    let at = |i: usize, j: usize| {
        let [x, z] = [i, j].map(|k| k as f32 / n as f32 * 2.0 - 1.0);
        [x, height * ((7.0 * x).sin() * (5.0 * z).cos()), z]
    };
    let cells = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let quad = |(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    cells.flat_map(quad).collect()
}
