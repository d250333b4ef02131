//! Shader sources: which files a shader includes, and which a chapter is made of.

use std::collections::BTreeMap;

use crate::project::{Chapter, Project};

/// What a shader file's extension may be, in the order in which a ray meets the stages.
pub const EXTENSIONS: [&str; 10] =
    ["rgen", "rmiss", "rchit", "rahit", "rint", "rcall", "comp", "vert", "frag", "glsl"];

/// The files that a shader includes itself, from the project's root.
///
/// As the compiler finds them: beside the file, else below `shaders/`. Those that do not exist are left
/// out; compiling names them better.
pub fn includes(project: &Project, file: &str) -> Vec<String> {
    let text = project.read(file).unwrap_or_default();
    let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
    let lines = text.lines().filter_map(|line| line.trim_start().strip_prefix("#include"));
    let found = lines.filter_map(|rest| {
        let name = rest.trim().trim_matches(['"', '<', '>']);
        let places = [format!("{folder}/{name}"), format!("shaders/{name}")];
        places.into_iter().find(|path| project.has(path))
    });
    found.collect()
}

/// A chapter's own shaders, in the order of the stages.
pub fn own(project: &Project, chapter: &Chapter) -> Vec<String> {
    let mut files = project.files(&format!("shaders/{}", chapter.name));
    files.sort_by_key(|file| {
        let extension = file.rsplit_once('.').map_or("", |(_, extension)| extension);
        EXTENSIONS.iter().position(|known| *known == extension)
    });
    files
}

/// The shaders that a chapter includes from elsewhere, directly or not, each with a file that does so.
pub fn shared(project: &Project, chapter: &Chapter) -> BTreeMap<String, String> {
    let own = own(project, chapter);
    let mut found = BTreeMap::new();
    let mut open = own.clone();
    while let Some(file) = open.pop() {
        for included in includes(project, &file) {
            if !own.contains(&included) && !found.contains_key(&included) {
                found.insert(included.clone(), file.clone());
                open.push(included);
            }
        }
    }
    found
}
