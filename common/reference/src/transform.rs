//! An instance's object-to-world matrix, and how far an f32 ray strays on its way through it.

use anyhow::{Result, ensure};
use glam::{DMat3, DVec3};

/// Half a unit in the last place of 1 in f32: the relative error of one rounding, u = 2^-24.
pub const U: f64 = 1.0 / (1 << 24) as f64;

/// An affine map from object to world space, `w = L·v + T`, as an instance of a TLAS holds it.
///
/// # How far the ray strays
/// A GPU tests triangles in object space, with a ray that it makes from the world's by the inverse
/// map W in f32: `o' = W_L·o + W_T`, `d' = W_L·d`. What follows bounds the error of that ray as
/// seen from the world, to first order in u; |·| of a matrix or vector takes every entry's absolute
/// value, and ≤ holds entry by entry.
///
/// 1. *The inverse.* By cofactors: each entry of `L^-1` is a cofactor over the determinant. The
///    cofactor sums products of entries; if P is the same sum with every sign positive, over |det|,
///    then the at most 7 roundings of a term (2 products and 5 sums, in a 4×4 inverse) cost `7u·P`.
///    The determinant costs `5u·π/|det|` of itself (a cofactor's 2, a product, two sums), π being its
///    sum with every sign positive; the division may cost 2.5 ULP ≤ 5u (Vulkan's precision table),
///    the product u. So `|δW_L| ≤ u·G` with `G = 7P + (5π/|det| + 6)·|L^-1|`.
/// 2. *The translation.* `W_T = -W_L·T` costs what W_L costs and 3 roundings:
///    `|δW_T| ≤ u·(G + 3|L^-1|)·|T|`.
/// 3. *The product.* A sum of four terms is rounded at most 4 times:
///    `4u·|L^-1|·(|o| + |T|)` for o', less for d'.
/// 4. *Back in the world*, through L: with `H = |L|·(G + 7|L^-1|)`, the origin strays by
///    `u·H·(|o| + |T|)`, the direction by `u·H·|d|`, so the ray at a point s·d from its origin by
///    `u·H·(|o| + |T| + s|d|)`.
///
/// If L only permutes and mirrors the axes and scales them by powers of two, the usual case being the identity,
/// all this is exact except the one sum `W_L·o + W_T`, and H is the identity.
#[derive(Clone, Debug)]
pub struct Transform {
    /// L: the object's axes in the world.
    pub linear: DMat3,
    /// T: the object's origin in the world.
    pub translation: DVec3,
    /// `L^-1`, in f64.
    pub inverse: DMat3,
    /// det L; negative where the map mirrors.
    pub determinant: f64,
    /// A bound on the factor by which L stretches: `√(‖L‖₁·‖L‖∞)`, at least its spectral norm.
    pub stretch: f64,
    /// H above, without unit.
    pub error_bound: DMat3,
}

fn absolute(m: DMat3) -> DMat3 {
    DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs())
}

/// Sums of products as in the cofactors of `m`, with every sign positive, transposed.
fn permanent_cofactors(m: DMat3) -> DMat3 {
    let [a, b, c] = [m.x_axis, m.y_axis, m.z_axis];
    let cross = |p: DVec3, q: DVec3| {
        DVec3::new(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x)
    };
    DMat3::from_cols(cross(b, c), cross(c, a), cross(a, b)).transpose()
}

/// True if every entry is 0 or ± a power of two, with exactly one nonzero in each row and column.
fn is_scaled_permutation(m: DMat3) -> bool {
    let power_of_two = |x: f64| x.is_normal() && x.to_bits() << 12 == 0;
    let sparse = |v: DVec3| {
        let entries = v.to_array().into_iter().filter(|&x| x != 0.0);
        entries.clone().count() == 1 && entries.into_iter().all(power_of_two)
    };
    let t = m.transpose();
    [m.x_axis, m.y_axis, m.z_axis, t.x_axis, t.y_axis, t.z_axis].into_iter().all(sparse)
}

