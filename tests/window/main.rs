//! The window from a user's view: on an X server, with a keyboard and a mouse.
//!
//! Xvfb has no window manager, so a window is minimised here by unmapping it, as a window manager does.
#![cfg(unix)]

mod desk;
mod failures;
mod history;
mod long;
mod lost;
mod signals;
mod stand_ins;
mod started;
mod wayland;
mod xvfb;

use std::path::Path;
use std::process::Output;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use image::{Rgb, RgbImage};

use run::layer::Layer;

use desk::{Desk, KEY_COMMA, KEY_ESCAPE, KEY_F1, KEY_HOME, KEY_PERIOD, KEY_SPACE, KEY_TAB, wait};

/// The slider "sun azimuth" in the panel, from end to end.
const SLIDER: [(i16, i16); 2] = [(140, 236), (250, 236)];
/// The checkbox "light shadows" in the panel of chapter 25.
const LIGHT_SHADOWS: (i16, i16) = (163, 461);
/// The right edge of the panel.
const PANEL: u32 = 352;
/// The panel's background while it shows an error.
const ERROR: Rgb<u8> = Rgb([58, 24, 24]);

/// One window at a time: two would share the processor and spoil each other's times.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Checks that the sample has ended successfully without an error or a validation message.
fn ended_well(output: Output) {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && errors.is_empty(), "{}: {errors}", output.status);
}

/// Returns whether all pixels right of the panel are equal except for rounding.
fn same(a: &RgbImage, b: &RgbImage) -> bool {
    let near = |a: &Rgb<u8>, b: &Rgb<u8>| (0..3).all(|i| a.0[i].abs_diff(b.0[i]) <= 1);
    let mut pixels = a.enumerate_pixels().zip(b.pixels());
    a.dimensions() == b.dimensions() && pixels.all(|((x, _, a), b)| x < PANEL || near(a, b))
}

fn tells_error(desk: &Desk) -> bool {
    desk.shown().pixels().filter(|pixel| **pixel == ERROR).count() > 500
}

/// The picture after a drag, which must differ. On a busy machine, a whole drag may happen between two frames
/// of the window, which then sees none of it, so it is repeated.
fn changed(desk: &Desk, before: &RgbImage, [from, to]: [(i16, i16); 2]) -> RgbImage {
    wait("another picture", || {
        desk.drag(from, to, 10);
        Some(desk.picture().0).filter(|picture| !same(picture, before))
    })
}

#[test]
fn a_window_shows_the_picture_and_answers_mouse_and_keys() {
    let _alone = alone();
    let desk = Desk::open("02_basic", &["--validate", "--size", "640x420"], &[]);
    let (first, file) = desk.picture();
    assert!(file.ends_with("02_basic-001.png"), "{}", file.display());
    // The same numbers as the picture's: the window converts to sRGB only once.
    wait("the picture in the window", || same(&desk.shown(), &first).then_some(()));

    let moved = changed(&desk, &first, [SLIDER[0], SLIDER[1]]);
    let moved = changed(&desk, &moved, [SLIDER[1], (SLIDER[1].0 - 40, SLIDER[1].1)]);
    let turned = changed(&desk, &moved, [(500, 300), (400, 260)]);

    wait("the picture in the window", || same(&desk.shown(), &turned).then_some(()));
    desk.key(KEY_F1);
    wait("the help", || (!same(&desk.shown(), &turned)).then_some(()));
    desk.key(KEY_ESCAPE);
    wait("no help", || same(&desk.shown(), &turned).then_some(()));
    let with_panel = *desk.shown().get_pixel(60, 60);
    desk.key(KEY_TAB);
    wait("no panel", || (*desk.shown().get_pixel(60, 60) != with_panel).then_some(()));
    desk.key(KEY_ESCAPE);
    ended_well(desk.end());
}

#[test]
fn a_pixel_that_is_clicked_has_its_rays_printed() {
    let _alone = alone();
    let desk = Desk::open("02_basic", &["--pixel", "click", "--size", "640x420"], &[]);
    desk.picture();
    desk.click_with_control((500, 300));
    // A request after the click is processed after it.
    desk.picture();
    desk.key(KEY_ESCAPE);
    let output = desk.end();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(printed.starts_with("pixel 500,300 of 640x420\nray 1 · camera.rgen · "), "{printed}");
    ended_well(output);
}

