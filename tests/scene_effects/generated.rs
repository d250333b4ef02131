//! Scenes generated from sets of effects, each with exactly the effects of its set.

use std::fs;
use std::path::{Path, PathBuf};

use common::gpu::ShaderEnum;
use effects::Effect::{self, *};
use effects::Effects;
use reference::random::Random;

/// A number with two digits, so that its text and its float are equal.
fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    (random.between(low, high) * 100.0).round() / 100.0
}

/// The effects of a set that a scene can have together: holes, textures and lines need triangles, a light's
/// size needs shadows, and a mirror, a pattern, glass and an emitter need a surface.
pub fn possible(mut set: Effects) -> Effects {
    for &effect in Effect::ALL {
        if !needed_by(effect).iter().all(|&needed| set.has(needed)) {
            set = set.without(effect);
        }
    }
    if !set.has_any(&[PointShadows, DirectionalShadows]) {
        set = set.without(AreaLight);
    }
    if !set.has_any(&[Triangles, Spheres, Boxes, SweptSpheres, Plane, Solids, Tori]) {
        set = set.without(Mirror);
    }
    if !set.has_any(&[Triangles, Spheres]) {
        set = set.without(Emitters);
    }
    if !set.has_any(&[Triangles, Spheres, Boxes, SweptSpheres, Solids, Tori]) {
        set = set.without(Patterns).without(Glass).without(RoughMetal);
    }
    set
}

/// The effects required by an effect: holes, textures and lines are on triangles.
fn needed_by(effect: Effect) -> &'static [Effect] {
    match effect {
        Textures | NormalMaps | CutOut | Blended | Wireframe => &[Triangles],
        FilteredTextures => &[Triangles, Textures],
        MotionBlur => &[Spheres],
        _ => &[],
    }
}

/// Two effects that no set has in one of the four possible ways: neither, one, the other, both.
pub fn unseen(sets: &[Effects]) -> Option<(Effect, Effect)> {
    let ways = [(false, false), (true, false), (false, true), (true, true)];
    let is_seen = |a: Effect, b: Effect| {
        let all = ways.iter().filter(|&&(with_a, with_b)| {
            let is_possible = with_a || !with_b || !needed_by(b).contains(&a);
            is_possible && !sets.iter().any(|set| set.has(a) == with_a && set.has(b) == with_b)
        });
        all.count() == 0
    };
    let pairs = Effect::ALL.iter().flat_map(|&a| Effect::ALL.iter().map(move |&b| (a, b)));
    pairs.filter(|&(a, b)| a < b).find(|&(a, b)| !is_seen(a, b))
}

/// Sixteen sets that contain each pair of effects in all four possible ways.
///
/// Each effect is in half of the sets, and never in the first: of two different halves neither contains the
/// other, they have a set in common, and none has the first (Kleitman and Spencer, "Families of k-independent
/// sets", 1973: that is enough for thousands of effects). [`possible`] removes some again. So while a pair is
/// missing, one of its effects gets another half. No ray leaves a surface in the second set.
pub fn all_pairs() -> Vec<Effects> {
    let mut random = Random(16);
    let mut halves: Vec<u32> =
        Effect::ALL.iter().map(|&effect| half(&mut random, effect)).collect();
    for _ in 0..10_000 {
        let set = |row: u32| {
            let chosen = Effect::ALL.iter().zip(&halves).filter(|(_, half)| **half >> row & 1 == 1);
            chosen.fold(Effects::default(), |set, (effect, _)| set.with(*effect))
        };
        let sets: Vec<Effects> = (0..16).map(set).map(possible).collect();
        let other = match unseen(&sets) {
            None if leaves_nothing(&sets[1]) => return sets,
            Some(pair) if random.below(2) == 0 => pair.0,
            Some(pair) if random.below(2) == 0 => pair.1,
            _ => Effect::ALL[random.below(Effect::ALL.len())],
        };
        halves[other as usize] = half(&mut random, other);
    }
    panic!("no sixteen sets have all pairs");
}

/// The effects with which rays leave a surface.
const LEAVING: [Effect; 8] =
    [PointShadows, DirectionalShadows, Mirror, RoughMetal, Bounces, Glass, Emitters, Environment];

/// Returns whether something is visible, and no ray leaves it: only a pipeline without such rays computes no
/// start.
fn leaves_nothing(set: &Effects) -> bool {
    set.has_any(&[Triangles, Spheres, Boxes, SweptSpheres, Solids, Tori]) && !set.has_any(&LEAVING)
}

