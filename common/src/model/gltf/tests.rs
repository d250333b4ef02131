//! glTF files written by hand: what is read, what is noted, what is refused.

use base64::Engine;
use glam::{Vec2, Vec3};

use super::container::MAGIC;
use super::load::load_within;
use crate::gpu::{Sampling, Wrap};
use crate::model::limits::Limits;
use crate::scene::{LightSource, PointLight, Scene};

/// The buffer of a file, with its views and accessors.
#[derive(Default)]
struct Data {
    bytes: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
}

impl Data {
    /// Adds an accessor to bytes of its own: `kind` has its type and component type, `more` other keys.
    fn add(&mut self, bytes: &[u8], count: usize, kind: (&str, u32), more: &str) -> usize {
        self.add_strided(bytes, count, kind, more, "")
    }

    fn add_strided(
        &mut self,
        bytes: &[u8],
        count: usize,
        (kind, component): (&str, u32),
        more: &str,
        stride: &str,
    ) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let (at, length) = (self.bytes.len(), bytes.len());
        self.views
            .push(format!(r#"{{"buffer":0,"byteOffset":{at},"byteLength":{length}{stride}}}"#));
        let view = self.views.len() - 1;
        self.accessors.push(format!(
            r#"{{"bufferView":{view},"count":{count},"type":"{kind}","componentType":{component}{more}}}"#
        ));
        self.bytes.extend(bytes);
        self.accessors.len() - 1
    }

    /// Adds an accessor of `N` floats in each element.
    fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let kind = ["", "SCALAR", "VEC2", "VEC3", "VEC4"].get(N).copied().unwrap_or("MAT4");
        let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|v| v.to_le_bytes()).collect();
        self.add(&bytes, values.len(), (kind, 5126), "")
    }

    fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.add(&bytes, values.len(), ("SCALAR", 5123), "")
    }

    /// The file, with other keys after those of the buffer.
    fn file(&self, more: &str) -> String {
        let data = base64::engine::general_purpose::STANDARD.encode(&self.bytes);
        let length = self.bytes.len();
        let (views, accessors) = (self.views.join(","), self.accessors.join(","));
        format!(
            r#"{{"asset":{{"version":"2.0"}},
"buffers":[{{"byteLength":{length},"uri":"data:;base64,{data}"}}],
"bufferViews":[{views}],
"accessors":[{accessors}],
{more}}}"#
        )
    }
}

/// One node with a mesh of one primitive.
fn one(primitive: &str) -> String {
    format!(
        r#""scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"meshes":[{{"name":"m","primitives":[{{{primitive}}}]}}]"#
    )
}

const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

fn load_bytes(bytes: &[u8], limits: &Limits) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.gltf");
    std::fs::write(&path, bytes).unwrap();
    let here = format!("{}/", folder.path().display());
    let scene = load_within(&path, limits);
    scene
        .map(|mut scene| {
            for line in &mut scene.model.warnings {
                *line = line.replace(&here, "");
            }
            scene
        })
        .map_err(|error| error.to_string().replace(&here, ""))
}

#[track_caller]
fn shown(text: &str) -> Scene {
    let scene = load_bytes(text.as_bytes(), &Limits::DEFAULT).unwrap();
    scene.check().unwrap();
    scene
}

#[track_caller]
fn refused(text: &str) -> String {
    load_bytes(text.as_bytes(), &Limits::DEFAULT).err().expect("it is refused")
}

/// The positions of the corners of a mesh's triangles.
fn places(scene: &Scene, mesh: usize) -> Vec<[Vec3; 3]> {
    let mesh = &scene.model.meshes[mesh];
    let at = |i: u32| mesh.vertices[i as usize].position;
    mesh.triangles.iter().map(|triangle| triangle.map(at)).collect()
}

