//! Files that are written whole or not at all.

pub mod cache;
pub mod folder;
mod several;

use std::collections::BTreeMap;
use std::collections::hash_map::DefaultHasher;
use std::fs::{self, Metadata};
use std::hash::{Hash, Hasher};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::{Context, Result, anyhow, ensure};
use tempfile::NamedTempFile;

pub use self::folder::NewFolder;
pub use self::several::write_all;

/// Writes `bytes` to `path`: into a temporary file beside it, then renamed.
///
/// A link is followed, and an existing file keeps its permissions.
///
/// # Errors
/// As [`check_writable`], or if the disk is full. An existing file is then left unchanged.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let failed = || format!("cannot write '{}'", path.display());
    Unfinished::new(path, bytes).and_then(|mut file| file.finish()).with_context(failed)
}

/// The kind of unfinished output at a path.
#[derive(Clone, Copy)]
enum Made {
    File,
    Folder,
    FilesOfFolder,
}

impl Made {
    /// Removes it, ignoring errors: nobody could receive them.
    fn remove(self, path: &Path) {
        let _ = match self {
            Self::File => fs::remove_file(path),
            Self::Folder => fs::remove_dir_all(path),
            Self::FilesOfFolder => {
                let entries = fs::read_dir(path).into_iter().flatten().flatten();
                for path in entries.map(|entry| entry.path()) {
                    let made = if path.is_dir() { Self::Folder } else { Self::File };
                    made.remove(&path);
                }
                Ok(())
            }
        };
    }
}

/// The temporary files being written, and the folders being created.
static UNFINISHED: Mutex<BTreeMap<PathBuf, Made>> = Mutex::new(BTreeMap::new());

fn unfinished() -> MutexGuard<'static, BTreeMap<PathBuf, Made>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes unfinished output because the process is about to end. Any thread that wants to write waits until then.
pub fn abandon() {
    let paths = unfinished();
    paths.iter().for_each(|(path, made)| made.remove(path));
    std::mem::forget(paths);
}

/// The most bytes of a cache's file: a larger one is not ours.
const CACHED_BYTES: u64 = 256 << 20;

/// A cache's file; `None` if there is none, or something that may never end, such as a pipe.
pub fn read_cached(path: &Path) -> Option<Vec<u8>> {
    let metadata = fs::metadata(path).ok()?;
    let fits = metadata.is_file() && metadata.len() <= CACHED_BYTES;
    fits.then(|| fs::read(path).ok()).flatten()
}

/// The contents that [`write_sealed`] left in a cache's file; `None` if there is none, or if it is damaged by a
/// full disk or by another program.
pub fn read_sealed(path: &Path) -> Option<Vec<u8>> {
    let mut bytes = read_cached(path)?;
    let end = bytes.split_off(bytes.len().checked_sub(8)?);
    (end == seal(&bytes)).then_some(bytes)
}

/// Writes a cache's file, and makes its folder: the bytes, then a hash of them, to detect damage.
/// Failing to write it only makes the next start slower.
pub fn write_sealed(path: &Path, bytes: &[u8]) {
    let _ = path.parent().map(fs::create_dir_all);
    let _ = write_whole(path, &[bytes, &seal(bytes)].concat());
}

fn seal(bytes: &[u8]) -> [u8; 8] {
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    hasher.finish().to_le_bytes()
}

/// Fails if [`write_whole`] could not write `path`, so that the error comes before the work.
///
/// # Errors
/// If the folder is missing or cannot be written, or the name belongs to something other than a file.
pub fn check_writable(path: &Path) -> Result<()> {
    let failed = || format!("cannot write '{}'", path.display());
    Unfinished::new(path, b"").map(drop).with_context(failed)
}

/// True if two paths lead to the same file, whether or not it exists.
pub fn same(a: &Path, b: &Path) -> bool {
    a == b || matches!((target(a), target(b)), (Ok(a), Ok(b)) if a == b)
}

/// A file being written, under a temporary name in the same folder.
struct Unfinished {
    target: PathBuf,
    file: Option<NamedTempFile>,
    temporary: PathBuf,
}

