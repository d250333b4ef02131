//! Interactive figures: a script draws them, with the chapters' own shaders if possible.
//!
//! `<!-- touch NAME: CONTROLS -->`, on one line or more, comes before a picture, which is shown if no
//! script runs. NAME is `docs/site/interactive/NAME.js`, with a shader `NAME.frag` next to it if it needs
//! the GPU, and `NAME.txt` if it needs stored results of a test. [`control`] describes the controls, and
//! [`shader`] the translation of the shader.

pub mod control;
pub mod shader;
mod source;

use anyhow::Result;
use manuscript::fault::Fault;
use manuscript::project::Project;

use crate::color::escaped;

/// The script shared by all figures.
pub const FRAME: (&str, &str) = ("figure.js", include_str!("figure.js"));

/// The folder of the figures.
const FOLDER: &str = "docs/site/interactive";

/// The file of a figure's script on the site.
pub fn address(name: &str) -> String {
    format!("figure-{name}.js")
}

/// Parses a mark: returns the figure's name and its HTML in one line, around its picture.
///
/// # Errors
/// The fault of the mark.
pub fn html(
    project: &Project,
    mark: &str,
    picture: &str,
    words: &str,
) -> Result<(String, String), String> {
    let (name, controls) = mark.split_once(':').unwrap_or((mark, ""));
    let name = name.trim();
    if !project.has(&format!("{FOLDER}/{name}.js")) {
        return Err(format!("there is no figure '{name}': {FOLDER}/{name}.js does not exist"));
    }
    let html = format!(
        "<span class=\"figure\" data-figure=\"{name}\" role=\"group\" aria-label=\"{}\">\
         <span class=\"still\">{picture}</span><span class=\"controls\" hidden>{}</span></span>",
        escaped(words),
        control::html(controls)?
    );
    Ok((name.to_owned(), html))
}

/// The end of a page with figures: their scripts.
pub fn scripts<'a>(names: impl Iterator<Item = &'a String>) -> String {
    let files: Vec<String> = names.map(|name| address(name)).collect();
    let all = files.iter().map(String::as_str);
    let frame = (!files.is_empty()).then_some(FRAME.0);
    let tags = frame.into_iter().chain(all);
    tags.map(|file| format!("\n\n<script src=\"{file}\" defer></script>")).collect()
}

/// A script without indents and comment lines.
pub fn bare(script: &str) -> String {
    let lines = script.lines().map(str::trim_start);
    lines
        .filter(|line| !line.is_empty() && !line.starts_with("//"))
        .flat_map(|line| [line, "\n"])
        .collect()
}

/// A figure's script, preceded by its shader and stored values, or the faults of the shader.
///
/// # Errors
/// If a file cannot be read.
pub fn script(project: &Project, name: &str) -> Result<Result<String, Vec<Fault>>> {
    let mut own = bare(&project.read(&format!("{FOLDER}/{name}.js"))?);
    let stored = format!("{FOLDER}/{name}.txt");
    if project.has(&stored) {
        own =
            format!("figures.stored[\"{name}\"] = \"{}\";\n\n{own}", project.read(&stored)?.trim());
    }
    let file = format!("{FOLDER}/{name}.frag");
    if !project.has(&file) {
        return Ok(Ok(own));
    }
    let read = |path: &str| project.has(path).then(|| project.read(path).ok()).flatten();
    // GLSL contains neither of the two characters that would end the text.
    Ok(shader::translated(&read, &file)
        .map(|text| format!("figures.shaders[\"{name}\"] = `{text}`;\n\n{own}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bare_script_says_the_same_without_comments_and_indents() {
        let script = "// Why.\n\nfunction f() {\n    // Why, too.\n    return \"// no comment\"; // kept\n}\n";
        assert_eq!(bare(script), "function f() {\nreturn \"// no comment\"; // kept\n}\n");
    }
}
