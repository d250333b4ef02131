//! 22_solids: every hit compared with the exact solid, ties of planes and cutters, clips, and fog that stays
//! outside.

mod clips;
mod counterpart;
mod fog;
mod hits;
mod shadows;
mod stub;
mod tally;
mod ties;

#[path = "../../samples/22_solids/pieces.rs"]
mod pieces;
#[allow(dead_code)]
#[path = "../../samples/22_solids/program.rs"]
mod program;
#[allow(dead_code)]
#[path = "../../samples/22_solids/shapes.rs"]
mod shapes;
#[allow(dead_code)]
#[path = "../../samples/22_solids/solid.rs"]
mod solid;

use glam::DVec3;
use shapes::number;
use solid::Solid;

const NAME: &str = "22_solids";
const SIZE: &str = "48x30";

/// An eye and its target.
type View = (DVec3, DVec3);
const OUTSIDE: View = (DVec3::new(2.6, 1.9, 3.4), DVec3::new(0.0, -0.1, 0.0));
const INSIDE: View = (DVec3::new(0.05, -0.35, -0.12), DVec3::new(0.6, 0.1, 0.3));
const FIELD_OF_VIEW: f64 = 37.0;

fn shape(name: &str) -> Solid {
    shapes::shape(number(name), 20)
}

/// Returns whether a solid is unbounded, so that the largest box clips it.
fn is_endless(name: &str) -> bool {
    ["wedge", "half-space", "sunk room"].contains(&name)
}
