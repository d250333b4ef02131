//! Bounces, glass, emitters and a lens, compared with results computed by hand.

use std::fs;
use std::path::Path;

use common::app::Picture;
use effects::{Effect, findings};

use super::run;

/// The picture of a scene, 32 by 20 pixels or of the given size.
fn picture(size: &str, text: &str) -> Picture {
    picture_in(tempfile::tempdir().unwrap().path(), size, text)
}

/// As [`picture`], for a scene whose file is in a folder.
fn picture_in(folder: &Path, size: &str, text: &str) -> Picture {
    let file = folder.join("s.toml");
    fs::write(&file, format!("version = 1\n{text}")).unwrap();
    run(size, &["--scene", file.to_str().unwrap()], &[]).picture
}

const CAMERA: &str = "[camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nfield_of_view = 20\n";

#[test]
fn a_room_that_shines_gathers_a_geometric_series() {
    // A box around the camera, whose sides scatter half of the light and emit 1.
    let room = |bounces: u32| {
        picture(
            "32x20",
            &format!(
                "[picture]\nbounces = {bounces}\n{CAMERA}[[material]]\nname = \"wall\"\n\
                 color = [0.5, 0.5, 0.5]\nemission = [1, 1, 1]\n[[box]]\nlow = [-9, -9, -9]\n\
                 high = [9, 9, 9]\nmaterial = \"wall\"\n"
            ),
        )
    };
    for bounces in [0, 1, 3, 8] {
        // 1 + 1/2 + 1/4 + ..., and half of the last from the assumed sky around.
        let part = 0.5f32.powi(bounces as i32 + 1);
        let sum = 2.0 * (1.0 - part);
        for pixel in &room(bounces).pixels {
            let (darkest, brightest) = ([0.16, 0.14, 0.12], [0.42, 0.47, 0.55]);
            for channel in 0..3 {
                let range = sum + part * darkest[channel]..=sum + part * brightest[channel];
                let value = pixel[channel];
                let near = *range.start() - 1e-5..=*range.end() + 1e-5;
                assert!(near.contains(&value), "{bounces} bounces: {value}, not in {range:?}");
            }
        }
    }
}

#[test]
fn a_red_wall_colours_the_floor_beside_it() {
    let floor = |bounces: u32| {
        let picture = picture(
            "32x20",
            &format!(
                "[picture]\nsamples = 64\nbounces = {bounces}\n[camera]\neye = [0, 3, 6]\n\
                 target = [-0.5, 0, 0]\nfield_of_view = 4\n[[light]]\nkind = \"directional\"\n\
                 azimuth = 90\nelevation = 30\nradiance = [3, 3, 3]\n[[material]]\nname = \"floor\"\n\
                 color = [0.7, 0.7, 0.7]\n[[material]]\nname = \"wall\"\ncolor = [0.7, 0.05, 0.05]\n\
                 [[box]]\nlow = [-3, -1, -3]\nhigh = [3, 0, 3]\nmaterial = \"floor\"\n[[box]]\n\
                 low = [-2, 0, -3]\nhigh = [-1, 3, 3]\nmaterial = \"wall\"\n"
            ),
        );
        let sum = |channel: usize| picture.pixels.iter().map(|pixel| pixel[channel]).sum::<f32>();
        sum(0) / sum(2)
    };
    let (without, with) = (floor(0), floor(2));
    println!("red over blue: {without} without bounces, {with} with two");
    // The sky from above, and the sun's contribution at 30 degrees.
    let sun = 3.0 * 0.5 / std::f32::consts::PI;
    assert!((without - (0.42 + sun) / (0.55 + sun)).abs() < 1e-3, "{without}");
    assert!(with > 1.15 * without, "{with}");
}

/// A box of glass, two units thick, in front of a luminous ball, seen by the camera.
fn before_a_ball(glass: &str) -> [f32; 3] {
    let text = format!(
        "{CAMERA}[[material]]\nname = \"lamp\"\ncolor = [0, 0, 0]\nemission = [1, 1, 1]\n\
         [[sphere]]\ncenter = [0, 0, -40]\nradius = 30\nmaterial = \"lamp\"\n{glass}"
    );
    let pixels = picture("32x20", &text).pixels;
    let [red, green, blue, _] = pixels[10 * 32 + 16];
    [red, green, blue]
}

fn pane(keys: &str) -> String {
    format!(
        "[[material]]\nname = \"glass\"\nglass = \"thick\"\n{keys}[[box]]\nlow = [-3, -3, -1]\n\
         high = [3, 3, 1]\nmaterial = \"glass\"\n"
    )
}

