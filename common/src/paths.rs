//! The crate that a program belongs to: the book, unless the program names another.
//!
//! A program of another crate has its shaders beside its manifest, and its caches in the user's folder. Both folders
//! are those in which the program was built. A checkout that was moved has them elsewhere; one that was copied with
//! its `target/` has them twice.

use std::path::{Path, PathBuf};
use std::sync::{LazyLock, OnceLock};

static HOME: OnceLock<Folder> = OnceLock::new();

static BOOK: LazyLock<Folder> = LazyLock::new(|| {
    let built = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let is_book = |folder: &Path| folder.join("common/src/paths.rs").is_file();
    Folder::new(built.canonicalize().unwrap_or_else(|_| built.into()), is_book)
});

/// Sets the folder of the program's crate, its `CARGO_MANIFEST_DIR`, and the program's name. Only the first call
/// counts; [`run!`](crate::run) makes it.
pub fn set(folder: &str, name: &str) {
    let is_home = |folder: &Path| folder.join("shaders").join(name).is_dir();
    let _ = HOME.set(Folder::new(folder.into(), is_home));
}

/// The folder of the program's crate; `None` for a program of the book.
pub fn folder() -> Option<&'static Path> {
    HOME.get().map(|home| &*home.path)
}

/// The folder of the book.
pub fn book() -> &'static Path {
    &BOOK.path
}

/// A warning if the program lies in a copy of the folder in which it was built, and so reads the other one's files.
pub fn elsewhere() -> Option<String> {
    let Folder { path, other } = HOME.get().unwrap_or(&BOOK);
    let (path, other) = (path.display(), other.as_ref()?.display());
    Some(format!(
        "this program was built in '{path}' and reads the shaders and files there, not those in '{other}', where it \
         lies: `cargo clean` in '{other}', and build it there"
    ))
}

/// A folder of sources.
struct Folder {
    path: PathBuf,
    /// A copy of it that contains the program.
    other: Option<PathBuf>,
}

impl Folder {
    /// The folder `built`, or the one that contains the program, if `built` no longer exists.
    fn new(built: PathBuf, is_one: impl Fn(&Path) -> bool) -> Self {
        let program = std::env::current_exe().unwrap_or_default();
        match beside(&program, &built, &is_one) {
            Some(other) if !is_one(&built) => Self { path: other, other: None },
            other => Self { path: built, other },
        }
    }
}

/// The folder like `built` that is nearest to the program: above it, or in a folder above it under the last names of
/// `built`, as in a workspace. `None` if that is `built` itself, or a folder around it, to whose `target` it was
/// built.
fn beside(program: &Path, built: &Path, is_one: impl Fn(&Path) -> bool) -> Option<PathBuf> {
    let names: Vec<_> = built.components().collect();
    let below = |above: &Path, count: usize| {
        above.join(names[names.len() - count..].iter().collect::<PathBuf>())
    };
    let folders = program.ancestors().skip(1);
    let counts = 0..names.len().min(3);
    let mut all = folders.flat_map(|above| counts.clone().map(move |count| below(above, count)));
    let found = all.find(|folder| is_one(folder))?.canonicalize().ok()?;
    let built = built.canonicalize().unwrap_or_else(|_| built.into());
    (!built.starts_with(&found)).then_some(found)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// Makes folders with shaders, and looks for the one beside a program that was built elsewhere.
    fn found(folders: &[&str], program: &str, built: &str) -> Option<String> {
        let root = tempfile::tempdir().unwrap();
        let root = root.path().canonicalize().unwrap();
        for folder in folders {
            fs::create_dir_all(root.join(folder).join("shaders/glow")).unwrap();
        }
        let is_one = |folder: &Path| folder.join("shaders/glow").is_dir();
        let folder = beside(&root.join(program), &root.join(built), is_one)?;
        Some(folder.strip_prefix(root).unwrap().to_str().unwrap().to_owned())
    }

    #[test]
    fn a_program_knows_a_copy_of_its_folder() {
        let both = ["old", "new"];
        assert_eq!(found(&both, "old/target/debug/glow", "old"), None);
        assert_eq!(found(&both, "new/target/debug/glow", "old").as_deref(), Some("new"));
        // The old one is gone.
        assert_eq!(found(&["new"], "new/target/debug/glow", "old").as_deref(), Some("new"));
        // In a workspace, and in a target folder of its own.
        let both = ["old/glow", "new/glow"];
        assert_eq!(found(&both, "new/target/debug/glow", "old/glow").as_deref(), Some("new/glow"));
        assert_eq!(found(&both, "old/target/debug/glow", "old/glow"), None);
        assert_eq!(found(&["old"], "elsewhere/debug/glow", "old"), None);
    }

    #[test]
    fn a_copy_within_the_folder_that_it_is_built_to_is_its_own() {
        let both = ["book", "book/target/exercises/one"];
        assert_eq!(found(&both, "book/target/debug/glow", both[1]), None);
        assert_eq!(found(&both, "book/target/exercises/one/target/debug/glow", both[1]), None);
    }
}
