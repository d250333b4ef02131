//! The place of caches: the book's `target/`, which `cargo clean` removes, or the user's own folder.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use crate::paths;

/// The folder of a kind of cache, such as `spirv`; `None` on a system that has no place for caches.
pub fn folder(kind: &str) -> Option<PathBuf> {
    static ALL: LazyLock<Option<PathBuf>> = LazyLock::new(|| {
        let users = users(std::env::consts::OS, |name| std::env::var_os(name));
        place(paths::folder(), &paths::book().join("target"), users)
    });
    ALL.as_ref().map(|all| all.join(kind))
}

/// The folder of a kind of cache that every copy of the book shares, such as `intel`.
pub fn users_own(kind: &str) -> Option<PathBuf> {
    Some(users(std::env::consts::OS, |name| std::env::var_os(name))?.join(kind))
}

/// The place of all caches for a program of the crate in the folder `home`. The book's copy in Cargo's checkouts
/// has no `target/`, and none is created there.
fn place(home: Option<&Path>, book: &Path, users: Option<PathBuf>) -> Option<PathBuf> {
    let is_of_the_book = home.is_none_or(|home| {
        let paths = [home, book].map(Path::canonicalize);
        matches!(paths, [Ok(home), Ok(book)] if home.starts_with(&book))
    });
    let target = book.join("target");
    if is_of_the_book && target.is_dir() { Some(target) } else { users }
}

/// The user's cache folder by the system's convention (XDG Base Directory Specification; Known Folders; File
/// System Programming Guide). A path that is not absolute is ignored.
fn users(system: &str, variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let path = |name| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let caches = match system {
        "windows" => path("LOCALAPPDATA"),
        "macos" => path("HOME").map(|home| home.join("Library/Caches")),
        _ => path("XDG_CACHE_HOME").or_else(|| path("HOME").map(|home| home.join(".cache"))),
    };
    caches.map(|caches| caches.join("raybook"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_of_another_crate_leaves_nothing_in_the_book() {
        let [book, other] = [0, 1].map(|_| tempfile::tempdir().unwrap());
        let users = PathBuf::from("/home/ada/.cache/raybook");
        let place = |home: Option<&Path>| place(home, book.path(), Some(users.clone()));
        // In Cargo's checkout.
        assert_eq!(place(None).as_ref(), Some(&users));
        let target = book.path().join("target");
        std::fs::create_dir(&target).unwrap();
        assert_eq!(place(None).as_ref(), Some(&target));
        assert_eq!(place(Some(&target)).as_ref(), Some(&target));
        assert_eq!(place(Some(other.path())).as_ref(), Some(&users));
    }

    #[cfg(unix)]
    #[test]
    fn each_system_has_a_place_for_caches_of_its_own() {
        let of = |system: &str, set: &[(&str, &str)]| {
            let value = |name: &str| set.iter().find(|(other, _)| *other == name);
            users(system, |name| value(name).map(|(_, value)| value.into()))
        };
        let home = ("HOME", "/home/ada");
        let is = |path: &str| Some(PathBuf::from(path));
        assert_eq!(of("linux", &[home]), is("/home/ada/.cache/raybook"));
        assert_eq!(of("linux", &[home, ("XDG_CACHE_HOME", "/fast")]), is("/fast/raybook"));
        assert_eq!(of("linux", &[home, ("XDG_CACHE_HOME", "rel")]), is("/home/ada/.cache/raybook"));
        assert_eq!(of("macos", &[home]), is("/home/ada/Library/Caches/raybook"));
        assert_eq!(of("windows", &[home, ("LOCALAPPDATA", "/local")]), is("/local/raybook"));
        assert_eq!(of("linux", &[]), None);
    }
}