#[test]
fn glass_absorbs_by_the_length_of_the_way() {
    assert_eq!(before_a_ball(""), [1.0; 3]);
    // Index 1 reflects nothing and bends no ray: the path is 2, up to the angle of the pixel.
    let seen = before_a_ball(&pane("index = 1\nthrough = [0.5, 0.25, 1]\n"));
    println!("through two units: {seen:?}");
    for (seen, expected) in seen.into_iter().zip([0.25, 0.0625, 1.0]) {
        assert!((seen - expected).abs() < 2e-3 * expected, "{seen}, not {expected}");
    }
}

#[test]
fn from_within_glass_a_flat_angle_is_reflected_as_a_whole() {
    // The camera is inside a cube of glass, and looks at an edge of it: 45 degrees to both sides, which
    // exceeds the critical angle of 41.8 degrees for index 1.5. No light comes in that way, whatever is
    // outside.
    let seen = |target: &str, index: f32| {
        let text = format!(
            "[picture]\ndepth = 12\n[camera]\neye = [0, 0.05, 0]\ntarget = {target}\n\
             field_of_view = 1\n[[material]]\nname = \"glass\"\nglass = \"thick\"\nindex = {index}\n\
             [[box]]\nlow = [-2, -2, -2]\nhigh = [2, 2, 2]\nmaterial = \"glass\"\n"
        );
        picture("16x10", &text).pixels
    };
    let is_dark = |pixel: &[f32; 4]| pixel[..3] == [0.0; 3];
    assert!(seen("[1, 0.05, 1]", 1.5).iter().all(is_dark), "an edge lets light in");
    assert!(seen("[1, 0.05, 1]", 1.2).iter().any(|pixel| !is_dark(pixel)), "1.2 is below");
    let dark = seen("[0, 0.05, 1]", 1.5).iter().filter(|pixel| is_dark(pixel)).count();
    // A side reflects 4 %, which the side behind the camera transmits.
    assert!(dark == 0, "{dark} pixels are dark, looking straight at a side");
}

/// The mean of a floor's red and of its blue, directly below an emitter, at night.
fn lit_floor(bounces: u32, lamp: &str) -> [f64; 2] {
    lit_floor_in(tempfile::tempdir().unwrap().path(), bounces, "", lamp)
}

fn lit_floor_in(folder: &Path, bounces: u32, keys: &str, lamp: &str) -> [f64; 2] {
    let text = format!(
        "sky = 0\n{keys}[picture]\nsamples = 64\nbounces = {bounces}\n[camera]\neye = [0, 4, 9]\n\
         target = [0, 0, 0]\nfield_of_view = 1\n[[material]]\nname = \"floor\"\n\
         color = [0.8, 0.8, 0.4]\n[[box]]\nlow = [-9, -1, -9]\nhigh = [9, 0, 9]\nmaterial = \"floor\"\n\
         [[material]]\nname = \"lamp\"\ncolor = [0, 0, 0]\nemission = [5, 5, 5]\n{lamp}"
    );
    let pixels = picture_in(folder, "32x20", &text).pixels;
    [0, 2].map(|channel| {
        pixels.iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>() / pixels.len() as f64
    })
}

const BALL: &str = "[[sphere]]\ncenter = [0, 3, 0]\nradius = 1\nmaterial = \"lamp\"\n";

#[test]
fn a_ball_lights_the_floor_by_the_square_of_its_sine() {
    // Below its middle, a luminous ball sends pi·L·(r/d)^2, of which the floor scatters a fraction divided by
    // pi.
    let expected = [0.8, 0.4].map(|color| color * 5.0 / 9.0);
    for bounces in [0, 1, 4] {
        // With bounces, paths also hit the ball at random, but it only counts once.
        for (found, expected) in lit_floor(bounces, BALL).into_iter().zip(expected) {
            println!("{bounces} bounces: {found}, not {expected}");
            assert!((found / expected - 1.0).abs() < 0.01, "{bounces}: {found}, not {expected}");
        }
    }
}

#[test]
fn what_chance_alone_finds_is_as_bright() {
    // Shadow rays do not test a box; and none passes through glass, although this glass bends no ray and
    // absorbs nothing.
    let glass = "[[material]]\nname = \"glass\"\nglass = \"thick\"\nindex = 1\n[[box]]\n\
                 low = [-2, 1, -2]\nhigh = [2, 5, 2]\nmaterial = \"glass\"\n";
    let [free, _] = lit_floor(1, BALL);
    let [in_glass, _] = lit_floor(1, &format!("{BALL}{glass}"));
    println!("a ball: {free}; in glass: {in_glass}");
    // One path in nine hits it, of 41,000: three times the deviation is 0.04.
    assert!((in_glass / free - 1.0).abs() < 0.04, "{in_glass}, not {free}");
    let plate = "[[box]]\nlow = [-1, 2, -1]\nhigh = [1, 2.002, 1]\nmaterial = \"lamp\"\n";
    let [by_chance, _] = lit_floor(1, plate);
    let folder = tempfile::tempdir().unwrap();
    let model = "o plate\nv -1 2 -1\nv 1 2 -1\nv 1 2 1\nv -1 2 1\nf 1 2 3 4\n";
    let file = folder.path().join("plate.obj");
    fs::write(&file, model).unwrap();
    let piece = "[[piece]]\nmesh = \"plate\"\nat = [0, 0, 0]\nmaterial = \"lamp\"\n";
    let [by_both, _] = lit_floor_in(folder.path(), 1, "model = \"plate.obj\"\n", piece);
    println!("a plate by chance: {by_chance}; by both: {by_both}");
    assert!((by_chance / by_both - 1.0).abs() < 0.04, "{by_chance}, not {by_both}");
}

