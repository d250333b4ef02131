//! `--set` in any order: a preset, a scene or a primitive sets further values, but never overrides an
//! explicit setting.

/// The values of all controls after these settings.
fn values(name: &str, sets: &[&str]) -> Vec<String> {
    let mut command = run::command(name);
    let output = command.arg("--list-controls").args(run::set_arguments(sets)).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{name}: {errors}");
    String::from_utf8_lossy(&output.stdout).lines().map(str::to_owned).collect()
}

/// Checks that every setting is in effect, whether the preset with further values comes first or last.
fn held(name: &str, sets: [&str; 3]) {
    let [a, b, c] = sets;
    let last = values(name, &[c, b, a]);
    for set in sets {
        let (control, value) = set.split_once('=').unwrap();
        let is_control = |line: &&String| line.split('\t').next() == Some(control);
        let line = last.iter().find(is_control).unwrap_or_else(|| panic!("{name}: no {control}"));
        assert_eq!(line.split('\t').next_back(), Some(value), "{name}: {line}");
    }
    assert_eq!(values(name, &sets), last, "{name} {sets:?}");
}

#[test]
fn the_order_of_settings_does_not_matter() {
    held("42_distant_spheres", ["scene=planet", "distance=50", "camera eye=1,2,3"]);
    held("09_instancing", ["geometry=copies", "squares=900", "camera eye=1,2,3"]);
    held("11_path_tracing", ["scene=furnace", "sky=black", "camera eye=1,2,3"]);
    held("12_infinite_plane", ["preset=pov", "plane distance=0.5", "camera eye=1,2,3"]);
    held("21_heightfield", ["preset=steep", "steepness=3", "sun azimuth=10"]);
    held("22_solids", ["preset=one solid", "fog distance=7", "sun elevation=40"]);
    held("25_scene_effects", ["scene=lake", "depth=2", "light size=0.25"]);
    held("27_glass", ["scene=drink", "sky=day", "camera eye=1,2,3"]);
    held("29_emitters", ["scene=ball", "sky=day", "camera eye=1,2,3"]);
    held("33_roots", ["scene=ring", "distance=5", "camera eye=1,2,3"]);
    held("45_rough_metal", ["scene=furnace", "sky=black", "camera eye=1,2,3"]);
    held("47_normal_maps", ["scene=plate", "sky=black", "camera eye=1,2,3"]);
}
