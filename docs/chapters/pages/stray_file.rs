//! Finds files that nothing mentions: left behind by a rename, or forgotten by their author.

use std::collections::BTreeSet;

use manuscript::fault::Fault;
use manuscript::project::{MEASUREMENTS, Project, SUMMARY};
use manuscript::shader;

use super::gallery::is_other_page;
use crate::exercises::exercise;
use crate::mistakes::mistake;
use crate::survey::card;
use crate::values::record;

/// The folders in which every file must be used.
const FOLDERS: [&str; 5] = ["docs", "samples", "shaders", "tests/golden", "tests/samples"];

/// All stray files; `linked` are the files that pages link to or make.
pub fn check(project: &Project, linked: &BTreeSet<String>) -> Vec<Fault> {
    let texts = Texts::read(project);
    let files = FOLDERS.into_iter().flat_map(|folder| project.files(folder));
    let stray = files.filter_map(|file| Some((why(project, &texts, linked, &file)?, file)));
    stray
        .map(|(why, file)| Fault::new(file, 1, format!("stray file: {why}"), "use it or delete it"))
        .collect()
}

/// The reason why a file is stray, or `None` if it is not.
fn why(project: &Project, texts: &Texts, linked: &BTreeSet<String>, file: &str) -> Option<String> {
    let (folder, name) = file.rsplit_once('/')?;
    let (stem, extension) = name.rsplit_once('.').unwrap_or((name, ""));
    let (used, why) = match extension {
        "rs" => {
            let path = |target: &&manuscript::project::Target| target.path == file;
            let target = project.bins.iter().chain(&project.tests).find(path).is_some();
            let root = target || project.libs.iter().any(|lib| lib == file);
            (root || texts.declares(folder, stem), "no [[bin]] and no `mod` names it")
        }
        "md" if folder == "docs" => {
            let page = project.of_page(file).is_some();
            (page || file == SUMMARY || is_other_page(name), "it is no chapter's page")
        }
        "md" if folder == format!("docs/{MEASUREMENTS}") => {
            (project.named(stem).is_some(), "it holds the tables of no chapter")
        }
        "png" | "svg" if folder == "docs/images" => (linked.contains(file), "no page shows it"),
        "png" if folder == "tests/golden" => {
            (texts.code_says(&format!("\"{stem}\"")), "no test compares with it")
        }
        "glsl" if file.starts_with("shaders/") => {
            (texts.included.contains(file), "no shader includes it")
        }
        extension if file.starts_with("shaders/") && shader::EXTENSIONS.contains(&extension) => {
            let below = file.trim_start_matches("shaders/");
            let own =
                texts.below(&folder.replacen("shaders/", "samples/", 1), &format!("\"{name}\""));
            // A compute shader of the framework is named without its folder.
            let common = folder == "shaders/common" && texts.code_says(&format!("\"{name}\""));
            (own || common || texts.code_says(&format!("\"{below}\"")), "no program names it")
        }
        // Their own check reports faulty ones.
        "diff" if [mistake::FOLDER, exercise::FOLDER].contains(&folder) => (true, ""),
        "json" if folder == card::FOLDER => (true, ""),
        "js" | "frag" | "txt" if folder == "docs/site/interactive" => {
            (texts.says(file, &format!("touch {stem}")), "no page has this figure")
        }
        _ if file.starts_with(record::FOLDER) => (true, ""),
        _ if name == "Cargo.toml" => {
            let member = format!("\"{folder}\",");
            (project.manifest.contains(&member), "it is no member of the workspace")
        }
        _ => (linked.contains(file) || texts.says(file, name), "nothing mentions it"),
    };
    (!used).then(|| why.to_owned())
}

/// The texts that may mention files.
struct Texts {
    /// Every text of the project that may mention a file, with its path.
    texts: Vec<(String, String)>,
    /// Every shader file that another includes.
    included: BTreeSet<String>,
}

impl Texts {
    fn read(project: &Project) -> Self {
        let folders = ["common", "docs", "samples", "tests"];
        let mut files: Vec<String> = folders.into_iter().flat_map(|f| project.files(f)).collect();
        let extensions = [".rs", ".toml", ".mtl", ".md"];
        files.retain(|file| extensions.iter().any(|extension| file.ends_with(extension)));
        let text = |file: String| project.read(&file).ok().map(|text| (file, text));
        let shaders = project.files("shaders");
        let included = shaders.iter().flat_map(|file| shader::includes(project, file)).collect();
        let mut texts: Vec<_> = files.into_iter().filter_map(text).collect();
        texts.push(("Cargo.toml".to_owned(), project.manifest.clone()));
        Self { texts, included }
    }

    fn code_says(&self, text: &str) -> bool {
        self.texts.iter().any(|(file, code)| file.ends_with(".rs") && code.contains(text))
    }

    fn below(&self, folder: &str, text: &str) -> bool {
        let inside =
            |file: &str| file.strip_prefix(folder).is_some_and(|rest| rest.starts_with('/'));
        self.texts.iter().any(|(file, code)| inside(file) && code.contains(text))
    }

    /// Returns whether another file contains the name between punctuation or blanks.
    fn says(&self, file: &str, name: &str) -> bool {
        let word = |c: char| c.is_alphanumeric() || ['_', '-', '.'].contains(&c);
        let whole = |text: &str| {
            text.match_indices(name).any(|(at, _)| {
                let after = text[at + name.len()..].chars().next();
                !text[..at].ends_with(word) && !after.is_some_and(|c| c.is_alphanumeric())
            })
        };
        self.texts.iter().any(|(other, text)| other != file && whole(text))
    }

    /// Returns whether a source next to a module, or above its folder, declares it.
    fn declares(&self, folder: &str, stem: &str) -> bool {
        let (folder, stem) = match stem {
            "mod" => folder.rsplit_once('/').unwrap_or(("", folder)),
            _ => (folder, stem),
        };
        let declaration = format!("mod {stem};");
        let parent = format!("{folder}.rs");
        self.texts.iter().any(|(file, code)| {
            let near = file.rsplit_once('/').is_some_and(|(of, _)| of == folder) || *file == parent;
            near && file.ends_with(".rs")
                && code.lines().any(|line| line.trim().trim_start_matches("pub ") == declaration)
        })
    }
}
