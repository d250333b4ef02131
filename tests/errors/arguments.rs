//! Options, controls, sizes, devices: wrong arguments exit with code 2 and a message that says what is
//! accepted.

use crate::{refused, refused_by, sample};

#[test]
fn options() {
    for (arguments, words) in [
        (&["--bogus"][..], "unexpected argument '--bogus' found; --help lists the options"),
        (&["stray"], "unexpected argument 'stray'"),
        (&[""], "unexpected argument ''"),
        (&["--set"], "a value is required for '--set <NAME=VALUE>'"),
        (&["--out"], "a value is required for '--out <FILE>'"),
        (&["--out", ""], "a value is required for '--out <FILE>'"),
        (&["--out", "a.png", "--out", "b.png"], "cannot be used multiple times"),
        (
            &["--frames", "0"],
            "invalid value '0' for '--frames <N>': frames are a whole number from 1 to 4294967295",
        ),
        (&["--frames", "1.5"], "invalid value '1.5' for '--frames <N>': frames are a whole number"),
        (
            &["--samples", "0..2", "--save", "a.sums", "--save-every", "1.5"],
            "invalid value '1.5' for '--save-every <SECONDS>': seconds are a whole number",
        ),
        (&["--frames=-1"], "invalid value '-1' for '--frames <N>'"),
        (&["--frames", "-1"], "invalid value '-1' for '--frames <N>'"),
        (
            &["--save", "a.sums"],
            "--save a.sums stores sums of samples: add --samples A..B; --out FILE writes a picture",
        ),
        (&["--save", "a.png"], "add --samples A..B; --out FILE writes a picture"),
        (&["--samples", "-1..4"], "invalid value '-1..4' for '--samples <A..B>'"),
        (&["--frames", "many"], "invalid value 'many' for '--frames <N>'"),
        (&["--scene", ""], "a value is required for '--scene <FILE>'"),
        (&["--sky", ""], "a value is required for '--sky <FILE>'"),
        (&["--sky", "a.exr"], "brings its own sky and takes no --sky"),
        (
            &["--exposure", "nan"],
            "invalid value 'nan' for '--exposure <STOPS>': stops are a number from -32 to 32",
        ),
        (&["--tone", "film"], "[possible values: clamp, reinhard, aces]"),
        (
            &["--pixel", "5"],
            "invalid value '5' for '--pixel <X,Y|click>': a pixel is a column and a row, such as 480,300",
        ),
        (
            &["--pixel", "-1,4"],
            "invalid value '-1,4' for '--pixel <X,Y|click>': a pixel is a column",
        ),
        (&["--pixel", "8,0"], "pixel 8,0 lies outside the picture of 8x8: the last is 7,7"),
        (&["--pixel", "click"], "--pixel click is for a window; without one, name a pixel"),
        (
            &["--pixel", "1,1", "--out", "a.png"],
            "'--pixel <X,Y|click>' cannot be used with '--out <FILE>'",
        ),
        (
            &["--pixel", "1,1", "--validate"],
            "'--pixel <X,Y|click>' cannot be used with '--validate'",
        ),
        (&["--compile-for"], "[possible values: navi21, navi31, gfx1201, dg2, bmg, all]"),
        (
            &["--compile-for", "nonsense"],
            "invalid value 'nonsense' for '--compile-for <FAMILY>' [possible values: navi21, navi31, gfx1201, dg2, bmg, all]",
        ),
    ] {
        refused(arguments, 2, &[words]);
    }
}

#[test]
fn frames_that_cannot_be_animated() {
    for (arguments, words) in [
        (&["--animate", "--frames", "4"][..], "--animate writes a file: name it, --out FILE.png"),
        (
            &["--animate", "--frames", "4", "--out", "a.exr"],
            "'a.exr' does not move: --animate writes a .png",
        ),
        (&["--animate", "--out", "a.png"], "say how many, --frames N"),
        (
            &["--animate", "--frames", "3601", "--out", "a.png"],
            "--animate takes at most 3600 frames, a minute; not 3601",
        ),
        (&["--animate", "--frames", "4", "--out", "a.png"], "shows nothing that moves"),
        (&["--animate", "--frames", "1", "--out", "a.png"], "two frames or more"),
    ] {
        refused(arguments, 2, &[words]);
    }
    for (name, arguments, words) in [
        ("01_foundation", &[][..], "this program has no animation"),
        (
            "14_animation",
            &["--compare", "flag=rebuilt|updated"],
            "'--compare <NAME=A|B|…>' cannot be used with '--animate'",
        ),
        ("14_animation", &["--set", "play=off"], "play=off stops it: leave that out"),
        (
            "14_animation",
            &["--pixel", "1,1"],
            "'--pixel <X,Y|click>' cannot be used with: --animate --out <FILE>",
        ),
    ] {
        let frames = ["--headless", "--animate", "--frames", "4", "--out", "a.png"];
        let (code, line) = run::refused(name, &[arguments, &frames].concat());
        assert!(code == 2 && line.contains(words), "{name}: {line}");
    }
    let mut window = run::command("14_animation");
    window.args(["--animate", "--frames", "4", "--out", "a.png"]);
    refused_by(window, 2, &["--headless"]);
}