#[test]
fn a_primitive_is_read_whatever_its_indices_are() {
    let want = [[0, 1, 2], [0, 2, 3]].map(|t: [usize; 3]| t.map(|i| Vec3::from(CORNERS[i])));
    let list: [u8; 6] = [0, 1, 2, 0, 2, 3];
    let wide = |size: usize| -> Vec<u8> {
        list.iter().flat_map(|&i| u32::from(i).to_le_bytes()[..size].to_vec()).collect()
    };
    for (size, component) in [(1, 5121), (2, 5123), (4, 5125)] {
        let mut data = Data::default();
        let at = data.floats(&CORNERS);
        let by = data.add(&wide(size), 6, ("SCALAR", component), "");
        let scene =
            shown(&data.file(&one(&format!(r#""attributes":{{"POSITION":{at}}},"indices":{by}"#))));
        assert_eq!(places(&scene, 0), want, "{component}");
        assert_eq!(scene.model.warnings, [] as [String; 0]);
        // Without normals, each triangle is flat.
        assert!(scene.model.meshes[0].vertices.iter().all(|vertex| vertex.normal == Vec3::Z));
        assert_eq!(scene.model.meshes[0].vertices.len(), 6);
    }
    let mut data = Data::default();
    let at = data.floats(&list.map(|i| CORNERS[i as usize]));
    let scene = shown(&data.file(&one(&format!(r#""attributes":{{"POSITION":{at}}}"#))));
    assert_eq!(places(&scene, 0), want);
}

#[test]
fn strips_and_fans_keep_their_front() {
    let mut data = Data::default();
    let at = data.floats(&[CORNERS[0], CORNERS[1], CORNERS[3], CORNERS[2]]);
    let fan = data.floats(&CORNERS);
    for (mode, at) in [(5, at), (6, fan)] {
        let scene =
            shown(&data.file(&one(&format!(r#""attributes":{{"POSITION":{at}}},"mode":{mode}"#))));
        let places = places(&scene, 0);
        assert_eq!(places.len(), 2, "{mode}");
        for [a, b, c] in places {
            assert_eq!((b - a).cross(c - a), Vec3::Z, "{mode}");
        }
    }
    for mode in [0, 1, 2, 3] {
        let said = refused(
            &data.file(&one(&format!(r#""attributes":{{"POSITION":{at}}},"mode":{mode}"#))),
        );
        assert!(said.starts_with("m.gltf: nothing to show: mesh \"m\" has "), "{said}");
    }
}

#[test]
fn accessors_may_be_whole_strided_normalised_or_sparse() {
    let places_of = |data: &Data, at: usize| {
        places(&shown(&data.file(&one(&format!(r#""attributes":{{"POSITION":{at}}}"#)))), 0)
    };
    let want = [[Vec3::ZERO, Vec3::X, Vec3::ONE]];
    let bytes = |one: i32, size: usize| -> Vec<u8> {
        let corners = [[0, 0, 0], [one, 0, 0], [one, one, one]];
        corners.iter().flatten().flat_map(|n: &i32| n.to_le_bytes()[..size].to_vec()).collect()
    };
    for (component, size, most) in
        [(5120, 1, 127), (5121, 1, 255), (5122, 2, 32767), (5123, 2, 65535)]
    {
        let mut data = Data::default();
        let normalised =
            data.add(&bytes(most, size), 3, ("VEC3", component), r#","normalized":true"#);
        let plain = data.add(&bytes(1, size), 3, ("VEC3", component), "");
        assert_eq!(places_of(&data, normalised), want, "{component}");
        assert_eq!(places_of(&data, plain), want, "{component}");
    }
    // Three floats every sixteen bytes.
    let mut data = Data::default();
    let corners = [Vec3::ZERO, Vec3::X, Vec3::ONE].map(|v| v.extend(9.0).to_array());
    let bytes: Vec<u8> = corners.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    let at = data.add_strided(&bytes[..44], 3, ("VEC3", 5126), "", r#","byteStride":16"#);
    assert_eq!(places_of(&data, at), want);
    // All zero, and two elements changed.
    let mut data = Data::default();
    let by = data.indices(&[1, 2]);
    let values = data.floats(&[[1.0, 0.0, 0.0], [1.0, 1.0, 1.0]]);
    data.accessors.push(format!(
        r#"{{"count":3,"type":"VEC3","componentType":5126,"sparse":{{"count":2,"indices":{{"bufferView":{by},"componentType":5123}},"values":{{"bufferView":{values}}}}}}}"#
    ));
    assert_eq!(places_of(&data, 2), want);
    data.accessors[2] = data.accessors[2].replace(r#""count":3"#, r#""count":2"#);
    let said = refused(&data.file(&one(r#""attributes":{"POSITION":2}"#)));
    assert!(said.ends_with("accessor 2 changes element 2, and has 2"), "{said}");
}

#[test]
fn nodes_place_meshes_by_matrix_or_by_parts() {
    let mut data = Data::default();
    let at = data.floats(&CORNERS);
    let rest = |nodes: &str| {
        data.file(&format!(
            r#""scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{at}}},"mode":6}}]}}]"#
        ))
    };
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let parts = shown(&rest(&format!(
        r#"{{"children":[1],"translation":[1,2,3]}},{{"mesh":0,"rotation":[0,{half},0,{half}],"scale":[2,-1,1]}}"#
    )));
    let matrix = shown(&rest(
        r#"{"children":[1],"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1]},{"mesh":0,"matrix":[0,0,-2,0,0,-1,0,0,1,0,0,0,0,0,0,1]}"#,
    ));
    let corner = Vec3::new(1.0, 1.0, 0.0);
    for scene in [&parts, &matrix] {
        assert_eq!(scene.instances.len(), 1);
        let moved = scene.instances[0].transform.transform_point3(corner);
        assert!(moved.distance(Vec3::new(1.0, 1.0, 1.0)) < 1e-6, "{moved}");
    }
    // A node in a cycle, one with two parents, one that is not there, one that is flat.
    let odd = shown(&rest(
        r#"{"children":[1,1,2,3,9],"mesh":0},{"children":[0]},{"mesh":0,"scale":[1,1,0]},{"mesh":0,"translation":[5,0,0]}"#,
    ));
    assert_eq!(odd.instances.len(), 2);
    let said = odd.model.warnings.join("\n");
    for part in
        ["node 0 twice in the tree", "node 9, and there are 4", "node 2 makes its mesh flat"]
    {
        assert!(said.contains(part), "{part}: {said}");
    }
    // Without a scene, what is nobody's child is the root.
    let text = rest(r#"{"mesh":0},{"children":[0],"translation":[7,0,0]}"#);
    let text = text.replace(r#""scenes":[{"nodes":[0]}],"#, "");
    assert_eq!(shown(&text).instances[0].transform.translation.x, 7.0);
}

#[test]
fn a_pose_moves_vertices() {
    let mut data = Data::default();
    let at = data.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let up = data.floats(&[[0.0, 0.0, 2.0]; 3]);
    let morph = format!(
        r#""scenes":[{{"nodes":[0,1]}}],"nodes":[{{"mesh":0}},{{"mesh":0,"weights":[1]}}],"meshes":[{{"weights":[0.5],"primitives":[{{"attributes":{{"POSITION":{at}}},"targets":[{{"POSITION":{up}}}]}}]}}]"#
    );
    let scene = shown(&data.file(&morph));
    assert_eq!(places(&scene, 0)[0][0].z, 1.0);
    assert_eq!(places(&scene, 1)[0][0].z, 2.0);
    assert!(scene.model.warnings[0].contains("has morph targets"), "{:?}", scene.model.warnings);
    // Two joints: one moves by x, the other turns about z; the second vertex has half of each.
    let joints = data.add(&[0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0], 3, ("VEC4", 5121), "");
    let weights = data.floats(&[[1.0, 0.0, 0.0, 0.0], [0.5, 0.5, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]);
    let skin = format!(
        r#""scenes":[{{"nodes":[0,1,2]}}],"nodes":[{{"mesh":0,"skin":0,"translation":[100,0,0]}},{{"translation":[3,0,0]}},{{"rotation":[0,0,1,0]}}],"skins":[{{"joints":[1,2]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{at},"JOINTS_0":{joints},"WEIGHTS_0":{weights}}}}}]}}]"#
    );
    let scene = shown(&data.file(&skin));
    let [a, b, c] = places(&scene, 0)[0];
    assert_eq!(scene.instances[0].transform, glam::Affine3A::IDENTITY);
    for (found, want) in [(a, [3.0, 0.0, 0.0]), (b, [1.5, 0.0, 0.0]), (c, [0.0, -1.0, 0.0])] {
        assert!(found.distance(Vec3::from(want)) < 1e-6, "{found} for {want:?}");
    }
}

/// A picture of one texel.
fn texel(rgba: [u8; 4]) -> String {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbaImage::from_pixel(1, 1, image::Rgba(rgba));
    image::DynamicImage::from(image).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    let data = base64::engine::general_purpose::STANDARD.encode(bytes.into_inner());
    format!("data:image/png;base64,{data}")
}

/// A quad in a material, with a texture, and two sets of texture coordinates.
fn quad(material: &str, rgba: [u8; 4]) -> String {
    let mut data = Data::default();
    let at = data.floats(&CORNERS);
    let first = data.floats(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    let second =
        data.add(&[0, 0, 255, 0, 255, 255, 0, 255], 4, ("VEC2", 5121), r#","normalized":true"#);
    let color = data.add(
        &[255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255],
        4,
        ("VEC4", 5121),
        r#","normalized":true"#,
    );
    let primitive = format!(
        r#""attributes":{{"POSITION":{at},"TEXCOORD_0":{first},"TEXCOORD_1":{second}COLOR}},"mode":6,"material":0"#
    );
    let primitive = primitive.replace(
        "COLOR",
        &if material.contains("tinted") { format!(r#","COLOR_0":{color}"#) } else { String::new() },
    );
    data.file(&format!(
        r#"{},"materials":[{{{material}}}],"textures":[{{"source":0,"sampler":0}}],"samplers":[{{"wrapS":33071,"wrapT":33648,"magFilter":9728}}],"images":[{{"uri":"{}"}}]"#,
        one(&primitive),
        texel(rgba)
    ))
}

#[test]
fn materials_become_todays() {
    let base = r#""pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,0.5],"metallicFactor":0,"baseColorTexture":{"index":0,"texCoord":1,"extensions":{"KHR_texture_transform":{"offset":[0.5,0],"scale":[2,3],"rotation":0}}}}"#;
    let scene = shown(&quad(&format!(r#""name":"a",{base}"#), [255, 0, 0, 99]));
    let material = &scene.model.materials[0];
    assert_eq!(material.base_color, Vec3::new(0.5, 0.25, 1.0));
    assert_eq!((material.base_texture, material.opacity_texture), (Some(0), None));
    assert_eq!((material.opacity, material.illumination), (1.0, 2));
    let sampling = Sampling { u: Wrap::Clamp, v: Wrap::Mirror, nearest: true };
    assert_eq!(scene.model.textures[0].sampling, sampling);
    assert!(scene.model.textures[0].srgb);
    assert_eq!(scene.model.meshes[0].vertices[1].uv, Vec2::new(2.5, 3.0));
    // A threshold of 0.3 with a factor of one half cuts where the texture has less than 0.6.
    for (alpha, is_solid) in [(150, false), (156, true)] {
        let text =
            quad(&format!(r#""alphaMode":"MASK","alphaCutoff":0.3,{base}"#), [9, 9, 9, alpha]);
        let scene = shown(&text);
        assert_eq!(scene.model.materials[0].opacity_texture, Some(0));
        assert_eq!(scene.model.textures[0].rgba[3] >= 128, is_solid);
    }
    let scene = shown(&quad(&format!(r#""alphaMode":"BLEND",{base}"#), [9, 9, 9, 255]));
    assert_eq!(scene.model.materials[0].opacity, 0.5);
    let tinted = shown(&quad(&format!(r#""name":"tinted",{base}"#), [9, 9, 9, 255]));
    assert_eq!(tinted.model.materials[0].base_color, Vec3::new(0.5, 0.0, 0.0));
    let metal = shown(&quad(
        r#""pbrMetallicRoughness":{"roughnessFactor":0,"baseColorFactor":[1,0.5,0,1]}"#,
        [0; 4],
    ));
    assert!(metal.model.materials[0].is_mirror());
    assert_eq!(metal.model.materials[0].specular, Vec3::new(1.0, 0.5, 0.0));
    let glass = r#""extensions":{"KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_ior":{"ior":1.3},"KHR_materials_volume":{"thicknessFactor":1,"attenuationColor":[0.25,1,1],"attenuationDistance":2}}"#;
    let glass = shown(&quad(glass, [0; 4]));
    let material = &glass.model.materials[0];
    assert_eq!((material.illumination, material.refraction), (7, 1.3));
    assert_eq!(material.transmission, Vec3::new(0.5, 1.0, 1.0));
    let lamp = r#""emissiveFactor":[1,0.5,0],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}}"#;
    assert_eq!(shown(&quad(lamp, [0; 4])).model.materials[0].emission, Vec3::new(4.0, 2.0, 0.0));
}

#[test]
fn lights_and_cameras_are_placed_by_nodes() {
    let mut data = Data::default();
    let at = data.floats(&CORNERS);
    let text = data.file(&format!(
        r#""extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"point","intensity":5,"color":[1,0.5,0]}},{{"type":"directional","intensity":2}}]}}}},
"scenes":[{{"nodes":[0,1,2,3]}}],"cameras":[{{"type":"perspective","perspective":{{"yfov":1.0,"znear":0.1}}}}],
"nodes":[{{"mesh":0}},{{"translation":[0,3,0],"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}},
{{"rotation":[-0.7071068,0,0,0.7071068],"extensions":{{"KHR_lights_punctual":{{"light":1}}}}}},{{"camera":0,"translation":[0.5,0.5,4]}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{at}}},"mode":6}}]}}]"#
    ));
    let scene = shown(&text);
    assert_eq!(scene.model.warnings, [] as [String; 0]);
    let lamp =
        PointLight { position: Vec3::new(0.0, 3.0, 0.0), intensity: Vec3::new(5.0, 2.5, 0.0) };
    assert_eq!(scene.model.lights[0], LightSource::Point(lamp));
    let LightSource::Directional { direction, radiance } = scene.model.lights[1] else { panic!() };
    assert!(direction.distance(Vec3::Y) < 1e-6 && radiance == Vec3::splat(2.0), "{direction}");
    assert_eq!(scene.camera.eye.z, 4.0);
    assert!((scene.camera.target.z - 0.0).abs() < 1e-6 && scene.camera.target.x == 0.5);
    assert!((scene.camera.fov_y - 1f64.to_degrees()).abs() < 1e-5);
    let bright = shown(&text.replace(r#""intensity":2"#, r#""intensity":100000"#));
    assert!(bright.model.warnings[0].contains("1.000e5 lux"), "{:?}", bright.model.warnings);
    let LightSource::Directional { radiance, .. } = bright.model.lights[1] else { panic!() };
    assert!((radiance.x - 2.6).abs() < 1e-5);
}

#[test]
fn a_model_far_from_the_origin_is_moved() {
    let mut data = Data::default();
    let at = data.floats(&CORNERS);
    let scene = shown(&data.file(&format!(
        r#""scenes":[{{"nodes":[0]}}],"nodes":[{{"translation":[1000000,0,0],"children":[1,2]}},{{"mesh":0,"translation":[0.125,0,0]}},{{"mesh":0,"translation":[-0.125,0,2]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{at}}},"mode":6}}]}}]"#
    )));
    let said = &scene.model.warnings[0];
    assert!(said.contains("it was moved by (-1000001, -1, -1) in 64 bits"), "{said}");
    assert_eq!(scene.instances[0].transform.translation.x, -0.875);
}

/// A GLB file of a JSON part and a buffer.
fn glb(json: &str, bytes: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = (12 + 8 + json.len() + 8 + bytes.len()) as u32;
    let number = |n: u32| n.to_le_bytes().to_vec();
    let parts = [
        MAGIC.to_vec(),
        number(2),
        number(length),
        number(json.len() as u32),
        b"JSON".to_vec(),
        json,
        number(bytes.len() as u32),
        b"BIN\0".to_vec(),
        bytes.to_vec(),
    ];
    parts.concat()
}

#[test]
fn a_binary_file_is_the_same_as_its_text() {
    let mut data = Data::default();
    let at = data.floats(&CORNERS);
    let text = data.file(&one(&format!(r#""attributes":{{"POSITION":{at}}},"mode":6"#)));
    let (start, end) =
        (text.find(r#","uri""#).unwrap(), text.find("\"}],\n\"bufferViews").unwrap());
    let json = format!("{}{}", &text[..start], &text[end + 1..]);
    let binary = glb(&json, &data.bytes);
    let loaded = load_bytes(&binary, &Limits::DEFAULT).unwrap();
    assert_eq!(loaded.model, shown(&text).model);
    let cut = load_bytes(&binary[..binary.len() - 1], &Limits::DEFAULT).err().unwrap();
    assert!(cut.starts_with("m.gltf: is cut off: it has "), "{cut}");
    let old = [&binary[..4], &1u32.to_le_bytes(), &binary[8..]].concat();
    let old = load_bytes(&old, &Limits::DEFAULT).err().unwrap();
    assert_eq!(old, "m.gltf: is glTF 1, and glTF 2 is read; export it again as glTF 2.0");
}

#[test]
fn what_gltf_allows_and_the_parser_does_not_is_read() {
    let mut data = Data::default();
    let at = data.floats(&CORNERS);
    let text = data.file(&one(&format!(r#""attributes":{{"POSITION":{at}}},"mode":6"#)));
    let odd = text.replacen(
        r#""scenes":[{"nodes":[0]}]"#,
        r#""scenes":[{"nodes":[0]},{"name":"empty"}],"animations":[{"channels":[{"sampler":0,"target":{"path":"pointer"}}],"samplers":[]}]"#,
        1,
    );
    let scene = shown(&odd);
    assert_eq!(scene.model.meshes, shown(&text).model.meshes);
    assert_eq!(scene.model.warnings.len(), 2, "{:?}", scene.model.warnings);
    let transposed = text.replacen(
        r#"{"mesh":0}"#,
        r#"{"mesh":0,"matrix":[1,0,0,5,0,1,0,6,0,0,1,7,0,0,0,1]}"#,
        1,
    );
    let scene = shown(&transposed);
    assert!(scene.model.warnings[0].contains("the matrix of node 0 is transposed"));
    assert_eq!(scene.instances[0].transform.translation, glam::Vec3A::new(5.0, 6.0, 7.0));
    let old = refused(r#"{"asset":{"version":"1.0"},"nodes":{}}"#);
    assert_eq!(old, "m.gltf: is glTF 1.0, and glTF 2 is read; export it again as glTF 2.0");
}

#[test]
fn what_cannot_be_read_is_refused_in_one_line() {
    let mut data = Data::default();
    let at = data.floats(&CORNERS);
    let good = data.file(&one(&format!(r#""attributes":{{"POSITION":{at}}},"mode":6"#)));
    shown(&good);
    let changed = |from: &str, to: &str| {
        assert!(good.contains(from), "{from}");
        refused(&good.replacen(from, to, 1))
    };
    for (from, to, message) in [
        ("{", "", "m.gltf: line 1: "),
        (
            "\"buffers\"",
            "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"buffers\"",
            "m.gltf: requires the extension \"KHR_draco_mesh_compression\", which is not read: its geometry is compressed; export it without compression",
        ),
        ("2.0", "1.0", "m.gltf: is glTF 1.0, and glTF 2 is read; export it again as glTF 2.0"),
        (
            "\"count\":4",
            "\"count\":-4",
            "m.gltf: line 4: a value of another type than glTF 2 has here",
        ),
        ("\"count\":4,", "", "m.gltf: line 4: the key \"count\" is missing here"),
        (
            "\"count\":4",
            "\"count\":5",
            "m.gltf: nothing to show: a part of mesh \"m\" is left out: accessor 0: reaches beyond the 48 bytes of buffer view 0",
        ),
        ("\"count\":4", "\"count\":400000000", "m.gltf: would take up to"),
        (
            "VEC3",
            "VEC2",
            "m.gltf: nothing to show: a part of mesh \"m\" is left out: accessor 0 has 2 numbers in each element, where there are 3",
        ),
        (
            "\"POSITION\":0",
            "\"POSITION\":7",
            "m.gltf: nothing to show: a part of mesh \"m\" is left out: accessor 7 is not there; there are 1, counted from 0",
        ),
        (
            "data:;base64,",
            "data:;base64,*",
            "m.gltf: nothing to show: a part of mesh \"m\" is left out: accessor 0: buffer 0 is a data URI that is not base64",
        ),
        (
            "\"byteLength\":48}]",
            "\"byteLength\":49}]",
            "m.gltf: nothing to show: a part of mesh \"m\" is left out: accessor 0: buffer view 0 reaches beyond the 48 bytes of buffer 0",
        ),
        (
            "\"nodes\":[0]",
            "\"nodes\":[]",
            "m.gltf: has no nodes in its scene, and so nothing to show",
        ),
        (
            "{\"mesh\":0}",
            "{\"mesh\":3}",
            "m.gltf: nothing to show: node 0 names mesh 3, which is not there",
        ),
        ("{\"mesh\":0}", "{\"mesh\":0,\"scale\":[1e30,1e30,1e30]}", "m.gltf: reaches "),
    ] {
        let said = changed(from, to);
        assert!(said.starts_with(message) && !said.contains('\n'), "{from} to {to}: {said}");
    }
    let gone = refused(&good.replacen("data:;base64,", "../x/", 1));
    assert!(gone.contains("outside the glTF file's folder"), "{gone}");
    // Objects are counted before they are parsed.
    let many =
        format!(r#"{{"asset":{{"version":"2.0"}},"nodes":[{}{{}}]}}"#, "{},".repeat(5_000_000));
    let said = refused(&many);
    assert!(said.starts_with("m.gltf: would take up to ") && said.contains("objects"), "{said}");
}

#[test]
fn the_chess_set_is_the_same_as_its_obj_file() {
    let assets = crate::scene::assets();
    let gltf = Scene::open(&assets.join("chess.gltf")).unwrap();
    let obj = Scene::chess().unwrap();
    assert_eq!(gltf.model.warnings.len(), 1, "{:?}", gltf.model.warnings);
    assert!(gltf.model.warnings[0].contains("both are approximated by a matte surface"));
    assert_eq!(gltf.instances.len(), obj.instances.len());
    let positions = |scene: &Scene, mesh: usize| -> Vec<[Vec3; 3]> { places(scene, mesh) };
    for instance in &obj.instances {
        let want = positions(&obj, instance.mesh);
        let apart = |(a, b): (&[Vec3; 3], &[Vec3; 3])| {
            (0..3).map(|i| a[i].distance(b[i])).fold(0.0, f32::max)
        };
        let twin = gltf.instances.iter().find(|other| {
            let found = positions(&gltf, other.mesh);
            other.transform.abs_diff_eq(instance.transform, 1e-6)
                && found.len() == want.len()
                && found.iter().zip(&want).map(apart).fold(0.0, f32::max) < 1e-6
        });
        let twin = twin.unwrap_or_else(|| panic!("{}", obj.model.meshes[instance.mesh].name));
        let (a, b) = (&gltf.model.meshes[twin.mesh], &obj.model.meshes[instance.mesh]);
        let uv = |mesh: &crate::scene::Mesh| mesh.vertices[mesh.triangles[0][0] as usize].uv;
        assert!(uv(a).distance(uv(b)) < 1e-6, "{}", b.name);
    }
    let holes = |scene: &Scene| {
        let with = scene.model.materials.iter().filter(|material| material.has_cutout());
        with.count()
    };
    assert_eq!((holes(&gltf), holes(&obj)), (1, 1));
    assert_eq!(gltf.model.textures[0].rgba, obj.model.textures[0].rgba);
    assert!(gltf.camera.eye.distance(obj.camera.eye) < 1e-6);
    assert_eq!(gltf.model.lights.len(), 2);
}
