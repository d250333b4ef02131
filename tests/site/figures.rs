//! Figures in Chromium with WebGL 2: what they compute, and how they answer.
//!
//! `UPDATE=1 cargo test -p site figures::stills -- --ignored` writes the pictures that stand where no script runs.

use std::fs;
use std::path::Path;

use glam::{DVec2, DVec3};
use reference::Ray;
use reference::sphere::Sphere;
use reference::triangle::intersect_exact;
use reference::ulp::ulp_error;
use serde_json::{Value, json};

use crate::browser::Browser;
use crate::reading::{DESK, PHONE, address, checked, complaints, decode, sized, theme};
use crate::{addresses, built, faults};

const SPHERE: &str = "08_intersection.html";
const START: &str = "05_shadow_miss.html";
const TRIANGLE: &str = "02_basic.html";
const WALK: &str = "30_own_tree.html";
const TABLES: [&str; 2] = ["01_foundation.html", "07_multi_closest_hit.html"];

fn root() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The pages with figures.
fn pages() -> Vec<&'static String> {
    addresses().filter(|page| built().pages[*page].0.contains("class=\"figure\"")).collect()
}

/// Waits, for so many frames at most, until an expression on the page is true.
fn wait(browser: &mut Browser, until: &str) {
    let script = format!(
        "new Promise(done => {{
            let tries = 5000;
            const look = () => ({until}) || --tries < 0 ? done(tries >= 0) : requestAnimationFrame(look);
            look();
        }})"
    );
    assert_eq!(browser.run(&script), true, "never: {until}");
}

/// Opens a page and brings its figure into view, until it is drawn.
fn shown(browser: &mut Browser, address: &str) -> Vec<Value> {
    browser.open("about:blank");
    let told = browser.open(address);
    browser.run("figures.all[0].box.scrollIntoView({ block: 'center', behavior: 'instant' })");
    wait(browser, "figures.all[0].found || figures.all[0].said.textContent");
    told
}

/// A picture of an element of the page, without the bar that would stand before it.
fn taken(browser: &mut Browser, element: &str, file: &Path) {
    browser.run("document.getElementById('mdbook-menu-bar').hidden = true");
    decode(&browser.part(element), file);
}

/// Sets controls as a reader would, and gives what the figure finds.
fn found(browser: &mut Browser, controls: &[(&str, &str)], what: &str) -> Value {
    for (name, value) in controls {
        browser.run(&format!(
            "(input => {{
                figures.all[0].found = null;
                input.value = {value:?};
                input.dispatchEvent(new Event('input', {{ bubbles: true }}));
            }})(figures.all[0].input({name:?}))"
        ));
        wait(browser, "figures.all[0].found");
    }
    browser.run(&format!("(found => {what})(figures.all[0].found)"))
}

#[test]
fn every_figure_starts_can_be_read_and_answers_the_keyboard_alone() {
    let mut browser = Browser::with_webgl();
    let mut answered = 0;
    for page in pages() {
        sized(&mut browser, PHONE);
        let mut faults = complaints(&shown(&mut browser, &address(page)));
        for size in [PHONE, DESK] {
            sized(&mut browser, size);
            for name in ["light", "navy"] {
                theme(&mut browser, name);
                faults.extend(checked(&mut browser).wrong);
            }
        }
        assert_eq!(browser.run("figures.all[0].box.classList.contains('moves')"), true, "{page}");
        let names = browser.run(
            "figures.all[0].inputs().filter(input => input.type !== 'hidden').map(input => input.name)",
        );
        let names: Vec<String> = serde_json::from_value(names).unwrap();
        assert!(names.len() > 1, "{names:?}");
        browser.run(&format!("figures.all[0].input({:?}).focus()", names[0]));
        for (index, name) in names.iter().enumerate() {
            if index > 0 {
                browser.press("Tab", 9);
            }
            assert_eq!(browser.run("document.activeElement.name"), json!(name), "{page}");
            let value = "document.activeElement.value";
            let before = browser.run(value);
            browser.run("figures.all[0].found = null");
            browser.press("ArrowDown", 40);
            if browser.run(value) == before {
                browser.press("ArrowUp", 38);
            }
            assert_ne!(browser.run(value), before, "{page}: {name}");
            wait(&mut browser, "figures.all[0].found");
            answered += 1;
        }
        assert!(browser.run("location.pathname").as_str().unwrap().ends_with(page.as_str()));
        // Whoever wants less motion has none.
        assert_eq!(
            browser.run("figures.all[0].box.getAnimations({ subtree: true }).length"),
            0,
            "{page}"
        );
        faults.extend(complaints(&browser.told()));
        assert!(faults.is_empty(), "{page}:\n{}", faults.join("\n"));
    }
    assert!(answered > 10 && pages().len() == built().counts.figures, "{answered}");
}

