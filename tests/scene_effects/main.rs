//! 25_scene_effects: the effects a scene triggers; nothing else is compiled, and no picture changes.

mod alpha;
mod compiled;
mod departures;
mod generated;
mod history;
mod light;
mod lines;
mod normals;
mod plots;
mod rough;
mod sky;
mod time;
mod tori;
mod why;

use std::collections::BTreeSet;
use std::path::Path;

use common::app::Picture;
use common::gpu::ShaderEnum;
use effects::Effect::*;
use effects::{Effect, Effects, findings, needed};
use reference::random::Random;
use serde_json::{Value, json};

use run::{Chapter, Run, bits, expected, golden, render, root, same_colors, set_arguments};

const NAME: &str = "25_scene_effects";

/// The chapter's own scenes: the effects of each, and the stages, listed by hand. Every pipeline has
/// `camera.rgen` and `sky.rmiss`.
const SCENES: [(&str, &[Effect], &[&str]); 23] = [
    ("one sphere", &[Spheres], &["sphere.rint", "shape.rchit"]),
    ("two kings", &[Triangles], &["mesh.rchit"]),
    ("empty board", &[Plane], &[]),
    ("opening", &[Triangles, DirectionalShadows], &["common/shadow.rmiss", "mesh.rchit"]),
    ("lamp at night", &[Triangles, Plane, PointShadows], &["common/shadow.rmiss", "mesh.rchit"]),
    (
        "soft evening",
        &[Triangles, Plane, DirectionalShadows, AreaLight],
        &["common/shadow.rmiss", "mesh.rchit"],
    ),
    (
        "fretwork",
        &[Triangles, Textures, FilteredTextures, CutOut, DirectionalShadows],
        &["common/shadow.rmiss", "mesh.rchit", "cut_out.rahit"],
    ),
    (
        "knight",
        &[Triangles, DirectionalShadows, AntiAliasing],
        &["common/shadow.rmiss", "mesh.rchit"],
    ),
    (
        "bauhaus",
        &[Spheres, Boxes, DirectionalShadows],
        &["common/shadow.rmiss", "sphere.rint", "box.rint", "shape.rchit"],
    ),
    (
        "mirror balls",
        &[Spheres, Plane, DirectionalShadows, Mirror],
        &["common/shadow.rmiss", "sphere.rint", "shape.rchit"],
    ),
    (
        "solids",
        &[Plane, Solids, DirectionalShadows],
        &["common/shadow.rmiss", "solid.rint", "solid.rchit"],
    ),
    (
        "knot",
        &[SweptSpheres, Plane, DirectionalShadows, Mirror],
        &["common/shadow.rmiss", "strand.rint", "strand.rchit"],
    ),
    (
        "chain",
        &[Plane, Tori, DirectionalShadows, Mirror],
        &["common/shadow.rmiss", "torus.rint", "torus.rchit"],
    ),
    (
        "lake",
        &[Triangles, Heightfield, Plane, DirectionalShadows, Mirror],
        &["common/shadow.rmiss", "mesh.rchit", "ground.rint", "ground.rchit"],
    ),
    (
        "colonnade",
        &[Triangles, Boxes, Spheres, Plane, Solids, DirectionalShadows, Mirror, Patterns],
        &[
            "common/shadow.rmiss",
            "mesh.rchit",
            "sphere.rint",
            "box.rint",
            "shape.rchit",
            "solid.rint",
            "solid.rchit",
        ],
    ),
    (
        "painted room",
        &[Triangles, Boxes, DirectionalShadows, AreaLight, Bounces, AntiAliasing],
        &["common/shadow.rmiss", "mesh.rchit", "box.rint", "shape.rchit"],
    ),
    (
        "crystal",
        &[Triangles, Spheres, Plane, DirectionalShadows, Bounces, Glass, AntiAliasing],
        &["common/shadow.rmiss", "mesh.rchit", "sphere.rint", "shape.rchit"],
    ),
    (
        "close up",
        &[Triangles, DirectionalShadows, AntiAliasing, DepthOfField],
        &["common/shadow.rmiss", "mesh.rchit"],
    ),
    (
        "globes",
        &[Triangles, Spheres, Plane, Mirror, Bounces, Glass, Emitters, AntiAliasing],
        &["common/shadow.rmiss", "mesh.rchit", "sphere.rint", "shape.rchit"],
    ),
    (
        "billiards",
        &[Spheres, Plane, DirectionalShadows, AntiAliasing, MotionBlur],
        &["common/shadow.rmiss", "sphere.rint", "shape.rchit"],
    ),
    (
        "rough gold",
        &[Triangles, RoughMetal, Bounces, Environment, AntiAliasing],
        &["common/shadow.rmiss", "mesh.rchit"],
    ),
    (
        "in motion",
        &[Triangles, DirectionalShadows, AreaLight, Bounces, History],
        &["common/shadow.rmiss", "mesh.rchit"],
    ),
    ("everything", STILL, &EVERY_STAGE),
];

