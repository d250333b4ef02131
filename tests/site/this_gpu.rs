//! The page that tests the reader's own device, in Chromium with SwiftShader.
//!
//! `UPDATE=1 cargo test -p site this_gpu::the_stored` writes the exact answers for the page's rays.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use reference::Ray;
use reference::aabb::Aabb;
use reference::rational::to_f64;
use reference::sphere::Sphere;
use reference::ulp::ulp_error;
use serde_json::{Map, Value, json};

use crate::browser::Browser;
use crate::faults;
use crate::interactive::{found, root, shown, stored};
use crate::reading::address;

const PAGE: &str = "this-gpu.html";
const STORED: &str = "docs/site/interactive/device.txt";
const RUNGS: [(&str, usize); 6] = [
    ("sphere textbook", 0),
    ("sphere stable", 0),
    ("sphere two-float", 0),
    ("box reciprocal", 1),
    ("box division", 1),
    ("box two-float", 1),
];
/// The kinds of rays for each solid, and the number of each.
const KINDS: usize = 4;
const MANY: usize = 64;

/// A check of an operation's results, given its operands.
type Right<'a> = &'a dyn Fn(&[f32; 3], &[f32]) -> bool;

/// The figure's results at an address, its lists as lists.
fn told(browser: &mut Browser, address: &str) -> Value {
    shown(browser, address, "device");
    let lists =
        "({ ...found, rays: Object.values(found.rays).map(kinds => kinds.map(bits => [...bits])),
        draws: Object.values(found.operations).map(({ draws }) => draws.map(bits => [...bits])) })";
    found(browser, &[], lists)
}

/// The figure's results with SwiftShader.
fn swiftshader() -> &'static Value {
    static TOLD: OnceLock<Value> = OnceLock::new();
    TOLD.get_or_init(|| told(&mut Browser::with_webgl(), &address(PAGE)))
}

/// The exact t of every ray, 0 for a miss: for the sphere, then for the box, kind by kind.
fn exact(told: &Value) -> [Vec<f64>; 2] {
    let rays: [Vec<Vec<u32>>; 2] = serde_json::from_value(told["rays"].clone()).unwrap();
    let walls: [[f32; 3]; 2] = serde_json::from_value(told["walls"].clone()).unwrap();
    let [low, high] = walls.map(|wall| glam::Vec3::from(wall).as_dvec3());
    let (sphere, aabb) = (Sphere { center: [0.0; 3].into(), radius: 1.0 }, Aabb { low, high });
    let mut solid = 0;
    rays.map(|kinds| {
        solid += 1;
        assert_eq!(kinds.iter().map(Vec::len).collect::<Vec<_>>(), [8 * MANY; KINDS]);
        let all = kinds.concat();
        let rays = all.chunks(8).map(|bits| {
            let at = |index: usize| f32::from_bits(bits[index]);
            Ray::from_f32([0, 1, 2].map(at), [4, 5, 6].map(at), 0.0, f32::INFINITY)
        });
        let t = |ray: Ray| match solid {
            1 => sphere.intersect_exact(&ray).map(|hit| hit.to_f64().t),
            _ => aabb.intersect_exact(&ray).map(|hit| to_f64(&hit.t)),
        };
        rays.map(|ray| t(ray).unwrap_or(0.0)).collect()
    })
}

/// The errors of a case's hits, and its false hits and false misses, from the bits of its results.
fn judged(case: &Value, exact: &[f64]) -> (Vec<f64>, [usize; 2]) {
    let answers: Vec<u32> = serde_json::from_value(case["answers"].clone()).unwrap();
    assert_eq!(answers.len(), 4 * exact.len());
    let (mut errors, mut wrong) = (Vec::new(), [0, 0]);
    for (answer, &exact) in answers.chunks(4).zip(exact) {
        match (answer[0] != 0, exact != 0.0) {
            (true, true) => errors.push(ulp_error(f32::from_bits(answer[1]), exact)),
            (true, false) => wrong[0] += 1,
            (false, true) => wrong[1] += 1,
            (false, false) => {}
        }
    }
    errors.sort_by(f64::total_cmp);
    (errors, wrong)
}

