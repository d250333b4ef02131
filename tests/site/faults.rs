//! Faults of a page: each is reported in one line with its place, and no site is written.

use std::fs;
use std::path::Path;
#[cfg(unix)]
use std::process::{Command, Stdio};
#[cfg(unix)]
use std::time::Duration;

use tempfile::TempDir;

const MANIFEST: &str = "[package]\nname = \"book\"\n\n[workspace]\nmembers = []\n";
const SUMMARY: &str = "# Summary\n\n[One](one.md)\n\n# I · Part\n\n- [Two](two.md)\n";

/// A book of two pages, the first as given.
pub fn book(page: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let files = [
        ("Cargo.toml", MANIFEST),
        ("docs/SUMMARY.md", SUMMARY),
        ("docs/one.md", page),
        ("docs/two.md", "# Two\n\n## A place\n"),
        (
            "docs/images/a.svg",
            "<svg width=\"10\" height=\"10\" xmlns=\"http://www.w3.org/2000/svg\"/>",
        ),
        ("samples/x.rs", "// ANCHOR: a\nfn x() {}\n// ANCHOR_END: a\n"),
    ];
    for (path, text) in files {
        let path = folder.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

/// The names of the files in a folder.
fn names(folder: &Path) -> Vec<String> {
    let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name());
    files.map(|name| name.to_string_lossy().into_owned()).collect()
}

pub fn built(folder: &Path) -> Result<String, String> {
    let out = folder.join("book");
    let result = site::output::replace(&out, |made| site::build(folder, made));
    match result {
        Ok(_) => Ok(fs::read_to_string(out.join("one.html")).unwrap()),
        Err(error) => {
            assert!(!out.exists(), "half a site is left");
            assert!(!names(folder).iter().any(|name| name.starts_with(".book")));
            Err(format!("{error:#}"))
        }
    }
}

#[test]
fn a_page_without_fault_is_built() {
    let page = "# One\n\n[There](two.md#a-place), ![A](images/a.svg), $x^2$.\n\n\
                <!-- snippet samples/x.rs#a -->\n```rust\nfn x() {}\n```\n<!-- /snippet -->\n\n\
                - an item\n  <!-- explains 3 -->\n- and another\n";
    let html = built(book(page).path()).unwrap();
    assert!(html.contains("two.html#a-place") && html.contains("<msup>"), "{html}");
    assert!(html.contains("one-code.html#samples-x-rs.a"), "{html}");
    // Neither the comment nor its blank line is left, which would make the list loose.
    assert!(!html.contains("explains") && html.contains("<li>an item</li>"), "{html}");
    assert!(html.contains("<span class=\"hljs-keyword\">fn</span>"), "{html}");
}

#[test]
fn every_fault_is_named_with_its_line() {
    let cases = [
        ("![A](images/b.png)", "there is no picture 'images/b.png'"),
        ("[a](three.md)", "the link leads to 'docs/three.md', which is no file"),
        ("[a](two.md#nowhere)", "the link leads to 'two.html#nowhere', and there is no such place"),
        ("[a](#nowhere)", "the link leads to 'one.html#nowhere', and there is no such place"),
        ("[a](../samples/y.rs)", "the link leads to 'samples/y.rs', which is no file"),
        ("$\\nonsense$", "the formula '\\nonsense' cannot be drawn: "),
        ("$$\\frac{1}{2$$", "a '$' begins a formula that does not end"),
        ("{{#include a.md}}", "mdBook's {{#…}} is not filled in here"),
        ("<!-- slider -->\n\nNo picture.", "no picture follows the mark 'slider'"),
        ("<!-- touch a -->\n\nNo picture.", "no picture follows the mark 'touch'"),
        (
            "<!-- touch b -->\n![A](images/a.svg)",
            "there is no figure 'b': docs/site/interactive/b.js does",
        ),
        ("<!-- slider b: x | y -->\n![A](images/a.svg)", "the slider takes 'docs/images/b.png'"),
        (
            "<!-- snippet samples/x.rs#b -->\n```rust\n```\n<!-- /snippet -->",
            "the link leads to 'one-code.html#samples-x-rs.b', and there is no such place",
        ),
        (
            "<!-- snippet samples/y.rs -->\n```rust\n```\n<!-- /snippet -->",
            "the marker names 'samples/y.rs', which is no file",
        ),
    ];
    for (fault, expected) in cases {
        let error = built(book(&format!("# One\n\n{fault}\n")).path());
        let error = error.expect_err(fault);
        let lines: Vec<&str> = error.lines().collect();
        // Such a fault belongs to the picture, one line below the mark.
        let below = ["the slider takes", "there is no figure"];
        let place = if below.iter().any(|what| expected.contains(what)) { 4 } else { 3 };
        let expected = format!("docs/one.md:{place}: {expected}");
        assert!(lines.len() == 1 && lines[0].starts_with(&expected), "{expected}: {error}");
        assert!(lines[0].contains("; "), "no remedy: {error}");
    }
    let folder = book("# One\n");
    fs::write(folder.path().join("docs/SUMMARY.md"), format!("{SUMMARY}- [Three](three.md)\n"))
        .unwrap();
    let error = built(folder.path()).unwrap_err();
    assert!(error.starts_with("docs/SUMMARY.md:8: 'docs/three.md' does not exist; "), "{error}");
}

#[test]
fn what_has_moved_leads_on() {
    let folder = book("# One\n");
    let moved = |text: &str| fs::write(folder.path().join("docs/moved.toml"), text).unwrap();
    moved(
        "# so\n\"one.md#old\" = \"two.md#a-place\"\n\"gone.md\" = \"two.md\"\n\"exercise 1.2\" = \"2.1\"\n",
    );
    let html = built(folder.path()).unwrap();
    assert!(html.contains(r##"{"#old":"two.html#a-place"}"##), "{html}");
    let gone = fs::read_to_string(folder.path().join("book/gone.html")).unwrap();
    assert!(gone.contains("two.html"), "{gone}");
    fs::remove_dir_all(folder.path().join("book")).unwrap();
    for (text, fault) in [
        ("\"one.md#old\" = \"two.md#nowhere\"", "1: the link leads to 'two.html#nowhere', and"),
        ("\"one.md#old\" = \"three.md\"", "1: 'three.md' is no page of the book; correct it"),
        ("\"one.md\" = \"two.md\"", "1: 'one.md' has not moved: it is a page of the book"),
        ("\n\"one.md#one\" = \"two.md\"", "2: 'one.html' still has a place 'one'; take this line"),
        ("\"one#old\" = \"two.md\"", "1: 'one#old' is no place of a page; correct it"),
        ("one = two", "1: "),
    ] {
        moved(text);
        let error = built(folder.path()).unwrap_err();
        assert!(error.starts_with(&format!("docs/moved.toml:{fault}")), "{text}: {error}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
}

#[test]
fn all_faults_are_named_at_once() {
    let error = built(book("# One\n\n$\\a$ [a](b.md)\n\n![A](c.png)\n").path()).unwrap_err();
    assert_eq!(error.lines().count(), 3, "{error}");
}

#[cfg(unix)]
#[test]
fn a_signal_leaves_a_site_or_none() {
    let text = "A sentence of which there are many.\n\n".repeat(2000);
    let folder = book(&format!("# One\n\n{text}"));
    let (mut stopped, mut made) = (0, 0);
    for round in 0..8 {
        let out = folder.path().join(format!("site{round}"));
        // `nohup`, under which tests may run, ignores a signal.
        let mut command = Command::new("env");
        command.arg("--default-signal=INT,TERM,HUP").arg(env!("CARGO_BIN_EXE_site"));
        command.arg("--root").arg(folder.path()).arg("--out").arg(&out);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let mut child = command.spawn().unwrap();
        let begun = || names(folder.path()).iter().any(|name| name.starts_with(".book"));
        while !begun() && child.try_wait().unwrap().is_none() {}
        std::thread::sleep(Duration::from_millis(30 * round));
        Command::new("kill").arg(child.id().to_string()).status().unwrap();
        let status = child.wait().unwrap();
        if status.success() {
            made += 1;
        } else {
            stopped += 1;
        }
        // Its mark is the last file of a site to be written.
        let is_whole = out.join(".made-by-cargo-chapters-book").exists();
        assert!(is_whole || !(out.exists() || status.success()), "{status}");
        assert!(!begun(), "{status}: {:?}", names(folder.path()));
    }
    assert!(stopped > 0, "{made} were made before a signal came");
}
