//! Files that are written whole or not at all.

use std::collections::hash_map::DefaultHasher;
use std::fs::{self, Metadata};
use std::hash::{Hash, Hasher};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, ensure};
use tempfile::NamedTempFile;

/// Writes `bytes` to `path`: into a temporary file beside it, then renamed.
///
/// A link is followed, and a file that was there keeps its permissions.
///
/// # Errors
/// As [`check_writable`], or if the disk is full. A file that was there is left as it was.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let failed = || format!("cannot write '{}'", path.display());
    let (target, mut file) = begin(path).with_context(failed)?;
    file.write_all(bytes).with_context(failed)?;
    file.persist(target).map_err(|error| error.error).with_context(failed)?;
    Ok(())
}

/// What a cache keeps of `bytes`: them, then a hash of them, by which damage is noticed: a full disk's, or
/// another program's.
pub fn sealed(bytes: &[u8]) -> Vec<u8> {
    [bytes, &seal(bytes)].concat()
}

/// The bytes of a cache's file; `None` if it is damaged.
pub fn unsealed(file: &[u8]) -> Option<&[u8]> {
    let (bytes, end) = file.split_last_chunk()?;
    (seal(bytes) == *end).then_some(bytes)
}

fn seal(bytes: &[u8]) -> [u8; 8] {
    let mut hasher = DefaultHasher::new();
    bytes.hash(&mut hasher);
    hasher.finish().to_le_bytes()
}

/// Fails if [`write_whole`] could not write `path`, so that it can be said before the work.
///
/// # Errors
/// If the folder is missing or cannot be written, or something that is no file bears the name.
pub fn check_writable(path: &Path) -> Result<()> {
    begin(path).map(drop).with_context(|| format!("cannot write '{}'", path.display()))
}

/// Whether two paths lead to the same file, be it there or not.
pub fn same(a: &Path, b: &Path) -> bool {
    a == b || matches!((target(a), target(b)), (Ok(a), Ok(b)) if a == b)
}

/// Where a path leads, and an empty temporary file in the same folder.
fn begin(path: &Path) -> Result<(PathBuf, NamedTempFile)> {
    let target = target(path)?;
    let existing = match fs::metadata(&target) {
        Ok(metadata) => Some(metadata),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => return Err(error.into()),
    };
    // Renaming would put a file in the place of a device, `/dev/null` for one.
    if let Some(metadata) = &existing {
        ensure!(!metadata.is_dir(), "it is a folder");
        ensure!(metadata.is_file(), "it is a device or a pipe, not a file");
        // A rename asks for no right to write the file that it replaces.
        ensure!(!metadata.permissions().readonly(), "it is read-only");
    }
    let folder = target.parent().context("it has no folder")?;
    let mut builder = tempfile::Builder::new();
    permit(&mut builder, existing);
    // The error's text would name the temporary file, which means nothing to the reader.
    let failed = |error: std::io::Error| {
        anyhow!("no file can be made in '{}': {}", folder.display(), error.kind())
    };
    let file = builder.tempfile_in(folder).map_err(failed)?;
    Ok((target, file))
}

/// The path with links resolved; its last part need not be there.
fn target(path: &Path) -> Result<PathBuf> {
    if let Ok(existing) = path.canonicalize() {
        return Ok(existing);
    }
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let name = path.file_name().context("it has no file name")?;
    let missing = || format!("there is no folder '{}'", folder.display());
    Ok(folder.canonicalize().ok().with_context(missing)?.join(name))
}

/// Temporary files are private to their owner; a result has the permissions of the file that it
/// replaces, else those that the umask allows.
#[cfg(unix)]
fn permit(builder: &mut tempfile::Builder, existing: Option<Metadata>) {
    use std::os::unix::fs::PermissionsExt;
    let new = || fs::Permissions::from_mode(0o666);
    builder.permissions(existing.map_or_else(new, |metadata| metadata.permissions()));
}

#[cfg(not(unix))]
fn permit(_: &mut tempfile::Builder, _: Option<Metadata>) {}

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
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o600)).unwrap();
        symlink("file", &link).unwrap();
        assert!(same(&file, &link) && !same(&file, &folder.path().join("other")));
        write_whole(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o600);
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_refused() {
        // A link to one: were it not refused, the link would be lost and not the device.
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("null");
        std::os::unix::fs::symlink("/dev/null", &link).unwrap();
        let error = format!("{:#}", check_writable(&link).unwrap_err());
        assert!(error.ends_with("it is a device or a pipe, not a file"), "{error}");
    }
}
