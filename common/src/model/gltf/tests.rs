//! glTF files written by hand, and their primitives.

mod forms;
mod materials;
mod nodes;

use base64::Engine;
use glam::Vec3;

use super::load::load_within;
use crate::model::limits::Limits;
use crate::scene::Scene;

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