/// The effects of a scene that does not move: all but the last.
const STILL: &[Effect] = match Effect::ALL.split_last() {
    Some((History, still)) => still,
    _ => panic!("the last effect is history"),
};

const EVERY_STAGE: [&str; 14] = [
    "common/shadow.rmiss",
    "mesh.rchit",
    "cut_out.rahit",
    "sphere.rint",
    "box.rint",
    "shape.rchit",
    "ground.rint",
    "ground.rchit",
    "solid.rint",
    "solid.rchit",
    "strand.rint",
    "strand.rchit",
    "torus.rint",
    "torus.rchit",
];

fn run(size: &str, scene: &[&str], sets: &[&str]) -> Run {
    Chapter::new(NAME).size(size).with(scene).sets(sets).run()
}

/// A pixel's number, and its colours in two pictures.
type Pair<'a> = (usize, (&'a [f32; 4], &'a [f32; 4]));

/// The pixels in which two pictures differ, and their largest difference.
fn differing<'a>(one: &'a Picture, other: &'a Picture) -> (Vec<Pair<'a>>, f32) {
    let pairs = one.pixels.iter().zip(&other.pixels).enumerate();
    let differ: Vec<Pair> = pairs.filter(|(_, (one, other))| one != other).collect();
    let most = |(_, (one, other)): &Pair| {
        one.iter().zip(other.iter()).fold(0.0, |most: f32, (a, b)| most.max((a - b).abs()))
    };
    let largest = differ.iter().map(most).fold(0.0, f32::max);
    (differ, largest)
}

/// Renders a scene with its own pipeline and with the one that has everything, checks that both pictures are
/// equal bit for bit, and returns the first run.
fn same_by_both(size: &str, scene: &[&str]) -> Run {
    let [own, everything] =
        ["specialised", "everything"].map(|p| run(size, scene, &[&format!("pipeline={p}")]));
    same_colors(&format!("{scene:?}"), NAME, &own.picture, &everything.picture);
    own
}

