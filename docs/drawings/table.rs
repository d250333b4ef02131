//! The shader binding table.

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BLUE, Sheet, YOURS};

/// That of chapter 13, which has records in all four regions.
pub fn chapter_13() -> String {
    let mut s =
        Sheet::new([840, 430], "The shader binding table of chapter 13, with callable shaders");
    let hit = ["0: shade.rchit", "1: shade.rchit", "2: shade.rchit", "3: shade.rchit"];
    let callable =
        ["0: marble.rcall", "1: wood.rcall", "2: checker.rcall", "3: sun.rcall", "4: lamp.rcall"];
    let regions: [(&str, &str, &[&str]); 4] = [
        ("ray generation", "one record", &["camera.rgen"]),
        ("miss", "chosen by missIndex", &["0: sky.rmiss", "1: shadow.rmiss"]),
        ("hit", "chosen by the formula", &hit),
        ("callable", "chosen by the callable index", &callable),
    ];
    for (column, (name, chosen, records)) in regions.into_iter().enumerate() {
        let x = 24.0 + 204.0 * column as f64;
        s.title([x, 70.0], Start, name);
        s.note([x, 88.0], Start, chosen);
        for (row, record) in records.iter().enumerate() {
            s.card([x, 98.0 + 34.0 * row as f64], [180.0, 30.0], YOURS, "", &[record]);
        }
    }
    let lines = [
        "A record is a handle of shaderGroupHandleSize bytes, and behind it bytes of your own (shaderRecordEXT).",
        "The stride from one record to the next is a multiple of shaderGroupHandleAlignment,",
        "and a region begins at a multiple of shaderGroupBaseAlignment.",
    ];
    for (row, line) in lines.into_iter().enumerate() {
        s.note([24.0, 296.0 + 18.0 * row as f64], Start, line);
    }
    s.card([24.0, 354.0], [792.0, 52.0], BLUE, "", &[]);
    s.say([420.0, 385.0], Middle, "hit record = instance offset (TLAS) + geometry index (BLAS) × sbtRecordStride (ray) + sbtRecordOffset (ray)");
    s.svg()
}
