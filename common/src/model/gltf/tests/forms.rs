//! The forms of a file, and what is refused.

use super::super::container::MAGIC;
use super::{CORNERS, Data, load_bytes, one, refused, shown};
use crate::model::limits::Limits;

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
            "m.gltf: line 4: the key \"count\" has a value of another type than in glTF 2",
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
fn what_a_small_file_states_does_not_take_memory_or_time() {
    let mut data = Data::default();
    let at = data.floats(&CORNERS);
    // Zeros without end, as normals, colours, joints and targets.
    data.accessors.push(r#"{"count":99999999999,"type":"VEC3","componentType":5126}"#.to_owned());
    let scene = shown(&data.file(&one(&format!(
        r#""attributes":{{"POSITION":{at},"NORMAL":1,"COLOR_0":1}},"mode":6"#
    ))));
    let said = scene.model.warnings.join(" ");
    assert!(said.contains("NORMAL is left out: accessor 1 has 99999999999 elements"), "{said}");
    let target =
        format!(r#""attributes":{{"POSITION":{at}}},"mode":6,"targets":[{{"POSITION":1}}]"#);
    let text = data.file(&one(&target)).replacen(r#"{"mesh":0}"#, r#"{"mesh":0,"weights":[1]}"#, 1);
    let said = refused(&text);
    assert!(said.ends_with("accessor 1 has 99999999999 elements, where there are 4"), "{said}");
    // Elements that overlap, so that few bytes are many.
    let mut data = Data::default();
    let at = data.add_strided(&[0; 4096], 4000, ("VEC3", 5126), "", r#","byteStride":1"#);
    let said = refused(&data.file(&one(&format!(r#""attributes":{{"POSITION":{at}}}"#))));
    assert!(said.ends_with("buffer view 0 has the stride 1, and an element 12 bytes"), "{said}");
    // A skin of many joints at many nodes.
    let mut data = Data::default();
    let at = data.floats(&CORNERS);
    let count = 10_000;
    let numbers = |value: &str| vec![value; count].join(",");
    let text = data.file(&format!(
        r#""nodes":[{}],"skins":[{{"joints":[{}]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{at}}}}}]}}]"#,
        numbers(r#"{"mesh":0,"skin":0}"#),
        numbers("0")
    ));
    assert!(refused(&text).contains("would take up to 25.6 GB"), "{}", refused(&text));
    // A list of numbers that are not needed.
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"accessors":[{{"min":[{}0]}}]}}"#,
        "0,".repeat(70_000_000)
    );
    assert!(refused(&text).contains("of memory for the"));
}
