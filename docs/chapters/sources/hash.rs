//! What a picture or a figure is made from, as a hash that tells whether it would come out the same.
//!
//! Where a text stands does not count, nor what is said about it in comments: shaders are taken as they are
//! compiled, with what they include in its place, and of other files what has an effect.

use std::collections::BTreeMap;
use std::fs;

use manuscript::project::Project;
use manuscript::shader;

use super::essence;

/// Texts that stand in for a project's own, by path.
type Changed = BTreeMap<String, String>;

/// Hashes of what chapters' pictures are made from.
#[derive(Default)]
pub struct Sources(BTreeMap<String, String>);

impl Sources {
    /// The hash of a chapter's code, its shaders as they are compiled, and the world that it shows.
    pub fn of(&mut self, project: &Project, chapter: &str) -> String {
        if let Some(known) = self.0.get(chapter) {
            return known.clone();
        }
        let hash = of_chapter(project, chapter, &Changed::new());
        self.0.insert(chapter.to_owned(), hash.clone());
        hash
    }
}

/// The hash of a chapter in which some files hold something else.
pub fn of_chapter(project: &Project, chapter: &str, changed: &Changed) -> String {
    let mut files = project.with_borrowed(project.files(&format!("samples/{chapter}")));
    let says = |word: &str| {
        files.iter().any(|file| project.read(file).is_ok_and(|text| text.contains(word)))
    };
    // A chapter that opens scene files, or legs, shows what they hold; to the others they are nothing.
    let (scene, scene_files) = (says("common::scene"), says("Composition"));
    let legs = says(".legs\"");
    if scene {
        // Where the pieces stand and how the light falls is framework code. How all that comes to the device
        // is seen in no picture: tests hold it.
        let shown = |file: &String| !UPLOAD.iter().any(|name| file.ends_with(name));
        files.extend(project.files("common/src/scene").into_iter().filter(shown));
        let asset = |path: &String| {
            path.matches('/').count() == 2
                || scene_files && path.starts_with("samples/assets/scenes/")
                || legs && path.ends_with(".legs")
        };
        files.extend(project.files("samples/assets").into_iter().filter(asset));
    }
    files.extend(changed.keys().filter(|file| !file.starts_with("shaders/")).cloned());
    // No picture shows what a unit test holds.
    files.retain(|file| !file.ends_with("/tests.rs"));
    files.sort();
    files.dedup();
    let read = |file: &str| changed.get(file).cloned().or_else(|| project.read(file).ok());
    let mut parts: Vec<u64> = files.iter().map(|file| part(project, file, read(file))).collect();
    let stages = project.files(&format!("shaders/{chapter}"));
    let stages = stages.iter().filter(|file| !file.ends_with(".glsl"));
    let stages = stages.map(|stage| essence::shader(&shader::spliced(&read, stage)));
    parts.extend(stages.map(|stage| fnv(FNV_OFFSET, stage.as_bytes())));
    of_parts(parts)
}

/// The files of `common/src/scene` that carry a scene to the device, and change nothing of it.
const UPLOAD: [&str; 3] = ["/upload.rs", "/meshes.rs", "/records.rs"];

/// A hash of files, wherever they lie.
pub fn of_files(project: &Project, files: &[String]) -> String {
    of_parts(files.iter().map(|file| part(project, file, project.read(file).ok())).collect())
}

/// A hash of several texts in their order.
pub fn hash(parts: [&[u8]; 2]) -> String {
    format!("{:016x}", parts.into_iter().fold(FNV_OFFSET, fnv))
}

/// The hash of a file: of what has an effect, or, where it is no text, of its bytes.
fn part(project: &Project, file: &str, text: Option<String>) -> u64 {
    match text {
        Some(text) => fnv(FNV_OFFSET, essence::of(file, &text).as_bytes()),
        None => fnv(FNV_OFFSET, &fs::read(project.root.join(file)).unwrap_or_default()),
    }
}

/// One hash of many, whose order does not count.
fn of_parts(mut parts: Vec<u64>) -> String {
    parts.sort_unstable();
    format!("{:016x}", parts.iter().fold(FNV_OFFSET, |hash, part| fnv(hash, &part.to_le_bytes())))
}

// FNV-1a, 64 bits (Fowler, Noll, Vo): the same on every system and with every version of Rust.
const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

fn fnv(hash: u64, bytes: &[u8]) -> u64 {
    // A byte that no text holds ends each part.
    let bytes = bytes.iter().chain(&[0xff]);
    bytes.fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_the_known_one() {
        // FNV-1a of "a" followed by the byte that ends a part.
        let a = 0xaf63_dc4c_8601_ec8c_u64;
        assert_eq!(fnv(FNV_OFFSET, b"a"), (a ^ 0xff).wrapping_mul(0x0100_0000_01b3));
    }

    #[test]
    fn the_order_of_files_does_not_count() {
        assert_eq!(of_parts(vec![1, 2]), of_parts(vec![2, 1]));
        assert_ne!(of_parts(vec![1, 2]), of_parts(vec![1, 1]));
    }
}
