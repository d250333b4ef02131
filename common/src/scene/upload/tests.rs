//! Mistakes in a program's own scene: each is reported in one line.

use glam::{Affine3A, Mat3A, Vec2, Vec3A};

use super::*;
use crate::gpu::{BuildOptions, Geometry, GpuOptions, Requirements};
use crate::scene::{Camera, Instance, Material, Mesh, Vertex};

fn gpu() -> Gpu {
    let requirements = Requirements::ray_tracing().textures();
    Gpu::new(&GpuOptions { requirements, ..GpuOptions::default() }).unwrap()
}

fn shape(gpu: &Gpu, name: &str) -> AccelerationStructure {
    let boxes = boxes_on_gpu(gpu, name, &[[Vec3::NEG_ONE, Vec3::ONE]]).unwrap();
    let boxes = [Geometry::Aabbs { boxes: boxes.address, count: 1, opaque: true }];
    AccelerationStructure::bottom(gpu, name, &boxes, BuildOptions::default()).unwrap()
}

fn refusal<T>(result: Result<T>) -> String {
    format!("{:#}", result.err().expect("it is refused"))
}

#[test]
fn a_box_is_finite_and_its_corners_are_in_order() {
    let gpu = gpu();
    let said = |corners: [Vec3; 2]| {
        refusal(boxes_on_gpu(&gpu, "cone", &[[Vec3::NEG_ONE, Vec3::ONE], corners]))
    };
    assert_eq!(
        said([Vec3::new(0.0, f32::NAN, 0.0), Vec3::ONE]),
        "box 1 of 'cone' is not finite: its low corner is [0, NaN, 0], its high corner [1, 1, 1]"
    );
    assert!(said([Vec3::ZERO, Vec3::INFINITY]).starts_with("box 1 of 'cone' is not finite"));
    assert_eq!(
        said([Vec3::new(0.0, 2.0, 0.0), Vec3::ONE]),
        "box 1 of 'cone': its low corner is above its high one in y: [0, 2, 0], [1, 1, 1]"
    );
    // A box may be flat.
    boxes_on_gpu(&gpu, "wall", &[[Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0)]]).unwrap();
}

#[test]
fn an_instance_has_a_transform_that_can_be_inverted() {
    let gpu = gpu();
    let shape = shape(&gpu, "cone");
    let said = |transform: Affine3A| {
        let good = instance_on_gpu(&Affine3A::IDENTITY, 7, 0, &shape);
        refusal(build_top(&gpu, &[good, instance_on_gpu(&transform, 9, 0, &shape)]))
    };
    let wild = Affine3A::from_translation(Vec3::new(0.0, f32::NAN, 0.0));
    assert_eq!(
        said(wild),
        "instance 1 of the top level, with the custom index 9: its transform is not finite: [1, 0, 0], \
         [0, 1, 0], [0, 0, 1], [0, NaN, 0]"
    );
    let flat = "its transform has no inverse, it makes everything flat: [";
    assert!(said(Affine3A::from_scale(Vec3::ZERO)).contains(flat));
    assert!(said(Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0))).contains(flat));
    let doubled = Mat3A::from_cols(Vec3A::X, Vec3A::Y, Vec3A::X + Vec3A::Y);
    assert!(said(Affine3A { matrix3: doubled, translation: Vec3A::ZERO }).contains(flat));
    // Small is not flat: the determinant of this one vanishes in 64 bits.
    let small = Affine3A::from_scale(Vec3::splat(1e-36));
    build_top(&gpu, &[instance_on_gpu(&small, 0, 0, &shape)]).unwrap();
}

