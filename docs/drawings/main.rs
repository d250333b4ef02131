//! Draws the ideas of the book: `cargo run -p drawings` writes them all to `docs/images`.
//!
//! A drawing that shows data computes it: the hill, the solids and the triangles are real ones.

mod calls;
mod lens;
mod lights;
mod march;
mod rays;
mod shapes;
mod sheet;
mod structures;
mod table;

use std::path::Path;
use std::process::ExitCode;

/// A drawing's name, and what draws it.
type Drawing = (&'static str, fn() -> String);

const DRAWINGS: &[Drawing] = &[
    ("acceleration_structures", structures::two_levels),
    ("acne_and_leak", rays::acne_and_leak),
    ("address_chain", structures::address_chain),
    ("any_hit_order", calls::any_hit_order),
    ("barycentrics", rays::barycentrics),
    ("footprint", rays::footprint),
    ("from_raster", rays::from_raster),
    ("heightfield_steps", march::steps),
    ("refit", structures::refit),
    ("shader_binding_table", table::chapter_13),
    ("shader_calls", calls::shader_calls),
    ("slabs", shapes::slabs),
    ("solid_angles", lights::solid_angles),
    ("solid_intervals", shapes::intervals),
    ("thin_lens", lens::thin_lens),
];

fn folder() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../images")
}

fn main() -> ExitCode {
    for (name, draw) in DRAWINGS {
        let file = folder().join(format!("{name}.svg"));
        if let Err(error) = std::fs::write(&file, draw()) {
            eprintln!("error: cannot write {}: {error}", file.display());
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

#[test]
fn the_drawings_of_the_book_are_these() {
    for (name, draw) in DRAWINGS {
        let file = folder().join(format!("{name}.svg"));
        let found = std::fs::read_to_string(&file).unwrap_or_default();
        assert!(found == draw(), "{name}.svg is not what is drawn; run: cargo run -p drawings");
    }
}
