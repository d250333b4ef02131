//! A solution with one wrong number is rejected, unless its exercise explains why the picture is the same.

use std::process::Command;

use crate::fixture::{Fixture, Outcome, run};

/// The tool on the real book.
fn vary(names: &[&str]) -> Outcome {
    run(Command::new(env!("CARGO_BIN_EXE_chapters")).arg("exercise").args(names).arg("--vary"))
}

#[test]
fn half_a_right_answer_is_refused() {
    let outcome = vary(&["17.4"]);
    let line = "17.4: 4 variants, 4 refused, 0 the same\n";
    assert_eq!((outcome.code, &*outcome.out), (0, line), "{}", outcome.err);
}

#[test]
#[ignore = "nightly: each variant of each solution is rendered; quick: variants::half_a_right_answer_is_refused"]
fn every_wrong_number_is_refused() {
    let outcome = vary(&[]);
    assert_eq!(outcome.code, 0, "\n{}{}", outcome.out, outcome.err);
}

#[test]
fn a_variant_that_is_the_same_is_told_by_its_exercise() {
    let fixture = Fixture::new();
    let file = "docs/exercises/02.1.diff";
    let whole = fixture.read(file);
    let of_white = "Same: 1.0 doubled, a tenth more because white is white\n";
    let of_grey = "Same: 1.0 halved because grey is white\n";
    for (same, code, end) in [
        (
            "",
            1,
            format!(
                "{file}: the check accepts 1.0 doubled in `imageStore(picture, ivec2(id), vec4(1.0));`"
            ),
        ),
        (of_white, 0, "02.1: 4 variants, 2 refused, 2 the same\n".to_owned()),
        (&*format!("{of_white}{of_grey}"), 1, format!("{file}: 1.0 halved is not the same\n")),
    ] {
        fixture.write(file, &whole.replace("Minutes:", &format!("{same}Minutes:")));
        let outcome = fixture.run(&["exercise", "02.1", "--vary"]);
        assert_eq!(outcome.code, code, "{}{}", outcome.out, outcome.err);
        assert!(outcome.out.starts_with(&end), "{}", outcome.out);
    }
}
