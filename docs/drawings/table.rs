//! The shader binding table.

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BLUE, Sheet, WHITE, YOURS};

/// The table of chapter 01 in bytes: one record per region, on a device like this one and on one with a
/// larger alignment of regions.
pub fn chapter_01() -> String {
    const HANDLE: u32 = 32;
    const HANDLE_ALIGNMENT: u32 = 16;
    let mut s = Sheet::new([840, 330], "The shader binding table of chapter 01, byte by byte");
    let place = |byte: u32| 24.0 + 4.9 * f64::from(byte);
    for (row, base_alignment) in [32u32, 64].into_iter().enumerate() {
        let top = 96.0 + 112.0 * row as f64;
        let stride = HANDLE.next_multiple_of(HANDLE_ALIGNMENT);
        let region = stride.next_multiple_of(base_alignment);
        s.title([24.0, top - 16.0], Start, &format!("shaderGroupBaseAlignment {base_alignment}"));
        for (i, group) in ["camera.rgen", "sky.rmiss", "shade.rchit"].into_iter().enumerate() {
            let start = i as u32 * region;
            let width = place(stride) - place(0);
            s.card([place(start), top], [width, 46.0], YOURS, group, &["handle"]);
            s.note([place(start), top + 64.0], Middle, &start.to_string());
            if region > stride && i < 2 {
                let gap = place(region) - place(stride);
                s.card([place(start + stride), top], [gap, 46.0], WHITE, "", &["unused"]);
            }
        }
        let size = 2 * region + stride;
        s.note([place(size), top + 64.0], Middle, &size.to_string());
    }
    s.note([24.0, 302.0], Start, "A handle has 32 bytes. Numbers are bytes from the table’s beginning; the last one is its size.");
    s.svg()
}

/// The table of chapter 05: a second miss record, chosen by a shadow ray's missIndex.
pub fn chapter_05() -> String {
    let mut s = Sheet::new([840, 250], "The shader binding table of chapter 05");
    let regions: [(&str, &str, &[&str]); 3] = [
        ("ray generation", "one record", &["camera.rgen"]),
        ("miss", "chosen by missIndex", &["0: sky.rmiss", "1: shadow.rmiss"]),
        ("hit", "one record for all triangles", &["0: shade.rchit"]),
    ];
    for (column, (name, chosen, records)) in regions.into_iter().enumerate() {
        let x = 24.0 + 272.0 * column as f64;
        s.title([x, 70.0], Start, name);
        s.note([x, 88.0], Start, chosen);
        for (row, record) in records.iter().enumerate() {
            let fill = if *record == "1: shadow.rmiss" { BLUE } else { YOURS };
            s.card([x, 98.0 + 34.0 * row as f64], [236.0, 30.0], fill, "", &[record]);
        }
    }
    let lines = [
        "The camera's ray has missIndex 0 and may run shade.rchit.",
        "The shadow ray has missIndex 1 and skips the closest hit shader: only shadow.rmiss may run.",
    ];
    for (row, line) in lines.into_iter().enumerate() {
        s.note([24.0, 200.0 + 20.0 * row as f64], Start, line);
    }
    s.svg()
}

/// The table of chapter 13, which has records in all four regions.
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
    s.note([432.0, 250.0], Start, "the same shader four times:");
    s.note([432.0, 267.0], Start, "callables draw the patterns");
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
