//! The drawings in the light and the dark scheme, in Chromium: text and lines have enough contrast with their
//! background.

use std::fs;
use std::path::{Path, PathBuf};

use drawings::{For, INKS};
use serde_json::{Value, json};

use crate::browser::Browser;
use crate::reading::{address, decode, theme};

const CHECKS: &str = include_str!("drawing.js");
pub const SCHEMES: [&str; 2] = ["light", "dark"];

pub fn prefers(browser: &mut Browser, scheme: &str) {
    let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
    browser.call("Emulation.setEmulatedMedia", &json!({ "features": features }));
}

/// A colour in the browser's notation.
fn told(color: &str) -> String {
    let part = |at: usize| u8::from_str_radix(&color[at..at + 2], 16).unwrap();
    format!("rgb({}, {}, {})", part(1), part(3), part(5))
}

/// The texts and lines without enough contrast, and the number of those checked.
fn looked_at(browser: &mut Browser, file: &Path, scheme: &str) -> (Vec<String>, u64) {
    prefers(browser, scheme);
    browser.open(&format!("file://{}", file.display()));
    let script = [("GROUNDS", For::Ground), ("GRIDS", For::Grid)];
    let script = script.into_iter().fold(CHECKS.to_owned(), |script, (word, use_for)| {
        let inks = INKS.iter().filter(|ink| ink.use_for == use_for);
        let colors: Vec<String> = inks.flat_map(|ink| [told(ink.light), told(ink.dark)]).collect();
        script.replace(word, &json!(colors).to_string())
    });
    let found = browser.run(&script);
    let name = file.file_name().unwrap().to_string_lossy();
    let wrong = found["wrong"].as_array().into_iter().flatten().filter_map(Value::as_str);
    (
        wrong.map(|line| format!("{name}, {scheme}: {line}")).collect(),
        found["seen"].as_u64().unwrap(),
    )
}

fn drawings() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../images").canonicalize().unwrap();
    let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
    let mut files: Vec<_> =
        files.filter(|file| file.extension().is_some_and(|e| e == "svg")).collect();
    files.sort();
    files
}

#[test]
#[ignore = "nightly only: in a browser"]
fn every_drawing_stands_out_by_light_and_by_dark() {
    let mut browser = Browser::start();
    let (mut faults, mut seen) = (Vec::new(), 0);
    for file in drawings() {
        for scheme in SCHEMES {
            let (wrong, count) = looked_at(&mut browser, &file, scheme);
            assert!(count > 5, "{}: {count}", file.display());
            faults.extend(wrong);
            seen += count;
        }
    }
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
    assert!(seen > 2000, "{seen} texts and lines");
}

#[test]
#[ignore = "nightly only: in a browser"]
fn dark_ink_that_stays_on_dark_paper_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.svg");
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"90\" height=\"90\" fill=\"#22303c\">\
        <style>@media (prefers-color-scheme: dark){[fill=\"#f7f8f9\"]{fill:#1c212d}}</style>\
        <rect width=\"90\" height=\"90\" fill=\"#f7f8f9\"/><text x=\"9\" y=\"40\">ink</text>\
        <path d=\"M9 60 L80 60\" stroke=\"#5b6b78\" fill=\"none\"/></svg>";
    fs::write(&file, svg).unwrap();
    let mut browser = Browser::start();
    assert_eq!(looked_at(&mut browser, &file, "light"), (Vec::new(), 2));
    let (wrong, _) = looked_at(&mut browser, &file, "dark");
    assert!(wrong[0].starts_with("a.svg, dark: 'ink' has a contrast of 1."), "{wrong:?}");
    assert!(wrong[1].starts_with("a.svg, dark: a line in rgb(91, 107, 120)"), "{wrong:?}");
}

/// The lightness of the page's first drawing, from 0 to 1.
fn lightness(browser: &mut Browser) -> f64 {
    browser.run(
        "(async () => {
            const image = document.querySelector('img.drawing');
            image.loading = 'eager';
            await image.decode();
            image.scrollIntoView({ block: 'start', behavior: 'instant' });
            await new Promise(done => setTimeout(done, 200));
        })()",
    );
    let file = tempfile::Builder::new().suffix(".png").tempfile().unwrap();
    decode(&browser.picture(), file.path());
    let picture = image::open(file.path()).unwrap().to_luma8();
    let place = browser.run(
        "(box => [box.x, box.y, box.width, box.height])
            (document.querySelector('img.drawing').getBoundingClientRect())",
    );
    let [x, y, width, height] = [0, 1, 2, 3].map(|at| place[at].as_f64().unwrap() as u32);
    let height = height.min(picture.height() - y);
    let part = image::imageops::crop_imm(&picture, x, y, width, height).to_image();
    let sum: f64 = part.pixels().map(|pixel| f64::from(pixel[0])).sum();
    sum / f64::from(width * height) / 255.0
}

#[test]
#[ignore = "nightly only: in a browser"]
fn a_drawing_of_the_book_follows_its_switch_whatever_the_system_prefers() {
    let mut browser = Browser::start();
    browser.size(1280, 900, false);
    for scheme in SCHEMES {
        prefers(&mut browser, scheme);
        browser.open(&address("43_filtered_checker.html"));
        theme(&mut browser, "light");
        let light = lightness(&mut browser);
        theme(&mut browser, "navy");
        let dark = lightness(&mut browser);
        assert!(light > 0.8 && dark < 0.35, "{scheme}: light {light:.2}, dark {dark:.2}");
    }
}

#[test]
#[ignore = "by hand: writes pictures to look at"]
fn pictures() {
    let folder = PathBuf::from(std::env::var_os("SHOTS").expect("SHOTS names a folder"));
    fs::create_dir_all(&folder).unwrap();
    let mut browser = Browser::start();
    for file in drawings() {
        let size = site::picture::size(&file).unwrap();
        browser.size(size.0, size.1, false);
        for scheme in SCHEMES {
            prefers(&mut browser, scheme);
            browser.open(&format!("file://{}", file.display()));
            let name = file.file_stem().unwrap().to_string_lossy();
            decode(&browser.picture(), &folder.join(format!("{name}-{scheme}.png")));
        }
    }
}
