//! What a chapter teaches stands raw in its own folder; `shaders/common` holds copies for later chapters.
//!
//! So whoever edits a chapter's file changes that chapter alone. The first line of each shared file says
//! whose it is.

use crate::fault::Fault;
use crate::project::{Chapter, Project};
use crate::shader;

/// The forms of a shared file's first line. Only the first promises the same text.
const COPY: &str = ", whose own file this is a copy of.";
const FORMS: &str = "begin it with `// Taught by NN_name, whose own file this is a copy of.`, \
                     `// Taught by NN_name; …` or `// Of no chapter: …`";

/// What is wrong with the files that chapters share.
pub fn check(project: &Project) -> Vec<Fault> {
    let files = project.files("shaders/common");
    files.iter().flat_map(|file| shared(project, file)).collect()
}

fn shared(project: &Project, file: &str) -> Vec<Fault> {
    let text = project.read(file).unwrap_or_default();
    // A stage begins with its version: nothing may stand before it.
    let first = text.lines().find(|line| !line.starts_with("#version")).unwrap_or_default();
    if first.starts_with("// Of no chapter: ") {
        return Vec::new();
    }
    let fault = |what: String, remedy: String| vec![Fault::new(file, 1, what, remedy)];
    let Some(rest) = first.strip_prefix("// Taught by ") else {
        return fault("it does not say which chapter teaches it".to_owned(), FORMS.to_owned());
    };
    let name = rest.split([',', ';', ' ', '.']).next().unwrap_or_default();
    let Some(chapter) = project.chapters.iter().find(|chapter| chapter.name == name) else {
        return fault(format!("there is no chapter '{name}'"), FORMS.to_owned());
    };
    let own = file.replacen("common", name, 1);
    if first.ends_with(COPY) && project.read(&own).ok() != Some(without_head(&text)) {
        let what = format!("it is no copy of {own}");
        return fault(what, "copy that below the first two lines, or say what differs".to_owned());
    }
    includers(project, chapter, file)
}

/// The teaching chapter itself must not depend on the copy.
fn includers(project: &Project, chapter: &Chapter, file: &str) -> Vec<Fault> {
    let includer = shader::shared(project, chapter).remove(file);
    let own = file.replacen("common", &chapter.name, 1);
    let fault = |includer| {
        let what = format!("it includes {file}, which {} teaches", chapter.name);
        Fault::new(includer, 1, what, format!("include {own}"))
    };
    includer.into_iter().map(fault).collect()
}

/// A shared file without its first line and the empty comment that follows.
fn without_head(text: &str) -> String {
    text.split_inclusive('\n').skip(2).collect()
}
