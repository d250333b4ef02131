//! 23_motion_blur: what is seen while the shutter is open is what closed forms and many moments say, and without a
//! shutter the picture is its parent's.

mod claims;
mod hard;
mod smear;

#[allow(dead_code)]
#[path = "../../samples/23_motion_blur/ball.rs"]
mod ball;
#[allow(dead_code)]
#[expect(clippy::duplicate_mod, reason = "to 14 it is a part of its own")]
#[path = "../../samples/14_animation/leg.rs"]
mod leg;
#[allow(dead_code)]
#[expect(clippy::duplicate_mod, reason = "to 14 it is a part of its own")]
#[path = "../../samples/14_animation/legs.rs"]
mod legs;
#[allow(dead_code)]
#[path = "../../samples/23_motion_blur/motion.rs"]
mod motion;
#[allow(dead_code)]
#[path = "../../samples/23_motion_blur/shutter.rs"]
mod shutter;

use crate::animation::turned;
use common::app::Picture;
use run::{golden, render};

const NAME: &str = "23_motion_blur";

fn picture(size: &str, arguments: &[&str], sets: &[&str]) -> Picture {
    let sets = sets.iter().flat_map(|&set| ["--set", set]);
    render(NAME, size, &arguments.iter().copied().chain(sets).collect::<Vec<_>>()).picture
}

#[test]
fn the_picture_is_the_golden_one() {
    let picture = picture("240x150", &[], &["frame=934", "shutter=2"]);
    // Tolerance set by llvmpipe (Mesa 25.0.7), which made the golden and repeats it to the bit.
    golden(NAME, &picture, 0.002);
}