#[test]
fn what_shines_calls_for_shadow_rays_if_something_scatters_its_light() {
    let needed = |text: &str| {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("s.toml");
        let lamp = "[[material]]\nname = \"lamp\"\ncolor = [0, 0, 0]\nemission = [1, 0, 0]\n";
        fs::write(&file, format!("version = 1\n{CAMERA}{lamp}{text}")).unwrap();
        let found = findings(&effects::open(&file).unwrap());
        let found = found.into_iter().find(|found| found.effect == Effect::Emitters).unwrap();
        (found.needed, found.why)
    };
    let wall = "[[material]]\nname = \"wall\"\ncolor = [0, 0.1, 0]\n[[box]]\nlow = [0, 0, 0]\n\
                high = [1, 1, 1]\nmaterial = \"wall\"\n";
    let none = (false, "no sphere and no mesh shines, or nothing scatters light".to_owned());
    assert_eq!(needed(BALL), none, "nothing has a colour");
    assert_eq!(needed(wall), none, "nothing wears the lamp");
    let shining = wall.replace("material = \"wall\"", "material = \"lamp\"");
    assert_eq!(
        needed(&format!(
            "{shining}{}",
            wall.replace("[[material]]\nname = \"wall\"\ncolor = [0, 0.1, 0]\n", "")
        )),
        none,
        "a box is met by chance"
    );
    assert_eq!(needed(&format!("{BALL}{wall}")), (true, "material \"lamp\" shines".to_owned()));
    let glass = wall.replace("[[box]]", "glass = \"thick\"\n[[box]]");
    assert_eq!(needed(&format!("{BALL}{glass}")), none, "glass scatters nothing");
}

#[test]
fn a_lens_blurs_an_edge_by_its_distance_from_the_focus() {
    // The edge is at 5; points at `focus` are sharp. A point at z becomes a disk of diameter·|z - f| / f at
    // z; across a straight edge, a disk's standard deviation is a quarter of its width.
    let spread = |lens: &str| {
        let text = format!(
            "[picture]\nsamples = 64\n{CAMERA}{lens}[[material]]\nname = \"lamp\"\ncolor = [0, 0, 0]\n\
             emission = [1000, 1000, 1000]\n[[box]]\nlow = [0, -9, -0.01]\nhigh = [9, 9, 0]\n\
             material = \"lamp\"\n"
        );
        let (width, height) = (96, 60);
        let picture = picture("96x60", &text);
        // The mean of all rows, and the place of the edge in it.
        let row: Vec<f64> = (0..width)
            .map(|x| (0..height).map(|y| f64::from(picture.pixels[y * width + x][1])).sum())
            .collect();
        let steps: Vec<f64> = row.windows(2).map(|pair| (pair[1] - pair[0]) / row[95]).collect();
        let moment = |power: i32, mean: f64| -> f64 {
            steps.iter().enumerate().map(|(i, step)| step * (i as f64 - mean).powi(power)).sum()
        };
        let mean = moment(1, 0.0);
        moment(2, mean).max(0.0).sqrt()
    };
    // 60 pixels are 2·tan(10°)·5 high.
    let pixel = 2.0 * 10f64.to_radians().tan() * 5.0 / 60.0;
    assert!(spread("") < 0.6, "a pinhole");
    assert!(spread("lens = { diameter = 0.5, focus = 5 }\n") < 0.6, "in focus");
    for (diameter, focus) in [(0.3, 3.0), (0.3, 9.0), (0.2, 2.5)] {
        let lens = format!("lens = {{ diameter = {diameter}, focus = {focus} }}\n");
        let expected = diameter * (5.0_f64 - focus).abs() / focus / pixel / 4.0;
        // A pixel's own width also blurs.
        let found = (spread(&lens).powi(2) - 1.0 / 6.0).sqrt();
        println!("diameter {diameter}, focus {focus}: {found} pixels, not {expected}");
        assert!((found / expected - 1.0).abs() < 0.05, "{found} pixels, not {expected}");
    }
}
