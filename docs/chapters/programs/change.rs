//! Files that have changed since a commit, according to git.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;

use manuscript::project::Project;

/// The environment variable that names the commit to compare a clean tree with: in CI, the one before a push.
const SINCE: &str = "CHANGED_SINCE";

/// The output of a git command; empty where there is no git, or no repository.
pub fn text(root: &Path, arguments: &[&str]) -> String {
    let output = Command::new("git").args(arguments).current_dir(root).output();
    let output = output.ok().filter(|output| output.status.success());
    output.map_or_else(String::new, |output| String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The files that differ from the last commit; in a clean tree, from the commit before, or from the one named
/// by [`SINCE`].
fn files(root: &Path) -> Vec<String> {
    let list = |text: String| text.lines().map(str::to_owned).collect::<Vec<_>>();
    let mut found = list(text(root, &["diff", "--name-only", "HEAD"]));
    found.extend(list(text(root, &["ls-files", "--others", "--exclude-standard"])));
    if found.is_empty() {
        let since = std::env::var(SINCE).ok().filter(|since| !since.is_empty());
        let since = since.unwrap_or_else(|| "HEAD~1".to_owned());
        found = list(text(root, &["diff", "--name-only", &since, "HEAD"]));
    }
    found
}

/// The lines of each file that were edited since the last commit, from 1.
pub fn lines(root: &Path) -> BTreeMap<String, BTreeSet<usize>> {
    let diff = text(root, &["diff", "--unified=0", "--no-prefix", "HEAD"]);
    let (mut found, mut file) = (BTreeMap::<_, BTreeSet<usize>>::new(), String::new());
    for line in diff.lines() {
        if let Some(name) = line.strip_prefix("+++ ") {
            file = name.to_owned();
        } else if let Some(place) = line.strip_prefix("@@ ") {
            let place = place.split(" +").nth(1).and_then(|rest| rest.split(' ').next());
            let (first, count) =
                place.and_then(|p| p.split_once(',')).unwrap_or((place.unwrap_or(""), "1"));
            let (Ok(first), Ok(count)) = (first.parse::<usize>(), count.parse::<usize>()) else {
                continue;
            };
            found.entry(file.clone()).or_default().extend(first..first + count);
        }
    }
    found
}

/// The chapters whose own code or shaders have changed, by name.
pub fn chapters(project: &Project) -> BTreeSet<String> {
    let of = |file: String| {
        let mut parts = file.split('/');
        let is_own = ["samples", "shaders"].contains(&parts.next()?);
        parts.next().filter(|_| is_own).map(str::to_owned)
    };
    let names: BTreeSet<String> = files(&project.root).into_iter().filter_map(of).collect();
    names.into_iter().filter(|name| project.named(name).is_some()).collect()
}
