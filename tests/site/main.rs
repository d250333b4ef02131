//! The book's website: built completely, then checked as text and in a browser without a window.
//!
//! `SHOTS=FOLDER cargo test --test site pictures -- --ignored` writes screenshots of three pages.

#[cfg(unix)]
mod browser;
#[cfg(unix)]
mod chromium;
#[cfg(unix)]
mod drawing;
mod faults;
#[cfg(unix)]
mod firefox;
#[cfg(unix)]
mod interactive;
#[cfg(unix)]
mod lost;
mod pages;
#[cfg(unix)]
mod reading;
#[cfg(unix)]
mod talk;
#[cfg(unix)]
mod this_gpu;
#[cfg(unix)]
#[path = "../window/xvfb.rs"]
mod xvfb;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use site::Counts;
use site::html::{Attribute, attributes};

/// The built site.
struct Built {
    folder: PathBuf,
    counts: Counts,
    /// Every page: its address, its text, its attributes.
    pages: BTreeMap<String, (String, Vec<Attribute>)>,
}

/// The variable with the address of Firefox, for tests that run again in it.
const FIREFOX: &str = "SITE_FIREFOX";

/// The site of this project, built once for all tests, and kept for inspection.
fn built() -> &'static Built {
    static BUILT: OnceLock<Built> = OnceLock::new();
    BUILT.get_or_init(|| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        // As on a code host: below a name.
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("site/a book");
        // A repeated run uses the existing site.
        let counts = match std::env::var_os(FIREFOX) {
            Some(_) => Counts::default(),
            None => site::output::replace(&folder, |made| site::build(&root, made))
                .unwrap_or_else(|error| panic!("{error:#}")),
        };
        let mut pages = BTreeMap::new();
        for file in fs::read_dir(&folder).unwrap() {
            let name = file.unwrap().file_name().into_string().unwrap();
            if name.ends_with(".html") {
                let text = fs::read_to_string(folder.join(&name)).unwrap();
                // A page that has moved as a whole: its old address only redirects.
                if text.contains("<title>Redirecting...</title>") {
                    continue;
                }
                let mut found = attributes(&text);
                // There are a hundred thousand spans of code.
                found.retain(|attribute| !["class", "data-n"].contains(&&*attribute.name));
                pages.insert(name, (text, found));
            }
        }
        Built { folder, counts, pages }
    })
}

/// The addresses of the pages to check: neither those shown in a frame without scripts, nor the one for
/// missing pages.
fn addresses() -> impl Iterator<Item = &'static String> {
    built().pages.keys().filter(|name| !["toc.html", "404.html"].contains(&&***name))
}
