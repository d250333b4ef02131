//! 02_basic: the picture, and primary visibility held to the reference pixel by pixel.

use crate::run::{bits, golden, render};

const SIZE: &str = "240x150";

#[test]
fn the_picture_is_the_golden_one() {
    // Tolerance set by llvmpipe (Mesa 25.0.7), which made the golden and repeats it to the bit.
    golden("02_basic", &render("02_basic", SIZE, &[]).picture, 0.002);
}

#[test]
fn two_runs_give_the_same_bits() {
    let [first, second] = [0, 1].map(|_| render("02_basic", SIZE, &[]));
    assert_eq!(bits(&first.picture), bits(&second.picture));
}
