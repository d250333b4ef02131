//! The site in Chromium, from a reader's view: on a desktop and on a phone, in the light and the dark scheme,
//! with the keyboard.

use std::fs;
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::browser::Browser;
use crate::{addresses, built};

const CHECKS: &str = include_str!("checks.js");
pub const DESK: (u32, u32, bool) = (1280, 900, false);
pub const PHONE: (u32, u32, bool) = (390, 844, true);
/// The suffix of pages of code.
const CODE: &str = "-code.html";

pub fn address(page: &str) -> String {
    let path = fs::canonicalize(&built().folder).unwrap().join(page);
    format!("file://{}", path.display().to_string().replace(' ', "%20"))
}

pub fn sized(browser: &mut Browser, (width, height, phone): (u32, u32, bool)) {
    browser.size(width, height, phone);
}

/// The faults while a page was open, and its requests to other hosts.
pub fn complaints(told: &[Value]) -> Vec<String> {
    let mut found = Vec::new();
    for event in told {
        let parameters = &event["params"];
        match event["method"].as_str().unwrap_or_default() {
            "log.entryAdded" => {
                let level = parameters["level"].as_str().unwrap_or_default();
                let wrong = ["error", "warn"].contains(&level);
                found.extend(wrong.then(|| parameters.to_string()));
            }
            "Runtime.exceptionThrown" => found.push(parameters["exceptionDetails"].to_string()),
            "Runtime.consoleAPICalled" => {
                let kind = parameters["type"].as_str().unwrap_or_default();
                let wrong = ["error", "warning", "assert"].contains(&kind);
                found.extend(wrong.then(|| parameters["args"].to_string()));
            }
            "Log.entryAdded" => found.push(parameters["entry"].to_string()),
            "Network.loadingFailed" | "network.fetchError" => found.push(parameters.to_string()),
            "Network.requestWillBeSent" | "network.beforeRequestSent" => {
                let url = parameters["request"]["url"].as_str().unwrap_or_default();
                if !["file://", "data:"].iter().any(|scheme| url.starts_with(scheme)) {
                    found.push(format!("asks for {url}"));
                }
            }
            _ => {}
        }
    }
    found
}

pub fn theme(browser: &mut Browser, name: &str) {
    // A stylesheet that was disabled is loaded again.
    browser.run(&format!(
        "(async () => {{
            document.getElementById('mdbook-theme-{name}').click();
            const links = [...document.querySelectorAll('link[rel~=stylesheet]')];
            const coming = links.filter(link => !link.disabled && !link.sheet);
            await Promise.all(coming.map(link => new Promise(done => link.onload = link.onerror = done)));
        }})()"
    ));
}

/// The results of the checks of a page.
#[derive(Default)]
pub struct Checked {
    pub wrong: Vec<String>,
    /// The number of kinds of text found.
    kinds: u64,
    /// The number of boxes that scroll sideways.
    scrolling: u64,
}

pub fn checked(browser: &mut Browser) -> Checked {
    let found = browser.run(CHECKS);
    let wrong = found["wrong"].as_array().into_iter().flatten();
    let wrong = wrong.map(|line| line.as_str().unwrap_or_default().to_owned()).collect();
    let [kinds, scrolling] = ["kinds", "scrolling"].map(|key| found[key].as_u64().unwrap());
    Checked { wrong, kinds, scrolling }
}

#[test]
#[ignore = "nightly only: in a browser"]
fn every_page_is_quiet_and_can_be_read_on_a_desk_and_on_a_phone() {
    let (Checked { kinds, scrolling, .. }, asked) =
        read(addresses().filter(|page| !page.ends_with(CODE)));
    // Make sure that the checks have found something.
    assert!(kinds > 3000 && asked > 500, "{kinds} kinds of text, {asked} requests");
    assert!(scrolling > 500, "{scrolling} boxes scroll");
}

#[test]
#[ignore = "nightly only: a minute"]
fn every_page_of_code_is_quiet_and_can_be_read_on_a_desk_and_on_a_phone() {
    let (Checked { kinds, .. }, asked) = read(addresses().filter(|page| page.ends_with(CODE)));
    assert!(kinds > 1600 && asked > 300, "{kinds} kinds of text, {asked} requests");
}

