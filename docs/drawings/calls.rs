//! Who calls whom: the shaders of a ray, and the order in which any-hit shaders run.

use crate::sheet::Anchor::{End, Middle, Start};
use crate::sheet::{BROWN, DEVICE, LINE, RED, Sheet, WHITE, YOURS};

/// From `traceRayEXT` to its return.
pub fn shader_calls() -> String {
    let mut s = Sheet::new([840, 520], "The order of shader calls");
    s.card(
        [24.0, 72.0],
        [176.0, 90.0],
        YOURS,
        "ray generation",
        &["one call a pixel;", "calls traceRayEXT"],
    );
    let walk = ["the device walks both levels", "and meets leaves in any order"];
    s.card([290.0, 72.0], [250.0, 90.0], DEVICE, "traversal", &walk);
    let once = ["once, at the nearest", "hit accepted"];
    s.card([650.0, 72.0], [166.0, 72.0], YOURS, "closest hit", &once);
    s.card([650.0, 184.0], [166.0, 72.0], YOURS, "miss", &["once, if no hit", "was accepted"]);
    s.card([186.0, 250.0], [176.0, 72.0], DEVICE, "triangle test", &["by the device"]);
    let inside = ["says where the ray", "meets what is inside"];
    s.card([468.0, 250.0], [176.0, 72.0], YOURS, "intersection", &inside);
    let counts = ["does the candidate count?", "terminateRayEXT ends the search"];
    s.card([290.0, 404.0], [250.0, 72.0], YOURS, "any-hit", &counts);
    let function = ["a function from the", "table, without a ray"];
    s.card([650.0, 404.0], [166.0, 72.0], YOURS, "callable", &function);
    s.arrow(&[[200.0, 108.0], [288.0, 108.0]]);
    s.note([244.0, 84.0], Middle, "ray,");
    s.note([244.0, 100.0], Middle, "payload");
    s.arrow(&[[320.0, 162.0], [320.0, 248.0]]);
    s.note([312.0, 206.0], End, "a triangle");
    s.arrow(&[[510.0, 162.0], [510.0, 248.0]]);
    s.note([518.0, 206.0], Start, "a box");
    s.arrow(&[[320.0, 322.0], [320.0, 402.0]]);
    s.note([312.0, 358.0], End, "nearer,");
    s.note([312.0, 374.0], End, "not opaque");
    s.arrow(&[[510.0, 322.0], [510.0, 402.0]]);
    s.note([518.0, 346.0], Start, "reportIntersectionEXT");
    s.arrow(&[[415.0, 404.0], [415.0, 164.0]]);
    s.arrow(&[[362.0, 286.0], [388.0, 286.0], [388.0, 164.0]]);
    s.note([382.0, 240.0], End, "opaque");
    s.arrow(&[[468.0, 286.0], [442.0, 286.0], [442.0, 164.0]]);
    s.note([448.0, 240.0], Start, "opaque");
    for (row, text) in ["accepted", "or ignored:", "go on"].into_iter().enumerate() {
        s.note([408.0, 344.0 + 17.0 * row as f64], End, text);
    }
    s.arrow(&[[540.0, 94.0], [648.0, 94.0]]);
    s.note([594.0, 87.0], Middle, "hit");
    s.arrow(&[[540.0, 140.0], [590.0, 140.0], [590.0, 220.0], [648.0, 220.0]]);
    s.note([600.0, 176.0], Start, "no hit");
    s.arrow(&[[733.0, 72.0], [733.0, 56.0], [150.0, 56.0], [150.0, 70.0]]);
    s.arrow(&[[816.0, 220.0], [828.0, 220.0], [828.0, 44.0], [84.0, 44.0], [84.0, 70.0]]);
    s.note([816.0, 36.0], End, "traceRayEXT returns; the payload holds the answer");
    s.arrow(&[[733.0, 384.0], [733.0, 402.0]]);
    s.note([733.0, 344.0], Middle, "executeCallableEXT, from");
    s.note([733.0, 360.0], Middle, "ray generation, closest hit,");
    s.note([733.0, 376.0], Middle, "miss or callable shaders");
    s.card([24.0, 490.0], [14.0, 14.0], YOURS, "", &[]);
    s.note([46.0, 502.0], Start, "your shaders");
    s.card([150.0, 490.0], [14.0, 14.0], DEVICE, "", &[]);
    s.note([172.0, 502.0], Start, "the device");
    s.svg()
}

/// Four panes along a ray, met in the order of a tree.
pub fn any_hit_order() -> String {
    let mut s =
        Sheet::new([840, 300], "Any-hit shaders run in the order of the tree, not of the ray");
    let ray = 150.0;
    s.arrow(&[[40.0, ray], [800.0, ray]]);
    s.dot([40.0, ray], 5.0, LINE);
    s.note([40.0, ray + 24.0], Middle, "origin");
    // Where each pane is along the ray, which call meets it, and what becomes of it.
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
