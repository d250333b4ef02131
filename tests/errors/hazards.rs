//! Synchronization validation is enabled for every version of the layer, which differ in how it is requested.

use run::layer::Layer;

/// 01 creates its own instance, and 02 creates the one shared by all others.
#[test]
fn a_copy_made_twice_with_nothing_between_is_a_hazard() {
    let layer = Layer::fail_nth_call("vkCmdCopyImageToBuffer");
    for name in ["01_foundation", super::SAMPLE] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut command = layer.command(name);
        command.args(["--headless", "--validate", "--size", "8x8", "--out"]);
        let output =
            command.arg(folder.path().join("out.png")).output().expect("the sample starts");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{name}: {errors}");
        assert!(errors.contains("WRITE_AFTER_WRITE"), "{name}: {errors}");
    }
}
