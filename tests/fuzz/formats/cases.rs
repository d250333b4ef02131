//! Files of hard cases. 24 reads them once it has a device, so there is no function to call.

use std::sync::LazyLock;

use super::corpus;
use crate::format::Format;
use crate::grammar::Grammar;

static GRAMMAR: LazyLock<Grammar> =
    LazyLock::new(|| Grammar::new(include_str!("../grammars/cases.txt")));

/// The text of a file of cases.
pub const FORMAT: Format = Format {
    name: "cases",
    file: "c.json",
    most: 1 << 17,
    make: |random| GRAMMAR.text(random, 4000).into_bytes(),
    grammar: Some(|| &GRAMMAR),
    seeds: || [vec![SPHERE.into()], corpus("cases")].concat(),
    seal: None,
};

/// A ball in front of the eye: with more primitives, a device would compile pipelines for minutes.
const SPHERE: &str = r#"{"schema": "rt-hard-cases/2", "cases": [{"id": "a", "primitive": "sphere", "family": "f",
"ray": {"origin": [0, 0, 5], "dir": [0, 0, -1], "tmin": 0, "tmax": 100}, "shape": {"center": [0, 0, 0], "radius": 1},
"expect": {"hit": "yes", "t": "4.0", "normal": ["0", "0", "1"]}, "tol": {"t_ulp": 1}}]}"#;
