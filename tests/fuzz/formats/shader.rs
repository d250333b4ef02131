//! The text of a shader, with included files.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use super::{corpus, ours};
use crate::format::Format;
use crate::grammar::Grammar;

static GRAMMAR: LazyLock<Grammar> =
    LazyLock::new(|| Grammar::new(include_str!("../grammars/shader.txt")));

/// A miss shader.
pub const FORMAT: Format = Format {
    name: "shader",
    file: "s.rmiss",
    most: 1 << 15,
    make: |random| GRAMMAR.text(random, 2000).into_bytes(),
    grammar: Some(|| &GRAMMAR),
    seeds: || {
        let right = ours("shaders/common/shadow.rmiss");
        [vec![right, long_sum()], corpus("shader")].concat()
    },
    seal: None,
};

/// More terms than glslang's stack can take: it recurses into a sum term by term.
fn long_sum() -> Vec<u8> {
    let sum = " + x".repeat(60_000);
    format!("#version 460\nfloat much(float x) {{ return x{sum}; }}\nvoid main() {{ }}\n").into()
}

/// The files that shaders include: one that includes both, and one that includes itself.
pub fn beside(folder: &Path) {
    let file = |name: &str, text: &str| fs::write(folder.join(name), text);
    file("a.glsl", "#include \"b.glsl\"\n#include \"s.rmiss\"\nfloat a(float x) { return x; }\n")
        .and_then(|()| file("b.glsl", "#include \"b.glsl\"\nconst uint B = 1;\n"))
        .expect("a file can be written");
}
