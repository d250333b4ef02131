//! The stages that a mistake's patch changes. Each must compile, or the program shows no picture to find the
//! mistake by.

use common::gpu::shader::StageText;
use manuscript::fault::Fault;
use manuscript::project::Project;
use manuscript::shader;

use super::mistake::Mistake;

/// The faults of a mistake's patch: it does not apply, changes no stage of its chapter, or leaves one that
/// does not compile.
pub fn check(project: &Project, mistake: &Mistake) -> Vec<Fault> {
    let patched = match mistake.patched(project) {
        Ok(patched) => patched,
        Err(misfit) => return vec![misfit],
    };
    let wrong = |what| Fault::new(mistake.file(), 1, what, "make the patch again");
    let before = |file: &str| project.read(file).ok();
    let after = |file: &str| patched.get(file).cloned().or_else(|| before(file));
    let files = project.files(&format!("shaders/{}", mistake.chapter));
    let stages = files.iter().filter(|file| !file.ends_with(".glsl"));
    let texts = stages.map(|stage| (stage, shader::spliced(&after, stage)));
    let changed: Vec<_> =
        texts.filter(|(stage, text)| *text != shader::spliced(&before, stage)).collect();
    if changed.is_empty() && mistake.is_in_shaders() {
        return vec![wrong(format!("this patch changes no stage of {}", mistake.chapter))];
    }
    let fault = |(path, text): (&String, String)| {
        let said = StageText { path, text, ..StageText::default() }.words().err()?.to_string();
        let said = said.trim_start_matches("shader does not compile: ");
        Some(wrong(format!("with this patch {path} does not compile: {said}")))
    };
    changed.into_iter().filter_map(fault).collect()
}
