//! Light of earlier frames, in scenes that move.

use std::fs;

use common::app::Picture;
use common::scene::Instance;
use glam::Vec3;
use run::{Chapter, bits};

use super::{NAME, differing};

/// The chess set in motion.
fn in_motion() -> Chapter {
    Chapter::new(NAME).size("48x30").set("scene", "in motion")
}

/// The root of the mean squared difference.
fn error(a: &Picture, b: &Picture) -> f64 {
    let colors = |picture: &Picture| -> Vec<f32> {
        picture.pixels.iter().flat_map(|pixel| pixel[..3].to_vec()).collect()
    };
    let (a, b) = (colors(a), colors(b));
    let squares = a.iter().zip(&b).map(|(a, b)| f64::from(a - b).powi(2));
    (squares.sum::<f64>() / a.len() as f64).sqrt()
}

/// Checks that history changes the picture, and makes it better.
pub fn check_needed() {
    let large = || in_motion().size("96x60");
    let moment = ["frame=12", "play=off", "without=history"];
    let truth = large().sets(&moment).with(&["--samples", "0..32"]).picture();
    let [with, without] = ["nothing", "history"]
        .map(|left_out| large().set("without", left_out).frames(13).picture());
    let (differ, _) = differing(&with, &without);
    assert!(differ.len() > 8, "without history: {} pixels differ", differ.len());
    let [with, without] = [with, without].map(|picture| error(&picture, &truth));
    println!("error with history {with}, without {without}");
    assert!(with < 0.7 * without, "{with} {without}");
}

/// The light of a white surface that is the same everywhere stays so to the bit while the camera turns above it.
#[test]
fn constant_light_stays_constant() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("s.toml");
    let scene = "version = 1\n[picture]\nframes = 20\n[camera]\neye = [1, 4, 1]\ntarget = [0, 0, 0]\n\
                 field_of_view = 30\norbit = 90\n[[light]]\nkind = \"directional\"\nazimuth = 10\n\
                 elevation = 60\nradiance = [1, 2, 3]\nshadows = false\n[[material]]\nname = \"white\"\n\
                 color = [1, 1, 1]\n[[box]]\nlow = [-9, -1, -9]\nhigh = [9, 0, 9]\nmaterial = \"white\"\n";
    fs::write(&file, scene).unwrap();
    let picture = Chapter::new(NAME).size("32x20").scene(&file).frames(7).picture();
    let first = picture.pixels[0];
    assert!(first[0] > 0.0 && picture.pixels.iter().all(|pixel| *pixel == first), "{first:?}");
}

/// While nothing moves, frames are samples, and their mean is the picture.
#[test]
fn what_stands_still_converges() {
    let moment = || in_motion().sets(&["frame=12", "play=off"]);
    let still = moment().frames(16).picture();
    let mean = moment().with(&["--samples", "0..16"]).picture();
    // Each frame rounds a division by the colour, a difference, a quotient and a product.
    for (pixel, mean) in still.pixels.iter().zip(&mean.pixels) {
        for channel in 0..3 {
            let bound = 16.0 * 8.0 * 0.5f32.powi(24) * pixel[channel].max(1.0);
            let off = (pixel[channel] - mean[channel]).abs();
            assert!(off <= bound, "{} {}", pixel[channel], mean[channel]);
        }
    }
}

/// After a cut, and in another scene, the picture has nothing of what was before.
#[test]
fn a_cut_and_another_scene_begin_again() {
    let eye = "camera eye=-6,3,5";
    let cut = in_motion().frames(4).with(&["--then", &format!("3:{eye}")]).picture();
    let begun = in_motion().sets(&["frame=3", eye]).picture();
    assert_eq!(bits(&cut), bits(&begun), "a cut");
    let two = Chapter::new(NAME).size("48x30").set("scene", "two kings").frames(3);
    let changed = two.with(&["--then", "2:scene=in motion"]).picture();
    assert_eq!(bits(&changed), bits(&in_motion().picture()), "another scene");
}

/// Everything goes its way and comes back, and what cannot move is refused.
#[test]
fn a_way_leads_there_and_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("s.toml");
    let opened = |more: &str| {
        let scene = "version = 1\n[picture]\nframes = 8\n[camera]\neye = [1, 4, 1]\ntarget = [0, 0, 0]\n\
                     field_of_view = 30\norbit = 90\n[[material]]\nname = \"lamp\"\nemission = [1, 1, 1]\n\
                     [[piece]]\nmesh = \"pawn\"\nat = [1, 0, 0]\nway = [0, 0, 2]\n";
        fs::write(&file, format!("{scene}{more}")).unwrap();
        effects::open(&file)
    };
    let scene = opened("spin = 90\n").unwrap();
    let motion = scene.motion.as_ref().unwrap();
    let at = |frame: u32| -> Vec<Instance> {
        let mut instances = scene.scene.instances.clone();
        motion.place(&mut instances, frame);
        instances
    };
    let place = |frame: u32| Vec3::from(at(frame)[0].transform.translation);
    assert_eq!([place(0), place(4), place(8)], [Vec3::X, Vec3::new(1.0, 0.0, 2.0), Vec3::X]);
    assert_eq!(at(3)[0].transform.matrix3, at(5)[0].transform.matrix3);
    let camera = &scene.scene.camera;
    assert_eq!(motion.camera(camera, 16), *camera);
    let turned = motion.camera(camera, 4).eye;
    assert!(turned.distance(glam::DVec3::new(1.0, 4.0, -1.0)) < 1e-9, "{turned}");
    for (more, what) in [
        ("material = \"lamp\"\n", ":13: a piece that moves does not shine"),
        ("spin = 400\n", ":16: 400.0 is not a number from -360 to 360"),
    ] {
        let error = format!("{:#}", opened(more).err().unwrap());
        assert!(error.ends_with(what), "{error}");
    }
}
