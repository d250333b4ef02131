//! 23_motion_blur: the picture, and what the chapter claims.

use run::{bits, golden, render};

const NAME: &str = "23_motion_blur";

#[test]
fn the_picture_is_the_golden_one_and_repeats() {
    let [first, second] = [0, 1].map(|_| render(NAME, "240x150", &[]).picture);
    assert_eq!(bits(&first), bits(&second));
    // Say here which device set the tolerance.
    golden(NAME, &first, 0.002);
}