#[test]
fn the_spheres_agree_with_the_exact_ones() {
    const EVERY: usize = 59;
    let sphere = Sphere { center: [0.0; 3].into(), radius: 1.0 };
    let mut browser = Browser::with_webgl();
    shown(&mut browser, &address(SPHERE));
    let sample = format!(
        "({{ eye: found.eye, truths: found.truths,
            rays: Array.from({{ length: 57600 }}, (_, i) => i).filter(i => i % {EVERY} === 0)
                .map(i => [i, ...found.answers.slice(4 * i, 4 * i + 4)]) }})"
    );
    // What the rungs gave with Vulkan on llvmpipe, over all rays.
    let given =
        fs::read_to_string(root().join("docs/figures/08_intersection/errors.json")).unwrap();
    let given: Value = serde_json::from_str(&given).unwrap();
    let given = |name: String| given["values"][&*name].as_f64().unwrap();
    for (steps, distance) in [(0, 1), (40, 100), (80, 10_000)] {
        let slider = steps.to_string();
        for rung in ["textbook", "stable", "two-float"] {
            let told = found(&mut browser, &[("distance", &slider), ("rung", rung)], &sample);
            let eye: [f32; 3] = serde_json::from_value(told["eye"].clone()).unwrap();
            let rays: Vec<[u32; 5]> = serde_json::from_value(told["rays"].clone()).unwrap();
            let (mut hits, mut wrong, mut worst, count) = (0, 0, 0.0f64, rays.len());
            for [index, t, x, y, z] in rays {
                let ray = Ray::from_f32(eye, [x, y, z].map(f32::from_bits), 0.0, f32::INFINITY);
                let exact = sphere.intersect_exact(&ray).map_or(0.0, |hit| hit.to_f64().t);
                // What the script holds the rungs to. The answers' first line is the lowest one.
                let (line, column) = (239 - index as usize / 240, index as usize % 240);
                let truth = told["truths"][240 * line + column].as_f64().unwrap();
                assert!((truth - exact).abs() <= 1e-12 * exact, "{truth} {exact}");
                let t = f32::from_bits(t);
                match (t == 0.0, exact == 0.0) {
                    (false, false) => {
                        hits += 1;
                        worst = worst.max(ulp_error(t, exact));
                    }
                    (one, other) => wrong += usize::from(one != other),
                }
            }
            assert!(hits > 500, "{hits}");
            // A two-float has 48 bits; its last rounding costs half a place. Another device may round
            // the direction and a quotient otherwise: a factor of 2 for the worst of the rays.
            let (most_wrong, most) = match rung {
                "two-float" => (0.0, 0.5001),
                _ => {
                    let of = |figure: &str| given(format!("{distance}.{rung}.{figure}"));
                    (2.0 * (of("false_hits") + of("false_misses")), 2.0 * of("max"))
                }
            };
            let wrong = wrong as f64 / count as f64;
            assert!(wrong <= most_wrong + 1e-3, "{rung}, {distance}: {wrong}");
            assert!(worst <= most, "{rung}, {distance}: {worst} ULP");
        }
    }
    // The page's own figures, to a tenth: 746 ULP, and 25 % of false hits.
    let what = "[found.median, found.falseHits / 240 ** 2]";
    let told = found(&mut browser, &[("distance", "80"), ("rung", "textbook")], what);
    for (at, figure) in ["p50", "false_hits"].into_iter().enumerate() {
        let ratio = told[at].as_f64().unwrap() / given(format!("10000.textbook.{figure}"));
        assert!((0.9..1.1).contains(&ratio), "{figure}: {told}");
    }
}