fn part(errors: &[f64], part: f64) -> f64 {
    errors[(part * (errors.len() - 1) as f64) as usize]
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_stored_answers_are_exact() {
    let all = exact(swiftshader()).concat();
    // From a half on, a step is a 256th of a ULP.
    assert!(all.iter().all(|&t| t == 0.0 || (0.5..1.0).contains(&t)));
    let bytes = all.iter().flat_map(|t| ((t * 2f64.powi(32)).round() as u32).to_le_bytes());
    let text = base64(&bytes.collect::<Vec<_>>()) + "\n";
    let path = root().join(STORED);
    if std::env::var("UPDATE").as_deref() == Ok("1") {
        fs::write(&path, &text).unwrap();
    }
    assert!(
        fs::read_to_string(&path).unwrap() == text,
        "run: UPDATE=1 cargo test -p site this_gpu::the_stored"
    );
    for (solid, all) in all.chunks(KINDS * MANY).enumerate() {
        let hits = all.iter().filter(|t| **t > 0.0).count();
        assert!((120..220).contains(&hits), "{solid}: {hits}");
    }
}

fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let word = (0..3).fold(0, |word, i| word << 8 | u32::from(*three.get(i).unwrap_or(&0)));
        for i in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= three.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

/// Checks the page's statements about all devices: the counts follow from the raw bits, and with `keep` the
/// two-float rungs are right.
fn hold(told: &Value) {
    let exact = exact(told);
    let number = |case: &Value, key: &str| case[key].as_f64().unwrap();
    for (rung, solid) in RUNGS {
        for keep in ["with", "without"] {
            let case = &told["cases"][rung][keep];
            let (errors, wrong) = judged(case, &exact[solid]);
            // The stored answers are rounded to a 256th of a ULP.
            for (key, at) in [("median", 0.5), ("most", 0.99), ("worst", 1.0)] {
                let (said, from_bits) = (number(case, key), part(&errors, at));
                assert!((said - from_bits).abs() <= 0.5 / 256.0, "{rung}: {said}, {from_bits}");
            }
            assert_eq!(
                ["falseHits", "falseMisses"].map(|key| number(case, key) as usize),
                wrong,
                "{rung}"
            );
            if rung.ends_with("two-float") && keep == "with" {
                assert!(
                    part(&errors, 1.0) <= 0.5001 && wrong == [0, 0],
                    "{rung}: {errors:?} {wrong:?}"
                );
            }
        }
    }
}

#[test]
#[ignore = "nightly only: in a browser"]
fn two_floats_are_right_and_the_counts_are_those_of_the_raw_bits() {
    hold(swiftshader());
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_textbook_errs_as_much_as_the_chapter_says() {
    let chapter = stored("24_accuracy/sphere_errors");
    let [exact, _] = exact(swiftshader());
    let case = &swiftshader()["cases"]["sphere textbook"]["with"];
    let answers = case["answers"].as_array().unwrap();
    for (kind, family) in ["from-10", "from-1e3"].into_iter().enumerate() {
        let of_kind = json!({ "answers": answers[4 * MANY * kind..][..4 * MANY] });
        let (errors, _) = judged(&of_kind, &exact[MANY * kind..][..MANY]);
        let chapter = &chapter["values"][format!("sphere-{family}-radii-S0-direct.p50")];
        // The page's rays start up to √3 times as far away, and the error grows with the square of the
        // distance.
        let ratio = part(&errors, 0.5) / chapter.as_f64().unwrap();
        assert!((0.5..3.0).contains(&ratio), "{family}: {ratio}");
    }
    // From a million radii, and near the edge, many rays are judged wrongly.
    let (_, wrong) = judged(&json!({ "answers": answers[8 * MANY..] }), &exact[2 * MANY..]);
    assert!(wrong.iter().sum::<usize>() > 20, "{wrong:?}");
}

#[test]
#[ignore = "nightly only: in a browser"]
fn operations_are_judged_as_the_processor_judges_them() {
    let told = swiftshader();
    let operands: Vec<[f64; 3]> = serde_json::from_value(told["operands"].clone()).unwrap();
    for (keep, draws) in ["with", "without"].into_iter().zip(told["draws"].as_array().unwrap()) {
        let draws: Vec<Vec<u32>> = serde_json::from_value(draws.clone()).unwrap();
        let said = &told["operations"][keep]["told"];
        let counted = |draw: usize, at: usize, right: Right| {
            let answers = draws[draw].chunks(4).zip(&operands);
            let right = answers.filter(|(answer, operands)| {
                let answer: Vec<f32> = answer.iter().copied().map(f32::from_bits).collect();
                right(&operands.map(|x| x as f32), &answer[at..])
            });
            right.count()
        };
        let nearest: [(usize, usize, Right); 6] = [
            (0, 0, &|[a, b, _], r| r[0] == a + b),
            (0, 1, &|[a, b, _], r| r[0] == a * b),
            (0, 2, &|[a, b, _], r| r[0] == a / b),
            (0, 3, &|[a, ..], r| r[0] == 1.0 / a),
            (1, 0, &|[a, ..], r| r[0] == a.sqrt()),
            (1, 1, &|[a, ..], r| r[0] == f64::from(*a).sqrt().recip() as f32),
        ];
        for (row, (draw, at, right)) in nearest.into_iter().enumerate() {
            let expected = format!("{} of {MANY} nearest", counted(draw, at, right));
            assert!(said[row].as_str().unwrap().starts_with(&expected), "{expected}: {said}");
        }
        let twice = |[a, b, c]: &[f32; 3], r: &[f32]| r[0] == a * b + c;
        let once = |[a, b, c]: &[f32; 3], r: &[f32]| r[0] == a.mul_add(*b, *c);
        for (row, at) in [(6, 2), (7, 3)] {
            let expected = match [counted(1, at, &twice), counted(1, at, &once)] {
                [MANY, 0] => "rounded twice",
                [0, MANY] => "rounded once",
                _ => "rounded twice or once",
            };
            assert_eq!(said[row], expected, "{said}");
        }
        let sum = |[a, b, _]: &[f32; 3], r: &[f32]| {
            f64::from(r[0]) + f64::from(r[1]) == f64::from(*a) + f64::from(*b)
        };
        let product = |[a, b, _]: &[f32; 3], r: &[f32]| {
            f64::from(r[0]) + f64::from(r[1]) == f64::from(*a) * f64::from(*b)
        };
        assert_eq!(said[8], format!("{} of {MANY} exact", counted(2, 0, &sum)));
        assert_eq!(said[9], format!("{} of {MANY} exact", counted(2, 2, &product)));
        let tiny = draws[3].chunks(4).map(|answer| f32::from_bits(answer[1]));
        let tiny: Vec<&str> = tiny.take(2).map(|x| if x == 0.0 { "0" } else { "2" }).collect();
        assert!((0..2).all(|i| said[10 + i].as_str().unwrap().starts_with(tiny[i])), "{said}");
    }
    // Two-floats require both of these.
    let with = &told["operations"]["with"]["told"];
    assert_eq!([&with[8], &with[9]], [&json!("64 of 64 exact"); 2]);
}

#[test]
#[ignore = "nightly only: in a browser"]
fn without_keep_nothing_is_left_of_it_but_its_name() {
    let mut browser = Browser::with_webgl();
    shown(&mut browser, &address(PAGE), "device");
    let [with, without] = ["device", "device without keep"].map(|name| {
        browser.run(&format!("figures.shaders[{name:?}]")).as_str().unwrap().to_owned()
    });
    assert_eq!(with.matches("^ kept").count(), 4);
    assert_eq!(without.matches("{ return a; }").count(), 4);
    let kept = "uintBitsToFloat(floatBitsToUint(a) ^ kept)";
    assert_eq!(without, with.replace(kept, "a"));
    // The source passed to the browser is what runs: if `kept` is not 0, only one of them is affected.
    let disturbed = browser.run(
        "(() => {
            const compute = name => {
                const given = new Uint32Array(512);
                given.fill(0x3f800000);
                const uniforms = { given: ['4uiv', given], subject: ['1ui', 2], rung: ['1ui', 2], kept: ['1ui', 1] };
                const answers = figures.compute(name, 8, uniforms)[0];
                figures.compute(name, 8, { kept: ['1ui', 0] });
                return answers === 0x40000000;
            };
            return [compute('device'), compute('device without keep')];
        })()",
    );
    assert_eq!(disturbed, json!([false, true]));
}