impl Transform {
    /// The map whose rows are those of a `VkTransformMatrixKHR`, taken without rounding.
    ///
    /// # Errors
    /// If the left 3×3 part is singular or an entry is not finite.
    pub fn from_rows(rows: [[f32; 4]; 3]) -> Result<Self> {
        ensure!(rows.as_flattened().iter().all(|x| x.is_finite()), "{rows:?} is not finite");
        let column = |i: usize| DVec3::from_array(rows.map(|row| f64::from(row[i])));
        let linear = DMat3::from_cols(column(0), column(1), column(2));
        let determinant = linear.determinant();
        ensure!(determinant != 0.0, "the transform {rows:?} cannot be inverted");

        let inverse = linear.inverse();
        let (size, inverse_size) = (absolute(linear), absolute(inverse));
        let error_bound = if is_scaled_permutation(linear) {
            DMat3::IDENTITY
        } else {
            let cofactors = permanent_cofactors(size);
            let permanent = size.x_axis.dot(cofactors.transpose().x_axis) / determinant.abs();
            let inversion =
                cofactors * (7.0 / determinant.abs()) + inverse_size * (5.0 * permanent + 6.0);
            size * (inversion + inverse_size * 7.0)
        };
        let column_sum = (size.transpose() * DVec3::ONE).max_element();
        let row_sum = (size * DVec3::ONE).max_element();
        Ok(Self {
            linear,
            translation: column(3),
            inverse,
            determinant,
            stretch: (column_sum * row_sum).sqrt(),
            error_bound,
        })
    }

    /// The map that changes nothing.
    pub fn identity() -> Self {
        let rows = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        Self::from_rows(rows).expect("the identity can be inverted")
    }

    /// A point of the object in the world, in f64.
    pub fn point(&self, v: DVec3) -> DVec3 {
        self.linear * v + self.translation
    }

    /// Bound on the deviation of a ray from `origin`, along each axis of the world, at distance `reach`.
    ///
    /// `reach` is a vector: the farthest the ray goes along each axis. In world units.
    pub fn stray(&self, origin: DVec3, reach: DVec3) -> DVec3 {
        self.error_bound * (origin.abs() + self.translation.abs() + reach.abs()) * U
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, instance};
    use super::super::simulated::{apply, invert};
    use super::*;

    /// Inverts and applies in f32 as a driver would; `w` is 1 for an origin, 0 for a direction.
    fn through_f32(rows: [[f32; 4]; 3], v: DVec3, w: f32) -> DVec3 {
        apply(invert(rows), v.as_vec3(), w).as_dvec3()
    }

    #[test]
    fn an_f32_ray_strays_less_than_the_bound_but_not_far_less() {
        let mut random = Random(5);
        let mut worst = 0f64;
        for _ in 0..20_000 {
            let rows = instance(&mut random, true);
            let transform = Transform::from_rows(rows).unwrap();
            let origin = f32s(random.in_cube() * random.scale(1e-2, 1e4));
            let local = through_f32(rows, origin, 1.0);
            let back = transform.point(local);
            let strayed = (back - origin).abs() / transform.stray(origin, DVec3::ZERO);
            worst = worst.max(strayed.max_element());

            let direction = f32s(random.unit());
            let local = through_f32(rows, direction, 0.0);
            let back = transform.linear * local;
            let bound = transform.error_bound * direction.abs() * U;
            worst = worst.max(((back - direction).abs() / bound).max_element());
        }
        assert!((0.03..=1.0).contains(&worst), "{worst}");
    }

    #[test]
    fn the_identity_and_its_kin_stray_by_one_rounding() {
        let rows = [[0.0, -2.0, 0.0, 3.1], [0.5, 0.0, 0.0, -7.7], [0.0, 0.0, 1.0, 1e-3]];
        let transform = Transform::from_rows(rows).unwrap();
        assert_eq!(transform.error_bound, DMat3::IDENTITY);
        assert_eq!(Transform::identity().error_bound, DMat3::IDENTITY);
        let mut random = Random(6);
        for _ in 0..1000 {
            let origin = f32s(random.in_cube() * 10.0);
            let local = through_f32(rows, origin, 1.0);
            let back = transform.point(local);
            let bound = transform.stray(origin, DVec3::ZERO);
            assert!((back - origin).abs().cmple(bound).all());
        }
        let mut turned = rows;
        turned[2][2] = 1.5;
        assert_ne!(Transform::from_rows(turned).unwrap().error_bound, DMat3::IDENTITY);
    }

    #[test]
    fn singular_and_infinite_transforms_are_errors() {
        let flat = [[1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        assert!(Transform::from_rows(flat).is_err());
        let endless = [[f32::INFINITY, 0.0, 0.0, 0.0], [0.0; 4], [0.0; 4]];
        assert!(Transform::from_rows(endless).is_err());
    }

    #[test]
    fn stretch_is_at_least_what_the_map_does() {
        let mut random = Random(7);
        for _ in 0..1000 {
            let transform = Transform::from_rows(instance(&mut random, true)).unwrap();
            let v = random.unit();
            assert!((transform.linear * v).length() <= transform.stretch);
        }
    }
}