/// Checks that a run's pipeline has these stages, by the modules passed to the driver.
fn check_stages(report: &Value, effects: Effects, expected: &[&str], name: &str) {
    let pipeline = &report["chapter"]["pipeline"];
    assert_eq!(pipeline["effects"], json!(effects.names()), "{name}");
    let stages = pipeline["stages"].as_array().unwrap();
    let paths: BTreeSet<&str> =
        stages.iter().map(|stage| stage["path"].as_str().unwrap()).collect();
    let expected = [&["camera.rgen", "sky.rmiss"], expected].concat();
    let below_shaders = |stage: &&str| {
        if stage.contains('/') { (*stage).to_owned() } else { format!("{NAME}/{stage}") }
    };
    let expected: BTreeSet<String> = expected.iter().map(below_shaders).collect();
    assert_eq!(paths, expected.iter().map(String::as_str).collect(), "{name}");
    let lifts = effects.has_any(&[PointShadows, DirectionalShadows]);
    let shadows = lifts || effects.has_any(&[Emitters, Environment]);
    for stage in stages {
        let (path, module) = (stage["path"].as_str().unwrap(), &stage["module"]);
        let place = format!("{name}: {path}");
        let (kind, traces, reports) = match path.rsplit_once('.').unwrap().1 {
            // One location for all rays of the path, and one for all shadow rays.
            "rgen" => ("RayGeneration", 1 + u64::from(shadows), 0),
            "rmiss" => ("Miss", 0, 0),
            "rchit" => ("ClosestHit", 0, 0),
            "rahit" => ("AnyHit", 0, 0),
            _ => ("Intersection", 0, 1),
        };
        assert_eq!(module["stage"], kind, "{place}");
        assert_eq!(module["traces"], traces, "{place}: raygen traces every ray");
        assert_eq!(module["reports"], reports, "{place}");
        let textured = path.ends_with("cut_out.rahit")
            || path.ends_with("mesh.rchit") && effects.has_any(&[Textures, NormalMaps]);
        assert_eq!(module["samples"], textured, "{place}: reads textures");
    }
    let groups = &pipeline["groups"];
    let misses = 1 + u64::from(shadows);
    let kinds = [Triangles, Spheres, Boxes, SweptSpheres, Heightfield, Solids, Tori];
    let hits = kinds.into_iter().filter(|&kind| effects.has(kind)).count();
    assert_eq!(groups, &json!({ "raygen": 1, "miss": misses, "hit": hits }), "{name}");
    assert_eq!(pipeline["recursion"], 1, "{name}");
    // Position, distance, normal, material and colour; the start of new rays, height and face; the offset to
    // the round surface; roughness and metalness from textures; the body it came into; the emitter; its curvature; the
    // ray's cone; and the surface whose light is kept. A shadow ray has its own payload, a bool.
    let cones = effects.has_any(&[Plane, Heightfield, Wireframe, FilteredTextures]);
    let leaves = shadows || effects.has_any(&[Mirror, RoughMetal, Bounces, Glass, History]);
    let payload = 11
        + 4 * usize::from(leaves)
        + 3 * usize::from(lifts && effects.has(Triangles))
        + usize::from(effects.has(RoughMetal) && effects.has(Textures))
        + usize::from(effects.has(Glass))
        + usize::from(effects.has(Emitters) && effects.has_any(&[RoughMetal, Bounces]))
        + usize::from(cones && effects.has_any(&[Mirror, RoughMetal, Glass]))
        + 2 * usize::from(effects.has_any(&[Wireframe, FilteredTextures]))
        + usize::from(effects.has(History));
    for stage in stages {
        let path = stage["path"].as_str().unwrap();
        let floats = match path.rsplit_once('/').unwrap().1 {
            "shadow.rmiss" => 1,
            name if name.ends_with("rahit") || name.ends_with("rint") => 0,
            _ => payload,
        };
        assert_eq!(stage["module"]["payload"], 4 * floats, "{name}: {path}");
    }
    assert!(4 * payload <= 96, "{name}");
}

fn set_of(effects: &[Effect]) -> Effects {
    effects.iter().fold(Effects::default(), |set, &effect| set.with(effect))
}

#[test]
fn the_picture_is_the_golden_one() {
    // Tolerance set by llvmpipe (Mesa 25.0.7), which made the golden picture and reproduces it bit for bit.
    golden("25_scene_effects", &render(NAME, "240x150", &[]).picture, 0.002);
}

#[test]
fn every_scene_has_its_stages_and_looks_the_same_with_all_of_them() {
    for (name, effects, stages) in SCENES {
        // The first frame has no history.
        let frames = if effects.contains(&History) { "3" } else { "1" };
        let own = same_by_both("96x60", &["--set", &format!("scene={name}"), "--frames", frames]);
        check_stages(&own.report, set_of(effects), stages, name);
        let found = own.report["chapter"]["effects"].as_array().unwrap();
        let whys: Vec<&str> = found.iter().map(|found| found["why"].as_str().unwrap()).collect();
        assert!(whys.iter().all(|why| !why.is_empty()));
        if name == "fretwork" {
            let meshes: u32 = whys[0].split(' ').next().unwrap().parse().unwrap();
            expected::hold("25_scene_effects/fretwork", json!({ "meshes": meshes }));
        }
        println!("{name}: same to the bit");
    }
}

#[test]
#[ignore = "nightly: a pipeline for each effect; quick: taking_out_what_is_needed_changes_the_picture"]
fn taking_out_any_effect_changes_the_picture() {
    check_needed(STILL.iter().copied());
    history::check_needed();
}