#[test]
fn a_top_level_keeps_its_bottom_levels_alive() {
    let gpu = gpu();
    let bytes = || gpu.statistics().acceleration_structure_bytes;
    let (cone, ball) = (shape(&gpu, "cone"), shape(&gpu, "ball"));
    let instances = [&cone, &ball].map(|of| instance_on_gpu(&Affine3A::IDENTITY, 0, 0, of));
    let (of_one, address) = (cone.size, cone.address);
    let top = build_top(&gpu, &instances).unwrap();
    let before = bytes();
    drop(cone);
    assert_eq!(bytes(), before);
    assert!(gpu.level_at(address).is_some());
    // Without an owner it is dropped, and an instance of it is refused.
    drop(top);
    assert!(of_one > 0);
    assert_eq!(bytes(), ball.size);
    let said = refusal(build_top(&gpu, &instances));
    assert!(
        said.starts_with(
            "instance 0 of the top level, with the custom index 0: its bottom level, at 0x"
        ) && said.ends_with(", was dropped before"),
        "{said}"
    );
}

fn triangle() -> Scene {
    let corner = |x, z| Vertex { position: Vec3::new(x, 0.0, z), normal: Vec3::Y, uv: Vec2::ZERO };
    let mesh = Mesh {
        name: "roof".to_owned(),
        vertices: vec![corner(0.0, 0.0), corner(0.0, 1.0), corner(1.0, 0.0)],
        triangles: vec![[0, 1, 2]],
        material: 0,
    };
    let model =
        Model { meshes: vec![mesh], materials: vec![Material::default()], ..Model::default() };
    let instance =
        Instance { mesh: 0, transform: Affine3A::IDENTITY, material: 0, record_offset: 0 };
    Scene { model, instances: vec![instance], camera: Camera::default() }
}

#[test]
fn an_index_of_a_scene_is_in_range() {
    let gpu = gpu();
    let on_gpu = |scene: &Scene| SceneOnGpu::new(&gpu, scene, SceneOptions::default());
    on_gpu(&triangle()).unwrap();
    for (edit, line) in [
        (
            (|scene| scene.model.meshes[0].triangles[0][1] = 100) as fn(&mut Scene),
            "mesh 'roof': triangle 0 has the vertex 100, and there are 3, counted from 0",
        ),
        (
            |scene| scene.model.meshes[0].vertices[2].position.x = f32::NAN,
            "mesh 'roof': vertex 2 is not finite: [NaN, 0, 0]",
        ),
        (
            |scene| scene.model.materials[0].base_texture = Some(4),
            "material 0 has the texture 4, and there are 0, counted from 0",
        ),
        (
            |scene| scene.instances[0].mesh = 1,
            "instance 0 has the mesh 1, and there are 1, counted from 0",
        ),
        (
            |scene| scene.instances[0].material = 99,
            "instance 0 has the material 99, and there are 1, counted from 0",
        ),
        (
            |scene| scene.instances[0].transform.translation.x = f32::INFINITY,
            "instance 0, of 'roof': its transform is not finite: [1, 0, 0], [0, 1, 0], [0, 0, 1], [inf, 0, 0]",
        ),
        (
            |scene| scene.instances[0].transform = Affine3A::from_scale(Vec3::ZERO),
            "instance 0, of 'roof': its transform has no inverse, it makes everything flat: [0, 0, 0], [0, 0, \
             0], [0, 0, 0]",
        ),
    ] {
        let mut scene = triangle();
        edit(&mut scene);
        // A camera may be placed by it before it is uploaded.
        scene.bounds();
        assert_eq!(refusal(on_gpu(&scene)), line);
    }
}

#[test]
fn what_a_scene_seldom_means_is_a_warning() {
    let gpu = gpu();
    let mut scene = triangle();
    let empty =
        Mesh { name: "gap".to_owned(), triangles: Vec::new(), ..scene.model.meshes[0].clone() };
    scene.model.meshes.push(empty);
    scene.model.meshes[0].material = 99;
    scene.model.meshes[0].vertices[1].normal = Vec3::ZERO;
    SceneOnGpu::new(&gpu, &scene, SceneOptions::default()).unwrap();
    let told = gpu.statistics().warnings.into_iter().map(|(_, line)| line);
    let told: Vec<_> = told.collect();
    assert_eq!(
        told,
        [
            "mesh 'roof': the normal of vertex 1 has no direction: [0, 0, 0]",
            "mesh 'roof' has the material 99, and there are 1, counted from 0; the material of its instances \
             counts",
            "mesh 'gap' has no triangles: there is nothing to see of it",
        ]
    );
}
