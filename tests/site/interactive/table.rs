//! The shader binding tables of 01 and 07, compared with the records printed on the pages.

use serde_json::json;

use super::{found, shown};
use crate::browser::Browser;
use crate::reading::address;

const PAGES: [&str; 2] = ["01_foundation.html", "07_multi_closest_hit.html"];

#[test]
#[ignore = "nightly only: in a browser"]
fn the_tables_lead_to_the_records_that_the_pages_print() {
    let mut browser = Browser::start();
    let what = "[found.offsets, found.strides, found.size, found.record, found.at, found.inside]";
    shown(&mut browser, &address(PAGES[0]), "table");
    let cases = [
        (vec![], json!([[0, 32, 64], [32, 32, 32], 96, 0, 64, true])),
        (vec![("region alignment", "64")], json!([[0, 64, 128], [32, 32, 32], 160, 0, 128, true])),
        (vec![("sbtRecordOffset", "1")], json!([[0, 64, 128], [32, 32, 32], 160, 1, 160, false])),
    ];
    for (controls, expected) in cases {
        assert_eq!(found(&mut browser, &controls, what), expected, "{controls:?}");
    }
    let said = browser.run("figure.said.textContent");
    assert!(said.as_str().unwrap().contains("Error: the region has 1 record "), "{said}");
    shown(&mut browser, &address(PAGES[1]), "table");
    let cases = [
        (vec![], json!([[0, 64, 96], [48, 32, 64], 4320, 44, 2912, true])),
        (vec![("sbtRecordOffset", "1")], json!([[0, 64, 96], [48, 32, 64], 4320, 45, 2976, true])),
        (vec![("instance", "32")], json!([[0, 64, 96], [48, 32, 64], 4320, 65, 4256, true])),
        (vec![("geometry", "1")], json!([[0, 64, 96], [48, 32, 64], 4320, 67, 4384, false])),
        (
            vec![("region alignment", "64")],
            json!([[0, 64, 128], [48, 32, 64], 4352, 67, 4416, false]),
        ),
    ];
    for (controls, expected) in cases {
        assert_eq!(found(&mut browser, &controls, what), expected, "{controls:?}");
        let read =
            browser.run("[...document.querySelectorAll('.record.read')].map(a => a.textContent)");
        let inside = expected[5] == true;
        let wanted = if inside { json!([expected[3].to_string()]) } else { json!([]) };
        assert_eq!(read, wanted);
    }
    // Instance 3 has the records 6 and 7: geometry 1 at a stride of 2 gives the next instance's first.
    let said = "[found.record, found.owner, document.querySelector('.figure .said').textContent]";
    for (stride, geometry, record, owner) in [("1", "1", 7, 3), ("2", "0", 6, 3), ("2", "1", 8, 4)]
    {
        let controls = [
            ("instance", "3"),
            ("geometry", geometry),
            ("sbtRecordStride", stride),
            ("sbtRecordOffset", "0"),
        ];
        let (at, of, said): (usize, usize, String) =
            serde_json::from_value(found(&mut browser, &controls, said)).unwrap();
        assert_eq!((at, of), (record, owner), "{said}");
        let terms = format!(
            "instance 3 × 2 records + geometry {geometry} × stride {stride} + offset 0 = {at},"
        );
        assert!(said.contains(&terms), "{said}");
        assert_eq!(said.contains("belongs to instance 4"), owner != 3, "{said}");
    }
}