#[test]
fn what_cannot_be_set_on_the_way() {
    for (then, words) in [
        ("sun elevation=30", "it takes the number of a frame and a setting, such as \"12:sun"),
        ("x:sun elevation=30", "it takes the number of a frame"),
        (
            "4:sun elevation=30",
            "--then names frame 4, but the run has frames 0 to 3: give it more by --frames",
        ),
        ("1:sun=30", "no control 'sun'"),
        ("1:sun elevation=300", "cannot be '300'"),
        ("-1:sun elevation=30", "it takes the number of a frame"),
    ] {
        refused(&["--frames", "4", "--then", then], 2, &[words]);
    }
    // Also where nothing is rendered.
    refused(&["--list-controls", "--then", "0:sun=30"], 2, &["no control 'sun'"]);
    let two = ["--scene", "samples/assets/chess.obj", "--then", "0:scene=chess"];
    let (code, line) = run::refused("31_history_and_filter", &[&["--headless"][..], &two].concat());
    assert!(code == 2 && line.contains("are two scenes"), "{line}");
    let two = ["--sky", "samples/assets/evening.exr", "--set", "sky=day"];
    let (code, line) = run::refused("46_environment", &[&["--headless"][..], &two].concat());
    assert!(code == 2 && line.contains("\"sky=day\" are two skies"), "{line}");
    let (code, line) = run::refused("01_foundation", &["--headless", "--then", "0:a=1"]);
    assert!(code == 2 && line.contains("--then works from 02 on"), "{line}");
}

#[test]
fn what_makes_its_pipeline_by_itself_is_not_compiled_for_another_gpu() {
    let (code, line) = run::refused("01_foundation", &["--compile-for", "navi31"]);
    assert!(code == 2 && line.contains("--compile-for works from 02 on"), "{line}");
}

#[test]
fn a_chapter_of_its_own_scenes_takes_no_file() {
    // 22 knows the pieces of the chess set by name.
    for name in ["22_solids", "38_primitive_order", "39_far_from_origin"] {
        let (code, line) = run::refused(name, &["--headless", "--scene", "a.obj"]);
        assert!(code == 2 && line.contains("brings its own scene and takes no --scene"), "{line}");
    }
}

#[test]
fn what_only_tells_takes_no_other_task() {
    for (arguments, other) in [
        (["--pixel", "1,1"], "'--pixel <X,Y|click>'"),
        (["--list-devices", "--validate"], "'--list-devices'"),
    ] {
        let listed = [&["--list-controls"], &arguments[..]].concat();
        refused(&listed, 2, &["'--list-controls'", other, "cannot be used with"]);
    }
}

#[test]
fn controls() {
    let there_is = "there is show, sun azimuth, sun elevation, camera eye";
    let azimuth = "control 'sun azimuth' cannot be";
    for (setting, words) in [
        ("bogus=1", &["no control 'bogus'", there_is][..]),
        ("Show=picture", &["no control 'Show'", there_is]),
        ("sun azimuth=360.5", &[azimuth, "0 to 360"]),
        ("sun azimuth=NaN", &[azimuth, "0 to 360"]),
        ("sun azimuth=", &[azimuth, "0 to 360"]),
        ("sun azimuth=1=2", &[azimuth, "'1=2'", "0 to 360"]),
        ("show=nothing", &["'show'", "'nothing'", "picture, normal, triangle"]),
        ("camera eye=1,2", &["'camera eye'", "x,y,z"]),
        ("camera eye=1,2,inf", &["'camera eye'", "x,y,z"]),
        ("camera eye=0.35,0.3,-0.2", &["'camera eye'", "'camera target'", "two different points"]),
        ("camera eye=1,2,1e300", &["'camera eye'", "x,y,z, each -1e18 to 1e18"]),
        ("sun azimuth", &["a setting is a name and a value"]),
        ("=1", &["a setting is a name and a value"]),
        ("", &["a setting is a name and a value"]),
    ] {
        refused(&["--set", setting], 2, words);
    }
    for (name, control) in [("12_infinite_plane", "plane normal"), ("22_solids", "cut normal")] {
        for text in ["0,0,0", "1e-60,-1e-60,0"] {
            let (code, line) =
                run::refused(name, &["--headless", "--set", &format!("{control}={text}")]);
            let words = "it takes x,y,z, each -1000 to 1000, not all 0 in 32 bits";
            let control = format!("control '{control}' cannot be '{text}': {words}");
            assert!(code == 2 && line.contains(&control), "{line}");
        }
    }
    // Every setting is validated, not only the last one of a name.
    refused(&["--set", "show=bogus", "--set", "show=normal"], 2, &["'bogus'"]);
}