#[test]
fn an_animation_is_stepped_played_and_paused_by_keys() {
    let _alone = alone();
    let paused = ["--validate", "--size", "640x420", "--set", "play=off", "--set", "frame=100"];
    let desk = Desk::open("14_animation", &paused, &[]);
    let (first, _) = desk.picture();
    desk.key(KEY_PERIOD);
    let (next, _) = desk.picture();
    assert!(!same(&first, &next), "a step changes nothing");
    desk.key(KEY_COMMA);
    let (back, _) = desk.picture();
    assert!(same(&first, &back), "a step back does not lead back");

    wait("the picture in the window", || same(&desk.shown(), &back).then_some(()));
    desk.key(KEY_SPACE);
    wait("what moves", || (!same(&desk.shown(), &back)).then_some(()));
    let moving = desk.shown();
    wait("what goes on moving", || (!same(&desk.shown(), &moving)).then_some(()));
    desk.key(KEY_SPACE);
    let (stopped, _) = desk.picture();
    assert!(!same(&stopped, &back), "it is where it was");
    wait("the picture in the window", || same(&desk.shown(), &stopped).then_some(()));
    let (still, _) = desk.picture();
    assert!(same(&still, &stopped), "it goes on while it is paused");
    desk.key(KEY_ESCAPE);
    ended_well(desk.end());
}

#[test]
#[ignore = "nightly: a large window; quick: a_window_shows_the_picture_and_answers_mouse_and_keys"]
fn a_wide_window_has_the_panel_beside_the_picture() {
    let _alone = alone();
    let desk = Desk::open("02_basic", &["--validate", "--size", "960x420"], &[]);
    let beside = || Some(desk.picture().0).filter(|picture| picture.width() < 960);
    let picture = wait("a picture beside the panel", beside);
    let (width, height) = picture.dimensions();
    assert!(width > 600 && height == 420, "{width}x{height}");
    let near = |a: &Rgb<u8>, b: &Rgb<u8>| (0..3).all(|i| a.0[i].abs_diff(b.0[i]) <= 1);
    let stands = |shown: &RgbImage| {
        let at = |x, y| near(shown.get_pixel(960 - width + x, y), picture.get_pixel(x, y));
        (0..height).all(|y| (0..width).all(|x| at(x, y)))
    };
    wait("the whole picture in the window", || stands(&desk.shown()).then_some(()));
    desk.key(KEY_TAB);
    let alone = || Some(desk.picture().0).filter(|picture| picture.dimensions() == (960, 420));
    wait("a picture as wide as the window", alone);
    desk.key(KEY_ESCAPE);
    ended_well(desk.end());
}

#[test]
fn a_window_can_be_resized_minimised_and_closed() {
    let _alone = alone();
    let desk = Desk::open("02_basic", &["--validate", "--size", "480x300"], &[]);
    for (width, height) in [(700, 360), (361, 500), (1, 1), (640, 400)] {
        desk.resize(width, height);
        let sized = || Some(desk.picture().0).filter(|image| image.dimensions() == (width, height));
        let picture = wait("a picture of the new size", sized);
        wait("the picture in the window", || same(&desk.shown(), &picture).then_some(()));
    }
    let (before, _) = desk.picture();
    desk.map(false);
    desk.map(true);
    wait("the picture in the window", || same(&desk.shown(), &before).then_some(()));
    desk.close();
    ended_well(desk.end());
}

#[test]
#[ignore = "nightly: another window; quick: a_window_shows_the_picture_and_answers_mouse_and_keys"]
fn home_brings_the_camera_back() {
    let _alone = alone();
    let desk = Desk::open("02_basic", &["--size", "480x300"], &[]);
    let (first, _) = desk.picture();
    changed(&desk, &first, [(440, 150), (470, 250)]);
    desk.key(KEY_HOME);
    wait("the first picture", || same(&desk.picture().0, &first).then_some(()));
    desk.key(KEY_ESCAPE);
    ended_well(desk.end());
}

