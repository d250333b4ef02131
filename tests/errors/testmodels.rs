//! The OBJ files of Debian's assimp-testmodels, written to test another reader: each is shown as a small
//! reader of our own reads it, or refused in one line.

use std::fs;
use std::path::{Path, PathBuf};

use common::model::obj;

use crate::sample;

/// The folder of the package.
pub const FOLDER: &str = "/usr/share/assimp/models";

/// Files that cannot be shown, and the reason.
const REFUSED: [(&str, &str); 5] = [
    ("box_UTF16BE.obj", ":1: this is UTF-16 text; save it as UTF-8"),
    ("empty.obj", ": has no faces"),
    ("point_cloud.obj", ": has no faces"),
    ("testline.obj", ": has no faces"),
    ("testpoints.obj", ": has no faces"),
];

/// The files of that folder and its subfolders.
pub fn objects(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("the folder can be read").flatten() {
        let path = entry.path();
        if path.is_dir() {
            files.extend(objects(&path));
        } else if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj")) {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// The number of triangles of a file, and the bounding box of its faces. Faces with too few corners, or with
/// a corner that is missing or has no position, do not count.
fn read(text: &str) -> (usize, [f32; 3], [f32; 3]) {
    let mut positions: Vec<[f32; 3]> = Vec::new();
    let (mut count, mut low, mut high) = (0, [f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for line in text.replace("\\\r\n", " ").replace("\\\n", " ").lines() {
        let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Vec<f32> =
                    words.map(|word| word.parse().unwrap_or(f32::NAN)).collect();
                positions.push([numbers[0], numbers[1], numbers[2]]);
            }
            Some("f") => {
                let end = positions.len() as isize + 1;
                let corner = |word: &str| {
                    let index: isize = word.split('/').next().unwrap().parse().expect("an index");
                    positions.get((index + if index < 0 { end } else { 0 } - 1) as usize).copied()
                };
                let corners: Option<Vec<[f32; 3]>> = words.map(corner).collect();
                let is_shown = |corners: &Vec<[f32; 3]>| {
                    corners.len() > 2 && corners.iter().flatten().all(|part| !part.is_nan())
                };
                let corners = corners.filter(is_shown).unwrap_or_default();
                count += corners.len().saturating_sub(2);
                for position in corners {
                    for axis in 0..3 {
                        low[axis] = low[axis].min(position[axis]);
                        high[axis] = high[axis].max(position[axis]);
                    }
                }
            }
            _ => {}
        }
    }
    (count, low, high)
}

#[test]
#[ignore = "nightly: a package of files; quick: models::files_of_other_exporters"]
fn files_of_another_reader_s_tests_are_shown_or_refused() {
    let folder = Path::new(FOLDER);
    if !folder.is_dir() {
        println!(
            "not tried: there is no {FOLDER}: run ./setup --tests, where the system has the package"
        );
        return;
    }
    let files = objects(folder);
    assert!(files.len() >= 25, "{} files", files.len());
    for file in files {
        let name = file.file_name().unwrap().to_str().unwrap();
        let mut command = sample();
        command.arg("--validate").arg("--scene").arg(&file);
        if let Some((_, why)) = REFUSED.iter().find(|(refused, _)| *refused == name) {
            let (code, line) = run::refusal(command.output().unwrap());
            assert_eq!((code, line.ends_with(why)), (1, true), "{line}");
            println!("refused: {line}");
            continue;
        }
        let output = command.output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{name}: {said}");
        assert!(said.lines().all(|line| line.starts_with("warning: ")), "{name}: {said}");

        let model = obj::load(&file).unwrap();
        let (count, low, high) = read(&String::from_utf8_lossy(&fs::read(&file).unwrap()));
        assert_eq!(
            model.meshes.iter().map(|mesh| mesh.triangles.len()).sum::<usize>(),
            count,
            "{name}"
        );
        let bounds: Vec<_> = model.meshes.iter().map(common::scene::Mesh::bounds).collect();
        for axis in 0..3 {
            let lowest = bounds.iter().map(|(low, _)| low[axis]).fold(f32::INFINITY, f32::min);
            let highest =
                bounds.iter().map(|(_, high)| high[axis]).fold(f32::NEG_INFINITY, f32::max);
            assert_eq!((lowest, highest), (low[axis], high[axis]), "{name}, axis {axis}");
        }
        println!("shown: {name}, {count} triangles, {} warnings", model.warnings.len());
    }
}
