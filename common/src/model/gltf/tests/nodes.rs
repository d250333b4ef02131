//! Objects placed by nodes: meshes, poses, lights, cameras.

use glam::Vec3;

use super::{CORNERS, Data, places, shown};
use crate::scene::{LightSource, PointLight, Scene};

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

#[test]
fn the_chess_set_is_the_same_as_its_obj_file() {
    let assets = crate::scene::assets();
    let gltf = Scene::open(&assets.join("chess.gltf")).unwrap();
    let obj = Scene::chess().unwrap();
    assert!(gltf.model.warnings.is_empty(), "{:?}", gltf.model.warnings);
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
    let picture = |scene: &Scene| {
        let material = scene.model.materials.iter().find(|material| material.has_cutout());
        let texture = material.and_then(|material| material.base_texture).unwrap();
        scene.model.textures[texture].rgba.clone()
    };
    assert!(picture(&gltf) == picture(&obj), "the pictures of the screens differ");
    let squares = ["board_light", "board_dark"];
    for material in &gltf.model.materials {
        let has_map = material.normal_texture.is_some_and(|map| !gltf.model.textures[map].srgb);
        assert_eq!(has_map, squares.contains(&&*material.name), "{}", material.name);
    }
    assert!(gltf.camera.eye.distance(obj.camera.eye) < 1e-6);
    assert_eq!(gltf.model.lights.len(), 2);
}