#[test]
fn the_tables_lead_to_the_records_that_the_pages_print() {
    let mut browser = Browser::start();
    let what = "[found.offsets, found.strides, found.size, found.record, found.at, found.inside]";
    shown(&mut browser, &address(TABLES[0]));
    let cases = [
        (vec![], json!([[0, 32, 64], [32, 32, 32], 96, 0, 64, true])),
        (vec![("region alignment", "64")], json!([[0, 64, 128], [32, 32, 32], 160, 0, 128, true])),
        (vec![("sbtRecordOffset", "1")], json!([[0, 64, 128], [32, 32, 32], 160, 1, 160, false])),
    ];
    for (controls, expected) in cases {
        assert_eq!(found(&mut browser, &controls, what), expected, "{controls:?}");
    }
    let said = browser.run("figures.all[0].said.textContent");
    assert!(said.as_str().unwrap().contains("Error: the region has 1 record "), "{said}");
    shown(&mut browser, &address(TABLES[1]));
    let cases = [
        (vec![], json!([[0, 64, 96], [48, 32, 64], 4320, 44, 2912, true])),
        (vec![("sbtRecordOffset", "1")], json!([[0, 64, 96], [48, 32, 64], 4320, 45, 2976, true])),
        (vec![("instance", "32")], json!([[0, 64, 96], [48, 32, 64], 4320, 65, 4256, true])),
        (vec![("geometry", "1")], json!([[0, 64, 96], [48, 32, 64], 4320, 67, 4384, false])),
        (
            vec![("region alignment", "64")],
            json!([[0, 64, 128], [48, 32, 64], 4352, 67, 4416, false]),
        ),
    ];
    for (controls, expected) in cases {
        assert_eq!(found(&mut browser, &controls, what), expected, "{controls:?}");
        let read =
            browser.run("[...document.querySelectorAll('.record.read')].map(a => a.textContent)");
        let inside = expected[5] == true;
        let wanted = if inside { json!([expected[3].to_string()]) } else { json!([]) };
        assert_eq!(read, wanted);
    }
}

#[test]
fn the_starts_hit_their_surface_where_the_figure_says_acne() {
    // The surface of the figure, from corner to corner.
    let [low, high] = [0.1f32, 0.7].map(f64::from);
    let corners = [[0.0, low, -8.0], [0.0, low, 8.0], [2.0, high, 0.0]].map(DVec3::from);
    let mut browser = Browser::start();
    shown(&mut browser, &address(START));
    let mut acne = 0;
    // In steps of the sliders: 20 are ten times as much.
    for point in ["along the ray", "by corners"] {
        for distance in ["0", "20", "40", "80"] {
            for step in ["0", "20", "35", "60"] {
                let controls = [("point", point), ("distance", distance), ("step", step)];
                let told = found(&mut browser, &controls, "found");
                let start: [f64; 2] = serde_json::from_value(told["start"].clone()).unwrap();
                let height = told["height"].as_f64().unwrap();
                assert_eq!(start, start.map(|x| f64::from(x as f32)), "a start is a float");
                let ray = Ray {
                    origin: DVec3::new(start[0], start[1], 0.0),
                    direction: DVec3::new(0.3, 1.0, 0.0),
                    tmin: 0.0,
                    tmax: f64::INFINITY,
                };
                let hits = intersect_exact(&ray, &corners).is_some();
                assert_eq!(hits, height < 0.0, "{controls:?}: {told}");
                let said = browser.run("figures.all[0].said.textContent");
                assert_eq!(said.as_str().unwrap().contains(": acne."), hits, "{said}");
                acne += usize::from(hits);
                // From the bound on no start by corners lies below, however far the eye is.
                let safe = 1e-8 * 10f64.powf(step.parse::<f64>().unwrap() / 20.0)
                    >= told["bound"].as_f64().unwrap();
                let all = told["acne"].as_f64().unwrap();
                assert!(all == 0.0 || point == "along the ray" || !safe, "{controls:?}: {told}");
            }
        }
    }
    assert!(acne > 2, "{acne}");
    // The page: a short step has acne, a long one leaks.
    let part = "[found.acne, found.leaks]";
    let far = [("point", "along the ray"), ("distance", "80"), ("step", "20")];
    assert!(found(&mut browser, &far, part)[0].as_f64().unwrap() > 0.3);
    assert_eq!(found(&mut browser, &[("distance", "20"), ("step", "100")], part), json!([0, 1]));
}

