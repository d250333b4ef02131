//! Features of a scene file's material beyond those of an MTL file: a pattern, and lines along edges.

use common::gpu::ShaderEnum;
use common::scene::Material;
use glam::Vec3;

common::shader_enum! {
    /// A pattern that fills space (13).
    pub enum Pattern: PATTERN {
        /// None: the material's own colour.
        Plain,
        /// Veins.
        Marble,
        /// Grain.
        Wood,
        /// Every other cell.
        Checker,
    }
}

impl Pattern {
    /// Its name.
    pub fn word(self) -> &'static str {
        Self::LAYOUT.words[self as usize]
    }
}

common::shader_struct! {
    /// A finish as shaders get it.
    #[derive(PartialEq)]
    pub struct Finish {
        /// The colour where the pattern is 1, linear RGB; where it is 0, the material's own is seen.
        pub second: Vec3,
        /// Cells of the pattern's lattice a unit of the mesh's own space.
        pub scale: f32,
        /// Colour of the lines, linear RGB.
        pub ink: Vec3,
        /// Width of lines along the edges of triangles, in pixels; 0 for none.
        pub lines: f32,
        /// A [`Pattern`].
        pub pattern: u32,
        /// 1 if the alpha of its texture is how much of the surface there is.
        pub blended: u32,
    }
}

/// Tests whether the alpha of a material's texture is how much of the surface there is.
pub fn is_blended(material: &Material) -> bool {
    material.blended && material.opacity_texture.is_some()
}

impl Finish {
    /// Neither a pattern nor lines.
    pub const NONE: Self = Self {
        second: Vec3::ZERO,
        scale: 1.0,
        ink: Vec3::ZERO,
        lines: 0.0,
        pattern: 0,
        blended: 0,
    };

    /// The finish of a model's material.
    pub fn of(material: &Material) -> Self {
        Self { blended: is_blended(material).into(), ..Self::NONE }
    }

    /// The pattern, if there is one.
    pub fn pattern(&self) -> Option<Pattern> {
        Pattern::ALL[1..].iter().copied().find(|&kind| kind as u32 == self.pattern)
    }
}
