//! Effects: what a scene calls for, found from the scene alone, with the reason.
//!
//! Chapter 25 builds its pipeline from these bits. A chapter that adds an effect says so in its metadata
//! (`effects` in Cargo.toml) and adds a row to [`Effect`], the condition to [`found`] and the reason to
//! [`why_not`]; a test fails until it has.

use super::Material;
use super::file::{Composition, SceneLight};
use Effect::*;

/// Something that costs time and that not every scene needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u32)]
pub enum Effect {
    /// Meshes (02).
    Triangles,
    /// Colours from an image, `map_Kd` (02).
    Textures,
    /// Surfaces with holes, `map_d` or `d` below 1 (03).
    CutOut,
    /// Spheres that a shader intersects (08).
    Spheres,
    /// Boxes that a shader intersects (08).
    Boxes,
    /// A landscape that a shader marches over (21).
    Heightfield,
    /// A plane without end (12).
    Plane,
    /// Convex solids that a shader intersects (22).
    Solids,
    /// Shadows of a light at a place (05).
    PointShadows,
    /// Shadows of a light at infinity (05).
    DirectionalShadows,
    /// Soft shadows: a light with a size (05).
    AreaLight,
    /// Surfaces that mirror, `illum` 3 or more with `Ks` above 0 (06).
    Mirror,
    /// Several rays a pixel (04).
    AntiAliasing,
}

impl Effect {
    /// All effects, by number: that of an effect is its bit.
    pub const ALL: [Self; 13] = [
        Triangles,
        Textures,
        CutOut,
        Spheres,
        Boxes,
        Heightfield,
        Plane,
        Solids,
        PointShadows,
        DirectionalShadows,
        AreaLight,
        Mirror,
        AntiAliasing,
    ];

    /// The name, as metadata, reports and controls have it.
    pub fn name(self) -> &'static str {
        match self {
            Triangles => "triangles",
            Textures => "textures",
            CutOut => "cut-out",
            Spheres => "spheres",
            Boxes => "boxes",
            Heightfield => "heightfield",
            Plane => "plane",
            Solids => "solids",
            PointShadows => "point shadows",
            DirectionalShadows => "directional shadows",
            AreaLight => "area light",
            Mirror => "mirror",
            AntiAliasing => "anti-aliasing",
        }
    }

    /// The macro that shaders know it by, such as `EFFECT_CUT_OUT`.
    pub fn define(self) -> String {
        let letter = |c: char| if c.is_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
        format!("EFFECT_{}", self.name().chars().map(letter).collect::<String>())
    }

    /// The effect of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|effect| effect.name() == name)
    }
}

/// A set of effects: bit n is the effect with number n.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effects(pub u32);

impl Effects {
    /// Every effect that there is.
    pub fn everything() -> Self {
        Effect::ALL.into_iter().fold(Self(0), Self::with)
    }

    /// Whether the effect is in the set.
    pub fn has(self, effect: Effect) -> bool {
        self.0 & 1 << effect as u32 != 0
    }

    /// Whether one of the effects is in the set.
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

    /// The names of the effects in the set.
    pub fn names(self) -> Vec<&'static str> {
        Effect::ALL.into_iter().filter(|&e| self.has(e)).map(Effect::name).collect()
    }
}

/// Whether an effect is called for, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Which effect.
    pub effect: Effect,
    /// Whether the scene calls for it.
    pub needed: bool,
    /// What in the scene says so.
    pub why: String,
}

/// What a scene calls for: a finding for every effect, in the order of [`Effect::ALL`].
pub fn findings(scene: &Composition) -> Vec<Finding> {
    let finding = |effect| match found(scene, effect) {
        Some(why) => Finding { effect, needed: true, why },
        None => Finding { effect, needed: false, why: why_not(effect).to_owned() },
    };
    Effect::ALL.into_iter().map(finding).collect()
}

/// The effects that findings call for.
pub fn needed(findings: &[Finding]) -> Effects {
    let needed = findings.iter().filter(|finding| finding.needed);
    needed.fold(Effects::default(), |set, finding| set.with(finding.effect))
}

// ANCHOR: found
/// Why a scene calls for an effect, if it does. Only what is placed counts: a material that nothing
/// wears calls for nothing.
fn found(scene: &Composition, effect: Effect) -> Option<String> {
    let worn = |is: &dyn Fn(&Material) -> bool, what: &str| {
        let mut worn = scene.materials_in_use();
        worn.find(|material| is(material)).map(|m| format!("material `{}` {what}", m.name))
    };
    let light = |is: &dyn Fn(&SceneLight) -> bool, what: &str| {
        let number = scene.lights.iter().position(is)?;
        Some(format!("light {} {what}", number + 1))
    };
    let count = |count: usize, what: &str| match count {
        0 => None,
        1 => Some(format!("1 {what}")),
        _ => Some(format!("{count} {what}s")),
    };
    match effect {
        Triangles => {
            count(scene.scene.instances.len(), "placed mesh").map(|n| n.replace("meshs", "meshes"))
        }
        Textures => worn(&|m| m.base_texture.is_some(), "has map_Kd"),
        CutOut => worn(&|m| m.opacity_texture.is_some(), "has map_d")
            .or_else(|| worn(&|m| m.opacity < 1.0, "has d below 1")),
        Spheres => count(scene.spheres.len(), "sphere"),
        Boxes => count(scene.boxes.len(), "box").map(|n| n.replace("boxs", "boxes")),
        Heightfield => scene.heightfield.as_ref().map(|_| "there is a heightfield".to_owned()),
        Solids => count(scene.solids.len(), "solid"),
        Plane => scene.plane.as_ref().map(|_| "there is a plane".to_owned()),
        PointShadows => light(&|l| l.shadows && l.light.kind == 1, "is a point light with shadows"),
        DirectionalShadows => {
            light(&|l| l.shadows && l.light.kind == 0, "is directional, with shadows")
        }
        AreaLight => light(&|l| l.shadows && l.light.size > 0.0, "casts shadows and has a size"),
        // No ray goes on at depth 0.
        Mirror if scene.depth == 0 => None,
        Mirror => worn(&Material::is_mirror, "has illum 3 or more and Ks above 0").or_else(|| {
            let mirrors = scene.plane.as_ref().is_some_and(|plane| plane.reflection > 0.0);
            mirrors.then(|| "the plane mirrors".to_owned())
        }),
        AntiAliasing => (scene.samples > 1).then(|| format!("{} rays a pixel", scene.samples)),
    }
}
// ANCHOR_END: found

fn why_not(effect: Effect) -> &'static str {
    match effect {
        Triangles => "no mesh is placed",
        Textures => "no material in use has map_Kd",
        CutOut => "every material in use is opaque",
        Spheres => "no sphere",
        Boxes => "no box",
        Heightfield => "no heightfield",
        Plane => "no plane",
        Solids => "no solid",
        PointShadows => "no point light casts shadows",
        DirectionalShadows => "no directional light casts shadows",
        AreaLight => "no light that casts shadows has a size",
        Mirror => "nothing in use mirrors, or paths end at once",
        AntiAliasing => "one ray a pixel",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effects_bit_is_its_place_in_the_list() {
        for (number, effect) in Effect::ALL.into_iter().enumerate() {
            assert_eq!(effect as usize, number);
            assert_eq!(Effect::named(effect.name()), Some(effect));
        }
        let all = Effects::everything();
        assert_eq!(all.0.count_ones() as usize, Effect::ALL.len());
        assert!(!all.without(Plane).has(Plane) && all.without(Plane).with(Plane) == all);
    }
}