#[test]
fn frames_are_counted_and_controls_can_be_set() {
    let _alone = alone();
    let arguments = ["--validate", "--size", "480x300", "--frames", "40", "--set", "show=normal"];
    let desk = Desk::open("02_basic", &arguments, &[]);
    ended_well(desk.end());
}

#[test]
#[ignore = "nightly only: a time on the clock, for a machine with nothing else to do"]
fn dragging_a_slider_never_freezes_the_panel() {
    let _alone = alone();
    let log = [("RUST_LOG", Path::new("raybook=info")), ("NO_COLOR", Path::new("1"))];
    let desk = Desk::open("02_basic", &["--size", "1280x720"], &log);
    for _ in 0..2 {
        desk.drag(SLIDER[0], SLIDER[1], 100);
        desk.drag(SLIDER[1], SLIDER[0], 100);
    }
    desk.key(KEY_ESCAPE);
    let output = desk.end();
    let log = String::from_utf8_lossy(&output.stderr).into_owned();
    let longest = log
        .split("longest wait for a frame ")
        .nth(1)
        .and_then(|rest| rest.split(' ').next()?.parse::<u32>().ok());
    let longest = longest.unwrap_or_else(|| panic!("no figure in the log: {log}"));
    println!("longest wait for a frame: {longest} ms");
    assert!(longest < 250, "{longest} ms from input to picture");
}

/// Copies folders of shaders, to be edited.
fn copy_shaders(place: &Path, folders: &[&str]) {
    for folder in folders {
        let (from, to) = (run::root().join("shaders").join(folder), place.join(folder));
        std::fs::create_dir(&to).expect("a folder");
        for file in from.read_dir().expect("shaders").map(|file| file.expect("a shader").path()) {
            std::fs::copy(&file, to.join(file.file_name().expect("a name"))).expect("a copy");
        }
    }
}

#[test]
fn edited_shaders_are_reloaded_and_broken_ones_are_told_of() {
    let _alone = alone();
    let copy = tempfile::tempdir().expect("a temporary folder");
    copy_shaders(copy.path(), &["common", "02_basic"]);
    let sky = copy.path().join("02_basic/sky.rmiss");
    let good = std::fs::read_to_string(&sky).expect("the sky");
    let end = good.rfind('}').expect("a body");
    let edited = |line: &str| format!("{}{line}\n}}\n", &good[..end]);
    let edit = |text: &str| std::fs::write(&sky, text).expect("an edit");
    let arguments = ["--validate", "--size", "640x420", "--set", "sun azimuth=100"];
    let desk = Desk::open("02_basic", &arguments, &[("SHADERS", copy.path())]);
    let (first, _) = desk.picture();

    edit(&edited("    payload = nonsense;"));
    wait("the error", || tells_error(&desk).then_some(()));
    assert!(same(&desk.picture().0, &first), "the last good picture stays");

    // Input that makes the compiler's bindings panic: a zero byte, and a version of desktop GLSL. And a sum
    // that overflows the compiler's stack.
    let terms = " + x * y".repeat(100_000);
    let sum = format!("float much(float x) {{ float y = 0.0; y += x{terms}; return y; }}");
    let version = good.replace("#version 460", "#version 110");
    for text in [format!("{good}\0"), version, format!("{good}{sum}\n")] {
        edit(&text);
        wait("the error", || tells_error(&desk).then_some(()));
        assert!(same(&desk.picture().0, &first), "the last good picture stays");
        edit(&good);
        wait("no error", || (!tells_error(&desk)).then_some(()));
    }

    edit(&edited("    payload = vec4(1.0, 0.0, 0.0, 1.0);"));
    let red = wait("a red sky", || {
        let (shown, _) = desk.picture();
        (shown.get_pixel(shown.width() - 1, 0) == &Rgb([255, 0, 0])).then_some(shown)
    });

    let unbound = good.replace(
        "void main",
        "layout(set = 0, binding = 7, rgba32f) uniform image2D \
                                extra;\nvoid main",
    );
    let end = unbound.rfind('}').expect("a body");
    edit(&format!("{}    imageStore(extra, ivec2(0), payload);\n}}\n", &unbound[..end]));
    wait("the refusal", || tells_error(&desk).then_some(()));
    assert!(same(&desk.picture().0, &red), "the last good picture stays");

    let push = copy.path().join("02_basic/push.glsl");
    let layout = std::fs::read_to_string(&push).expect("the push constants");
    edit(&good);
    wait("no error", || (!tells_error(&desk)).then_some(()));
    // A changed setting survives every reload.
    wait("the first picture", || same(&desk.picture().0, &first).then_some(()));
    let light = "DirectionalLight light;";
    std::fs::write(&push, layout.replace(light, &format!("uint less;\n    {light}")))
        .expect("an edit");
    wait("the refusal", || tells_error(&desk).then_some(()));
    desk.close();
    ended_well(desk.end());
}

