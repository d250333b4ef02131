//! 23_motion_blur: pictures with an open shutter, compared with closed forms and with many moments; without a
//! shutter, the picture equals the parent's.

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
use run::Chapter;

const NAME: &str = "23_motion_blur";

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}