#[test]
fn taking_out_what_is_needed_changes_the_picture() {
    check_needed(STILL.iter().copied().step_by(8));
    history::check_needed();
}

fn check_needed(effects: impl Iterator<Item = Effect>) {
    let with = |sets: &[&str]| run("120x75", &[], sets);
    let whole = with(&[]);
    for effect in effects {
        let without = with(&[&format!("without={}", effect.name())]);
        let pairs = whole.picture.pixels.iter().zip(&without.picture.pixels);
        let differ = pairs.filter(|(a, b)| a != b).count();
        println!("without {}: {differ} pixels differ", effect.name());
        assert!(differ > 8, "without {}: {differ} pixels differ", effect.name());
        let kept = set_of(STILL).without(effect);
        assert_eq!(without.report["chapter"]["pipeline"]["effects"], json!(kept.names()));
    }
}

#[test]
#[ignore = "nightly: compiles 16 pipelines; quick: every_scene_has_its_stages_and_looks_the_same_with_all_of_them"]
fn sixteen_scenes_cover_all_pairs_of_effects_and_look_the_same_by_both() {
    let sets = generated::all_pairs();
    assert_eq!(generated::unseen(&sets), None);
    check_generated(&sets, &mut Random(16));
}

#[test]
#[ignore = "nightly: 400 pictures; quick: every_scene_has_its_stages_and_looks_the_same_with_all_of_them"]
fn two_hundred_random_scenes_look_the_same_by_both() {
    let mut random = Random(200);
    let sets: Vec<Effects> = (0..200)
        .map(|_| generated::possible(Effects(random.bits() as u32 & Effects::everything().0)))
        .collect();
    check_generated(&sets, &mut random);
}

fn check_generated(sets: &[Effects], random: &mut Random) {
    let folder = tempfile::tempdir().unwrap();
    for (number, &set) in sets.iter().enumerate() {
        let file = generated::write(folder.path(), &number.to_string(), set, random);
        let scene = effects::open(&file).unwrap_or_else(|error| panic!("{error:#}"));
        assert_eq!(needed(&findings(&scene)).names(), set.names(), "{number}");
        let frames = if set.has(History) { "3" } else { "1" };
        let own = same_by_both("64x40", &["--scene", file.to_str().unwrap(), "--frames", frames]);
        assert_eq!(own.report["chapter"]["pipeline"]["effects"], json!(set.names()), "{number}");
    }
}

#[test]
fn a_model_alone_is_a_scene() {
    let chess = root().join("samples/assets/chess.obj");
    let own = same_by_both("96x60", &["--scene", chess.to_str().unwrap()]);
    let effects = [Triangles, Textures, CutOut, DirectionalShadows, Mirror];
    let stages = ["common/shadow.rmiss", "mesh.rchit", "cut_out.rahit"];
    check_stages(&own.report, set_of(&effects), &stages, "chess.obj");
}

#[test]
fn an_edit_that_changes_the_set_changes_the_pipeline() {
    let cases: [(&str, &[&str], Effect, bool); 10] = [
        ("opening", &["light size=0.2"], AreaLight, true),
        ("opening", &["light shadows=off"], DirectionalShadows, false),
        ("opening", &["material=black", "mirror=on"], Mirror, true),
        ("knight", &["samples=1"], AntiAliasing, false),
        ("mirror balls", &["depth=0"], Mirror, false),
        ("two kings", &["bounces=2"], Bounces, true),
        ("two kings", &["material=black", "glass=on"], Glass, true),
        ("crystal", &["depth=0"], Glass, false),
        ("two kings", &["sky=evening", "sky rotation=30"], Environment, true),
        ("two kings", &["lens diameter=0.5", "focus=3"], DepthOfField, true),
    ];
    for (scene, edits, effect, there) in cases {
        let mut effects = set_of(SCENES.iter().find(|(name, ..)| *name == scene).unwrap().1);
        effects = if there { effects.with(effect) } else { effects.without(effect) };
        let scene = format!("scene={scene}");
        let sets = [&[scene.as_str()], edits].concat();
        let own = same_by_both("48x30", &set_arguments(&sets));
        assert_eq!(
            own.report["chapter"]["pipeline"]["effects"],
            json!(effects.names()),
            "{edits:?}"
        );
    }
}