/// What an element of a drawing says in an attribute.
fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    element.split_once(&format!("{name}=\"")).unwrap().1.split('"').next().unwrap()
}

/// A row of the walk's table: what is visited, what comes of it, and the stack then.
type Visit = (String, String, Vec<String>);

/// The triangles of the walk's drawing, and its table.
fn drawn_walk() -> (Vec<[DVec2; 3]>, Vec<Visit>) {
    let svg = fs::read_to_string(root().join("docs/images/30_walk.svg")).unwrap();
    let corner = |point: &str| {
        let (x, y) = point.split_once(',').unwrap();
        DVec2::new(x.parse().unwrap(), y.parse().unwrap())
    };
    let (mut triangles, mut rows) = (Vec::new(), Vec::new());
    for element in svg.lines() {
        if element.starts_with("<polygon") {
            let corners: Vec<DVec2> = attribute(element, "points").split(' ').map(corner).collect();
            triangles.extend(<[DVec2; 3]>::try_from(corners));
        }
        if element.starts_with("<text") && attribute(element, "y").parse::<f64>().unwrap() > 342.0 {
            let text = element.split(['>', '<']).nth(2).unwrap().to_owned();
            match (attribute(element, "x").parse::<f64>().unwrap(), rows.last_mut()) {
                (56.0, _) => rows.push((text, String::new(), Vec::new())),
                (130.0, Some(row)) => row.1 = text,
                (546.0.., Some(row)) => row.2.push(text),
                _ => {}
            }
        }
    }
    (triangles, rows)
}

/// Where a ray from `eye` enters a triangle: where it is within all three edges.
fn entered(eye: DVec2, towards: DVec2, corners: [DVec2; 3]) -> Option<f64> {
    let turn = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]).signum();
    let (mut enter, mut leave) = (0.0f64, f64::INFINITY);
    for i in 0..3 {
        let edge = turn * (corners[(i + 1) % 3] - corners[i]);
        let (within, rate) = (edge.perp_dot(eye - corners[i]), edge.perp_dot(towards));
        match rate {
            0.0 if within < 0.0 => return None,
            0.0 => {}
            _ if rate > 0.0 => enter = enter.max(-within / rate),
            _ => leave = leave.min(-within / rate),
        }
    }
    (enter <= leave).then_some(enter)
}

#[test]
fn the_walks_find_the_nearest_triangle() {
    let (triangles, rows) = drawn_walk();
    assert_eq!((triangles.len(), rows.len()), (5, 6));
    let mut browser = Browser::start();
    shown(&mut browser, &address(WALK));
    let drawn = found(&mut browser, &[], "[Object.values(found.corners), found.visits, found.hit]");
    let corners: Vec<[[f64; 2]; 3]> = serde_json::from_value(drawn[0].clone()).unwrap();
    assert_eq!(corners.iter().map(|all| all.map(DVec2::from)).collect::<Vec<_>>(), triangles);
    assert_eq!([&drawn[1], &drawn[2]], [&json!(rows), &json!("C")]);
    // Each step shows what its row says.
    for (step, row) in rows.iter().enumerate() {
        found(&mut browser, &[("step", &(step + 1).to_string())], "found");
        let stack = if row.2.is_empty() { vec!["empty".to_owned()] } else { row.2.clone() };
        let shown = "[...figures.all[0].stage.querySelectorAll('.record')].map(a => a.textContent)";
        assert_eq!(browser.run(shown), json!(stack));
        let now =
            "figures.all[0].stage.querySelector('.panel + .panel rect.visited-now').dataset.of";
        assert_eq!(browser.run(now), json!(row.0));
        let said = browser.run("figures.all[0].said.textContent");
        assert!(said.as_str().unwrap().contains(&row.1), "{said}");
    }

    let mut random = 1u32;
    let mut height = || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        i64::from(random >> 16) % 201
    };
    let (mut hits, mut counts) = (0, [0, 0]);
    for _ in 0..200 {
        let (eye, aim) = (height(), height());
        let controls = [("eye", eye), ("aim", aim)].map(|(name, at)| (name, at.to_string()));
        let controls = controls.each_ref().map(|(name, at)| (*name, &**at));
        let from = DVec2::new(34.0, (300 - eye) as f64);
        let towards = DVec2::new(400.0, (eye - aim) as f64);
        let met = triangles.iter().zip(["A", "B", "C", "D", "E"]);
        let met = met.filter_map(|(corners, name)| Some((entered(from, towards, *corners)?, name)));
        let nearest = met.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name);
        for order in ["near", "far"] {
            let told = found(&mut browser, &controls, "[found.hit, found.counts]");
            assert_eq!(told[0], json!(nearest), "{controls:?}, {order} first: {told}");
            found(&mut browser, &[("first", order)], "found");
            for (all, count) in counts.iter_mut().zip(told[1].as_array().unwrap()) {
                *all += count.as_u64().unwrap();
            }
        }
        hits += usize::from(nearest.is_some());
    }
    assert!(hits > 100 && hits < 200 && counts[0] < counts[1], "{hits} {counts:?}");
}

