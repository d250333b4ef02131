//! 15_opacity_micromaps: the picture of 03 at every level, correct states, and the savings.

use std::fmt::Write;
use std::fs;

use common::scene::Scene;
use glam::{DVec2, Vec2};
use reference::random::Random;
use reference::rational::rational;
use serde_json::{Map, Value, json};

use run::{Chapter, expected, refused, render, root, same_answers, same_colors};

#[allow(dead_code)]
#[path = "../../samples/15_opacity_micromaps/alpha.rs"]
mod alpha;
#[allow(dead_code)]
#[path = "../../samples/15_opacity_micromaps/classify.rs"]
mod classify;
#[allow(dead_code)]
#[path = "../../samples/15_opacity_micromaps/curve.rs"]
mod curve;

mod device;

use alpha::Alpha;
use classify::{Rule, SLACK};
use curve::{FINEST, State};

const NAME: &str = "15_opacity_micromaps";
const PARENT: &str = "03_any_hit";
const SIZE: &str = "96x60";
const LEVELS: [&str; 8] = ["none", "0", "1", "2", "3", "4", "5", "6"];
/// This chapter's view, for 03.
const BEHIND: [&str; 3] =
    ["camera eye=2.4,2.1,-7.4", "camera target=0.3,1.2,-2", "field of view=40"];
/// 03's view, for this chapter.
const BEFORE: [&str; 3] =
    ["camera eye=-5.6,4.8,9.2", "camera target=0.35,0.3,-0.2", "field of view=37"];

fn chapter(name: &str) -> Chapter {
    Chapter::new(name).size(SIZE)
}

/// The sum of what a view counts.
fn counted(view: &str, level: &str) -> f64 {
    let picture = chapter(NAME).set("show", view).set("level", level).picture();
    picture.pixels.iter().map(|pixel| f64::from(pixel[3])).sum()
}

#[test]
fn holes_without_texture_coordinates_are_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no leaf\nusemtl a\nf 1 2 3\n";
    fs::write(folder.path().join("a.obj"), obj).unwrap();
    fs::write(folder.path().join("a.mtl"), "newmtl a\nmap_d a.png\n").unwrap();
    image::RgbaImage::from_pixel(2, 2, image::Rgba([255; 4]))
        .save(folder.path().join("a.png"))
        .unwrap();
    let scene = folder.path().join("a.obj");
    let arguments =
        ["--headless", "--validate", "--size", "8x8", "--scene", scene.to_str().unwrap()];
    let output = run::command(NAME).args(arguments).output().unwrap();
    assert!(output.status.success());
    let said = String::from_utf8_lossy(&output.stderr);
    let words = "a.mtl:2: map_d is on faces without texture coordinates; write vt";
    assert!(said.lines().count() == 1 && said.contains(words), "{said}");
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).repeats();
}

#[test]
fn every_level_gives_the_picture_of_03() {
    let parent = chapter(PARENT).sets(&BEHIND).picture();
    let hits = chapter(PARENT).sets(&["show=hit"]).sets(&BEHIND).picture();
    for level in LEVELS {
        let level = format!("level={level}");
        same_colors(&level, NAME, &chapter(NAME).sets(&[&level]).picture(), &parent);
    }
    same_answers("hits", NAME, &chapter(NAME).sets(&["level=6", "show=hit"]).picture(), &hits);
    let parent = chapter(PARENT).picture();
    let before = chapter(NAME).sets(&["level=6"]).sets(&BEFORE).picture();
    same_colors("from before the screen", NAME, &before, &parent);
}

#[test]
fn four_samples_give_another_picture() {
    let parent = chapter(PARENT).size("240x150").sets(&BEHIND).picture();
    let mut held = Map::new();
    for level in &LEVELS[1..] {
        let sampled = chapter(NAME).size("240x150").set("level", level);
        let sampled = sampled.sets(&["rule=samples"]).picture();
        let pairs = sampled.pixels.iter().zip(&parent.pixels);
        let wrong = pairs.filter(|(a, b)| a != b).count();
        println!("level {level}: {wrong} of {} pixels are wrong", parent.pixels.len());
        assert!(wrong > 0, "level {level}");
        held.insert((*level).into(), wrong.into());
    }
    held.insert("pixels".into(), parent.pixels.len().into());
    expected::hold("15_opacity_micromaps/samples", Value::Object(held));
}

