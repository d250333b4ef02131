//! The finish of a material: a pattern and its two colours, as data by which a shader chooses.

use common::model::Model;
use glam::Vec3;

common::shader_enum! {
    /// A pattern that fills space.
    pub enum Pattern: PATTERN { Plain, Marble, Wood, Checker }
}

common::shader_struct! {
    /// The look of a material.
    pub struct Finish {
        /// Colour where the pattern is 0, linear RGB.
        first: Vec3,
        /// Cells of the pattern's lattice a unit of the mesh's own space.
        scale: f32,
        /// Colour where the pattern is 1, linear RGB.
        second: Vec3,
        /// A [`Pattern`].
        pub pattern: u32,
    }
}

/// A finish for each material: the chess set's by their names, plain for others.
pub fn finishes(model: &Model) -> Vec<Finish> {
    let finish = |pattern: Pattern, scale, first: [f32; 3], second: [f32; 3]| Finish {
        first: first.into(),
        scale,
        second: second.into(),
        pattern: pattern as u32,
    };
    let of = |name: &str| match name {
        "white" => finish(Pattern::Marble, 4.0, [0.80, 0.78, 0.72], [0.16, 0.17, 0.20]),
        "black" => finish(Pattern::Wood, 3.0, [0.13, 0.05, 0.02], [0.035, 0.012, 0.006]),
        "board_light" => finish(Pattern::Wood, 1.5, [0.62, 0.42, 0.22], [0.40, 0.23, 0.10]),
        "board_dark" => finish(Pattern::Marble, 1.5, [0.03, 0.10, 0.07], [0.35, 0.45, 0.38]),
        "frame" => finish(Pattern::Wood, 1.0, [0.16, 0.07, 0.03], [0.06, 0.02, 0.01]),
        "fretwork" => finish(Pattern::Checker, 4.0, [0.55, 0.42, 0.22], [0.12, 0.07, 0.04]),
        _ => finish(Pattern::Plain, 1.0, [0.0; 3], [0.0; 3]),
    };
    model.materials.iter().map(|material| of(&material.name)).collect()
}
