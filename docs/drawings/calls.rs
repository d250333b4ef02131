//! The shaders of a ray and their callers, and the order in which any-hit shaders run.

use crate::sheet::Anchor::{End, Middle, Start};
use crate::sheet::{BROWN, DEVICE, LINE, RED, Sheet, WHITE, YOURS};

/// From `traceRayEXT` to its return, with the two shaders that end a ray.
pub fn trace_calls() -> String {
    let mut s = Sheet::new([840, 250], "One ray, three shaders");
    let once = ["runs once per pixel;", "calls traceRayEXT"];
    s.card([24.0, 92.0], [176.0, 90.0], YOURS, "ray generation", &once);
    let walk = ["the device searches both levels", "for the nearest hit"];
    s.card([290.0, 92.0], [250.0, 90.0], DEVICE, "traversal", &walk);
    s.card([650.0, 78.0], [166.0, 56.0], YOURS, "closest hit", &["once, at the nearest hit"]);
    s.card([650.0, 160.0], [166.0, 56.0], YOURS, "miss", &["once, if there is no hit"]);
    s.arrow(&[[200.0, 137.0], [288.0, 137.0]]);
    s.note([244.0, 112.0], Middle, "ray,");
    s.note([244.0, 128.0], Middle, "payload");
    s.arrow(&[[540.0, 106.0], [648.0, 106.0]]);
    s.note([594.0, 98.0], Middle, "hit");
    s.arrow(&[[540.0, 168.0], [594.0, 168.0], [594.0, 188.0], [648.0, 188.0]]);
    s.note([588.0, 158.0], Middle, "no hit");
    returns(&mut s, 78.0, 188.0, 92.0);
    legend(&mut s, 220.0);
    s.svg()
}

/// The same, with the shaders that take part in the traversal.
pub fn shader_calls() -> String {
    let mut s = Sheet::new([840, 520], "The order of shader calls");
    traversal(&mut s);
    s.svg()
}

/// The same, and a callable shader.
pub fn callable_calls() -> String {
    let mut s = Sheet::new([840, 520], "The order of shader calls, with callable shaders");
    traversal(&mut s);
    let function = ["a function from the", "table, without a ray"];
    s.card([650.0, 404.0], [166.0, 72.0], YOURS, "callable", &function);
    s.arrow(&[[733.0, 374.0], [733.0, 402.0]]);
    s.note([820.0, 316.0], End, "executeCallableEXT,");
    s.note([820.0, 332.0], End, "from ray generation,");
    s.note([820.0, 348.0], End, "closest hit, miss or");
    s.note([820.0, 364.0], End, "other callable shaders");
    s.svg()
}