#[test]
fn fewer_calls_read_the_texture_the_finer_the_level() {
    let calls = counted("calls", "none");
    let mut held = json!({ "calls": calls, "pixels": 96 * 60 });
    // Each candidate causes a call, however little it does.
    assert_eq!(counted("calls", "6"), calls);
    let mut before = calls;
    for level in LEVELS {
        let reads = counted("reads", level);
        println!("level {level}: {reads} of {calls} calls read the texture");
        assert!(reads <= before, "level {level}: {reads} reads after {before}");
        before = reads;
        held[level] = json!(reads / calls);
    }
    assert_eq!(held["none"], 1.0);
    assert!(before < 0.4 * calls, "{before} of {calls}");
    expected::hold("15_opacity_micromaps/reads", held);
}

#[test]
fn states_by_level() {
    let model = Scene::chess().unwrap().model;
    let screen = model.meshes.iter().find(|mesh| mesh.name == "screen").unwrap();
    let texture = &model.textures[model.materials[screen.material].opacity_texture.unwrap()];
    let alpha = Alpha::new(texture.width, texture.height, &texture.rgba);
    let mut held = Map::new();
    for level in 0..=FINEST {
        let states = screen.triangles.iter().flat_map(|corners| {
            let corners = corners.map(|corner| screen.vertices[corner as usize].uv);
            classify::triangle(&alpha, corners, level, Rule::Conservative)
        });
        let states: Vec<_> = states.collect();
        let is_known = |&&state: &&State| matches!(state, State::Opaque | State::Transparent);
        let unknown = 1.0 - states.iter().filter(is_known).count() as f64 / states.len() as f64;
        held.insert(
            format!("{level}.bytes"),
            (screen.triangles.len() * curve::bytes(level)).into(),
        );
        held.insert(format!("{level}.unknown"), unknown.into());
    }
    let report = &render(NAME, "8x8", &["--set", "level=6"]).report["chapter"];
    assert_eq!([&report["bytes"], &report["unknown"]], [&held["6.bytes"], &held["6.unknown"]]);
    expected::hold_exact("15_opacity_micromaps/states", Value::Object(held));
}

/// The results of the specification's function for the middles of the 64 micro-triangles of level 3: in rows
/// of increasing v, and within a row by increasing u.
const LEVEL_3: [u32; 64] = [
    0, 1, 2, 7, 8, 9, 10, 31, 32, 33, 34, 39, 40, 41, 42, //
    3, 4, 5, 6, 11, 30, 29, 28, 35, 36, 37, 38, 43, //
    14, 13, 12, 19, 20, 21, 22, 27, 46, 45, 44, //
    15, 16, 17, 18, 23, 24, 25, 26, 47, //
    58, 57, 56, 55, 50, 49, 48, //
    59, 54, 53, 52, 51, //
    60, 61, 62, //
    63,
];

#[test]
fn the_order_is_the_specification_s() {
    let mut places: Vec<_> = (0..64)
        .map(|index| {
            let sum = |i: usize| curve::corners(index, 3).iter().map(|w| w[i]).sum::<i32>();
            // A middle's weights in 24ths; a row has those of 3k to 3k + 2.
            (sum(2) / 3, sum(1), index)
        })
        .collect();
    places.sort_unstable();
    assert_eq!(places.iter().map(|place| place.2).collect::<Vec<_>>(), LEVEL_3);
}

#[test]
fn states_are_packed_from_the_lowest_bit() {
    use State::{Opaque, Transparent, UnknownOpaque, UnknownTransparent};
    assert_eq!(curve::pack(&[Opaque]), [0b01]);
    let five = [Transparent, Opaque, UnknownTransparent, UnknownOpaque, UnknownOpaque];
    assert_eq!(curve::pack(&five), [0b1110_0100, 0b11]);
    assert_eq!([0, 1, 2, 6].map(curve::bytes), [1, 1, 4, 1024]);
}

/// The search of `micromap.glsl` in Rust, with the same roundings.
fn micro_triangle(u: f32, v: f32, level: u32) -> u32 {
    let mut w = [1.0 - u - v, u, v];
    (0..level).fold(0, |index, _| {
        let part = match w {
            [a, b, c] if a >= 0.5 => {
                w = [2.0 * a - 1.0, 2.0 * b, 2.0 * c];
                0
            }
            [a, b, c] if b >= 0.5 => {
                w = [2.0 * a, 2.0 * b - 1.0, 2.0 * c];
                2
            }
            [a, b, c] if c >= 0.5 => {
                w = [2.0 * b, 2.0 * a, 2.0 * c - 1.0];
                3
            }
            [a, b, c] => {
                w = [1.0 - 2.0 * b, 1.0 - 2.0 * a, 1.0 - 2.0 * c];
                1
            }
        };
        4 * index + part
    })
}