// All of them have the same structure: one without a parent, one with a parent, and that of the first page.
#[test]
#[ignore = "nightly only: in a browser"]
fn pages_of_code_are_quiet_and_can_be_read_on_a_desk_and_on_a_phone() {
    let chosen = ["01_foundation", "02_basic", "index"].map(|name| format!("{name}{CODE}"));
    let (Checked { kinds, .. }, _) = read(chosen.iter());
    assert!(kinds > 100, "{kinds} kinds of text");
}

/// Opens pages, looks for faults on a phone and on a desktop, in both schemes, and returns the results and
/// the number of requests.
fn read<'a>(pages: impl Iterator<Item = &'a String>) -> (Checked, usize) {
    // A figure may be visible immediately.
    let mut browser = Browser::with_webgl();
    let (mut all, mut asked) = (Checked::default(), 0);
    for page in pages {
        sized(&mut browser, PHONE);
        let told = browser.open(&address(page));
        asked += told.iter().filter(|event| event["method"] == "Network.requestWillBeSent").count();
        let mut faults = complaints(&told);
        for (size, on) in [(PHONE, "a phone"), (DESK, "a desk")] {
            sized(&mut browser, size);
            for name in ["light", "navy"] {
                theme(&mut browser, name);
                let found = checked(&mut browser);
                faults
                    .extend(found.wrong.into_iter().map(|what| format!("on {on}, {name}: {what}")));
                all.kinds += found.kinds;
                all.scrolling += found.scrolling;
            }
        }
        faults.extend(lost_pictures(&mut browser));
        faults.extend(complaints(&browser.told()));
        all.wrong.extend(faults.into_iter().map(|what| format!("{page}: {what}")));
    }
    let Checked { wrong, .. } = &all;
    assert!(wrong.is_empty(), "{} faults:\n{}", wrong.len(), wrong.join("\n"));
    (all, asked)
}

/// Pictures of the page that cannot be loaded.
fn lost_pictures(browser: &mut Browser) -> Vec<String> {
    let lost = browser.run(
        "Promise.all([...document.images].map(async image => {
            image.loading = 'eager';
            await image.decode().catch(() => {});
            return image.naturalWidth > 0 ? '' : `the picture ${image.src} is not drawn`;
        })).then(all => all.filter(Boolean))",
    );
    serde_json::from_value(lost).unwrap()
}

#[test]
#[ignore = "nightly only: in a browser"]
fn a_page_with_faults_is_not_called_quiet() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.html");
    // Firefox refuses to connect to the lowest ports.
    let text = "<!DOCTYPE html><body style=\"background: #111\"><main>\
        <p style=\"color: #555\">grey on black</p><div style=\"width: 2000px\">a wide box</div>\
        <div style=\"overflow: auto; height: 9px\"><div style=\"width: 999px\">hidden words</div></div>\
        <math style=\"display: block; font-size: 1px; width: 1px\"><mi>x</mi></math><img src=\"no.png\"></main>\
        <script>console.error('said'); new Image().src = 'http://127.0.0.1:50009/elsewhere.png'; \
        document.body.append(lost);</script>";
    fs::write(&page, text).unwrap();
    let mut browser = Browser::start();
    sized(&mut browser, PHONE);
    let told = complaints(&browser.open(&format!("file://{}", page.display()))).join("\n");
    for expected in ["said", "asks for http://127.0.0.1:50009/elsewhere.png", "lost is not defined"]
    {
        assert!(told.contains(expected), "'{expected}' is not in {told}");
    }
    let mut wrong = checked(&mut browser).wrong;
    wrong.extend(lost_pictures(&mut browser));
    let wrong = wrong.join("\n");
    for expected in [
        "grey on black has a contrast of ",
        " a wide box ends ",
        " hidden words scrolls by ",
        "formula 'x' is ",
        "no.png is not drawn",
    ] {
        assert!(wrong.contains(expected), "'{expected}' is not in {wrong}");
    }
}