/// A file may change between the check and the compiler's reading without harm.
#[test]
#[ignore = "nightly: many compilations; quick: edited_shaders_are_reloaded_and_broken_ones_are_told_of"]
fn a_shader_may_change_while_it_is_compiled() {
    let _alone = alone();
    let copy = tempfile::tempdir().expect("a temporary folder");
    copy_shaders(copy.path(), &["common", "02_basic"]);
    let sky = copy.path().join("02_basic/sky.rmiss");
    let good = std::fs::read_to_string(&sky).expect("the sky");
    let bad = format!("{good}\0");
    let desk = Desk::open("02_basic", &["--size", "640x420"], &[("SHADERS", copy.path())]);
    let (first, _) = desk.picture();
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(5) {
        for text in [&bad, &good] {
            std::fs::write(&sky, text).expect("an edit");
        }
    }
    wait("no error", || (!tells_error(&desk)).then_some(()));
    assert!(same(&desk.picture().0, &first));
    desk.close();
    ended_well(desk.end());
}

/// Checks for one line about the window system, and exit code 1.
#[track_caller]
fn failed(output: Output) {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), errors.lines().count()), (Some(1), 1), "{errors}");
    println!("{errors}");
    let is_told =
        ["error: the window system", "error: cannot draw to the window", "X connection to"];
    assert!(is_told.iter().any(|words| errors.starts_with(words)), "{errors}");
    assert!(!run::MISTAKES.iter().any(|mistake| errors.contains(mistake)), "{errors}");
}

#[test]
fn a_server_without_an_extension_is_said_in_one_line() {
    let _alone = alone();
    let server = xvfb::start(&["-extension", "RANDR"]);
    failed(desk::outcome_on(server, "02_basic", &["--size", "320x200"], &[], |_| {}));
}

#[test]
#[ignore = "nightly: another X server; quick: a_window_that_another_client_destroys_ends_in_one_line"]
fn a_server_that_dies_ends_the_window_in_one_line() {
    let _alone = alone();
    let mut desk = Desk::open("02_basic", &["--size", "320x200"], &[]);
    desk.kill_server();
    failed(desk.end());
}

#[test]
fn a_window_that_another_client_destroys_ends_in_one_line() {
    let _alone = alone();
    let desk = Desk::open("02_basic", &["--size", "320x200"], &[]);
    desk.destroy();
    failed(desk.end());
}

/// Vulkan results related to windows.
const OUT_OF_HOST_MEMORY: i32 = -1;
const DEVICE_LOST: i32 = -4;
const SURFACE_LOST: i32 = -1_000_000_000;
const OUT_OF_DATE: i32 = -1_000_001_004;
const SUBOPTIMAL: i32 = 1_000_001_003;
const TIMEOUT: i32 = 2;

/// Opens a window for a few frames with a failing call; returns whether the frames were shown nevertheless.
#[track_caller]
fn shows_all_the_same(function: &str, number: usize, result: i32) -> bool {
    let fault = format!("{function}:{number}:{result}");
    let layer = Layer::fail_nth_call(&fault);
    let arguments = ["--size", "160x100", "--frames", "3"];
    let output = desk::outcome("02_basic", &arguments, &layer.environment());
    let errors = String::from_utf8_lossy(&output.stderr);
    match output.status.code() {
        Some(0) => assert!(errors.is_empty(), "{fault}: {errors}"),
        Some(1) => {
            assert!(errors.starts_with("error: ") && errors.lines().count() == 1, "{errors}")
        }
        other => panic!("{fault}: {other:?}, {errors}"),
    }
    output.status.success()
}