/// The entries of `Cargo.toml` for each chapter: its name and its effects.
fn declared() -> Vec<(String, Vec<String>)> {
    let manifest: toml::Value =
        toml::from_str(&std::fs::read_to_string(root().join("Cargo.toml")).unwrap()).unwrap();
    let chapters = manifest["package"]["metadata"]["chapters"].as_table().unwrap();
    let effects = chapters.iter().map(|(name, chapter)| {
        let list = chapter.get("effects").and_then(toml::Value::as_array);
        let text = |effect: &toml::Value| effect.as_str().unwrap().to_owned();
        (name.clone(), list.into_iter().flatten().map(text).collect())
    });
    effects.collect()
}

#[test]
fn every_effect_that_a_chapter_declares_is_in_the_table_and_in_the_shaders() {
    let declared = declared();
    for (chapter, effects) in &declared {
        for effect in effects {
            assert!(
                Effect::named(effect).is_some(),
                "{chapter} declares the effect '{effect}', which samples/25_scene_effects/effect.rs lacks"
            );
        }
    }
    for &effect in Effect::ALL {
        let by = declared.iter().filter(|(_, effects)| effects.iter().any(|e| e == effect.name()));
        assert_eq!(by.count(), 1, "one chapter declares the effect '{}'", effect.name());
    }
    let folder = root().join("shaders").join(NAME);
    let everything = std::fs::read_to_string(folder.join("effects.glsl")).unwrap();
    let sources: Vec<String> = files(&folder);
    for &effect in Effect::ALL {
        let define = effect.define();
        assert!(everything.contains(&format!("#define {define}\n")), "effects.glsl lacks {define}");
        // Each effect has its own stage or line. Geometry has none: its stages are chosen.
        let used = sources.iter().filter(|text| text.contains(&define)).count();
        let geometry =
            [Triangles, Spheres, Boxes, SweptSpheres, Heightfield, Solids, Tori].contains(&effect);
        assert!(used > 1 || geometry, "no shader asks for {define}");
    }
}

fn files(folder: &Path) -> Vec<String> {
    let files = folder.read_dir().unwrap().map(|file| file.unwrap().path());
    files.map(|file| std::fs::read_to_string(file).unwrap()).collect()
}

#[test]
fn the_page_lists_every_scene_and_every_effect() {
    let page = |file: &str| std::fs::read_to_string(root().join(file)).unwrap();
    let page = page("docs/25_scene_effects.md") + &page("docs/measurements/25_scene_effects.md");
    for (name, ..) in SCENES {
        let file = format!("{}.toml", name.replace(' ', "_"));
        assert!(page.contains(&format!("(../samples/assets/scenes/{file})")), "{file}");
    }
    for &effect in Effect::ALL {
        assert!(page.contains(&format!("| {} |", effect.name())), "{}", effect.name());
    }
}

/// The page about the format.
fn format_page() -> String {
    std::fs::read_to_string(root().join("docs/scene-format.md")).unwrap()
}

#[test]
fn the_page_of_the_format_lists_every_key() {
    let page = format_page();
    // The keys that the file reader accepts, table by table.
    let tables = ["[camera]", "[picture]", "[sky]", "[plane]", "[heightfield]"];
    let lists = [
        "[[light]]",
        "[[material]]",
        "[[piece]]",
        "[[sphere]]",
        "[[box]]",
        "[[solid]]",
        "[[strand]]",
        "[[torus]]",
    ];
    let folder = tempfile::tempdir().unwrap();
    for table in tables.iter().chain(&lists).chain(&[""]) {
        let file = folder.path().join("s.toml");
        std::fs::write(&file, format!("version = 1\n{table}\nunheard_of = 1\n")).unwrap();
        let error = effects::open(&file).err().unwrap().to_string();
        let known = error.split_once("; there is ").expect(&error).1.replace(" or ", ", ");
        let rows =
            page.split_once(&format!("| `{table}` |")).map_or(page.as_str(), |split| split.1);
        let rows = &rows[..rows.find("\n| `[").or(rows.find("\n\n")).unwrap()];
        for key in known.split(", ").map(|key| format!("`{}`", key.trim_matches('`'))) {
            let there = if table.is_empty() {
                page.contains(&key) || page.contains(&format!("[{}]", key.trim_matches('`')))
            } else {
                let valued = format!("{} =", key.trim_end_matches('`'));
                rows.contains(&key) || rows.contains(&valued)
            };
            assert!(there, "{table} {key} is not on the page");
        }
    }
}