#[test]
fn the_shader_finds_each_micro_triangle_and_never_leaves_the_triangle() {
    let shaders = run::copy_of_shaders();
    let text = fs::read_to_string(shaders.path().join(NAME).join("micromap.glsl")).unwrap();
    let start = text.find("uint micro_triangle").unwrap();
    let (function, _) = text[start..].split_once("\n}\n").unwrap();
    let function = format!("{function}\n}}\n");
    // A row for each of 16 columns of u, beyond the triangle on every side, and NaN.
    let body = "
        vec2 uv = vec2(at) / vec2(37.0, 23.0) * 1.2 - 0.1;
        if (at.x == 0) uv.x = uintBitsToFloat(0x7fc00000u);
        if (at.y == 0) uv.y = -1e30;
        for (int level = 0; level <= 6; level += 2) {
            vec3 w = vec3(1.0 - uv.x - uv.y, uv);
            uint index = micro_triangle(w, level);
            answer[level / 2] = index >> (2 * level) == 0 ? float(index) : -1.0;
        }";
    let answers = run::evaluate(&function, body, "38x24");
    for (i, pixel) in answers.pixels.iter().enumerate() {
        assert!(pixel.iter().all(|&index| index >= 0.0), "{i}: {pixel:?}");
        let (x, y) = (i % 38, i / 38);
        let [u, v] = [x as f32 / 37.0 * 1.2 - 0.1, y as f32 / 23.0 * 1.2 - 0.1];
        // Away from the edges of the finest ones, whose sides are 1/64.
        let near = |w: f32| (64.0 * w - (64.0 * w).round()).abs() < 1e-3;
        if x == 0
            || y == 0
            || u < 0.0
            || v < 0.0
            || u + v > 1.0
            || near(u)
            || near(v)
            || near(u + v)
        {
            continue;
        }
        for (k, &index) in pixel.iter().enumerate() {
            assert_eq!(index as u32, micro_triangle(u, v, 2 * k as u32), "{u} {v}");
        }
    }
    // The middle of each is mapped back to it.
    for level in 0..=FINEST {
        for index in 0..curve::count(level) {
            let corners = curve::corners(index, level);
            let middle = |i: usize| corners.iter().map(|w| w[i]).sum::<i32>() as f32 / 3.0;
            let part = 1.0 / (1 << level) as f32;
            assert_eq!(micro_triangle(middle(1) * part, middle(2) * part, level), index);
        }
    }
}

struct Case {
    what: &'static str,
    alpha: Alpha,
    corners: [Vec2; 3],
}

fn case(what: &'static str, texture: (u32, u32, Vec<u8>), corners: [[f32; 2]; 3]) -> Case {
    let rgba: Vec<u8> = texture.2.iter().flat_map(|&alpha| [255, 255, 255, alpha]).collect();
    let alpha = Alpha::new(texture.0, texture.1, &rgba);
    Case { what, alpha, corners: corners.map(Vec2::from_array) }
}

/// Soft blobs on a texture whose size is not a power of two.
fn blobs(width: u32, height: u32) -> (u32, u32, Vec<u8>) {
    let alpha = |i: u32| {
        let wave = |x: u32, n: u32| (f64::from(x) / f64::from(n) * std::f64::consts::TAU).cos();
        let sum = 0.5 + 2.0 * (wave(i % width, width) + wave(i / width, height));
        (255.0 * sum.clamp(0.0, 1.0)) as u8
    };
    (width, height, (0..width * height).map(alpha).collect())
}