#[test]
fn what_a_window_system_takes_away_is_made_again_and_a_lost_device_is_said() {
    let _alone = alone();
    for function in ["vkAcquireNextImageKHR", "vkQueuePresentKHR"] {
        for result in [OUT_OF_DATE, SURFACE_LOST] {
            assert!(shows_all_the_same(function, 2, result), "{function}: {result}");
        }
        for result in [OUT_OF_HOST_MEMORY, DEVICE_LOST] {
            assert!(!shows_all_the_same(function, 2, result), "{function}: {result}");
        }
    }
    assert!(shows_all_the_same("vkAcquireNextImageKHR", 1, TIMEOUT));
    assert!(shows_all_the_same("vkQueuePresentKHR", 1, SUBOPTIMAL));
    for function in ["vkCreateSwapchainKHR", "vkGetPhysicalDeviceSurfaceCapabilitiesKHR"] {
        assert!(shows_all_the_same(function, 1, SURFACE_LOST), "{function}");
    }
    for function in ["vkCreateXlibSurfaceKHR", "vkCreateSemaphore", "vkQueueSubmit"] {
        assert!(!shows_all_the_same(function, 1, OUT_OF_HOST_MEMORY), "{function}");
    }
}

#[test]
#[ignore = "nightly: a large window; quick: a_window_can_be_resized_minimised_and_closed"]
fn a_window_may_be_larger_than_a_picture() {
    let _alone = alone();
    let (_narrow, environment) = narrow("rays=40000");
    let environment: Vec<_> =
        environment.iter().map(|(name, value)| (*name, Path::new(value))).collect();
    let desk = Desk::open("02_basic", &["--validate", "--size", "240x150"], &environment);
    desk.resize(480, 300);
    wait("the larger window", || (desk.shown().width() == 480).then_some(()));
    let picture = wait("a picture of it", || {
        let (width, height) = desk.picture().0.dimensions();
        (width > 240).then_some((width, height))
    });
    assert_eq!(picture, (252, 158), "as many rays as there may be, in the window's shape");
    desk.close();
    ended_well(desk.end());
}

#[test]
fn a_pipeline_that_is_made_in_the_background_changes_the_picture_when_it_is_there() {
    let _alone = alone();
    let arguments = ["--validate", "--size", "800x700", "--set", "scene=opening"];
    let desk = Desk::open("25_scene_effects", &arguments, &[]);
    let (before, _) = desk.picture();
    let click = || desk.drag(LIGHT_SHADOWS, LIGHT_SHADOWS, 4);
    click();
    let without = || Some(desk.picture().0).filter(|picture| !same(picture, &before));
    wait("a picture without shadows", without);
    click();
    wait("the first picture", || same(&desk.picture().0, &before).then_some(()));
    desk.key(KEY_ESCAPE);
    ended_well(desk.end());
}

#[test]
fn without_a_display_one_line_offers_headless() {
    let without = |name: &str| {
        let mut command = run::command(name);
        command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        command
    };
    let (code, line) = run::refusal(without("02_basic").output().expect("it starts"));
    let expected = "error: no display: set DISPLAY or WAYLAND_DISPLAY, or add --headless to render \
                    without a window";
    assert_eq!((code, line.as_str()), (1, expected));
    let wrong = without("02_basic").env("DISPLAY", ":98765").output().expect("it starts");
    let (code, line) = run::refusal(wrong);
    assert!(code == 1 && line.contains("':98765'") && line.contains("--headless"), "{line}");
    let (code, line) = run::refused("02_basic", &["--out", "a.png"]);
    assert!(code == 2 && line.contains("--headless"), "{line}");
}