#[test]
fn the_weights_are_those_of_the_exact_hit() {
    let mut browser = Browser::with_webgl();
    sized(&mut browser, DESK);
    shown(&mut browser, &address(TRIANGLE));
    let drawn = found(&mut browser, &[], "[found.corners, found.weights, found.color]");
    let svg = fs::read_to_string(root().join("docs/images/barycentrics.svg")).unwrap();
    let corners: [[f64; 2]; 3] = serde_json::from_value(drawn[0].clone()).unwrap();
    let points = corners.map(|[x, y]| format!("{x:.1},{y:.1}")).join(" ");
    assert!(svg.contains(&format!("<polygon points=\"{points}\" fill=\"none\"")), "{points}");
    let mut random = 1u32;
    let mut within = |low: u32, high: u32| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        low + (random >> 16) % (high + 1 - low)
    };
    let triangle = corners.map(|[x, y]| DVec3::new(x, y, 0.0));
    let (mut hits, mut points) = (0, vec![(250, 131)]);
    points.extend((0..100).map(|_| (within(40, 450), within(20, 240))));
    for (x, y) in points {
        let (across, up) = (x.to_string(), y.to_string());
        let told = found(&mut browser, &[("x", &across), ("y", &up)], "found");
        let ray = Ray {
            origin: DVec3::new(f64::from(x), 300.0 - f64::from(y), 1.0),
            direction: DVec3::new(0.0, 0.0, -1.0),
            tmin: 0.0,
            tmax: f64::INFINITY,
        };
        let exact = intersect_exact(&ray, &triangle);
        assert_eq!(told["hit"], exact.is_some(), "{told}");
        let weights: [f64; 3] = serde_json::from_value(told["weights"].clone()).unwrap();
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{told}");
        let said = browser.run("figures.all[0].said.textContent");
        assert_eq!(said.as_str().unwrap().contains("misses the triangle"), exact.is_none());
        let Some(exact) = exact else {
            assert!(weights.iter().any(|&weight| weight < 0.0), "{told}");
            continue;
        };
        hits += 1;
        for (weight, exact) in weights.iter().zip(&exact.weights) {
            assert!((weight - exact.to_f64().value()).abs() < 1e-12, "{told}");
        }
    }
    assert!(hits > 20 && hits < 90, "{hits}");

    // The drawing of the mixed color, at a place where no point lies upon it.
    found(&mut browser, &[("x", "450"), ("y", "240")], "found");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mixed.png");
    taken(&mut browser, "figures.all[0].stage.querySelector('svg')", &file);
    let picture = image::open(&file).unwrap().to_rgb8();
    let scale = f64::from(picture.width()) / 416.0;
    let [x, y] = [250.0 - 34.0, 169.0 - 44.0].map(|at| (at * scale) as u32);
    let weights: [f64; 3] = serde_json::from_value(drawn[1].clone()).unwrap();
    for (channel, weight) in picture.get_pixel(x, y).0.into_iter().zip(weights) {
        assert!((f64::from(channel) - 255.0 * weight).abs() < 4.0, "{:?}", picture.get_pixel(x, y));
    }
}

