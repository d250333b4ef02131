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
mod tests {
    use super::*;

    #[test]
    fn a_file_that_was_there_is_replaced_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a b.txt");
        for text in ["long, longer", "short"] {
            write_whole(&path, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(folder.path().read_dir().unwrap().count(), 1);
    }

    #[test]
    fn a_cache_notices_damage() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("made/with its folder");
        assert!(read_sealed(&path).is_none());
        write_sealed(&path, b"some words");
        assert_eq!(read_sealed(&path).unwrap(), b"some words");
        let whole = fs::read(&path).unwrap();
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            assert!(read_sealed(&path).is_none(), "cut off after {length} bytes");
        }
        for at in 0..whole.len() {
            let mut wrong = whole.clone();
            wrong[at] ^= 1;
            fs::write(&path, wrong).unwrap();
            assert!(read_sealed(&path).is_none(), "byte {at} is wrong");
        }
    }

    #[test]
    fn several_files_are_written_all_or_none() {
        let folder = tempfile::tempdir().unwrap();
        let [old, new, gone] = ["old", "new", "gone/file"].map(|name| folder.path().join(name));
        fs::write(&old, "as it was").unwrap();
        let write = |files: &[(&Path, &[u8])]| write_all(files, Vec::new());
        let error = write(&[(&old, b"1"), (&new, b"2"), (&gone, b"3")]).unwrap_err();
        assert!(format!("{error:#}").contains("gone/file': there is no folder"), "{error:#}");
        assert_eq!(fs::read_to_string(&old).unwrap(), "as it was");
        assert_eq!(folder.path().read_dir().unwrap().count(), 1);
        write(&[(&old, b"1"), (&new, b"2")]).unwrap();
        assert_eq!([&old, &new].map(|file| fs::read_to_string(file).unwrap()), ["1", "2"]);
        assert_eq!(folder.path().read_dir().unwrap().count(), 2);
    }

    #[test]
    fn what_is_no_file_is_refused_and_stays() {
        let folder = tempfile::tempdir().unwrap();
        let inside = folder.path().join("inside");
        fs::create_dir(&inside).unwrap();
        let refused = |path: &Path, cause: &str| {
            let error = format!("{:#}", write_whole(path, b"x").unwrap_err());
            assert!(error.starts_with("cannot write '") && error.contains(cause), "{error}");
        };
        refused(&inside, "': it is a folder");
        let kept = folder.path().join("kept");
        fs::write(&kept, "old").unwrap();
        let mut permissions = fs::metadata(&kept).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&kept, permissions).unwrap();
        refused(&kept, "': it is read-only");
        assert_eq!(fs::read_to_string(&kept).unwrap(), "old");
        refused(&folder.path().join("gone").join("a"), "': there is no folder '");
        refused(&folder.path().join("a".repeat(300)), "': ");
        refused(Path::new("/"), "");
        assert_eq!(folder.path().read_dir().unwrap().count(), 2);
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_permissions_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let [file, link] = ["file", "link"].map(|name| folder.path().join(name));
        symlink("file", &link).unwrap();
        assert!(same(&file, &link) && !same(&file, &folder.path().join("other")));
        // The second is more than the umask allows a new file.
        for mode in [0o600, 0o666] {
            fs::write(&file, "old").unwrap();
            fs::set_permissions(&file, fs::Permissions::from_mode(mode)).unwrap();
            write_whole(&link, b"new").unwrap();
            assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
            assert_eq!(fs::read_to_string(&file).unwrap(), "new");
            assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, mode);
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_to_what_is_not_there_yet_is_followed_and_a_circle_refused() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let [file, link, circle] = ["file", "link", "circle"].map(|name| folder.path().join(name));
        symlink("file", &link).unwrap();
        write_whole(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        symlink("circle", &circle).unwrap();
        let error = format!("{:#}", check_writable(&circle).unwrap_err());
        assert!(error.ends_with("it is a link that leads in a circle"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_in_the_place_of_a_cache_is_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().unwrap();
        assert!(made.success() && read_cached(&pipe).is_none());
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_refused() {
        // A link to one: if it were not refused, the link would be replaced, not the device.
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("null");
        std::os::unix::fs::symlink("/dev/null", &link).unwrap();
        let error = format!("{:#}", check_writable(&link).unwrap_err());
        assert!(error.ends_with("it is a device or a pipe, not a file"), "{error}");
    }
}