impl Unfinished {
    /// Bytes in a temporary file beside the path's target.
    fn new(path: &Path, bytes: &[u8]) -> Result<Self> {
        let target = target(path)?;
        let existing = fs::metadata(&target).ok();
        let folder = target.parent().context("it has no folder")?;
        if let Some(metadata) = &existing {
            check_replaceable(&target, folder, metadata)?;
        }
        let mut builder = tempfile::Builder::new();
        permit(&mut builder);
        // The error's text would name the temporary file, which means nothing to the reader.
        let failed = |error: std::io::Error| {
            anyhow!("no file can be made in '{}': {}", folder.display(), error.kind())
        };
        let mut unfinished = unfinished();
        let file = builder.tempfile_in(folder).map_err(failed)?;
        if let Some(metadata) = existing {
            // A file system without permissions has none to keep.
            let _ = file.as_file().set_permissions(metadata.permissions());
        }
        let temporary = file.path().to_owned();
        unfinished.insert(temporary.clone(), Made::File);
        drop(unfinished);
        let mut new = Self { target, file: Some(file), temporary };
        let written = new.file.iter_mut().try_for_each(|file| file.write_all(bytes));
        // As above, the kind alone.
        written.map_err(|error| anyhow!("{}", error.kind()))?;
        Ok(new)
    }

    /// Renames it to its final name.
    fn finish(&mut self) -> Result<()> {
        let file = self.file.take().context("it was written before")?;
        file.persist(&self.target).map_err(|error| anyhow!("{}", error.error.kind()))?;
        Ok(())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        let mut unfinished = unfinished();
        // Removes it, unless it has become the file itself.
        drop(self.file.take());
        unfinished.remove(&self.temporary);
    }
}

/// Fails if a file must not be replaced: a rename needs fewer rights than writing.
fn check_replaceable(target: &Path, folder: &Path, metadata: &Metadata) -> Result<()> {
    // Renaming would replace a device, for example `/dev/null`, by a file.
    ensure!(!metadata.is_dir(), "it is a folder");
    ensure!(metadata.is_file(), "it is a device or a pipe, not a file");
    ensure!(!metadata.permissions().readonly(), "it is read-only");
    fs::File::options().write(true).open(target).map_err(|error| anyhow!("{}", error.kind()))?;
    ensure!(may_rename(folder, metadata), "it belongs to another, in a folder that keeps it so");
    Ok(())
}

/// True if this process may replace a file in a folder it can write to: in one with the sticky bit, such as
/// `/tmp`, only the owner of the file or of the folder may.
#[cfg(unix)]
fn may_rename(folder: &Path, file: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    // SAFETY: the call has no preconditions.
    let this = unsafe { libc::geteuid() };
    let Ok(folder) = fs::metadata(folder) else { return true };
    let sticky = folder.mode() & 0o1000 != 0;
    !sticky || this == 0 || this == file.uid() || this == folder.uid()
}

#[cfg(not(unix))]
fn may_rename(_: &Path, _: &Metadata) -> bool {
    true
}

/// The maximum length of a chain of links, as in Linux.
const MOST_LINKS: usize = 40;

/// The path with links resolved; its last part need not exist.
fn target(path: &Path) -> Result<PathBuf> {
    if let Ok(existing) = path.canonicalize() {
        return Ok(existing);
    }
    // A link whose target does not exist yet is also followed.
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&path) else { break };
        path = path.parent().unwrap_or(Path::new("")).join(next);
    }
    ensure!(fs::read_link(&path).is_err(), "it is a link that leads in a circle");
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let name = path.file_name().context("it has no file name")?;
    let missing = || format!("there is no folder '{}'", folder.display());
    Ok(folder.canonicalize().ok().with_context(missing)?.join(name))
}

/// Temporary files are private to their owner; a result that replaces none has the permissions that the umask
/// allows.
#[cfg(unix)]
fn permit(builder: &mut tempfile::Builder) {
    use std::os::unix::fs::PermissionsExt;
    builder.permissions(fs::Permissions::from_mode(0o666));
}

#[cfg(not(unix))]
fn permit(_: &mut tempfile::Builder) {}

#[cfg(test)]
mod tests;
