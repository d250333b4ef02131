//! The view of time, and threads that change places: what they need of a device and of a scene.

use serde_json::Value;

use crate::NAME;

/// The report of a run on a small picture.
fn report(scene: &str, settings: &[&str]) -> Value {
    let scene = format!("scene={scene}");
    let settings = [scene.as_str()].into_iter().chain(settings.iter().copied());
    let mut command = run::command(NAME);
    command.args(["--headless", "--validate", "--size", "24x15", "--report", "-"]);
    command.args(settings.flat_map(|setting| ["--set", setting]));
    let output = command.output().expect("it starts");
    let err = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && err.is_empty(), "{err}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// A pixel with 16 rays takes longer than one with one ray.
#[test]
fn pixels_with_more_rays_take_more_time() {
    let median = |samples: &str| {
        let ticks = report("lake", &["show=time", samples])["chapter"]["ticks"].clone();
        let at = |part: &str| ticks[part].as_u64().unwrap_or_else(|| panic!("{ticks}"));
        assert!(at("least") <= at("median") && at("median") <= at("p99"), "{ticks}");
        at("median")
    };
    let [few, many] = ["samples=1", "samples=16"].map(median);
    assert!(few > 0 && many > 4 * few, "{few} {many}");
    assert!(report("lake", &[])["chapter"]["ticks"].is_null());
}

#[test]
fn times_are_not_written_to_a_picture() {
    for arguments in [&["--out", "x.png"][..], &["--animate", "--out", "x.png"]] {
        let mut command = run::command(NAME);
        command.args(["--headless", "--set", "show=time"]).args(arguments);
        let (code, line) = run::refusal(command.output().expect("it starts"));
        assert!(code == 2 && line.contains("show=time differs from run to run"), "{line}");
    }
}

/// Threads change places only where rays that surfaces send on meet several kinds of surface, and where the device
/// lets them.
#[test]
fn a_divergent_scene_has_a_reason() {
    for (scene, divergent, why) in [
        ("one sphere", false, "no surface sends a ray on"),
        ("mirror balls", false, "bounced rays meet one kind of surface"),
        ("crystal", true, "bounced rays meet meshes, spheres"),
    ] {
        let found = report(scene, &[])["chapter"]["reordering"].clone();
        assert_eq!(
            (&found["divergent"], &found["why"]),
            (&divergent.into(), &why.into()),
            "{scene}"
        );
        assert_eq!(found["in"], divergent && found["offered"] == true, "{found}");
    }
}
