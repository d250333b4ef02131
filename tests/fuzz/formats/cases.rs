//! Files of hard cases, which 24 reads, once it has a device: there is no function to ask.

use std::sync::LazyLock;

use super::{corpus, ours};
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
    seeds: || [vec![some_of_ours()], corpus("cases")].concat(),
    seal: None,
};

/// A case of each primitive of the book's own file.
fn some_of_ours() -> Vec<u8> {
    let mut file: serde_json::Value =
        serde_json::from_slice(&ours("tests/data/hard_cases.json")).expect("it is JSON");
    let mut seen = std::collections::BTreeSet::new();
    let cases = file["cases"].as_array_mut().expect("it has cases");
    cases.retain(|case| seen.insert(case["primitive"].to_string()));
    file["conventions"] = serde_json::Value::Null;
    serde_json::to_vec_pretty(&file).expect("it is JSON again")
}
