//! 30 · Own tree: placeholder of the branch, replaced before it is merged.
fn main() {}
