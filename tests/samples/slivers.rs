//! Triangles so thin that their area rounds to zero: no chapter computes an infinity or NaN from them.

use std::fs;

use run::Chapter;

/// The views of the test: pictures, and the views that show where rays leave a surface.
const VIEWS: [(&str, &[&str]); 10] = [
    ("41_ray_offset", &[]),
    ("41_ray_offset", &["show=shadow origin"]),
    ("06_reflection", &[]),
    ("06_reflection", &["show=shadow origin", "bounce=0"]),
    ("12_infinite_plane", &[]),
    ("12_infinite_plane", &["show=shadow origin"]),
    ("25_scene_effects", &[]),
    ("26_leaving_a_surface", &[]),
    ("26_leaving_a_surface", &["show=shadow origin", "bounce=0"]),
    ("26_leaving_a_surface", &["show=ray origin", "bounce=1"]),
];

/// A mirror with vertices (0, -1, 0), (0, 1, 0), and a third one.
fn sliver(corner: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let obj = format!("mtllib s.mtl\nusemtl m\nv 0 -1 0\nv 0 1 0\nv {corner}\nf 1 2 3\n");
    let mtl = "newmtl m\nKd 1 0.5 0.25\nKs 0.5 0.5 0.5\nNs 0\nillum 3\n";
    fs::write(folder.path().join("s.obj"), obj).expect("a file");
    fs::write(folder.path().join("s.mtl"), mtl).expect("a file");
    folder
}

#[test]
fn a_vanishing_triangle_makes_no_infinite_number() {
    let camera = ["camera eye=0,0.3,3", "camera target=0,0.3,0"];
    let mut met = 0;
    for corner in ["1e-10 0.5 0", "1e-24 0.5 0"] {
        let folder = sliver(corner);
        let scene = folder.path().join("s.obj");
        for (name, sets) in VIEWS {
            // An odd number of columns: the rays of the middle one go straight through the edge.
            let chapter = Chapter::new(name).size("5x5").scene(&scene);
            let seen = chapter.sets(&camera).sets(sets).picture().pixels;
            let all = seen.as_flattened().iter().all(|x| x.is_finite());
            assert!(all, "{name} {sets:?}, {corner}: {seen:?}");
            // Alpha is -1 where a view shows no surface.
            met += seen.iter().filter(|pixel| pixel[3] >= 0.0 && !sets.is_empty()).count();
        }
    }
    assert!(met > 10, "{met} pixels have a surface");
}
