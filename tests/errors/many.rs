//! A model of many small parts costs no more calls of Vulkan than one of few: no time, no memory and no limit
//! of a device goes with their number.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use run::layer::Layer;

/// A model of triangles side by side, each a mesh with a material and a texture of its own.
fn model(folder: &Path, count: usize) {
    let (mut obj, mut mtl) = (String::from("mtllib model.mtl\nvt 0 0\n"), String::new());
    let image = image::RgbaImage::from_pixel(2, 2, image::Rgba([200, 150, 100, 255]));
    for i in 0..count {
        image.save(folder.join(format!("{i}.png"))).unwrap();
        writeln!(mtl, "newmtl m{i}\nmap_Kd {i}.png").unwrap();
        writeln!(obj, "v {i} 0 0\nv {i}.5 0 0\nv {i} 1 0\nusemtl m{i}\nf -3/1 -2/1 -1/1").unwrap();
    }
    fs::write(folder.join("model.obj"), obj).unwrap();
    fs::write(folder.join("model.mtl"), mtl).unwrap();
}

/// How often each function was called to show a model of so many meshes and textures.
fn calls(count: usize) -> BTreeMap<String, usize> {
    let folder = tempfile::tempdir().unwrap();
    model(folder.path(), count);
    let told = folder.path().join("calls");
    let layer = Layer::failing("");
    let mut command = layer.command("02_basic");
    command.args(["--headless", "--size", "8x8", "--scene"]).arg(folder.path().join("model.obj"));
    let output = command.env("CALLS", &told).output().expect("the sample starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Layer::calls(&told)
}

#[test]
fn many_meshes_and_textures_take_as_many_buffers_and_submissions_as_few() {
    let (few, many) = (calls(2), calls(1000));
    for function in ["vkCreateBuffer", "vkAllocateMemory", "vkQueueSubmit2", "vkCreateQueryPool"] {
        let (few, many) = (few[function], many[function]);
        // How many bands a picture has depends on the time.
        assert!(many <= few + 8, "{function}: {few} calls for 2 meshes, {many} for 1,000");
    }
    // The layer does count what goes with their number.
    assert!(many["vkCreateImage"] >= 1000, "{many:?}");
}
