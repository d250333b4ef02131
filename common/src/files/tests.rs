//! Files that are written, and those that are refused.

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