/// All stages that a ray can call, and the tests of the device.
fn traversal(s: &mut Sheet) {
    let once = ["runs once per pixel;", "calls traceRayEXT"];
    s.card([24.0, 72.0], [176.0, 90.0], YOURS, "ray generation", &once);
    let walk = ["the device walks both levels", "and finds leaves in any order"];
    s.card([290.0, 72.0], [250.0, 90.0], DEVICE, "traversal", &walk);
    let once = ["once, at the nearest", "hit accepted"];
    s.card([650.0, 72.0], [166.0, 72.0], YOURS, "closest hit", &once);
    s.card([650.0, 184.0], [166.0, 72.0], YOURS, "miss", &["once, if no hit", "was accepted"]);
    s.card([186.0, 250.0], [176.0, 72.0], DEVICE, "triangle test", &["by the device"]);
    let inside = ["finds where the ray", "enters your shape"];
    s.card([468.0, 250.0], [176.0, 72.0], YOURS, "intersection", &inside);
    let counts = ["does the candidate count?", "terminateRayEXT ends the search"];
    s.card([290.0, 404.0], [250.0, 72.0], YOURS, "any-hit", &counts);
    s.arrow(&[[200.0, 108.0], [288.0, 108.0]]);
    s.note([244.0, 84.0], Middle, "ray,");
    s.note([244.0, 100.0], Middle, "payload");
    s.arrow(&[[320.0, 162.0], [320.0, 248.0]]);
    s.note([312.0, 206.0], End, "a triangle");
    s.arrow(&[[510.0, 162.0], [510.0, 248.0]]);
    s.note([518.0, 206.0], Start, "a box");
    s.arrow(&[[310.0, 322.0], [310.0, 402.0]]);
    s.note([302.0, 358.0], End, "nearer,");
    s.note([302.0, 374.0], End, "not opaque");
    s.arrow(&[[520.0, 322.0], [520.0, 402.0]]);
    s.note([528.0, 350.0], Start, "a hit, reported by");
    s.note([528.0, 366.0], Start, "reportIntersectionEXT");
    s.note([528.0, 382.0], Start, "(if not opaque)");
    // Back to the traversal: from the any-hit shader, and past it for opaque geometry.
    s.arrow(&[[415.0, 404.0], [415.0, 164.0]]);
    s.note([424.0, 344.0], Start, "accepted");
    s.note([424.0, 360.0], Start, "or ignored:");
    s.note([424.0, 376.0], Start, "go on");
    s.arrow(&[[362.0, 286.0], [388.0, 286.0], [388.0, 164.0]]);
    s.note([382.0, 216.0], End, "opaque:");
    s.note([382.0, 232.0], End, "accepted");
    s.arrow(&[[468.0, 286.0], [442.0, 286.0], [442.0, 164.0]]);
    s.note([448.0, 216.0], Start, "opaque:");
    s.note([448.0, 232.0], Start, "accepted");
    s.arrow(&[[540.0, 94.0], [648.0, 94.0]]);
    s.note([594.0, 87.0], Middle, "hit");
    s.arrow(&[[540.0, 140.0], [590.0, 140.0], [590.0, 220.0], [648.0, 220.0]]);
    s.note([600.0, 176.0], Start, "no hit");
    returns(s, 72.0, 220.0, 72.0);
    legend(s, 490.0);
}

/// The way back to the ray generation shader, from the closest hit shader and from the miss shader.
fn returns(s: &mut Sheet, hit: f64, miss: f64, raygen: f64) {
    s.arrow(&[[733.0, hit], [733.0, 56.0], [150.0, 56.0], [150.0, raygen - 2.0]]);
    s.arrow(&[[816.0, miss], [828.0, miss], [828.0, 44.0], [84.0, 44.0], [84.0, raygen - 2.0]]);
    s.note([816.0, 36.0], End, "traceRayEXT returns; the payload holds the result");
}

/// The meaning of the two fills.
fn legend(s: &mut Sheet, y: f64) {
    s.card([24.0, y], [14.0, 14.0], YOURS, "", &[]);
    s.note([46.0, y + 12.0], Start, "your shaders");
    s.card([150.0, y], [14.0, 14.0], DEVICE, "", &[]);
    s.note([172.0, y + 12.0], Start, "the device");
}

/// Four panes along a ray, met in the order of a tree.
pub fn any_hit_order() -> String {
    let mut s =
        Sheet::new([840, 300], "Any-hit shaders run in the order of the tree, not of the ray");
    let ray = 150.0;
    s.arrow(&[[40.0, ray], [800.0, ray]]);
    s.dot([40.0, ray], 5.0, LINE);
    s.note([40.0, ray + 24.0], Middle, "origin");
    // The place of each pane along the ray, the call that meets it, and the result.
    let panes = [
        (180.0, "3rd call", "accepted: the nearest", "so far", BROWN),
        (340.0, "1st call", "ignored: a hole", "", LINE),
        (500.0, "2nd call", "accepted, until", "the 3rd call", BROWN),
        (680.0, "no call", "farther than what", "was accepted", RED),
    ];
    for (x, call, first, second, color) in panes {
        let fill = if color == BROWN { YOURS } else { WHITE };
        let pane = [[x - 8.0, 80.0], [x + 8.0, 96.0], [x + 8.0, 220.0], [x - 8.0, 204.0]];
        s.polygon(&pane, fill, color);
        s.title([x, 70.0], Middle, call);
        s.note([x, 242.0], Middle, first);
        s.note([x, 258.0], Middle, second);
        s.dot([x, ray], 4.0, color);
    }
    s.note([24.0, 286.0], Start, "The closest hit shader runs once, at the pane of the 3rd call. Another device may have another order.");
    s.svg()
}
