//! Figures in Chromium and in Firefox with WebGL 2: their results, and their controls.
//!
//! `UPDATE=1 cargo test -p site figures::stills -- --ignored` writes the pictures shown without scripts.

mod r#box;
mod candidates;
mod checker;
mod digits;
mod glass;
mod lens;
mod march;
mod refit;
mod solids;
mod sphere;
mod start;
mod table;
mod triangle;
mod walk;

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use crate::browser::{Browser, Pointer};
use crate::firefox::Firefox;
use crate::reading::{DESK, PHONE, address, checked, complaints, decode, sized, theme};
use crate::{addresses, built, faults};

pub fn root() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Each page with figures, and the figures' names.
fn pages() -> impl Iterator<Item = (&'static str, Vec<&'static str>)> {
    let named = |page: &'static String| {
        let boxes = built().pages[page].0.split("data-figure=\"").skip(1);
        (page.as_str(), boxes.map(|rest| rest.split('"').next().unwrap()).collect())
    };
    addresses().map(named).filter(|(_, names): &(_, Vec<_>)| !names.is_empty())
}

/// Every figure: its page, and its name.
fn all() -> Vec<(&'static str, &'static str)> {
    pages().flat_map(|(page, names)| names.into_iter().map(move |name| (page, name))).collect()
}

/// A promise of whether an expression becomes true on the page, within this many frames.
fn waiting(until: &str) -> String {
    format!(
        "new Promise(done => {{
            let tries = 5000;
            const look = () => ({until}) || --tries < 0 ? done(tries >= 0) : requestAnimationFrame(look);
            look();
        }})"
    )
}

/// Waits until an expression on the page is true.
fn wait(browser: &mut Browser, until: &str) {
    assert_eq!(browser.run(&waiting(until)), true, "never: {until}");
}

/// Opens a page and scrolls a figure into view, until it is drawn. From then on it is the page's variable
/// `figure`.
pub fn shown(browser: &mut Browser, address: &str, name: &str) -> Vec<Value> {
    browser.open("about:blank");
    let told = browser.open(address);
    chosen(browser, name);
    browser.run("figure.box.scrollIntoView({ block: 'center', behavior: 'instant' })");
    wait(browser, "figure.found || figure.said.textContent");
    told
}

/// Makes a figure the page's variable `figure`.
fn chosen(browser: &mut Browser, name: &str) {
    browser.run(&format!("window.figure = figures.all.find(({{ name }}) => name === {name:?})"));
}

/// A screenshot of an element of the page, without the bar that would cover it.
fn taken(browser: &mut Browser, element: &str, file: &Path) {
    browser.run("document.getElementById('mdbook-menu-bar').hidden = true");
    decode(&browser.part(element), file);
}

/// Sets controls like a reader, and returns the figure's results.
pub fn found(browser: &mut Browser, controls: &[(&str, &str)], what: &str) -> Value {
    let (controls, drawn) = (json!(controls), waiting("figure.found"));
    browser.run(&format!(
        "(async () => {{
            for (const [name, value] of {controls}) {{
                const input = figure.input(name);
                figure.found = null;
                input.value = value;
                input.dispatchEvent(new Event('input', {{ bubbles: true }}));
            }}
            if (!await {drawn}) {{
                throw new Error(`nothing is found by ${{{controls}.join()}}`);
            }}
            return (found => {what})(figure.found);
        }})()"
    ))
}