/// The figure's results with some text of a shader replaced.
fn planted(file: &str, from: &str, to: &str) -> Value {
    let mark = "<!-- touch device: rung = sphere two-float; keep = with -->";
    let folder = faults::book(&format!("# One\n\n{mark}\n![A](images/a.svg)\n"));
    let copy = |path: &Path| {
        let to_path = folder.path().join(path);
        fs::create_dir_all(to_path.parent().unwrap()).unwrap();
        fs::copy(root().join(path), to_path).unwrap();
    };
    for name in ["device.js", "device.frag", "device.txt"] {
        copy(&Path::new("docs/site/interactive").join(name));
    }
    for shaders in ["shaders/common", "shaders/24_accuracy"] {
        for entry in fs::read_dir(root().join(shaders)).unwrap() {
            copy(&Path::new(shaders).join(entry.unwrap().file_name()));
        }
    }
    let path = folder.path().join(file);
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{file}");
    fs::write(&path, text.replace(from, to)).unwrap();
    faults::built(folder.path()).unwrap();
    let page = folder.path().join("book/one.html");
    told(&mut Browser::with_webgl(), &format!("file://{}", page.display()))
}

#[test]
#[ignore = "nightly only: in a browser"]
fn a_planted_error_of_2_ulp_is_seen_and_of_its_rung_alone() {
    let told = planted(
        "shaders/24_accuracy/sphere_two_float.glsl",
        "t = enters ? near.x : far.x;",
        "t = uintBitsToFloat(floatBitsToUint(enters ? near.x : far.x) + 2u);",
    );
    let cases = |told: &Value, rung: &str| told["cases"][rung]["with"].clone();
    let case = cases(&told, "sphere two-float");
    for (key, low, high) in [("median", 1.6, 2.4), ("worst", 2.4, 2.51)] {
        let error = case[key].as_f64().unwrap();
        assert!((low..high).contains(&error), "{key}: {error}");
    }
    assert_eq!([&case["falseHits"], &case["falseMisses"]], [&json!(0); 2]);
    for (rung, _) in RUNGS.into_iter().filter(|(rung, _)| *rung != "sphere two-float") {
        assert_eq!(cases(&told, rung), cases(swiftshader(), rung), "{rung}");
    }
}

