//! Lighting the point where shadow rays start would give the two pipelines different pictures.

use reference::random::Random;
use serde_json::json;

use super::{NAME, differing, generated};
use run::{command, expected, render_by, shaders_with};

/// The start of `lit_by`, and the point that a pipeline without shadows does not compute.
const LIT: &str = "    vec3 to_light = normalize(towards_light(light, hit.position));\n";
const LIFTED: &str = "#ifdef DEPARTURES\n    hit.position += hit.offset * hit.face;\n#endif\n";

#[test]
#[ignore = "by hand: takes figures of the page"]
fn lighting_the_start_of_a_shadow_ray_changes_bits() {
    let shaders = shaders_with("25_scene_effects/lighting.glsl", LIT, &format!("{LIFTED}{LIT}"));
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random(16);
    for (number, set) in generated::all_pairs().into_iter().enumerate() {
        let file = generated::write(folder.path(), &number.to_string(), set, &mut random);
        let [own, everything] = ["specialised", "everything"].map(|pipeline| {
            let pipeline = format!("pipeline={pipeline}");
            let arguments = ["--scene", file.to_str().unwrap(), "--set", &pipeline];
            let mut sample = command(NAME);
            render_by(sample.env("SHADERS", shaders.path()), "64x40", &arguments).picture
        });
        let (differ, largest) = differing(&own, &everything);
        println!("{number}: {} pixels differ, by {largest:e} at most", differ.len());
        // The test of all sixteen scenes would also stop here.
        if !differ.is_empty() {
            let (pixels, all) = (differ.len(), own.pixels.len());
            let found = json!({ "pixels": pixels, "all": all, "largest": largest });
            return expected::hold("25_scene_effects/lifted", found);
        }
    }
    panic!("no scene of the sixteen shows it");
}