/// Its example is a valid scene, and each line of its table of refusals turns it into one that is refused
/// accordingly.
#[test]
fn the_page_of_the_format_is_true() {
    let page = format_page();
    let (_, example) = page.split_once("```toml\n").unwrap();
    let (example, _) = example.split_once("```").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("s.toml");
    let opened = |text: &str| {
        std::fs::write(&file, text).unwrap();
        let told = effects::open(&file).map_err(|error| format!("{error:#}"));
        told.map_err(|line| line.replace(&file.display().to_string(), "s.toml"))
    };
    let scene = opened(example).unwrap();
    assert_eq!((scene.spheres.len(), scene.lights.len()), (1, 1));
    let (_, rows) = page.split_once("| line | message |\n|---|---|\n").unwrap();
    let rows: Vec<_> = rows.lines().take_while(|line| line.starts_with('|')).collect();
    for row in &rows {
        let cells: Vec<_> = row.trim_matches('|').split(" | ").map(str::trim).collect();
        let [line, told] = cells[..] else { panic!("{row}") };
        let code = |cell: &str| match cell.strip_prefix("`` ") {
            Some(rest) => rest.trim_end_matches(" ``").to_owned(),
            None => cell.trim_matches('`').to_owned(),
        };
        let (line, told) = (code(line), code(told));
        let key = line.split_once('=').unwrap().0;
        let same = |old: &&str| old.starts_with(key);
        let text = match example.lines().find(same) {
            Some(old) => example.replace(old, &line),
            None => format!("{example}{line}\n"),
        };
        assert_eq!(opened(&text).err().as_deref(), Some(&*told), "{line}");
    }
    assert!(rows.len() > 6, "{rows:?}");
}

#[test]
fn each_gathered_sample_has_rays_of_its_own() {
    let rays = |rays: &str, more: &[&str]| {
        let scene = ["--set", "scene=soft evening", "--set", rays];
        render(NAME, "48x30", &[&scene, more].concat()).picture
    };
    let gathered = |samples: &str| rays("samples=2", &["--samples", samples]);
    let [first, second, both] = ["0..1", "1..2", "0..2"].map(gathered);
    assert_eq!(bits(&first), bits(&rays("samples=2", &[])), "the first sample is the picture");
    let four = rays("samples=4", &[]);
    for (i, mean) in both.pixels.iter().enumerate() {
        for (channel, &mean) in mean.iter().take(3).enumerate() {
            let [a, b] = [&first, &second].map(|p| f64::from(p.pixels[i][channel]));
            assert_eq!(mean.to_bits(), (((a + b) / 2.0) as f32).to_bits(), "pixel {i}");
            // The same four rays, added in another order: three sums are rounded, and a division has an error
            // of up to the 2.5 units that Vulkan allows, in either direction.
            let bound = 2.0 * (3.0 + 5.0) * 0.5f64.powi(24) * f64::from(mean);
            let error = f64::from(four.pixels[i][channel] - mean).abs();
            assert!(error <= bound, "pixel {i}: {} and {}", four.pixels[i][channel], mean);
        }
    }
    assert_ne!(bits(&first), bits(&second), "the second sample has the rays of the first");
}

#[test]
fn rays_beyond_the_last_number_are_refused_and_not_those_of_the_first_again() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a.png");
    let sets =
        ["--headless", "--size", "8x8", "--set", "scene=soft evening", "--set", "samples=64"];
    // 64 rays per sample: this one would begin with ray 2^32.
    let last = ["--samples", "67108864..67108865", "--out", out.to_str().unwrap()];
    let (code, line) = run::refused(NAME, &[&sets[..], &last].concat());
    assert!(code == 1 && line.contains("rays are numbered up to 2^32"), "{code}: {line}");
    assert!(!out.exists());
}