#[test]
#[ignore = "nightly only: in a browser"]
fn a_sum_s_error_that_is_lost_is_seen() {
    let told = planted(
        "shaders/common/error_free.glsl",
        "precise float error = (a - (sum - back)) + (b - back);",
        "precise float error = 0.0;",
    );
    let sums = told["operations"]["with"]["told"][8].as_str().unwrap();
    assert!(sums.ends_with(" of 64 exact") && sums != "64 of 64 exact", "{sums}");
    let worst = &told["cases"]["sphere two-float"]["with"]["worst"];
    assert!(worst.as_f64().unwrap() > 1.0, "{worst}");
}

/// Records the page's figures, and compares them with the stored ones if browser and device are the same.
fn recorded(name: &str, device: &str, browser: &mut Browser, told: &Value) {
    assert!(told["device"].as_str().unwrap().contains(device), "{}", told["device"]);
    let version = browser.call("Browser.getVersion", &json!({}));
    let version = version["product"].as_str().unwrap().split(['/', '.']).nth(1).unwrap().to_owned();
    let mut values = Map::new();
    for (rung, _) in RUNGS {
        for keep in ["with", "without"] {
            for key in ["median", "most", "worst", "falseHits", "falseMisses"] {
                let name = format!("{}.{keep}.{key}", rung.replace(' ', "-"));
                values.insert(name, told["cases"][rung][keep][key].clone());
            }
        }
    }
    let rest = |row: &Value| row.as_str().unwrap().split(' ').next().unwrap().parse::<u32>().ok();
    for (keep, told) in told["operations"].as_object().unwrap() {
        let said = &told["told"];
        for (row, key) in [(5, "inversesqrt"), (8, "two-sum"), (9, "two-product")] {
            values.insert(format!("{key}.{keep}"), json!(rest(&said[row])));
        }
    }
    let given = json!({
        "timed": false, "device": device, "driver": format!("Chromium {version}"), "values": values,
    });
    if let Some(folder) = std::env::var_os("FIGURES") {
        let file = Path::new(&folder).join(format!("{name}.json"));
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, given.to_string()).unwrap();
        return;
    }
    let stored = stored(name);
    if ["device", "driver"].iter().all(|key| stored[*key] == given[*key]) {
        assert_eq!(stored["values"], given["values"], "run: cargo chapters measure {name}");
    }
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_page_has_the_numbers_of_swiftshader() {
    let told = swiftshader();
    // This compiler rearranges nothing.
    for (rung, _) in RUNGS {
        let [with, without] = ["with", "without"].map(|keep| &told["cases"][rung][keep]["answers"]);
        assert_eq!(with, without, "{rung}");
    }
    recorded("this-gpu/swiftshader", "SwiftShader", &mut Browser::start(), told);
}

#[test]
#[ignore = "by hand: needs a Mesa whose OpenGL draws without a GPU"]
fn the_page_has_the_numbers_of_llvmpipe() {
    let mut browser = Browser::with_opengl();
    let told = told(&mut browser, &address(PAGE));
    hold(&told);
    // Without `keep`, this compiler removes the rounding error of every sum.
    let errors = told["draws"][1][2].as_array().unwrap().chunks(4).map(|answer| &answer[1]);
    assert!(errors.into_iter().all(|error| *error == json!(0)));
    recorded("this-gpu/llvmpipe", "llvmpipe", &mut browser, &told);
}