#[test]
#[ignore = "nightly only: in a browser"]
fn a_slider_moves_by_the_arrow_keys() {
    let mut browser = Browser::start();
    sized(&mut browser, DESK);
    let pages = addresses().filter(|page| built().pages[*page].0.contains("class=\"slider"));
    let mut sliders = 0;
    for page in pages {
        browser.open(&address(page));
        let count = browser.run("document.querySelectorAll('.slider.moves input').length");
        for index in 0..count.as_u64().unwrap() {
            let slider = format!("document.querySelectorAll('.slider')[{index}]");
            let clip = format!(
                "getComputedStyle({slider}.querySelectorAll('img')[1]).clipPath + \
                 {slider}.querySelector('input').getAttribute('aria-valuetext')"
            );
            browser.run(&format!("{slider}.querySelector('input').focus()"));
            let before = browser.run(&clip);
            browser.press("ArrowRight", 39);
            let after = browser.run(&clip);
            assert!(before.as_str().unwrap().starts_with("inset(0px 0px 0px 50%)"), "{before}");
            assert!(after.as_str().unwrap().starts_with("inset(0px 0px 0px 51%)"), "{after}");
            let [size, label] = ["offsetWidth", "getAttribute('aria-label')"]
                .map(|what| browser.run(&format!("{slider}.querySelector('input').{what}")));
            assert!(size.as_u64() > Some(200), "{page}: {size}");
            assert!(label.as_str().unwrap().contains(", before: "), "{label}");
            sliders += 1;
        }
        // The slider handles the arrow key: the page is the same.
        assert!(browser.run("location.pathname").as_str().unwrap().ends_with(page.as_str()));
    }
    assert_eq!(sliders, built().counts.sliders);
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_tab_key_reaches_everything_and_shows_where_it_is() {
    let mut browser = Browser::start();
    sized(&mut browser, DESK);
    browser.open(&address("05_shadow_miss.html"));
    let mut reached = Vec::new();
    loop {
        browser.press("Tab", 9);
        let at = browser.run(
            "(() => {
                const at = document.activeElement, style = getComputedStyle(at);
                const line = parseFloat(style.outlineWidth) >= 2 && style.outlineStyle !== 'none';
                return [at.id || at.className || at.textContent, line || style.outlineStyle === 'auto'];
            })()",
        );
        if browser.run("document.activeElement === document.body") == true {
            break; // behind the page's last stop
        }
        let name = at[0].as_str().unwrap().to_owned();
        assert_eq!(at[1], true, "'{name}' does not show that it has the focus");
        reached.push(name);
    }
    assert_eq!(reached[0], "skip");
    let wanted =
        ["mdbook-sidebar-toggle", "mdbook-theme-toggle", "mdbook-search-toggle", "whole", "next"];
    for wanted in wanted {
        assert!(reached.iter().any(|name| name == wanted), "{wanted} is not among {reached:?}");
    }
    // The first stop of the Tab key skips everything that is the same on every page.
    browser.run("document.querySelector('.skip').focus()");
    browser.press("Enter", 13);
    browser.press("Tab", 9);
    assert_eq!(
        browser.run("document.querySelector('main').contains(document.activeElement)"),
        true
    );
    // The contents open and close without a mouse.
    let open = "document.documentElement.classList.contains('sidebar-visible')";
    let before = browser.run(open);
    browser.run("document.getElementById('mdbook-sidebar-toggle').focus()");
    browser.press("Enter", 13);
    assert_ne!(browser.run(open), before);
}

