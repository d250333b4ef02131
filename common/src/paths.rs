//! The crate that a program belongs to: the book, unless the program names another.
//!
//! A program of another crate has its shaders beside its manifest, and its caches in the user's folder.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

static HOME: OnceLock<PathBuf> = OnceLock::new();

/// Sets the folder of the program's crate, its `CARGO_MANIFEST_DIR`. Only the first call counts; [`run!`](crate::run)
/// makes it.
pub fn set(folder: &str) {
    let _ = HOME.set(folder.into());
}

/// The folder of the program's crate; `None` for a program of the book.
pub fn folder() -> Option<&'static Path> {
    HOME.get().map(PathBuf::as_path)
}

/// The folder of the book.
pub fn book() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}