/// A random half of sixteen sets for an effect: without the first, and if rays leave surfaces by it, without the
/// second.
fn half(random: &mut Random, effect: Effect) -> u32 {
    let among = if LEAVING.contains(&effect) { 0xfffc } else { 0xfffe };
    loop {
        let bits = random.bits() as u32 & among;
        if bits.count_ones() == 8 {
            return bits;
        }
    }
}

/// Writes a scene with a set of effects, and its model, to a folder.
pub fn write(folder: &Path, name: &str, set: Effects, random: &mut Random) -> PathBuf {
    fs::write(folder.join("model.obj"), MODEL).unwrap();
    fs::write(folder.join("model.mtl"), MATERIALS).unwrap();
    let checks = |x: u32, y: u32| match (x / 4 + y / 4) % 2 {
        0 => image::Rgba([200, 60, 30, 255]),
        _ => image::Rgba([40, 120, 180, 0]),
    };
    image::RgbaImage::from_fn(16, 16, checks).save(folder.join("checks.png")).unwrap();
    let dents = |x: u32, y: u32| image::Rgb([(8 + 16 * x) as u8, (8 + 16 * y) as u8, 200]);
    image::RgbImage::from_fn(16, 16, dents).save(folder.join("dents.png")).unwrap();
    let gauze = |x: u32, y: u32| image::Rgba([255, 255, 255, (8 * (x + y)) as u8]);
    image::RgbaImage::from_fn(16, 16, gauze).save(folder.join("gauze.png")).unwrap();
    let path = folder.join(name).with_extension("toml");
    fs::write(&path, text(set, random)).unwrap();
    path
}

const MODEL: &str = "mtllib model.mtl
v -1 0 0
v 1 0 0
v 1 2 0
v -1 2 0
v 0 0 1.5
vt 0 0
vt 2 0
vt 2 2
vt 0 2
o tent
usemtl plain
f 1 5 4
f 5 2 3
f 5 3 4
o picture
usemtl painted
f 1/1 2/2 3/3 4/4
o lattice
usemtl pierced
f 1/1 2/2 3/3 4/4
o veil
usemtl veil
f 1/1 2/2 3/3 4/4
o mat
usemtl scuffed
f 1/1 2/2 3/3 4/4
o relief
usemtl dented
f 1/1 2/2 3/3 4/4
";

const MATERIALS: &str = "newmtl plain
Kd 0.6 0.5 0.4
Ks 0 0 0
illum 2
newmtl painted
Kd 1 1 1
Ks 0 0 0
illum 2
map_Kd checks.png
newmtl scuffed
Kd 0.6 0.4 0.3
Pr 0.7
Pm 0.9
map_Pr checks.png
map_Pm checks.png
newmtl dented
Kd 0.5 0.6 0.5
Ks 0.3 0.3 0.3
Ns 40
illum 2
norm dents.png
newmtl veil
Kd 0.7 0.3 0.5
Ks 0 0 0
illum 2
d 0.6
newmtl gauze
Kd 0.3 0.4 0.6
Ks 0 0 0
illum 2
map_d gauze.png
newmtl pierced
Kd 0.3 0.5 0.3
Ks 0 0 0
illum 2
map_d checks.png
";

