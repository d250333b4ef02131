//! Known faults of drivers: none is seen on a right device, and each is seen where it is planted.

use std::path::Path;

use run::shaders_with;
use serde_json::{Value, json};

/// Looks for the faults under validation; returns the exit code and the rows.
fn faults(shaders: Option<&Path>, arguments: &[&str]) -> (i32, Value) {
    let mut command = run::command(crate::NAME);
    command.args(["--headless", "--validate", "--faults", "--report", "-"]).args(arguments);
    if let Some(shaders) = shaders {
        command.env("SHADERS", shaders);
    }
    let output = command.output().expect("it starts");
    let rows = serde_json::from_slice(&output.stdout).expect("the rows are JSON");
    (output.status.code().expect("it ends by itself"), rows)
}

fn wrong(rows: &Value) -> Vec<u64> {
    let rows = rows.as_array().expect("rows").iter();
    rows.map(|row| row["wrong"].as_u64().expect("a number")).collect()
}

#[test]
fn a_right_device_has_none() {
    for (arguments, rows) in [(&[][..], 3), (&["--risky"], 2)] {
        let (code, found) = faults(None, arguments);
        assert_eq!((code, wrong(&found)), (0, vec![0; rows]), "{found}");
    }
}

#[test]
fn a_lost_box_is_counted() {
    let (wanted, some) =
        ("if (gl_PrimitiveID ==", "if (gl_PrimitiveID % 64 != 5 && gl_PrimitiveID ==");
    let planted = shaders_with("24_accuracy/faults.rint", wanted, some);
    let (code, found) = faults(Some(planted.path()), &[]);
    assert_eq!((code, &wrong(&found)[..2]), (1, &[64, 64][..]), "{found}");
}

#[test]
fn wrong_hit_attributes_name_the_shaders_that_got_them() {
    let places = |file: &str, kept: &str, planted: &str| {
        let (code, found) = faults(Some(shaders_with(file, kept, planted).path()), &[]);
        let row = &found[2];
        assert_eq!((code, &row["wrong"]), (1, &row["rays"]), "{found}");
        row["places"].clone()
    };
    let mark = "marks = marks_of(gl_PrimitiveID, gl_WorldRayDirectionEXT);";
    let [any_hit, closest_hit, after, nested] = [
        "in an any-hit shader",
        "in a closest hit shader",
        "after a trace in a closest hit shader",
        "of a nested ray",
    ];
    let everywhere = places("24_accuracy/faults.rint", mark, &format!("{mark} marks.b.w++;"));
    assert_eq!(everywhere, json!([any_hit, closest_hit, after, nested]));
    let last = "if (differ(marks, expected)) {\n            seen.wrong |= WRONG_AFTER_TRACE;";
    let changed = last.replace("expected)", "marks_of(gl_PrimitiveID, -gl_WorldRayDirectionEXT))");
    assert_eq!(places("24_accuracy/faults_nested.rchit", last, &changed), json!([after]));
}