fn cases() -> Vec<Case> {
    let model = Scene::chess().unwrap().model;
    let screen = model.meshes.iter().find(|mesh| mesh.name == "screen").unwrap();
    let fretwork = model.materials[screen.material].opacity_texture.unwrap();
    let fretwork = &model.textures[fretwork];
    let alpha: Vec<u8> = fretwork.rgba.iter().skip(3).step_by(4).copied().collect();
    let fretwork = (fretwork.width, fretwork.height, alpha);
    let unit = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let threshold = (4, 1, vec![127, 128, 0, 255]);
    let half = |a, b| (64, 64, (0..4096).map(|i| if i % 64 < 32 { a } else { b }).collect());
    vec![
        case("fretwork", fretwork.clone(), [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]),
        case("fretwork, askew", fretwork.clone(), [[0.13, 0.91], [0.47, 0.2], [0.71, 0.83]]),
        case("blobs", blobs(61, 43), unit),
        case("wrapped", blobs(61, 43), [[-1.3, 2.7], [-0.1, 2.9], [-0.8, 3.6]]),
        case("over the seam", blobs(61, 43), [[0.9, 0.9], [1.1, 0.95], [0.97, 1.1]]),
        case("many times", blobs(61, 43), [[-20.0, 3.0], [40.0, 5.0], [7.0, 61.0]]),
        case("far away", blobs(61, 43), [[99_000.0, 7.0], [99_000.3, 7.0], [99_000.0, 7.3]]),
        case("a point", blobs(61, 43), [[0.5, 0.5]; 3]),
        case("a line", blobs(61, 43), [[0.1, 0.2], [0.5, 0.5], [0.9, 0.8]]),
        case("at the threshold", threshold, unit),
        case("two halves", half(0, 255), unit),
        case("two that are near", half(122, 133), unit),
        case("one texel", (1, 1, vec![255]), unit),
        case("huge", blobs(61, 43), [[1e30, 0.0], [-1e30, 1e30], [0.0, 3e38]]),
        case("no numbers", blobs(61, 43), [[f32::NAN, 0.0], [1.0, f32::INFINITY], [0.0, 1.0]]),
    ]
}

/// The texture coordinates computed by `surface_at` of `scene.glsl`, with the same roundings.
fn interpolated(corners: [Vec2; 3], u: f32, v: f32) -> Vec2 {
    (1.0 - u - v) * corners[0] + u * corners[1] + v * corners[2]
}

/// The weights of hits at the vertices, the middles of the edges and the middle of each micro-triangle, each
/// displaced slightly: by nothing, by roundings, by as much as a hit may be outside. Beyond that, the shader
/// reads no state.
fn weights(level: u32) -> impl Iterator<Item = (f32, f32)> {
    const PARTS: [[i32; 3]; 7] =
        [[6, 0, 0], [0, 6, 0], [0, 0, 6], [3, 3, 0], [0, 3, 3], [3, 0, 3], [2, 2, 2]];
    let moves = [0.0, 3e-8, -3e-8, 0.9 * SLACK as f32, -0.9 * SLACK as f32];
    let of = move |index| {
        let corners = curve::corners(index, level);
        PARTS.iter().enumerate().map(move |(k, part)| {
            let weight = |axis: usize| {
                let sum: i32 = (0..3).map(|corner| part[corner] * corners[corner][axis]).sum();
                sum as f32 / (6 << level) as f32
            };
            let i = index as usize + 3 * k;
            (weight(1) + moves[i % 5], weight(2) + moves[i / 5 % 5])
        })
    };
    let is_inside = |&(u, v): &(f32, f32)| [1.0 - u - v, u, v].iter().all(|&w| w >= -SLACK as f32);
    (0..curve::count(level)).flat_map(of).filter(is_inside)
}

/// The number of a rule's certain states, and of those that the any-hit shader contradicts somewhere. Each
/// place is looked up exactly, and as far next to it as a device's filter may look.
fn judged(case: &Case, level: u32, rule: Rule) -> (u64, u64) {
    let states = classify::triangle(&case.alpha, case.corners, level, rule);
    let (mut certain, mut wrong) = (0, 0);
    for (i, (u, v)) in weights(level).enumerate() {
        let opaque = match states[micro_triangle(u, v, level) as usize] {
            State::Opaque => true,
            State::Transparent => false,
            _ => continue,
        };
        let uv = interpolated(case.corners, u, v).as_dvec2();
        let beside = [DVec2::ZERO, DVec2::ONE, DVec2::NEG_ONE, DVec2::new(1.0, -1.0)][i % 4];
        // In 64 bits, the error of a lookup is far smaller than a state's distance from the threshold.
        let alpha = case.alpha.lookup(uv + beside * alpha::SUBTEXEL / case.alpha.size());
        certain += 1;
        wrong += u64::from((alpha >= alpha::THRESHOLD) != opaque);
    }
    (certain, wrong)
}