/// Compares a program's window with its picture below `docs/images`, which `UPDATE=1 cargo test --test
/// window` makes.
fn is_shown(program: &str, name: &str) {
    let _alone = alone();
    let file = run::root().join("docs/images").join(name);
    if std::env::var_os("UPDATE").is_some_and(|value| value == "1") {
        let desk = Desk::open(program, &["--size", "1280x720"], &[]);
        // Back and forth, until the plot is full.
        for _ in 0..2 {
            desk.drag((800, 500), (1100, 540), 240);
            desk.drag((1100, 540), (800, 500), 240);
        }
        desk.key(KEY_HOME);
        desk.picture();
        desk.point(1100, 690);
        // The note about the written picture disappears, and the usual text returns.
        std::thread::sleep(std::time::Duration::from_secs(5));
        desk.shown().save(&file).expect("the picture can be written");
        desk.key(KEY_ESCAPE);
        ended_well(desk.end());
    }
    let shown = image::open(&file).unwrap_or_else(|error| {
        panic!("no {}: {error}; UPDATE=1 cargo test --test window writes it", file.display())
    });
    assert_eq!((shown.width(), shown.height()), (1280, 720));
}

#[test]
fn the_readme_shows_this_window() {
    is_shown("02_basic", "window.png");
}

#[test]
fn the_page_on_an_own_program_shows_this_window() {
    is_shown("my_tracer", "own-program_window.png");
}

#[test]
fn a_pipeline_that_cannot_be_made_leaves_the_old_one_in_its_place() {
    let _alone = alone();
    let copy = tempfile::tempdir().expect("a temporary folder");
    copy_shaders(copy.path(), &["common", "25_scene_effects"]);
    let broken = "#version 460\nnonsense\n";
    std::fs::write(copy.path().join("common/shadow.rmiss"), broken).expect("an edit");
    // It casts no shadow until the box is ticked.
    let scene = run::root().join("samples/assets/scenes/one_sphere.toml");
    let scene = scene.to_str().expect("a plain path");
    let arguments = ["--validate", "--size", "800x700", "--scene", scene];
    let desk = Desk::open("25_scene_effects", &arguments, &[("SHADERS", copy.path())]);
    let (before, _) = desk.picture();
    desk.drag(LIGHT_SHADOWS, LIGHT_SHADOWS, 4);
    for _ in 0..6 {
        assert!(same(&desk.picture().0, &before), "the old pipeline goes on");
    }
    desk.key(KEY_ESCAPE);
    ended_well(desk.end());
}

/// The narrowest device's environment, with additional faults.
fn narrow(faults: &str) -> (Layer, Vec<(&'static str, std::ffi::OsString)>) {
    let narrow = Layer::minimum_limits(faults);
    let environment = narrow.environment();
    (narrow, environment)
}

/// Opens a window on the narrowest device, draws and closes it.
fn opens_on(faults: &str) {
    let _alone = alone();
    let (_narrow, environment) = narrow(faults);
    let environment: Vec<_> =
        environment.iter().map(|(name, value)| (*name, Path::new(value))).collect();
    let desk = Desk::open("02_basic", &["--validate", "--size", "480x300"], &environment);
    let (first, _) = desk.picture();
    changed(&desk, &first, [(440, 150), (470, 250)]);
    desk.resize(400, 360);
    let sized = || Some(desk.picture().0).filter(|image| image.dimensions() == (400, 360));
    wait("a picture of the new size", sized);
    desk.close();
    ended_well(desk.end());
}

#[test]
fn a_window_opens_on_the_narrowest_device() {
    opens_on("");
}

#[test]
fn a_swapchain_that_is_out_of_date_before_it_is_made_is_made_at_the_next_event() {
    opens_on("out-of-date");
}

#[test]
fn a_device_that_cannot_draw_to_the_window_is_refused_when_devices_are_chosen() {
    let _alone = alone();
    let refusals = [
        ("compute-only", "lacks a queue that draws to this window"),
        ("without=dynamicRendering", "lacks feature dynamicRendering"),
        ("no-transfer-dst", "lacks copies to this window's images (TRANSFER_DST)"),
    ];
    for (faults, words) in refusals {
        let (_narrow, environment) = narrow(faults);
        let line = desk::refusal("02_basic", &["--validate"], &environment);
        assert!(line.contains("no device can run this: 0: narrow "), "{line}");
        assert!(line.contains(words), "{line}");
    }
}
