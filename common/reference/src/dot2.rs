//! Sums of products with twice the precision of f64.

use glam::DVec3;

/// The sum of products `Σ a·b`, as good as if computed with twice f64's precision and rounded once.
///
/// Algorithm Dot2 of Ogita, Rump and Oishi, *Accurate Sum and Dot Product* (SIAM J. Sci. Comput. 26,
/// 2005, algorithm 5.3): the rounding error of every product and of every sum is itself an f64,
/// which is added at the end. Where the products are exact (factors that came from f32) and the sum
/// is zero, the result is zero, so rays parallel to a plane are recognised.
pub(crate) fn dot2<const N: usize>(terms: [(f64, f64); N]) -> f64 {
    let (mut sum, mut error) = (0.0, 0.0);
    for (a, b) in terms {
        let product = a * b;
        let product_error = a.mul_add(b, -product);
        let next = sum + product;
        let back = next - sum;
        error += ((sum - (next - back)) + (product - back)) + product_error;
        sum = next;
    }
    sum + error
}

/// [`dot2`] of two vectors.
pub(crate) fn vector_dot2(a: DVec3, b: DVec3) -> f64 {
    dot2([(a.x, b.x), (a.y, b.y), (a.z, b.z)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dot2_keeps_what_a_plain_sum_loses() {
        // 1 vanishes beside 1e32 in f64; the plain sum gives 0.
        assert_eq!(dot2([(1e16, 1e16), (1.0, 1.0), (-1e16, 1e16)]), 1.0);
        let x = f64::from(0.1f32);
        assert_eq!(dot2([(x, x), (x, x), (-2.0 * x, x)]), 0.0);
    }
}
