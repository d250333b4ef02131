//! Effects that a scene may trigger. Each is one bit.
//!
//! A chapter that adds an effect says so in its metadata (`effects` in Cargo.toml) and adds a row to
//! [`Effect`], and to `finding.rs` the condition and the reason; a test fails until it has.

use common::gpu::ShaderEnum;

common::shader_enum! {
    /// Something that costs time and that not every scene needs.
    #[derive(PartialOrd, Ord)]
    pub enum Effect {
        /// Meshes (02).
        Triangles,
        /// Colours from an image, `map_Kd` (02).
        Textures,
        /// The same, averaged over what a pixel sees of it (19).
        FilteredTextures = "filtered textures",
        /// Normals from an image, `norm` and `map_Bump` (47).
        NormalMaps = "normal maps",
        /// Surfaces with holes, `map_d` (03).
        CutOut = "cut-out",
        /// Surfaces that are partly there, `d` below 1 (03).
        Blended,
        /// Spheres that a shader intersects (08).
        Spheres,
        /// Boxes that a shader intersects (08).
        Boxes,
        /// Spheres swept along segments (18).
        SweptSpheres = "swept spheres",
        /// A landscape that a shader marches over (21).
        Heightfield,
        /// A plane without end (12).
        Plane,
        /// Convex solids that a shader intersects (22).
        Solids,
        /// Tori that a shader intersects (33).
        Tori,
        /// Shadows of a light at a place (34).
        PointShadows,
        /// Shadows of a light at infinity (05).
        DirectionalShadows,
        /// Soft shadows: a light with a size (35).
        AreaLight,
        /// Surfaces that mirror, `illum` 3 or more with `Ks` above 0 (06).
        Mirror,
        /// Surfaces of microfacets, `Pr` and `Pm` (45).
        RoughMetal = "rough metal",
        /// Light that surfaces scatter onto others (11).
        Bounces,
        /// Surfaces that let light in, `illum` 4, 6, 7 or 9 (27).
        Glass,
        /// Spheres and meshes that shine on others, `Ke` above 0 (29).
        Emitters,
        /// Light from a picture of the sky (46).
        Environment,
        /// Marble, wood or a checker that a surface is cut from (13).
        Patterns,
        /// Lines along the edges of triangles (20).
        Wireframe,
        /// Several rays per pixel (04).
        AntiAliasing = "anti-aliasing",
        /// A lens with a diameter (28).
        DepthOfField,
        /// Spheres that move while the shutter is open (23).
        MotionBlur = "motion blur",
        /// Light of earlier frames, where something moves from frame to frame (31).
        History,
    }
}

impl Effect {
    /// The name, as metadata, reports and controls have it.
    pub fn name(self) -> &'static str {
        Self::LAYOUT.words[self as usize]
    }

    /// The macro that shaders know it by, such as `EFFECT_CUT_OUT`.
    pub fn define(self) -> String {
        let letter = |c: char| if c.is_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
        format!("EFFECT_{}", self.name().chars().map(letter).collect::<String>())
    }

    /// The effect of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|effect| effect.name() == name)
    }
}

/// A set of effects: bit n is the effect with number n.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effects(pub u32);

impl Effects {
    /// Every effect that there is.
    pub fn everything() -> Self {
        Effect::ALL.iter().copied().fold(Self(0), Self::with)
    }

    /// Tests whether the effect is in the set.
    pub fn has(self, effect: Effect) -> bool {
        self.0 & 1 << effect as u32 != 0
    }

    /// Tests whether one of the effects is in the set.
    pub fn has_any(self, effects: &[Effect]) -> bool {
        effects.iter().any(|&effect| self.has(effect))
    }

    /// The set and this effect.
    pub fn with(self, effect: Effect) -> Self {
        Self(self.0 | 1 << effect as u32)
    }

    /// The set without this effect.
    pub fn without(self, effect: Effect) -> Self {
        Self(self.0 & !(1 << effect as u32))
    }

    /// The effects in the set, in the order of [`Effect::ALL`].
    pub fn all(self) -> impl Iterator<Item = Effect> {
        Effect::ALL.iter().copied().filter(move |&effect| self.has(effect))
    }

    /// The names of the effects in the set.
    pub fn names(self) -> Vec<&'static str> {
        self.all().map(Effect::name).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Effect::*;
    use super::*;

    #[test]
    fn an_effects_bit_is_its_place_in_the_list() {
        for (number, &effect) in Effect::ALL.iter().enumerate() {
            assert_eq!(effect as usize, number);
            assert_eq!(Effect::named(effect.name()), Some(effect));
        }
        let all = Effects::everything();
        assert_eq!(all.0.count_ones() as usize, Effect::ALL.len());
        assert!(!all.without(Plane).has(Plane) && all.without(Plane).with(Plane) == all);
    }
}