#[test]
#[ignore = "nightly only: in a browser"]
fn what_scrolls_sideways_shows_it_and_is_moved_by_the_arrow_keys() {
    let mut browser = Browser::start();
    sized(&mut browser, PHONE);
    browser.open(&address("01_foundation.html"));
    browser.run(
        "window.box = [...document.querySelectorAll('.scrolls.after > *')]
            .find(box => box.checkVisibility() && box.scrollWidth - box.clientWidth > 120);
        box.scrollIntoView({ block: 'center' }); box.focus({ preventScroll: true })",
    );
    let arrows =
        "['before', 'after'].map(side => getComputedStyle(box.parentElement, '::' + side).content)";
    assert_eq!(browser.run(arrows), serde_json::json!(["none", "\"›\""]));
    assert_eq!(browser.run("document.activeElement === box"), true);
    let settled = "new Promise(done => setTimeout(() => done(box.scrollLeft), 400))";
    browser.press("ArrowRight", 39);
    let moved = browser.run(settled);
    assert!(moved.as_f64() > Some(0.0), "{moved}");
    assert_eq!(browser.run(arrows), serde_json::json!(["\"‹\"", "\"›\""]));
    browser.run("box.scrollLeft = box.scrollWidth");
    browser.run(settled);
    assert_eq!(browser.run(arrows), serde_json::json!(["\"‹\"", "none"]));
    // The box handled the keys: the page is the same.
    let page = browser.run("location.pathname");
    assert!(page.as_str().unwrap().ends_with("01_foundation.html"), "{page}");
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_search_answers_from_a_file() {
    let mut browser = Browser::start();
    sized(&mut browser, PHONE);
    browser.open(&address("reading.html"));
    let found = browser.run(
        "(async () => {
            document.getElementById('mdbook-search-toggle').click();
            const bar = document.getElementById('mdbook-searchbar');
            for (let tries = 0; tries < 500; tries++) {
                bar.value = 'penumbra';
                bar.dispatchEvent(new InputEvent('input', { bubbles: true }));
                bar.dispatchEvent(new KeyboardEvent('keyup', { bubbles: true }));
                await new Promise(done => setTimeout(done, 20));
                const links = [...document.querySelectorAll('#mdbook-searchresults a')];
                if (links.length > 0) {
                    return links.map(link => link.getAttribute('href'));
                }
            }
        })()",
    );
    let found = found.as_array().expect("no result within ten seconds");
    assert!(
        found.iter().any(|link| link.as_str().unwrap().contains("35_soft_shadows.html")),
        "{found:?}"
    );
}

#[test]
#[ignore = "nightly only: in a browser"]
fn the_arrow_keys_turn_the_pages() {
    let mut browser = Browser::start();
    sized(&mut browser, DESK);
    browser.open(&address("36_two_normals.html"));
    let label =
        browser.run("document.querySelector('.nav-chapters.next').getAttribute('aria-label')");
    assert_eq!(label, "08 · Intersection");
    browser.run("document.activeElement.blur()");
    browser.press("ArrowRight", 39);
    let there = browser.run("new Promise(done => setTimeout(() => done(location.pathname), 1))");
    // The old page may still be there and answer.
    let there = if there.as_str().unwrap().ends_with("36_two_normals.html") {
        std::iter::repeat_with(|| browser.run("location.pathname"))
            .take(200)
            .find(|path| !path.as_str().unwrap().ends_with("36_two_normals.html"))
            .unwrap()
    } else {
        there
    };
    assert!(there.as_str().unwrap().ends_with("08_intersection.html"), "{there}");
}

#[test]
#[ignore = "by hand: writes pictures to look at"]
fn pictures() {
    let folder = std::path::PathBuf::from(std::env::var_os("SHOTS").expect("SHOTS names a folder"));
    fs::create_dir_all(&folder).unwrap();
    let mut browser = Browser::start();
    let pages = [
        "index.html",
        "02_basic.html#what-does-a-closest-hit-shader-know",
        "05_shadow_miss.html",
        "05_shadow_miss-code.html#shaders-05_shadow_miss-camera-rgen",
        "wrong-pictures.html",
        "21_heightfield.html",
        "glossary.html",
        "reading.html?search=shadow%20ray",
        "404.html",
    ];
    for page in pages {
        for ((width, height, phone), on) in [((1280, 900, false), "desk"), (PHONE, "phone")] {
            sized(&mut browser, (width, height, phone));
            browser.open("about:blank");
            browser.open(&address(page));
            let name_of = page.split('.').next().unwrap();
            for (name, id) in [("light", "light"), ("dark", "navy")] {
                if page != "404.html" {
                    theme(&mut browser, id);
                }
                for (part, at) in [("top", 0.0), ("middle", 0.45)] {
                    // A page opened at an anchor stays there.
                    if part == "middle" || !page.contains(['#', '?']) {
                        let to =
                            format!("scrollTo(0, {at} * document.documentElement.scrollHeight)");
                        browser.run(&to);
                    }
                    browser.run("new Promise(done => setTimeout(done, 600))");
                    let file = folder.join(format!("{name_of}-{on}-{name}-{part}.png"));
                    decode(&browser.picture(), &file);
                }
            }
        }
    }
}

/// Decodes base64 into a file.
pub fn decode(text: &str, file: &std::path::Path) {
    use std::io::Write;
    let mut child = Command::new("base64")
        .arg("-d")
        .stdin(Stdio::piped())
        .stdout(fs::File::create(file).unwrap())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
    assert!(child.wait().unwrap().success());
}
