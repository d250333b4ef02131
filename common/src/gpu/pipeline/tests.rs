//! Mistakes in a program's own pipeline: each is reported in one line.

use super::*;
use crate::gpu::{GpuOptions, Requirements, TextureTable};
use crate::scene::{CameraBasis, DirectionalLight, SceneAddresses};

common::shader_struct! {
    /// The push constants of 02, whose shaders are used here.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
    }
}

fn gpu(requirements: Requirements) -> Gpu {
    Gpu::new(&GpuOptions { requirements, ..GpuOptions::default() }).unwrap()
}

/// The bindings of 02.
fn bound<'a>(builder: PipelineBuilder<'a>, textures: &'a TextureTable) -> PipelineBuilder<'a> {
    let builder = builder.binding(Binding::AccelerationStructure).binding(Binding::StorageImage);
    builder.textures(textures).push_constants::<Push>()
}

fn refusal<T>(result: Result<T>) -> String {
    format!("{:#}", result.err().expect("it is refused"))
}

#[test]
fn each_line_of_a_pipeline_names_a_shader_of_its_kind() {
    let gpu = gpu(Requirements::ray_tracing().textures());
    let textures = TextureTable::new(&gpu, &[], false).unwrap();
    let build = |builder| bound(builder, &textures).build(&gpu);
    let pipeline = || RayTracingPipeline::builder("02_basic");
    let said = refusal(build(pipeline().miss("sky.rmiss")));
    assert!(said.starts_with("pipeline '02_basic' has no ray generation shader"), "{said}");
    let said = refusal(build(pipeline().raygen("sky.rmiss")));
    let line = "02_basic/sky.rmiss: the line .raygen names it; a shader of that kind ends in .rgen";
    assert_eq!(said, line);
    let swapped = pipeline().raygen("camera.rgen").miss("shade.rchit");
    let said = refusal(build(swapped));
    assert!(
        said.ends_with("the line .miss names it; a shader of that kind ends in .rmiss"),
        "{said}"
    );
    // A hit group without shaders is in order for shadow rays, and seldom meant.
    let empty = pipeline().raygen("camera.rgen").miss("sky.rmiss").hit(HitGroup::triangles());
    build(empty).unwrap();
    let told: Vec<_> = gpu.statistics().warnings.into_iter().map(|(_, line)| line).collect();
    let line = "hit group 0 of '02_basic' has neither a closest hit nor an any-hit shader: a ray that hits leaves \
                its payload as it was";
    assert_eq!(told, [line]);
}

#[test]
fn textures_are_asked_for() {
    let all = gpu(Requirements::ray_tracing().textures());
    let textures = TextureTable::new(&all, &[], false).unwrap();
    let few = gpu(Requirements::ray_tracing());
    let builder = RayTracingPipeline::builder("02_basic").raygen("camera.rgen").miss("sky.rmiss");
    let said = refusal(bound(builder, &textures).build(&few));
    assert!(said.ends_with("requirements() takes .textures()"), "{said}");
}

#[test]
fn an_address_in_the_push_constants_is_that_of_a_buffer() {
    let gpu = gpu(Requirements::ray_tracing().textures());
    let textures = TextureTable::new(&gpu, &[], false).unwrap();
    let builder = RayTracingPipeline::builder("02_basic").raygen("camera.rgen").miss("sky.rmiss");
    let pipeline = bound(builder, &textures).build(&gpu).unwrap();
    let image = Image::storage(&gpu, "picture", vk::Extent2D { width: 1, height: 1 }).unwrap();
    let tlas = crate::scene::build_top(&gpu, &[]).unwrap();
    let buffer = Buffer::with_data(&gpu, "mine", &[1u32], Buffer::ADDRESSED).unwrap();
    let mut push: Push = bytemuck::Zeroable::zeroed();
    push.scene.materials = buffer.address.into();
    let bind = |push: &Push| {
        let tlas = Descriptor::AccelerationStructure(&tlas);
        let descriptors = [tlas, Descriptor::StorageImage(&image)];
        gpu.submit(|cmd| pipeline.bind(cmd, &descriptors, push))
    };
    // 0 means no address.
    bind(&push).unwrap();
    let address = buffer.address;
    drop(buffer);
    assert_eq!(
        refusal(bind(&push)),
        format!(
            "pipeline '02_basic': no buffer lies at {address:#x}, the address in Push.scene; was it dropped? It must \
             live as long as it is read"
        )
    );
}
