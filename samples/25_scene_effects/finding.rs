//! Effects that a scene needs, found from the scene alone, with the reason.

use common::gpu::ShaderEnum;
use common::model::text::quoted;
use common::scene::{LightKind, Material};

use crate::Effect::{self, *};
use crate::{
    Composition, Effects, Finish, SceneLight, is_blended, is_glass, is_rough, rough_textures,
};

/// The need for an effect, and the reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// The effect in question.
    pub effect: Effect,
    /// True if the scene needs it.
    pub needed: bool,
    /// The reason, from the scene.
    pub why: String,
}

/// Findings for every effect, in the order of [`Effect::ALL`].
pub fn findings(scene: &Composition) -> Vec<Finding> {
    let finding = |&effect| match found(scene, effect) {
        Some(why) => Finding { effect, needed: true, why },
        None => Finding { effect, needed: false, why: why_not(effect).to_owned() },
    };
    Effect::ALL.iter().map(finding).collect()
}

/// The effects that findings trigger.
pub fn needed(findings: &[Finding]) -> Effects {
    let needed = findings.iter().filter(|finding| finding.needed);
    needed.fold(Effects::default(), |set, finding| set.with(finding.effect))
}

/// The reason why a scene needs an effect, if it does. Only placed objects count: a material that
/// no object uses triggers no effect.
fn found(scene: &Composition, effect: Effect) -> Option<String> {
    let worn = |is: &dyn Fn(&Material) -> bool, what: &str| {
        let mut worn = scene.materials_in_use();
        worn.find(|material| is(material)).map(|m| format!("material {} {what}", quoted(&m.name)))
    };
    let finished = |is: &dyn Fn(&Finish) -> Option<String>| {
        let mut worn = scene.in_use().into_iter();
        worn.find_map(|number| {
            let name = quoted(&scene.scene.model.materials[number].name);
            is(&scene.finishes[number]).map(|what| format!("material {name} {what}"))
        })
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
        Textures => {
            worn(&|m| m.base_texture.is_some() || rough_textures(m).is_some(), "has a texture")
        }
        FilteredTextures if !scene.filtered => None,
        FilteredTextures => worn(&|m| m.base_texture.is_some(), "has a texture, to be filtered"),
        NormalMaps => worn(&|m| m.normal_texture.is_some(), "has a normal map"),
        CutOut => worn(&|m| m.opacity_texture.is_some() && !m.blended, "has an opacity texture"),
        Blended => worn(&|m| m.opacity < 1.0, "is not opaque")
            .or_else(|| worn(&is_blended, "has a texture that is not opaque")),
        Spheres => count(scene.spheres.len(), "sphere"),
        Boxes => count(scene.boxes.len(), "box").map(|n| n.replace("boxs", "boxes")),
        SweptSpheres => count(scene.strands.segments.len(), "segment"),
        Heightfield => scene.heightfield.as_ref().map(|_| "there is a heightfield".to_owned()),
        Solids => count(scene.solids.len(), "solid"),
        Tori => count(scene.tori.len(), "torus").map(|n| n.replace("toruss", "tori")),
        Plane => scene.plane.as_ref().map(|_| "there is a plane".to_owned()),
        PointShadows => light(
            &|l| l.shadows && l.disk.light.kind == LightKind::Point,
            "is a point light with shadows",
        ),
        DirectionalShadows => light(
            &|l| l.shadows && l.disk.light.kind == LightKind::Directional,
            "is directional, with shadows",
        ),
        AreaLight => light(&|l| l.shadows && l.disk.radius > 0.0, "casts shadows and has a size"),
        // At depth 0 no ray is reflected or refracted.
        Mirror | Glass if scene.depth == 0 => None,
        Mirror => {
            let is_mirror = |m: &Material| m.is_mirror() && !is_glass(m) && !is_rough(m);
            worn(&is_mirror, "mirrors").or_else(|| {
                let mirrors = scene.plane.as_ref().is_some_and(|plane| plane.reflection > 0.0);
                mirrors.then(|| "the plane mirrors".to_owned())
            })
        }
        RoughMetal => worn(&is_rough, "has a roughness"),
        Bounces => count(scene.bounces as usize, "bounce").map(|n| format!("{n} of light")),
        Glass => worn(&is_glass, "is glass"),
        Emitters if !scene.scatters() => None,
        Emitters => scene.lamp().map(|m| format!("material {} shines", quoted(&m.name))),
        Environment => scene.environment.as_ref().map(|_| "the sky is a picture".to_owned()),
        Patterns => finished(&|finish| finish.pattern().map(|kind| format!("is {}", kind.word()))),
        Wireframe => finished(&|finish| (finish.lines > 0.0).then(|| "has lines".to_owned())),
        AntiAliasing => (scene.samples > 1).then(|| format!("{} rays per pixel", scene.samples)),
        DepthOfField => (scene.lens.diameter > 0.0)
            .then(|| format!("the camera has a lens of diameter {}", scene.lens.diameter)),
        MotionBlur => count(scene.moving(), "sphere").map(|n| format!("{n} under way")),
        History => scene.motion.as_ref().map(|motion| match motion.pieces.len() {
            0 => "the camera moves from frame to frame".to_owned(),
            1 => "1 placed mesh moves from frame to frame".to_owned(),
            count => format!("{count} placed meshes move from frame to frame"),
        }),
    }
}

fn why_not(effect: Effect) -> &'static str {
    match effect {
        Triangles => "no mesh is placed",
        Textures => "no material in use has a texture",
        FilteredTextures => "no material in use has a texture, or none is to be filtered",
        NormalMaps => "no material in use has a normal map",
        CutOut => "no material in use has holes",
        Blended => "every material in use is opaque",
        Spheres => "no sphere",
        Boxes => "no box",
        SweptSpheres => "no strand",
        Heightfield => "no heightfield",
        Plane => "no plane",
        Solids => "no solid",
        Tori => "no torus",
        PointShadows => "no point light casts shadows",
        DirectionalShadows => "no directional light casts shadows",
        AreaLight => "no light that casts shadows has a size",
        Mirror => "nothing in use mirrors, or paths end at once",
        RoughMetal => "no material in use has a roughness",
        Bounces => "no bounces",
        Glass => "no material in use is glass, or paths end at once",
        Emitters => "no sphere and no mesh shines, or nothing scatters light",
        Environment => "the sky is not a picture",
        Patterns => "no material in use has a pattern",
        Wireframe => "no material in use has lines",
        AntiAliasing => "one ray per pixel",
        DepthOfField => "the camera is a pinhole",
        MotionBlur => "nothing moves while the shutter is open",
        History => "nothing moves from frame to frame",
    }
}
