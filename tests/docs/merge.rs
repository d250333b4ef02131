//! `merge`: the parts of a long render become one file, or the picture, and no sample counts twice.

use std::fs;
use std::ops::Range;

use common::app::Picture;
use instruments::sums::{Header, Origin, Sums};

use crate::fixture::Fixture;

/// A file with these samples of a picture of one pixel, each of value 1.
fn part(fixture: &Fixture, name: &str, samples: Range<u32>) {
    let sum = i128::from(samples.end - samples.start) << 64;
    let origin = Origin { size: [1, 1], shaders: Some(0), ..Origin::default() };
    let header = Header { origin, samples: samples.into(), ..Header::default() };
    Sums { header, values: vec![sum; 4] }.save(&fixture.path(name)).expect("it can be written");
}

#[test]
fn parts_become_a_file_and_a_picture() {
    let fixture = Fixture::new();
    part(&fixture, "a.sums", 0..4);
    part(&fixture, "b.sums", 6..8);
    part(&fixture, "late.sums", 4..6);
    let file = |name: &str| fixture.path(name).to_str().expect("a plain name").to_owned();
    let [a, b, late, all, picture] =
        ["a.sums", "b.sums", "late.sums", "all.sums", "all.exr"].map(file);
    let merged = fixture.run(&["merge", &all, &a, &b]);
    assert_eq!(merged.out, format!("{all}: 6 samples, 0..4, 6..8; 4..6 are missing\n"));
    // The output may be one of the merged files.
    let merged = fixture.run(&["merge", &all, &late, &all, "--samples", "0..8"]);
    assert_eq!((merged.code, &*merged.err), (0, ""));
    assert_eq!(merged.out, format!("{all}: 8 samples, 0..8\n"));
    assert_eq!(fixture.run(&["merge", &picture, &all]).code, 0);
    assert_eq!(Picture::open_exr(&fixture.path("all.exr")).unwrap().pixels, [[1.0; 4]]);
}

#[test]
fn what_cannot_be_merged_is_refused_by_name_and_nothing_is_written() {
    let fixture = Fixture::new();
    part(&fixture, "a.sums", 0..4);
    part(&fixture, "b.sums", 3..5);
    fs::write(fixture.path("text"), "Once upon a time").unwrap();
    let file = |name: &str| fixture.path(name).to_str().expect("a plain name").to_owned();
    let [a, b, text, out, gone, jpeg] =
        ["a.sums", "b.sums", "text", "out.sums", "gone.sums", "out.jpg"].map(file);
    for (arguments, code, words) in [
        (&[&out, &a, &b][..], 1, "samples 3..4 are in both "),
        (&[&out, &a, &a], 1, " are in both "),
        (&[&a, &b], 2, "a.sums' exists: name it among the files, too"),
        (&[&out, &a, &text], 1, "text: was not written by --save"),
        (&[&out, &gone], 1, "gone.sums: there is no such file"),
        (&[&out], 2, "<FILE>..."),
        (&[&jpeg, &a], 2, "out.jpg': a picture is .png or .exr, and sums are .sums"),
    ] {
        let arguments: Vec<&str> = arguments.iter().map(|argument| argument.as_str()).collect();
        let outcome = fixture.run(&[&["merge"], &arguments[..]].concat());
        assert_eq!(outcome.code, code, "{arguments:?}: {}", outcome.err);
        assert!(outcome.err.contains(words), "{arguments:?}: {}", outcome.err);
        assert!(!fixture.path("out.sums").exists());
    }
    let outcome = fixture.run(&["merge", &out, &a, "--samples", "0..9"]);
    assert!(
        outcome.code == 1 && outcome.err.contains("samples 4..9 are missing"),
        "{}",
        outcome.err
    );
    assert!(!fixture.path("out.sums").exists());
}