#[test]
#[ignore = "nightly only: in a browser"]
fn every_figure_starts_can_be_read_and_answers_the_keyboard_alone() {
    let mut browser = Browser::with_webgl();
    let mut answered = 0;
    for (page, name) in all() {
        sized(&mut browser, PHONE);
        let mut faults = complaints(&shown(&mut browser, &address(page), name));
        for size in [PHONE, DESK] {
            sized(&mut browser, size);
            for name in ["light", "navy"] {
                theme(&mut browser, name);
                faults.extend(checked(&mut browser).wrong);
            }
        }
        assert_eq!(browser.run("figure.box.classList.contains('moves')"), true, "{page}");
        let names = browser.run(
            "figure.inputs().filter(input => input.type !== 'hidden').map(input => input.name)",
        );
        let names: Vec<String> = serde_json::from_value(names).unwrap();
        assert!(names.len() > 1, "{names:?}");
        browser.run(&format!("figure.input({:?}).focus()", names[0]));
        for (index, name) in names.iter().enumerate() {
            if index > 0 {
                browser.press("Tab", 9);
            }
            assert_eq!(browser.run("document.activeElement.name"), json!(name), "{page}");
            let value = "document.activeElement.value";
            let before = browser.run(value);
            browser.run("figure.found = null");
            browser.press("ArrowDown", 40);
            if browser.run(value) == before {
                browser.press("ArrowUp", 38);
            }
            assert_ne!(browser.run(value), before, "{page}: {name}");
            wait(&mut browser, "figure.found");
            answered += 1;
        }
        assert!(browser.run("location.pathname").as_str().unwrap().ends_with(page));
        // There is no animation for readers who prefer less motion.
        assert_eq!(browser.run("figure.box.getAnimations({ subtree: true }).length"), 0, "{page}");
        faults.extend(complaints(&browser.told()));
        assert!(faults.is_empty(), "{page}:\n{}", faults.join("\n"));
    }
    assert!(answered > 10, "{answered}");
}

#[test]
#[ignore = "nightly only: in a browser"]
fn who_is_on_the_still_picture_by_the_keyboard_goes_on_with_the_figure() {
    let mut browser = Browser::with_webgl();
    sized(&mut browser, DESK);
    shown(&mut browser, &address(walk::PAGE), "walk");
    let on = "document.activeElement";
    browser.run("figure.stand(true); figure.box.querySelector('.still a').focus()");
    assert_eq!(browser.run(&format!("{on}.className")), "picture");
    browser.run("figure.found = null; figure.change()");
    wait(&mut browser, "figure.found");
    assert_eq!(browser.run(&format!("{on} === figure.inputs()[0]")), true);
}

