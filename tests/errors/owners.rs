//! Files and folders of other users: those that may not be replaced are refused before any work, and are
//! preserved.
#![cfg(target_os = "linux")]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

use crate::scarce::as_nobody;

/// The refusal to overwrite this file, for a user who is not its owner; `None` if that cannot be tested.
fn refusal_over(file: &Path) -> Option<String> {
    let mut command = crate::sample();
    command.arg("--out").arg(file).env("VULKAN_LOADER", "/nonexistent");
    let before = fs::read(file).unwrap();
    let (code, line) = run::refusal(as_nobody(&command)?.output().unwrap());
    assert_eq!(code, 1, "{line}");
    assert_eq!(fs::read(file).unwrap(), before, "{line}");
    assert_eq!(file.parent().unwrap().read_dir().unwrap().count(), 1, "{line}");
    // Nothing was rendered, and no device was opened.
    assert!(line.contains("cannot write '"), "{line}");
    Some(line)
}

/// A folder of root with a file, with these permissions.
fn owned(folder: u32, file: u32) -> (tempfile::TempDir, std::path::PathBuf) {
    let outer = tempfile::tempdir().unwrap();
    fs::set_permissions(&outer, fs::Permissions::from_mode(0o755)).unwrap();
    let inner = outer.path().join("folder");
    let path = inner.join("a.png");
    fs::create_dir(&inner).unwrap();
    fs::write(&path, "precious").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(file)).unwrap();
    fs::set_permissions(&inner, fs::Permissions::from_mode(folder)).unwrap();
    (outer, path)
}

#[test]
fn a_file_of_another_stays() {
    // A user with write access to the folder could replace the file by a rename.
    let (_folder, file) = owned(0o777, 0o644);
    let Some(line) = refusal_over(&file) else { return };
    assert!(line.ends_with("permission denied"), "{line}");
    // In a folder with the sticky bit, even a file that everyone may write cannot be replaced.
    let (_folder, file) = owned(0o1777, 0o666);
    let line = refusal_over(&file).unwrap();
    assert!(line.ends_with("it belongs to another, in a folder that keeps it so"), "{line}");
    let (_folder, file) = owned(0o755, 0o666);
    let line = refusal_over(&file).unwrap();
    assert!(line.contains("no file can be made in '") && line.ends_with("permission denied"));
}

#[test]
fn a_file_that_all_may_write_to_is_replaced_in_a_folder_of_all() {
    let (_folder, file) = owned(0o777, 0o666);
    let mut command = crate::sample();
    command.arg("--out").arg(&file);
    let Some(mut command) = as_nobody(&command) else { return };
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(image::open(&file).unwrap().width(), 8);
    assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o666);
}