#[test]
fn points_can_be_dragged() {
    let grips = "[...figures.all[0].stage.querySelectorAll('.grip')].map(grip => grip.getBoundingClientRect())
        .map(box => [box.x + box.width / 2, box.y + box.height / 2, box.width])";
    let mut browser = Browser::with_webgl();
    sized(&mut browser, PHONE);
    for (page, index) in [(WALK, 0), (WALK, 1), (TRIANGLE, 0), (TRIANGLE, 1)] {
        shown(&mut browser, &address(page));
        let place = browser.run(grips)[index].clone();
        let [x, y, wide]: [f64; 3] = serde_json::from_value(place).unwrap();
        assert!(wide > 15.0, "{page}: {wide}");
        for (kind, up) in [("Pressed", 0.0), ("Moved", 20.0), ("Moved", 40.0), ("Released", 40.0)] {
            let kind = format!("mouse{kind}");
            let event = json!({ "type": kind, "x": x, "y": y - up, "button": "left", "buttons": 1, "clickCount": 1 });
            browser.call("Input.dispatchMouseEvent", &event);
        }
        wait(&mut browser, "!figures.all[0].changed");
        let moved = browser.run(grips)[index][1].as_f64().unwrap();
        assert!((moved - (y - 40.0)).abs() < 1.5, "{page}: from {y} to {moved}");
    }
}

