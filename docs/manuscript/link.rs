//! Links of a page.

use std::path::{Component, Path, PathBuf};

/// The file a page's link leads to, from the project's root; `None` if it leads to the web or to the page
/// itself.
pub fn local(page: &str, target: &str) -> Option<String> {
    let target = target.split(['#', '?']).next().unwrap_or_default();
    let scheme = target.split_once(':').is_some_and(|(scheme, _)| !scheme.contains('/'));
    if target.is_empty() || scheme || target.starts_with("//") {
        return None;
    }
    let mut path = PathBuf::from(page);
    path.pop();
    for part in Path::new(target).components() {
        match part {
            Component::ParentDir if path.pop() => {}
            // There is nothing above the root; the link is kept as one that cannot be resolved.
            Component::ParentDir => path.push(".."),
            Component::Normal(part) => path.push(part),
            _ => {}
        }
    }
    Some(path.to_string_lossy().replace('\\', "/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_resolved_from_their_page() {
        let cases = [
            ("docs/a.md", "b.md#c", Some("docs/b.md")),
            ("docs/a.md", "../samples/x/main.rs", Some("samples/x/main.rs")),
            ("README.md", "docs/a.md", Some("docs/a.md")),
            ("README.md", "../out", Some("../out")),
            ("docs/a.md", "#part", None),
            ("docs/a.md", "https://example.org/a.md", None),
            ("docs/a.md", "mailto:a@b", None),
        ];
        for (page, target, expected) in cases {
            assert_eq!(local(page, target).as_deref(), expected, "{target}");
        }
    }
}
