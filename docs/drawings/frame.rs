//! The commands of a frame in time, and the barriers between them.

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BLUE, DEVICE, GREEN, RED, Sheet, YOURS};

/// A bar of the drawing: its row, its beginning and end, its color and its name.
type Bar = (usize, f64, f64, &'static str, &'static str);

/// One frame of chapter 14: compute shader, copy, two builds and rays, each waiting for the previous one.
pub fn barriers() -> String {
    const TOP: f64 = 64.0;
    const ROW: f64 = 42.0;
    let rows = ["compute shader", "transfer", "build", "rays"];
    let bars: [Bar; 6] = [
        (3, 150.0, 206.0, DEVICE, "before"),
        (0, 258.0, 352.0, GREEN, "vertices"),
        (1, 258.0, 352.0, GREEN, "instances"),
        (2, 404.0, 504.0, BLUE, "bottom level"),
        (2, 556.0, 646.0, BLUE, "top level"),
        (3, 698.0, 810.0, YOURS, "trace"),
    ];
    let waits: [(f64, &[&str]); 4] = [
        (232.0, &["trace_to_deform", "reads_to_update"]),
        (378.0, &["deform_to_build", "update_to_reads", "trace_to_build"]),
        (530.0, &["between_builds"]),
        (672.0, &["build_to_trace"]),
    ];
    let mut s = Sheet::new([840, 330], "One frame: each command waits behind a barrier");
    let y = |row: usize| TOP + ROW * row as f64;
    for (row, name) in rows.into_iter().enumerate() {
        s.say([24.0, y(row) + 20.0], Start, name);
        s.line(&[[140.0, y(row) + 34.0], [820.0, y(row) + 34.0]], DEVICE, 1.0);
    }
    for (row, from, to, fill, name) in bars {
        s.card([from, y(row)], [to - from, 30.0], fill, "", &[name]);
    }
    for (x, names) in waits {
        s.dashes(&[[x, TOP - 10.0], [x, y(4) + 4.0]], RED, 1.6);
        for (line, name) in names.iter().enumerate() {
            s.note([x, y(4) + 22.0 + 17.0 * line as f64], Middle, name);
        }
    }
    s.arrow(&[[140.0, 312.0], [820.0, 312.0]]);
    s.say([24.0, 316.0], Start, "time");
    s.svg()
}
