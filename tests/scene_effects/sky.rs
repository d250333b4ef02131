//! Light from a picture of the sky, compared with chapter 46.

use std::fs;

use run::Chapter;

use super::rough::{estimate, green, picture_in};

#[test]
fn a_floor_under_the_evening_looks_as_in_46() {
    let folder = tempfile::tempdir().unwrap();
    let model =
        "mtllib floor.mtl\nv -9 0 9\nv 9 0 9\nv 9 0 -9\nv -9 0 -9\nusemtl floor\nf 1 2 3 4\n";
    let model_file = folder.path().join("floor.obj");
    fs::write(&model_file, model).unwrap();
    for look in ["Pr 0.4\nPm 0.5\n", "Ks 0 0 0\nillum 1\n"] {
        fs::write(folder.path().join("floor.mtl"), format!("newmtl floor\nKd 0.2 0.5 0.3\n{look}"))
            .unwrap();
        let sets = [
            "camera eye=0,2,3",
            "camera target=0,0,0",
            "field of view=20",
            "sky=evening",
            "seed=1",
        ];
        let other = Chapter::new("46_environment").size("64x40").frames(64).sets(&sets);
        let other = other.scene(model_file.to_str().unwrap()).picture();
        // Shadow rays alone, all rays, and for the rough floor shadow rays for the rest alone.
        for (depth, bounces) in [(0, 0), (4, 1), (4, 0)] {
            let text = format!(
                "model = \"floor.obj\"\n[sky]\nname = \"evening\"\n[picture]\nsamples = 64\n\
                 depth = {depth}\nbounces = {bounces}\n[camera]\neye = [0, 2, 3]\n\
                 target = [0, 0, 0]\nfield_of_view = 20\n"
            );
            let own = picture_in(folder.path(), "64x40", &text);
            let differences: Vec<f64> =
                green(&own).zip(green(&other)).map(|(own, other)| own - other).collect();
            let (mean, error) = estimate(&differences);
            let bright = green(&other).sum::<f64>() / differences.len() as f64;
            println!("{look:?}, {depth}, {bounces}: {mean:.6} ± {error:.6} of {bright:.4}");
            assert!(error < 0.05 * bright, "{error} is too much noise for {bright}");
            assert!(mean.abs() < error, "{look:?}, {depth}, {bounces}: {mean} ± {error}");
        }
    }
}
