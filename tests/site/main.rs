//! The website of the book: built whole, then read as text and in a browser without a window.
//!
//! `SHOTS=FOLDER cargo test --test site pictures -- --ignored` writes pictures of three pages to look at.

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

/// The variable that says where Firefox listens, for tests that run again in that.
const FIREFOX: &str = "SITE_FIREFOX";

/// The site of this project, built once for all tests, and left to be looked at.
fn built() -> &'static Built {
    static BUILT: OnceLock<Built> = OnceLock::new();
    BUILT.get_or_init(|| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        // As a code host serves it: below a name.
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("site/a book");
        // What runs again reads what is built already.
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
                // A page that has moved as a whole: its old address only leads on.
                if text.contains("<title>Redirecting...</title>") {
                    continue;
                }
                let mut found = attributes(&text);
                // Of the spans of code there are a hundred thousand.
                found.retain(|attribute| !["class", "data-n"].contains(&&*attribute.name));
                pages.insert(name, (text, found));
            }
        }
        Built { folder, counts, pages }
    })
}

/// The addresses of the pages that are read: not what is shown in a frame where there is no script, nor
/// where there is no page.
fn addresses() -> impl Iterator<Item = &'static String> {
    built().pages.keys().filter(|name| !["toc.html", "404.html"].contains(&&***name))
}