#[test]
fn comparisons() {
    for (comparison, words) in [
        ("bogus", "--compare needs a control and its values, as NAME=A|B, not 'bogus'"),
        ("show=picture", "NAME=A|B"),
        ("bogus=1|2", "no control 'bogus'; there is show"),
        ("show=picture|nothing", "control 'show' cannot be 'nothing'"),
        ("sun azimuth=0|1|NaN", "control 'sun azimuth' cannot be 'NaN'"),
    ] {
        // Refused before the first of that many frames.
        refused(&["--frames", "4000000000", "--compare", comparison], 2, &[words]);
    }
}

#[test]
fn sizes() {
    let whole = "a size is two whole numbers of at least 1, such as 640x400";
    for size in
        ["-1x4", "0x0", "0x8", "8x0", "8", "8x", "x8", "8x8x8", "8.5x8", "99999999999x8", ""]
    {
        refused_by(sized(size), 2, &[&format!("invalid value '{size}'"), whole]);
    }
    // No device supports an image of this size, or that many rays at once.
    for size in ["4294967295x1", "1x4294967295", "4294967295x4294967295"] {
        refused_by(sized(size), 2, &[&format!("{size} is too large for "), " a side and "]);
    }
    let mut window = run::command(crate::SAMPLE);
    window.args(["--size", "65536x10"]);
    refused_by(window, 2, &["65536x10 is too large for a window"]);
}

fn sized(size: &str) -> std::process::Command {
    let mut command = run::command(crate::SAMPLE);
    command.args(["--headless", "--size", size]);
    command
}

#[test]
fn memory_that_cannot_be_had() {
    // The list of hits needs 4.4 GB here, and a buffer of the software driver holds at most 2.
    let arguments = ["--headless", "--size", "16384x700", "--set", "mode=all hits"];
    let software = ["--device", "llvmpipe"];
    let (code, line) = run::refused("03_any_hit", &[&arguments[..], &software].concat());
    if code == 1 {
        assert!(line.contains("a list of all hits takes 384 bytes per pixel: llvmpipe"), "{line}");
        assert!(line.contains(" pixels, not for 11468800; a smaller picture fits"), "{line}");
    } else {
        println!("not tried: {line}");
        assert!(line.contains("no device 'llvmpipe'"), "{line}");
    }
}

#[test]
fn devices() {
    for device in ["no such device", "99", "-1", "18446744073709551616"] {
        refused(&["--device", device], 2, &[&format!("no device '{device}'; there is 0: ")]);
    }
    refused(&["--device", ""], 2, &["a value is required for '--device <N|NAME>'"]);
}

#[test]
fn what_only_tells_ends_with_0() {
    for (argument, words) in [
        ("--help", "--size <WxH>"),
        ("--list-devices", "0: "),
        ("--list-controls", "sun azimuth\tnumber\t0 to 360\t"),
    ] {
        let output = run::command(crate::SAMPLE).arg(argument).output().unwrap();
        let told = String::from_utf8(output.stdout).unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{argument}");
        assert!(told.contains(words), "{argument}: {told}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn help_that_nobody_can_read_is_an_error() {
    let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
    let output = sample().arg("--help").stdout(full).output().unwrap();
    let (code, line) = run::refusal(output);
    assert!(code == 1 && line.contains("cannot write to standard output"), "{line}");
}

#[test]
fn the_tools_of_the_chess_set_tell_their_usage() {
    for name in ["chess_set", "chess_game"] {
        let output = run::command(name).arg("--help").output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty());
        let told = String::from_utf8(output.stdout).unwrap();
        assert!(told.starts_with(&format!("usage: {name}")), "{told}");
    }
}

#[test]
fn help_begins_with_what_a_sample_does() {
    for name in [crate::SAMPLE, "24_accuracy"] {
        let output = run::command(name).arg("--help").output().unwrap();
        let told = String::from_utf8(output.stdout).unwrap();
        assert!(
            told.starts_with("Shows its scene in a window, or renders a picture\n\nUsage: "),
            "{name}: {told}"
        );
    }
}

#[test]
fn the_last_setting_of_a_name_counts() {
    let mut command = sample();
    command.args(["--set", "sun azimuth=1", "--set", "sun azimuth=2", "--list-controls"]);
    let told = String::from_utf8(command.output().unwrap().stdout).unwrap();
    assert!(told.contains("sun azimuth\tnumber\t0 to 360\t2\n"), "{told}");
}