#[test]
#[ignore = "nightly only: in a browser"]
fn points_can_be_dragged() {
    let grips =
        "[...figure.stage.querySelectorAll('.grip')].map(grip => grip.getBoundingClientRect())
        .map(box => [box.x + box.width / 2, box.y + box.height / 2, box.width])";
    let mut browser = Browser::with_webgl();
    sized(&mut browser, PHONE);
    // Each figure, and the number of its points that can be dragged anywhere.
    for (page, name, count) in [
        (candidates::PAGE, "candidates", 1),
        (glass::PAGE, "glass", 2),
        (lens::PAGE, "lens", 1),
        (walk::PAGE, "walk", 2),
        (triangle::PAGE, "triangle", 2),
        (r#box::PAGE, "box", 1),
        (march::PAGE, "march", 2),
        (refit::PAGE, "refit", 2),
        (solids::PAGE, "solids", 2),
    ] {
        shown(&mut browser, &address(page), name);
        for index in 0..count {
            // The second drag goes back, so that both have room. The page is at a whole pixel: if Firefox has
            // scrolled to a position between two pixels, it may move a moment later.
            for (by, way) in [(Pointer::Mouse, -40.0), (Pointer::Finger, 30.0)] {
                browser.run(&format!(
                    "var box = figure.stage.querySelectorAll('.grip')[{index}].getBoundingClientRect();
                    var whole = Math.round(scrollY + box.y - innerHeight / 2);
                    [0, whole].forEach(top => scrollTo({{ top, behavior: 'instant' }}))"
                ));
                let place = browser.run(grips)[index].clone();
                let [x, y, wide]: [f64; 3] = serde_json::from_value(place).unwrap();
                assert!(wide > 15.0, "{page}: {wide}");
                let top = browser.run("scrollY");
                browser.drag(&[[x, y], [x, y + 0.5 * way], [x, y + way]], by);
                wait(&mut browser, "!figure.changed");
                let moved = browser.run(grips)[index][1].as_f64().unwrap();
                let what = format!("{page}, point {index}, {by:?}");
                assert!((moved - (y + way)).abs() < 1.5, "{what}: from {y} to {moved}");
                assert_eq!(browser.run("scrollY"), top, "{what}");
            }
        }
    }
}

// Otherwise the test above would prove nothing about fingers. Firefox's do not scroll a page.
#[test]
#[ignore = "nightly only: in a browser"]
fn beside_a_point_a_finger_moves_the_page() {
    let mut browser = Browser::with_webgl();
    sized(&mut browser, PHONE);
    shown(&mut browser, &address(walk::PAGE), "walk");
    let top = browser.run("scrollY");
    browser.drag(&[[2.0, 400.0], [2.0, 300.0], [2.0, 200.0]], Pointer::Finger);
    wait(&mut browser, &format!("scrollY > {top} + 50"));
}

/// A book with only the figure of the sphere, with some text in `sphere.glsl` replaced.
fn other(from: &str, to: &str) -> (tempfile::TempDir, Result<String, String>) {
    let mark = "<!-- touch sphere: rung = textbook; distance = 1e4 -->";
    let folder = faults::book(&format!("# One\n\n{mark}\n![A](images/a.svg)\n"));
    for file in [
        "docs/site/interactive/sphere.js",
        "docs/site/interactive/sphere.frag",
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
#[ignore = "nightly only: in a browser"]
fn a_changed_line_of_a_shader_changes_its_figure() {
    let mut browser = Browser::with_webgl();
    let mut medians = Vec::new();
    for to in ["b * b - a * c", "a * c - b * b"] {
        let (folder, built) = other("b * b - a * c", to);
        built.unwrap();
        let page = folder.path().join("book/one.html");
        shown(&mut browser, &format!("file://{}", page.display()), "sphere");
        medians.push(browser.run("figure.found.falseHits"));
    }
    assert_ne!(medians[0], medians[1]);
}

#[test]
#[ignore = "nightly only: in a browser"]
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
#[ignore = "nightly only: in a browser"]
fn a_figure_out_of_view_costs_nothing() {
    let mut browser = Browser::with_webgl();
    sized(&mut browser, DESK);
    browser.open(&address(sphere::PAGE));
    chosen(&mut browser, "sphere");
    let draws = "figure.found";
    // A visible figure would be drawn in the next frame.
    let change = "figure.change(); new Promise(done => \
                  requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))))";
    browser.run(change);
    assert_eq!(browser.run(&format!("{draws} === undefined")), true);
    shown(&mut browser, &address(sphere::PAGE), "sphere");
    browser.run("scrollTo({ top: 0, behavior: 'instant' })");
    wait(&mut browser, "!figure.seen");
    browser.run("figure.found = null");
    browser.run(change);
    assert_eq!(browser.run(&format!("{draws} === null")), true);
    browser.run("figure.box.scrollIntoView()");
    wait(&mut browser, draws);
}

#[test]
#[ignore = "nightly only: in a browser"]
fn a_figure_outlives_a_lost_context_and_does_without_webgl() {
    let still = "[figure.box.querySelector('.still').checkVisibility(), \
                 figure.controls.checkVisibility(), figure.said.textContent]";
    let mut browser = Browser::with_webgl();
    shown(&mut browser, &address(sphere::PAGE), "sphere");
    browser.run(
        "window.loses = figures.context().getExtension('WEBGL_lose_context'); loses.loseContext()",
    );
    wait(&mut browser, "!figure.box.classList.contains('moves')");
    let told = browser.run(still);
    assert!(told[2].as_str().unwrap().starts_with("The browser has taken the GPU away"), "{told}");
    assert_eq!([&told[0], &told[1]], [&json!(true), &json!(false)]);
    browser.run("loses.restoreContext()");
    wait(&mut browser, "figure.box.classList.contains('moves')");
    assert_eq!(browser.run(still)[0], false);

    let mut browser = Browser::without_webgl();
    let told = shown(&mut browser, &address(sphere::PAGE), "sphere");
    assert_eq!(complaints(&told), Vec::<String>::new());
    let told = browser.run(still);
    assert!(told[2].as_str().unwrap().starts_with("This browser has no WebGL 2"), "{told}");
    assert_eq!([&told[0], &told[1]], [&json!(true), &json!(false)]);
    assert_eq!(complaints(&browser.told()), Vec::<String>::new());
}

// Each figure is drawn and responds; one runs its shader, and points follow mouse and finger.
#[test]
#[ignore = "nightly only: in a browser"]
fn figures_start_compute_and_are_dragged_in_firefox_too() {
    in_firefox(&[
        "--ignored",
        "every_figure_starts_can_be_read_and_answers_the_keyboard_alone",
        "sphere::",
        "points_can_be_dragged",
        "a_page_with_faults_is_not_called_quiet",
    ]);
}

#[test]
#[ignore = "nightly only: a minute"]
fn what_these_tests_find_in_chromium_holds_in_firefox() {
    // Skipped: tests of the book's build, the one in which a finger scrolls the page, and those run by hand.
    let skipped =
        ["firefox", "a_line_that", "a_changed_line", "beside_a_point", "stills", "pictures"];
    let mut arguments =
        vec!["--ignored", "interactive::", "a_page_with_faults_is_not_called_quiet"];
    arguments.extend(skipped.iter().flat_map(|name| ["--skip", name]));
    in_firefox(&arguments);
}

/// Runs tests of this program again in Firefox.
fn in_firefox(arguments: &[&str]) {
    built();
    let (said, passed) = Firefox::start().again(arguments, &[]);
    let tests = said.matches(" ... ok").count();
    assert!(passed && tests >= 4, "{tests} tests pass in Firefox:\n{said}");
}

#[test]
fn the_scripts_of_a_page_are_small() {
    let size = |file: &str| fs::metadata(built().folder.join(file)).unwrap().len();
    let own = fs::metadata(root().join("docs/site/site.js")).unwrap().len();
    for (page, _) in pages() {
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
    for (page, name) in all() {
        shown(&mut browser, &address(page), name);
        let still = browser.run("figure.box.querySelector('.still img').getAttribute('src')");
        let still = still.as_str().unwrap().to_owned();
        // The other pictures are drawings.
        if still.ends_with("_figure.png") {
            taken(&mut browser, "figure.stage", &root().join("docs").join(still));
        }
    }
}

#[test]
#[ignore = "by hand: writes pictures to look at"]
fn pictures() {
    let folder = std::path::PathBuf::from(std::env::var_os("SHOTS").expect("SHOTS names a folder"));
    fs::create_dir_all(&folder).unwrap();
    let mut browser = Browser::with_webgl();
    for (page, figure) in all() {
        for (size, on) in [(DESK, "desk"), (PHONE, "phone")] {
            sized(&mut browser, size);
            shown(&mut browser, &address(page), figure);
            for name in ["light", "navy"] {
                theme(&mut browser, name);
                browser.run("new Promise(done => setTimeout(done, 600))");
                let file = folder.join(format!("figure-{page}-{figure}-{on}-{name}.png"));
                taken(&mut browser, "figure.box", &file);
            }
        }
    }
}

#[test]
#[ignore = "by hand: writes pictures to look at, by Firefox"]
fn pictures_in_firefox() {
    built();
    let folder = std::path::PathBuf::from(std::env::var_os("SHOTS").expect("SHOTS names a folder"));
    let test = ["interactive::pictures", "--exact", "--ignored"];
    let (said, passed) = Firefox::start().again(&test, &[("SHOTS", &folder.join("firefox"))]);
    assert!(passed, "{said}");
}

/// A measurement of the book, by `PAGE/NAME`.
pub fn stored(name: &str) -> Value {
    let (page, own) = name.split_once('/').unwrap();
    let text = fs::read_to_string(root().join(format!("docs/values/{page}.json"))).unwrap();
    serde_json::from_str::<Value>(&text).unwrap()[own].take()
}