fn text(set: Effects, random: &mut Random) -> String {
    let has = |effect| set.has(effect);
    let mut n = |low, high| between(random, low, high);
    let mut text = format!(
        "version = 1\nmodel = \"model.obj\"\n[picture]\nsamples = {}\nlight_samples = 3\ndepth = 3\n\
         bounces = {}\nfiltered = {}\n",
        if has(AntiAliasing) { 2 } else { 1 },
        if has(Bounces) { 2 } else { 0 },
        has(FilteredTextures)
    );
    let (x, y) = (n(-1.5, 1.5), n(1.2, 2.4));
    text += &format!("[camera]\neye = [{x}, {y}, 7]\ntarget = [0, 0.6, 0]\nfield_of_view = 48\n");
    if has(History) {
        text += &format!("orbit = {}\n", n(-40.0, 40.0));
    }
    if has(DepthOfField) {
        text += &format!("lens = {{ diameter = {}, blades = 6 }}\n", n(0.05, 0.3));
    }
    if has(Environment) {
        text += &format!(
            "[sky]\nname = \"evening\"\nrotation = {}\nbrightness = {}\n",
            n(-90.0, 90.0),
            n(0.5, 1.5)
        );
    }
    // Both kinds of light are everywhere; only the effect decides which casts shadows.
    let size = if has(AreaLight) { 0.2 } else { 0.0 };
    text += &format!(
        "[[light]]\nkind = \"directional\"\nazimuth = {}\nelevation = {}\nradiance = [2, 2, 1.6]\n\
         size = {size}\nshadows = {}\n",
        n(270.0, 330.0),
        n(25.0, 50.0),
        has(DirectionalShadows)
    );
    text += &format!(
        "[[light]]\nkind = \"point\"\nposition = [{}, 3, {}]\nintensity = [6, 7, 9]\n\
         size = {size}\nshadows = {}\n",
        n(0.0, 2.0),
        n(1.0, 3.0),
        has(PointShadows)
    );
    let mirror = has(Mirror);
    for (name, pattern) in [("metal", "marble"), ("paint", "wood"), ("sheet", "checker")] {
        text += &format!(
            "[[material]]\nname = \"{name}\"\ncolor = [{}, {}, {}]\nspecular = [0.6, 0.5, 0.4]\n\
             shininess = 80\nmirror = {}\n",
            n(0.1, 0.8),
            n(0.1, 0.8),
            n(0.1, 0.8),
            mirror && name != "paint"
        );
        if has(Patterns) {
            text += &format!(
                "pattern = \"{pattern}\"\nsecond = [{}, 0.3, 0.1]\nscale = {}\n",
                n(0.1, 0.8),
                n(1.0, 4.0)
            );
        }
        if has(Wireframe) && name == "sheet" {
            text += &format!("lines = {}\nink = [0.1, 0, 0.2]\n", n(0.5, 3.0));
        }
    }
    if has(Blended) {
        text += "[[material]]\nname = \"gauze\"\nblended = true\n";
    }
    if has(Glass) {
        text += &format!(
            "[[material]]\nname = \"crystal\"\nglass = \"thick\"\nindex = {}\n\
             through = [{}, 0.9, 0.8]\nspecular = [0.04, 0.04, 0.04]\nshininess = 90\n",
            n(1.2, 1.9),
            n(0.2, 1.0)
        );
    }
    if has(NormalMaps) {
        let look = if has(RoughMetal) {
            "roughness = 0.4\nmetallic = 1\n".to_owned()
        } else {
            format!("specular = [0.5, 0.5, 0.5]\nmirror = {mirror}\n")
        };
        text += &format!(
            "[[material]]\nname = \"beaten\"\ncolor = [0.5, 0.6, 0.7]\nnormal_map = \"hammered\"\n\
             normal_scale = {}\n{look}",
            n(0.5, 2.5)
        );
        if has(Glass) {
            text += "[[material]]\nname = \"pane\"\nglass = \"thin\"\nnormal_map = \"bevelled\"\n";
        }
    }
    if has(RoughMetal) {
        text += &format!(
            "[[material]]\nname = \"brushed\"\ncolor = [{}, 0.7, 0.4]\nroughness = {}\n\
             metallic = {}\n",
            n(0.5, 1.0),
            n(0.0, 1.0),
            n(0.0, 1.0)
        );
    }
    if has(Emitters) {
        text += &format!(
            "[[material]]\nname = \"lamp\"\ncolor = [{}, 0, 0]\nemission = [{}, 3, 2]\n",
            n(0.0, 0.5),
            n(1.0, 9.0)
        );
    }
    // Otherwise, every mesh of the model would be placed.
    if has(Triangles) {
        let pieces = [
            ("tent", "sheet", true),
            ("tent", "crystal", has(Glass)),
            ("tent", "lamp", has(Emitters)),
            ("tent", "brushed", has(RoughMetal)),
            ("mat", "", has(RoughMetal) && has(Textures)),
            ("picture", "", has(Textures)),
            ("relief", "", has(NormalMaps)),
            ("relief", "beaten", has(NormalMaps)),
            ("relief", "pane", has(NormalMaps) && has(Glass)),
            ("lattice", "", has(CutOut)),
            ("lattice", "gauze", has(Blended)),
            ("veil", "", has(Blended)),
        ];
        for (mesh, material, placed) in pieces {
            if placed {
                text += &format!(
                    "[[piece]]\nmesh = \"{mesh}\"\nat = [{}, 0.02, {}]\nturn = {}\n",
                    n(-2.0, 2.0),
                    n(-2.0, 1.5),
                    n(-40.0, 40.0)
                );
                if has(History) && material != "lamp" {
                    text +=
                        &format!("way = [{}, 0.3, 0.1]\nspin = {}\n", n(-2.0, 2.0), n(-90.0, 90.0));
                }
                if !material.is_empty() {
                    text += &format!("material = \"{material}\"\n");
                }
            }
        }
    } else {
        text = text.replace("model = \"model.obj\"\n", "");
    }
    let worn =
        [("metal", true), ("paint", true), ("crystal", has(Glass)), ("brushed", has(RoughMetal))];
    let worn = worn.iter().filter(|(_, is_worn)| *is_worn);
    for (number, &(material, _)) in worn.enumerate() {
        let (x, z) = (n(-2.5, 2.5), n(-2.0, 3.0));
        let radius = n(0.3, 0.7);
        if has(Spheres) {
            text += &format!(
                "[[sphere]]\ncenter = [{x}, {radius}, {z}]\nradius = {radius}\nmaterial = \"{material}\"\n"
            );
            if has(MotionBlur) && material != "crystal" {
                text += &format!("moves = [{}, 0.1, {}]\n", n(-0.6, 0.6), n(-0.6, 0.6));
            }
        }
        let (x, z) = (n(-2.5, 2.5), n(-2.0, 3.0));
        if has(Boxes) {
            text += &format!(
                "[[box]]\nlow = [{x}, 0, {z}]\nhigh = [{}, {}, {}]\nmaterial = \"{material}\"\n",
                x + 0.5,
                n(0.3, 1.0),
                z + 0.5
            );
        }
        let (x, z) = (n(-2.5, 2.5), n(-2.0, 3.0));
        if has(SweptSpheres) && material != "crystal" {
            text += &format!(
                "[[strand]]\nnodes = [[{x}, 0.3, {z}, 0.2], [{x}, {}, {z}, 0.1], [{}, 1.1, {z}, 0]]\n\
                 material = \"{material}\"\n",
                n(0.6, 0.9),
                n(-2.5, 2.5)
            );
        }
        let (x, z) = (n(-2.5, 2.5), n(-2.0, 3.0));
        if has(Solids) {
            let side = ["1", "-1"];
            let planes = side.map(|x| side.map(|y| side.map(|z| format!("[{x}, {y}, {z}, 0.4]"))));
            let planes = planes.concat().concat().join(", ");
            text += &format!(
                "[[solid]]\ncenter = [{x}, {}, {z}]\nplanes = [{planes}]\nmaterial = \"{material}\"\n",
                0.5 + number as f64
            );
        }
        let (x, z) = (n(-2.5, 2.5), n(-2.0, 3.0));
        if has(Tori) {
            text += &format!(
                "[[torus]]\ncenter = [{x}, 0.7, {z}]\naxis = [{}, 1, {}]\nradius = {}\ntube = {}\n\
                 material = \"{material}\"\n",
                n(-2.0, 2.0),
                n(-2.0, 2.0),
                n(0.3, 0.6),
                n(0.03, 0.3)
            );
        }
    }
    if has(Emitters) && has(Spheres) {
        text += &format!(
            "[[sphere]]\ncenter = [{}, {}, 1]\nradius = 0.25\nmaterial = \"lamp\"\n",
            n(-2.0, 2.0),
            n(0.3, 1.5)
        );
    }
    if has(Heightfield) {
        text += &format!(
            "[heightfield]\nlow = [-12, -14]\nhigh = [12, -3]\nhills = {}\nhill = [9, 8]\nridges = 0.1\n\
             ridge = [2, 3]\nlight = [0.5, 0.4, 0.2]\ndark = [0.1, 0.2, 0.05]\nrock = [0.3, 0.2, 0.2]\n",
            n(0.6, 1.4)
        );
    }
    if has(Plane) {
        text += &format!(
            "[plane]\nnormal = [0, 2, {}]\nlight = [0.6, 0.5, 0.3]\ndark = [0.1, 0.05, 0.02]\n\
             reflection = {}\n",
            n(-0.1, 0.1),
            if mirror { 0.2 } else { 0.0 }
        );
    }
    text
}