#[test]
fn no_state_by_the_bound_is_wrong_at_any_level() {
    let mut held = json!({ "answers": 0, "wrong": 0, "samples.answers": 0, "samples.wrong": 0 });
    for case in cases() {
        for level in 0..=FINEST {
            let (certain, wrong) = judged(&case, level, Rule::Conservative);
            assert_eq!(wrong, 0, "{}, level {level}: of {certain}", case.what);
            let sampled = judged(&case, level, Rule::Samples);
            let new = [certain, wrong, sampled.0, sampled.1];
            for (sum, new) in held.as_object_mut().unwrap().values_mut().zip(new) {
                *sum = json!(sum.as_u64().unwrap() + new);
            }
            let is_known = certain > 0;
            match case.what {
                "one texel" | "a point" => assert!(is_known, "{}", case.what),
                "at the threshold" | "two that are near" | "huge" | "no numbers" => {
                    assert!(!is_known || case.what == "two that are near", "{}", case.what);
                }
                _ => assert!(is_known || level < 6 || case.what == "many times", "{}", case.what),
            }
        }
    }
    println!("{held}");
    assert!(held["samples.wrong"].as_u64() > Some(0));
    expected::hold_exact("15_opacity_micromaps/rules", held);
}

/// The roundings allowed by the bound, in exact arithmetic: the search ends in a micro-triangle that is no
/// farther from the hit, and the shader's texture coordinates are no farther from the exact ones.
#[test]
fn the_margins_hold_all_roundings() {
    let mut random = Random(15);
    let mut number = |low: f64, high: f64| random.between(low, high) as f32;
    for case in 0..3000 {
        let size = [1.0, 1e-3, 3e4][case % 3];
        let corners = [(); 3].map(|()| Vec2::new(number(-size, size), number(-size, size)));
        let (u, v) = (number(-SLACK, 1.0), number(-SLACK, 1.0));
        if 1.0 - u - v < -SLACK as f32 {
            continue;
        }
        let level = case as u32 % (FINEST + 1);
        let index = micro_triangle(u, v, level);
        let exact = [
            rational(1.0) - rational(u.into()) - rational(v.into()),
            rational(u.into()),
            rational(v.into()),
        ];
        let at = interpolated(corners, u, v);
        for axis in 0..2 {
            let corner = corners.map(|corner| rational(f64::from(corner[axis])));
            let blend = |w: &[_; 3]| &corner[0] * &w[0] + &corner[1] * &w[1] + &corner[2] * &w[2];
            let uv = blend(&exact);
            let largest = corners.iter().map(|corner| corner[axis].abs()).fold(0.0, f32::max);
            let rounding = rational(classify::ROUNDING) * rational(largest.into());
            let off = rational(f64::from(at[axis])) - &uv;
            assert!(off <= rounding && -off <= rounding, "{corners:?} {u} {v}");

            let part = rational(1.0 / f64::from(1 << level));
            let small =
                curve::corners(index, level).map(|w| blend(&w.map(|w| rational(w.into()) * &part)));
            let low = small.iter().min().unwrap();
            let high = small.iter().max().unwrap();
            let whole = corner.iter().max().unwrap() - corner.iter().min().unwrap();
            let beside = whole * rational(2.0 * (SLACK + classify::SEARCH));
            assert!(*low <= &uv + &beside, "{corners:?} {u} {v}");
            assert!(uv <= high + &beside, "{corners:?} {u} {v}");
        }
    }
}

#[test]
fn a_scene_with_too_many_states_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let mut obj = String::from("mtllib m.mtl\nusemtl m\nvt 0 0\nvt 1 0\nvt 0 1\n");
    for i in 0..65_537 {
        let (x, z) = (i % 256, i / 256);
        writeln!(obj, "v {x} 0 {z}\nv {x}.5 0 {z}\nv {x} 0 {z}.5\nf -3/1 -2/2 -1/3").unwrap();
    }
    fs::write(folder.path().join("m.obj"), obj).unwrap();
    fs::write(folder.path().join("m.mtl"), "newmtl m\nKd 1 1 1\nmap_d fretwork.png\n").unwrap();
    let texture = root().join("samples/assets/fretwork.png");
    fs::copy(texture, folder.path().join("fretwork.png")).unwrap();
    let scene = folder.path().join("m.obj");
    let scene = scene.to_str().unwrap();
    let (code, line) =
        refused(NAME, &["--headless", "--size", "8x8", "--scene", scene, "--set", "level=6"]);
    assert_eq!(code, 1);
    let words = "micromaps of level 6 for 65537 triangles take 67109888 bytes, and at most 67108864 are made: \
                 level 5 fits";
    assert!(line.contains(words) && !line.contains('\n'), "{line}");
}
