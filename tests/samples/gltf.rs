//! Models in glTF, rendered: samplers and mirrored nodes match the file, and the chess set equals that of its
//! OBJ file.

use std::fs;
use std::path::Path;

use common::app::Picture;

use run::Chapter;

const NAME: &str = "02_basic";

/// A picture of three texels in a row: red, green, blue.
fn texels(folder: &Path) {
    let colors = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255]];
    let image = image::RgbaImage::from_fn(3, 1, |x, _| image::Rgba(colors[x as usize]));
    image.save(folder.join("t.png")).expect("a picture can be written");
}

/// Two quads side by side, with these texture coordinates along u: left of the first, right of it, left of
/// the second, right of it. `sampler` is that of their texture, `node` contains keys of their node.
fn quads(u: [f32; 4], sampler: &str, node: &str, settings: &[&str]) -> Picture {
    let folder = tempfile::tempdir().expect("a temporary folder");
    texels(folder.path());
    let corners: Vec<[f32; 3]> =
        [-1.0, 0.0, 0.0, 1.0].iter().flat_map(|&x| [[x, 0.0, 0.0], [x, 1.0, 0.0]]).collect();
    let uvs: Vec<[f32; 2]> = u.iter().flat_map(|&u| [[u, 0.5], [u, 0.5]]).collect();
    let indices: [u16; 12] = [0, 2, 3, 0, 3, 1, 4, 6, 7, 4, 7, 5];
    let mut bytes: Vec<u8> = corners.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
    bytes.extend(uvs.as_flattened().iter().flat_map(|v| v.to_le_bytes()));
    bytes.extend(indices.iter().flat_map(|i| i.to_le_bytes()));
    fs::write(folder.path().join("b.bin"), &bytes).expect("a file can be written");
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{node}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":1}},"indices":2,"material":0}}]}}],
"materials":[{{"pbrMetallicRoughness":{{"metallicFactor":0,"baseColorTexture":{{"index":0}}}}}}],
"textures":[{{"source":0,"sampler":0}}],"samplers":[{{{sampler}}}],"images":[{{"uri":"t.png"}}],
"buffers":[{{"uri":"b.bin","byteLength":{}}}],
"bufferViews":[{{"buffer":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":64}},{{"buffer":0,"byteOffset":160,"byteLength":24}}],
"accessors":[{{"bufferView":0,"count":8,"type":"VEC3","componentType":5126}},{{"bufferView":1,"count":8,"type":"VEC2","componentType":5126}},{{"bufferView":2,"count":12,"type":"SCALAR","componentType":5123}}]}}"#,
        bytes.len()
    );
    let file = folder.path().join("m.gltf");
    fs::write(&file, text).expect("a file can be written");
    let sets = ["camera eye=0.013,0.5,3", "camera target=0.013,0.5,0"];
    let sets: Vec<_> = sets.iter().chain(settings).collect();
    Chapter::new(NAME).size("61x31").scene(file).sets(&sets).picture()
}

/// The number of pixels in which two pictures differ.
fn apart(one: &Picture, other: &Picture) -> usize {
    let (one, other) = (&one.pixels, &other.pixels);
    one.iter().zip(other).filter(|(one, other)| one != other).count()
}

#[test]
fn a_sampler_continues_a_texture_beyond_its_edge() {
    let nearest = |wrap: u32| format!(r#""magFilter":9728,"minFilter":9728,"wrapS":{wrap}"#);
    let go_on = [0.0, 1.0, 1.0, 2.0];
    let shown = |u, wrap| quads(u, &nearest(wrap), "", &[]);
    // Repeated, the second quad starts again; mirrored, it goes back; clamped, it continues the last texel.
    for (wrap, same) in [
        (10497, [0.0, 1.0, 0.0, 1.0]),
        (33648, [0.0, 1.0, 1.0, 0.0]),
        (33071, [0.0, 1.0, 0.9, 0.9]),
    ] {
        assert_eq!(apart(&shown(go_on, wrap), &shown(same, 10497)), 0, "{wrap}");
    }
    let (mirrored, clamped) = (shown(go_on, 33648), shown(go_on, 33071));
    assert!(apart(&mirrored, &clamped) > 50, "the samplers are not told apart");
    // Texels are interpolated, unless the file says otherwise.
    let blended = quads(go_on, r#""wrapS":33648"#, "", &[]);
    assert!(apart(&mirrored, &blended) > 50);
}

#[test]
fn a_mirrored_node_is_lit_as_its_mirror_image() {
    // A model that is its own mirror image, except for its texture coordinates.
    let plain = quads([0.0, 1.0, 1.0, 0.0], r#""magFilter":9728"#, "", &[]);
    let mirrored = quads([0.0, 1.0, 1.0, 0.0], r#""magFilter":9728"#, r#","scale":[-1,1,1]"#, &[]);
    assert_eq!(apart(&plain, &mirrored), 0);
    let turned = quads([0.0, 1.0, 0.0, 1.0], r#""magFilter":9728"#, r#","scale":[-1,1,1]"#, &[]);
    assert!(apart(&plain, &turned) > 50);
}