/// A book with the figure of the sphere alone, whose `sphere.glsl` has other words in a place.
fn other(from: &str, to: &str) -> (tempfile::TempDir, Result<String, String>) {
    let mark = "<!-- touch sphere: rung = textbook; distance = 1e4 -->";
    let folder = faults::book(&format!("# One\n\n{mark}\n![A](images/a.svg)\n"));
    for file in [
        "docs/site/figures/sphere.js",
        "docs/site/figures/sphere.frag",
        "shaders/24_accuracy/sphere_two_float.glsl",
        "shaders/common/camera.glsl",
        "shaders/common/error_free.glsl",
        "shaders/common/sphere.glsl",
        "shaders/common/two_float.glsl",
    ] {
        let mut text = fs::read_to_string(root().join(file)).unwrap();
        if file.ends_with("/sphere.glsl") {
            assert!(text.contains(from));
            text = text.replace(from, to);
        }
        let path = folder.path().join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let built = faults::built(folder.path());
    (folder, built)
}

#[test]
fn a_changed_line_of_a_shader_changes_its_figure() {
    let mut browser = Browser::with_webgl();
    let mut medians = Vec::new();
    for to in ["b * b - a * c", "a * c - b * b"] {
        let (folder, built) = other("b * b - a * c", to);
        built.unwrap();
        let page = folder.path().join("book/one.html");
        shown(&mut browser, &format!("file://{}", page.display()));
        medians.push(browser.run("figures.all[0].found.falseHits"));
    }
    assert_ne!(medians[0], medians[1]);
}

#[test]
fn a_line_that_fits_no_more_is_named() {
    let text = fs::read_to_string(root().join("shaders/common/sphere.glsl")).unwrap();
    let old = "precise float root = sqrt(discriminant);";
    let line = text.lines().position(|line| line.contains(old)).unwrap() + 1;
    for (new, what) in [
        ("double root = sqrt(double(discriminant));", "'double', a float of 64 bits"),
        ("precise float root; root = sqrt(discriminant);", "this form of 'precise'"),
    ] {
        let (_folder, built) = other(old, new);
        let error = built.unwrap_err();
        let expected = format!(
            "shaders/common/sphere.glsl:{line}: a figure includes this, and WebGL 2 has no equivalent of {what}; "
        );
        assert!(error.starts_with(&expected), "{error}");
    }
}

#[test]
fn a_figure_out_of_view_costs_nothing() {
    let mut browser = Browser::with_webgl();
    sized(&mut browser, DESK);
    browser.open(&address(SPHERE));
    let draws = "figures.all[0].found";
    let change = "figures.all[0].change(); new Promise(done => setTimeout(done, 300))";
    browser.run(change);
    assert_eq!(browser.run(&format!("{draws} === undefined")), true);
    shown(&mut browser, &address(SPHERE));
    browser.run("scrollTo({ top: 0, behavior: 'instant' })");
    wait(&mut browser, "!figures.all[0].seen");
    browser.run("figures.all[0].found = null");
    browser.run(change);
    assert_eq!(browser.run(&format!("{draws} === null")), true);
    browser.run("figures.all[0].box.scrollIntoView()");
    wait(&mut browser, draws);
}

#[test]
fn a_figure_outlives_a_lost_context_and_does_without_webgl() {
    let still = "[figures.all[0].box.querySelector('.still').checkVisibility(), \
                 figures.all[0].controls.checkVisibility(), figures.all[0].said.textContent]";
    let mut browser = Browser::with_webgl();
    shown(&mut browser, &address(SPHERE));
    browser.run(
        "window.loses = figures.context().getExtension('WEBGL_lose_context'); loses.loseContext()",
    );
    wait(&mut browser, "!figures.all[0].box.classList.contains('moves')");
    let told = browser.run(still);
    assert!(told[2].as_str().unwrap().starts_with("The browser has taken the GPU away"), "{told}");
    assert_eq!([&told[0], &told[1]], [&json!(true), &json!(false)]);
    browser.run("loses.restoreContext()");
    wait(&mut browser, "figures.all[0].box.classList.contains('moves')");
    assert_eq!(browser.run(still)[0], false);

    let mut browser = Browser::without_webgl();
    let told = shown(&mut browser, &address(SPHERE));
    assert_eq!(complaints(&told), Vec::<String>::new());
    let told = browser.run(still);
    assert!(told[2].as_str().unwrap().starts_with("This browser has no WebGL 2"), "{told}");
    assert_eq!([&told[0], &told[1]], [&json!(true), &json!(false)]);
    assert_eq!(complaints(&browser.told()), Vec::<String>::new());
}

#[test]
fn the_scripts_of_a_page_are_small() {
    let size = |file: &str| fs::metadata(built().folder.join(file)).unwrap().len();
    let own = fs::metadata(root().join("docs/site/site.js")).unwrap().len();
    for page in pages() {
        let tags = built().pages[page].0.split("<script src=\"figure").skip(1);
        let files = tags.map(|rest| format!("figure{}", rest.split('"').next().unwrap()));
        let total: u64 = own + files.map(|file| size(&file)).sum::<u64>();
        println!("{page}: {total} bytes");
        assert!(total < 40_000, "{page}: {total} bytes");
    }
}

#[test]
#[ignore = "by hand: writes the pictures that stand where no script runs"]
fn stills() {
    assert_eq!(std::env::var("UPDATE").as_deref(), Ok("1"), "UPDATE=1 writes them");
    let mut browser = Browser::with_webgl();
    sized(&mut browser, (900, 900, false));
    for page in pages() {
        shown(&mut browser, &address(page));
        let still =
            browser.run("figures.all[0].box.querySelector('.still img').getAttribute('src')");
        let still = still.as_str().unwrap().to_owned();
        // Others are drawings.
        if still.ends_with("_figure.png") {
            taken(&mut browser, "figures.all[0].stage", &root().join("docs").join(still));
        }
    }
}

#[test]
#[ignore = "by hand: writes pictures to look at"]
fn pictures() {
    let folder = std::path::PathBuf::from(std::env::var_os("SHOTS").expect("SHOTS names a folder"));
    fs::create_dir_all(&folder).unwrap();
    let mut browser = Browser::with_webgl();
    for page in pages() {
        for (size, on) in [(DESK, "desk"), (PHONE, "phone")] {
            sized(&mut browser, size);
            shown(&mut browser, &address(page));
            for name in ["light", "navy"] {
                theme(&mut browser, name);
                browser.run("new Promise(done => setTimeout(done, 600))");
                let file = folder.join(format!("figure-{page}-{on}-{name}.png"));
                taken(&mut browser, "figures.all[0].box", &file);
            }
        }
    }
}
