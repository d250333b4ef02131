//! 01 · Foundation: one ray-traced triangle, every Vulkan call in this one file.
//!
//! Read it from top to bottom: instance, device, acceleration structures, image, pipeline, shader
//! binding table, trace, picture. `common` gives arguments, shader compiler and picture, `instruments` the
//! report, and neither any Vulkan. From 02_basic on, `common::gpu` does what stands here in full.

use std::ffi::{CStr, c_void};
use std::io::Write;
use std::process::ExitCode;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use anyhow::{Context, Result, anyhow, bail, ensure};
use ash::{Device, Entry, Instance, ext, khr, vk};
use common::UsageError;
use common::app::{Args, Picture};
use common::exit::finish;
use common::gpu::ensure_threads;
use common::gpu::shader::compile;
use common::output::{complain, print};
use instruments::{Milliseconds, Report, check_files};
use vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};

const NAME: &str = env!("CARGO_BIN_NAME");

// ANCHOR: scene
/// The corners of the triangle in its own space, counter-clockwise from the front.
const TRIANGLE: [[f32; 3]; 3] = [[-1.1, -0.75, 0.0], [1.1, -0.75, 0.0], [0.0, 0.9, 0.0]];

/// Its place in the world, three rows of four: a turn about the y axis (0.8² + 0.6² = 1), and in
/// the last column a small shift.
const PLACE: [f32; 12] = [
    0.8, 0.0, 0.6, 0.12, //
    0.0, 1.0, 0.0, 0.05, //
    -0.6, 0.0, 0.8, 0.0,
];
// ANCHOR_END: scene

/// Four 32-bit floats a pixel, linear; every Vulkan device can store to it.
const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Nanoseconds that the device may take for what is submitted: ten minutes.
const PATIENCE: u64 = 600 * 1_000_000_000;

fn main() -> ExitCode {
    finish(run)
}

/// Every layer makes its object, hands it on, and destroys it however the rest ended.
fn run() -> Result<()> {
    let start = Instant::now();
    let (args, options) = instruments::parse(NAME)?;
    let refused = [
        (!args.sets.is_empty(), "has no controls"),
        (options.compare.compare.is_some(), "has no controls to compare"),
        (
            options.compile_for.compile_for.is_some(),
            "makes its own pipeline: --compile-for works from 02 on",
        ),
        (
            options.sums.samples.is_some(),
            "renders one frame: --samples is for chapters whose frames are samples of one picture, such as 04_jitter_camera",
        ),
        (!args.then.is_empty(), "has no controls: --then works from 02 on"),
        (args.scene.is_some(), "brings its own triangle and takes no --scene"),
        (args.unordered, "has one triangle: there is nothing to order"),
    ];
    if let Some((_, why)) = refused.iter().find(|(given, _)| *given) {
        return Err(UsageError(format!("{NAME} {why}")).into());
    }
    let messages = Messages::default();
    if args.list_devices {
        return with_instance(false, &messages, |instance| {
            let lines = candidates(instance)?.into_iter().map(|device| device.line() + "\n");
            print(&lines.collect::<String>())
        });
    }
    if args.list_controls {
        return Ok(());
    }
    check_files(&args, &options)?;
    // A software driver waits forever for threads that the system does not start.
    ensure_threads()?;
    let mut story = Story { lines: Vec::new(), silent: options.report.takes_output() };
    let (picture, mut report) = with_instance(args.validate, &messages, |instance| {
        let chosen = choose(candidates(instance)?, args.device.as_deref())?;
        with_device(instance, &chosen, |device| {
            render(instance, device, &chosen, &args, start, &mut story)
        })
    })?;

    match &args.out {
        Some(out) => {
            picture.save(out)?;
            story.tell("written", out.display().to_string());
        }
        None => story.tell("written", "nothing: --out FILE.png keeps the picture".to_owned()),
    }
    // Everything is destroyed by now: had an object been forgotten, a message would say so.
    let messages = messages.into_inner().unwrap_or_else(PoisonError::into_inner);
    if args.validate {
        story.tell("validation", format!("{} messages", messages.len()));
    }
    report.validation_messages = messages.clone();
    report.chapter = story.lines.into();
    if let Some(path) = &options.report.report {
        report.save(path)?;
    }
    match messages.first() {
        None => Ok(()),
        Some(first) => bail!("{} validation messages; the first: {first}", messages.len()),
    }
}

// ---- 1. The instance: Vulkan itself, and validation if asked for

fn with_instance<R>(
    validate: bool,
    messages: &Messages,
    then: impl FnOnce(&Instance) -> Result<R>,
) -> Result<R> {
    // SAFETY: loading the Vulkan loader runs its initialisation and nothing else.
    let entry = unsafe {
        match std::env::var_os("VULKAN_LOADER") {
            Some(path) => Entry::load_from(path),
            None => Entry::load(),
        }
    }
    .map_err(|error| anyhow!("no Vulkan loader ({error}): run ./setup, or install libvulkan"))?;

    // Synchronization is checked, too, if the layer is told: by a setting of its own, or, where it is too old
    // to have settings, by a feature.
    let on = vk::TRUE;
    let mut setting = vk::LayerSettingEXT::default()
        .layer_name(VALIDATION)
        .setting_name(c"validate_sync")
        .ty(vk::LayerSettingTypeEXT::BOOL32);
    (setting.value_count, setting.p_values) = (1, std::ptr::from_ref(&on).cast());
    let settings = [setting];
    let mut settings = vk::LayerSettingsCreateInfoEXT::default().settings(&settings);
    let checks = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&checks);
    let layers = [VALIDATION.as_ptr()];
    let mut extensions = [ext::debug_utils::NAME, ext::validation_features::NAME].map(CStr::as_ptr);
    let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
    let mut info = vk::InstanceCreateInfo::default().application_info(&application);
    if validate {
        // SAFETY: `entry` is loaded.
        let installed = unsafe { entry.enumerate_instance_layer_properties()? };
        ensure!(
            installed.iter().any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION)),
            "--validate needs {}, which is not installed: run ./setup (Windows: the Vulkan SDK)",
            VALIDATION.to_string_lossy()
        );
        // SAFETY: the layer is installed.
        let offered = unsafe { entry.enumerate_instance_extension_properties(Some(VALIDATION))? };
        let name = ext::layer_settings::NAME;
        if offered.iter().any(|offer| offer.extension_name_as_c_str() == Ok(name)) {
            extensions[1] = name.as_ptr();
            info = info.push_next(&mut settings);
        } else {
            info = info.push_next(&mut features);
        }
        info = info.enabled_layer_names(&layers).enabled_extension_names(&extensions);
    }
    // SAFETY: the names and structures that `info` points to outlive the call.
    let instance = unsafe { entry.create_instance(&info, None) }
        .context("cannot create a Vulkan instance: run ./setup, or install your GPU's driver")?;
    let result = if validate { hear(&entry, &instance, messages, then) } else { then(&instance) };
    // SAFETY: `then` has destroyed what it made.
    unsafe { instance.destroy_instance(None) };
    result
}

// ---- 2. The device: just the extensions and features that are used

/// Ray tracing pipelines, the acceleration structures that they trace and what those depend on; and
/// push descriptors, which need no pool.
const EXTENSIONS: [&CStr; 4] = [
    khr::ray_tracing_pipeline::NAME,
    khr::acceleration_structure::NAME,
    khr::deferred_host_operations::NAME,
    khr::push_descriptor::NAME,
];

/// The features that this program uses, as a chain that `f` gets: on, to make a device with, or off,
/// for a physical device to say which it has.
fn with_features<R>(
    on: bool,
    f: impl FnOnce(&mut vk::PhysicalDeviceFeatures2) -> R,
) -> (R, [(&'static str, vk::Bool32); 4]) {
    let mut vulkan12 = vk::PhysicalDeviceVulkan12Features::default().buffer_device_address(on);
    let mut vulkan13 = vk::PhysicalDeviceVulkan13Features::default().synchronization2(on);
    let mut structures =
        vk::PhysicalDeviceAccelerationStructureFeaturesKHR::default().acceleration_structure(on);
    let mut pipelines =
        vk::PhysicalDeviceRayTracingPipelineFeaturesKHR::default().ray_tracing_pipeline(on);
    let mut features = vk::PhysicalDeviceFeatures2::default()
        .push_next(&mut vulkan12)
        .push_next(&mut vulkan13)
        .push_next(&mut structures)
        .push_next(&mut pipelines);
    let result = f(&mut features);
    let now = [
        ("bufferDeviceAddress", vulkan12.buffer_device_address),
        ("synchronization2", vulkan13.synchronization2),
        ("accelerationStructure", structures.acceleration_structure),
        ("rayTracingPipeline", pipelines.ray_tracing_pipeline),
    ];
    (result, now)
}

fn with_device<R>(
    instance: &Instance,
    chosen: &Candidate,
    then: impl FnOnce(&Device) -> Result<R>,
) -> Result<R> {
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(chosen.queue_family)
        .queue_priorities(&[1.0])];
    let extensions = EXTENSIONS.map(CStr::as_ptr);
    let (device, _) = with_features(true, |features| {
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .push_next(features);
        // SAFETY: `judge` found all of this on the device.
        unsafe { instance.create_device(chosen.handle, &info, None) }
    });
    let device = device.with_context(|| format!("cannot open {}", chosen.name))?;
    let result = then(&device);
    // SAFETY: `then` has waited for its work and destroyed what it made.
    unsafe { device.destroy_device(None) };
    result
}

// ---- 3. Limits, queue, command buffers; from here on, the making of one picture

fn render(
    instance: &Instance,
    device: &Device,
    chosen: &Candidate,
    args: &Args,
    start: Instant,
    story: &mut Story,
) -> Result<(Picture, Report)> {
    story.tell("device", format!("{}, driver {}", chosen.name, chosen.driver));

    // The limits bound the size of a picture and the alignment of addresses.
    let mut tracing = vk::PhysicalDeviceRayTracingPipelinePropertiesKHR::default();
    let mut building = vk::PhysicalDeviceAccelerationStructurePropertiesKHR::default();
    let mut properties =
        vk::PhysicalDeviceProperties2::default().push_next(&mut tracing).push_next(&mut building);
    // SAFETY: the device has the extensions of both structures.
    let memory = unsafe {
        instance.get_physical_device_properties2(chosen.handle, &mut properties);
        instance.get_physical_device_memory_properties(chosen.handle)
    };
    let limits = properties.properties.limits;
    let handle_size = tracing.shader_group_handle_size as usize;
    let handle_alignment = u64::from(tracing.shader_group_handle_alignment);
    let base_alignment = u64::from(tracing.shader_group_base_alignment);
    let scratch_alignment = u64::from(building.min_acceleration_structure_scratch_offset_alignment);
    story.tell(
        "limits",
        format!(
            "handle {handle_size} bytes; multiples: record {handle_alignment}, \
             region {base_alignment}, scratch {scratch_alignment}"
        ),
    );
    let vk::Extent2D { width, height } = args.size;
    let pixels = u64::from(width) * u64::from(height);
    let (side, rays) = (limits.max_image_dimension2_d, tracing.max_ray_dispatch_invocation_count);
    if width.max(height) > side || pixels > u64::from(rays) {
        let name = &chosen.name;
        let most = format!("at most {side} a side and {rays} pixels");
        return Err(UsageError(format!("{width}x{height} is too large for {name}: {most}")).into());
    }

    // One queue; one command buffer to build with, one to trace with.
    let structures = khr::acceleration_structure::Device::new(instance, device);
    let ray_tracing = khr::ray_tracing_pipeline::Device::new(instance, device);
    let push_descriptor = khr::push_descriptor::Device::new(instance, device);
    let pool = vk::CommandPoolCreateInfo::default().queue_family_index(chosen.queue_family);
    // SAFETY: the device was made with one queue of this family.
    let queue = unsafe { device.get_device_queue(chosen.queue_family, 0) };
    let mut gpu =
        Gpu { device, structures: &structures, memory, queue, allocated: 0, undo: Vec::new() };
    // SAFETY: the family is the device's; the pool takes its command buffers along when it goes.
    let commands = unsafe {
        let pool = device.create_command_pool(&pool, None)?;
        gpu.own(device, pool, Device::destroy_command_pool);
        let two =
            vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(2);
        device.allocate_command_buffers(&two)?
    };
    let (build, trace) = (commands[0], commands[1]);
    let begin = vk::CommandBufferBeginInfo::default();

    // ---- 4. Bottom level: an acceleration structure for the triangle

    // ANCHOR: blas
    let input = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_KHR;
    let vertices = gpu.upload("vertices", &TRIANGLE, input, 4)?;
    let triangles = vk::AccelerationStructureGeometryTrianglesDataKHR::default()
        .vertex_format(vk::Format::R32G32B32_SFLOAT)
        .vertex_data(vk::DeviceOrHostAddressConstKHR { device_address: vertices.address })
        .vertex_stride(size_of::<[f32; 3]>() as u64)
        .max_vertex(2)
        .index_type(vk::IndexType::NONE_KHR);
    let geometry = vk::AccelerationStructureGeometryKHR::default()
        .geometry_type(vk::GeometryTypeKHR::TRIANGLES)
        .geometry(vk::AccelerationStructureGeometryDataKHR { triangles })
        .flags(vk::GeometryFlagsKHR::OPAQUE);
    // ANCHOR_END: blas
    // SAFETY: the command buffer is new.
    unsafe { device.begin_command_buffer(build, &begin)? };
    let level = vk::AccelerationStructureTypeKHR::BOTTOM_LEVEL;
    let bottom = gpu.build(build, level, geometry, scratch_alignment)?;
    story.tell("vertices", format!("3 at {:#x}", vertices.address));
    story.tell("bottom", format!("1 triangle: {bottom}"));

    // ---- 5. Top level: the bottom level, placed in the world

    // ANCHOR: tlas
    let placed = vk::AccelerationStructureInstanceKHR {
        transform: vk::TransformMatrixKHR { matrix: PLACE },
        instance_custom_index_and_mask: vk::Packed24_8::new(0, 0xff),
        instance_shader_binding_table_record_offset_and_flags: vk::Packed24_8::new(0, 0),
        acceleration_structure_reference: vk::AccelerationStructureReferenceKHR {
            device_handle: bottom.address,
        },
    };
    let instances = gpu.upload("instances", &[placed], input, 16)?;
    let data = vk::AccelerationStructureGeometryInstancesDataKHR::default()
        .data(vk::DeviceOrHostAddressConstKHR { device_address: instances.address });
    let geometry = vk::AccelerationStructureGeometryKHR::default()
        .geometry_type(vk::GeometryTypeKHR::INSTANCES)
        .geometry(vk::AccelerationStructureGeometryDataKHR { instances: data });
    // ANCHOR_END: tlas
    // ANCHOR: builds
    // The build of the top level reads the bottom level that the build before it wrote.
    gpu.barrier(
        build,
        (Stage::ACCELERATION_STRUCTURE_BUILD_KHR, Access::ACCELERATION_STRUCTURE_WRITE_KHR),
        (Stage::ACCELERATION_STRUCTURE_BUILD_KHR, Access::ACCELERATION_STRUCTURE_READ_KHR),
    );
    let level = vk::AccelerationStructureTypeKHR::TOP_LEVEL;
    let top = gpu.build(build, level, geometry, scratch_alignment)?;
    // Rays read both levels.
    gpu.barrier(
        build,
        (Stage::ACCELERATION_STRUCTURE_BUILD_KHR, Access::ACCELERATION_STRUCTURE_WRITE_KHR),
        (Stage::RAY_TRACING_SHADER_KHR, Access::ACCELERATION_STRUCTURE_READ_KHR),
    );
    // ANCHOR_END: builds
    let build_start = Instant::now();
    // SAFETY: the recording began above.
    unsafe { device.end_command_buffer(build)? };
    gpu.submit(build)?;
    let build_milliseconds = milliseconds(build_start);
    story.tell("instance", format!("1 at {:#x}", instances.address));
    story.tell("top", format!("1 instance: {top}"));
    story.tell("built", format!("both levels in {build_milliseconds:.3} ms"));

    // ---- 6. The image that rays write, the buffer that the host reads

    let extent = vk::Extent3D { width, height, depth: 1 };
    let info = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(FORMAT)
        .extent(extent)
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_SRC);
    let color = vk::ImageAspectFlags::COLOR;
    let whole =
        vk::ImageSubresourceRange::default().aspect_mask(color).level_count(1).layer_count(1);
    // SAFETY: the size is within the limits; the memory is made for this image.
    let (image, view) = unsafe {
        let image = device.create_image(&info, None)?;
        gpu.own(device, image, Device::destroy_image);
        let needs = device.get_image_memory_requirements(image);
        device.bind_image_memory(
            image,
            gpu.allocate("the image", needs, Place::Device, false)?,
            0,
        )?;
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(FORMAT)
            .subresource_range(whole);
        let view = device.create_image_view(&info, None)?;
        (image, gpu.own(device, view, Device::destroy_image_view))
    };
    let copy_target = vk::BufferUsageFlags::TRANSFER_DST;
    let readback = gpu.buffer("the readback", 16 * pixels, copy_target, Place::ToHost, 1)?;
    story.tell("image", format!("{width}x{height}, 16 bytes per pixel: {} bytes", readback.size));

    // ---- 7. The pipeline: three shaders, each in a group of its own

    let pipeline_start = Instant::now();
    // ANCHOR: groups
    let files = ["camera.rgen", "sky.rmiss", "shade.rchit"];
    let unused = vk::RayTracingShaderGroupCreateInfoKHR::default()
        .general_shader(vk::SHADER_UNUSED_KHR)
        .closest_hit_shader(vk::SHADER_UNUSED_KHR)
        .any_hit_shader(vk::SHADER_UNUSED_KHR)
        .intersection_shader(vk::SHADER_UNUSED_KHR);
    let general = unused.ty(vk::RayTracingShaderGroupTypeKHR::GENERAL);
    let triangle_hit = unused.ty(vk::RayTracingShaderGroupTypeKHR::TRIANGLES_HIT_GROUP);
    // The numbers are positions in `files`.
    let groups =
        [general.general_shader(0), general.general_shader(1), triangle_hit.closest_hit_shader(2)];
    // ANCHOR_END: groups
    let shaders = files.map(|file| compile(&format!("{NAME}/{file}")));
    let shaders: Vec<_> = shaders.into_iter().collect::<Result<_>>()?;
    let bindings = [
        (0, vk::DescriptorType::ACCELERATION_STRUCTURE_KHR),
        (1, vk::DescriptorType::STORAGE_IMAGE),
    ]
    .map(|(binding, kind)| {
        vk::DescriptorSetLayoutBinding::default()
            .binding(binding)
            .descriptor_type(kind)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::RAYGEN_KHR)
    });
    // SAFETY: the words are modules from the compiler, the groups name stages that exist, and all
    // that a call is given is alive.
    let (layout, pipeline, handles) = unsafe {
        let mut stages = Vec::new();
        for shader in &shaders {
            let info = vk::ShaderModuleCreateInfo::default().code(&shader.spirv);
            let module = device.create_shader_module(&info, None)?;
            gpu.own(device, module, Device::destroy_shader_module);
            let stage = vk::PipelineShaderStageCreateInfo::default().stage(shader.stage);
            stages.push(stage.module(module).name(c"main"));
        }
        let info = vk::DescriptorSetLayoutCreateInfo::default()
            .flags(vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR)
            .bindings(&bindings);
        let sets = [device.create_descriptor_set_layout(&info, None)?];
        gpu.own(device, sets[0], Device::destroy_descriptor_set_layout);
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
        let layout = device.create_pipeline_layout(&info, None)?;
        gpu.own(device, layout, Device::destroy_pipeline_layout);
        // ANCHOR: pipeline
        let info = vk::RayTracingPipelineCreateInfoKHR::default()
            .stages(&stages)
            .groups(&groups)
            .max_pipeline_ray_recursion_depth(1)
            .layout(layout);
        let (now, uncached) = (vk::DeferredOperationKHR::null(), vk::PipelineCache::null());
        let pipeline = ray_tracing
            .create_ray_tracing_pipelines(now, uncached, &[info], None)
            .map_err(|(_, error)| error)
            .context("cannot make the pipeline")?[0];
        gpu.own(device, pipeline, Device::destroy_pipeline);
        let (count, bytes) = (groups.len() as u32, groups.len() * handle_size);
        let handles =
            ray_tracing.get_ray_tracing_shader_group_handles(pipeline, 0, count, bytes)?;
        // ANCHOR_END: pipeline
        (layout, pipeline, handles)
    };
    let pipeline_milliseconds = milliseconds(pipeline_start);
    let count = groups.len();
    story
        .tell("pipeline", format!("{count} groups, recursion 1, in {pipeline_milliseconds:.1} ms"));

    // ---- 8. The shader binding table: where a ray finds its shaders

    // ANCHOR: sbt
    let stride = (handle_size as u64).next_multiple_of(handle_alignment);
    let region = stride.next_multiple_of(base_alignment);
    let offsets = [0, region, 2 * region];
    let mut records = vec![0u8; (offsets[2] + stride) as usize];
    for (offset, handle) in offsets.iter().zip(handles.chunks(handle_size)) {
        records[*offset as usize..][..handle_size].copy_from_slice(handle);
    }
    let usage = vk::BufferUsageFlags::SHADER_BINDING_TABLE_KHR;
    let table = gpu.upload("the shader binding table", &records, usage, base_alignment)?;
    let [raygen, miss, hit] = offsets.map(|offset| {
        vk::StridedDeviceAddressRegionKHR::default()
            .device_address(table.address + offset)
            .stride(stride)
            .size(stride)
    });
    let callable = vk::StridedDeviceAddressRegionKHR::default();
    // ANCHOR_END: sbt
    let (at, size) = (table.address, table.size);
    story.tell(
        "table",
        format!("raygen +0, miss +{region}, hit +{}: {size} bytes at {at:#x}", 2 * region),
    );

    // ---- 9. The frame, recorded once: trace, then copy

    // ANCHOR: descriptors
    let levels = [top.handle];
    let mut level =
        vk::WriteDescriptorSetAccelerationStructureKHR::default().acceleration_structures(&levels);
    let images =
        [vk::DescriptorImageInfo::default().image_view(view).image_layout(Layout::GENERAL)];
    let descriptors = [
        vk::WriteDescriptorSet::default()
            .dst_binding(0)
            .descriptor_type(vk::DescriptorType::ACCELERATION_STRUCTURE_KHR)
            .descriptor_count(1)
            .push_next(&mut level),
        vk::WriteDescriptorSet::default()
            .dst_binding(1)
            .descriptor_type(vk::DescriptorType::STORAGE_IMAGE)
            .image_info(&images),
    ];
    // ANCHOR_END: descriptors
    let layers = vk::ImageSubresourceLayers::default().aspect_mask(color).layer_count(1);
    let pixel_copy =
        [vk::BufferImageCopy::default().image_subresource(layers).image_extent(extent)];
    let has_clock = chosen.timestamp_bits > 0;
    let stamps =
        vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(2);
    // SAFETY: the command buffer is new. All that is recorded lives until `gpu` goes, after the last
    // wait. Descriptors and regions are those that the pipeline was made for.
    let clock = unsafe {
        let clock = device.create_query_pool(&stamps, None)?;
        gpu.own(device, clock, Device::destroy_query_pool);
        device.begin_command_buffer(trace, &begin)?;
        // ANCHOR: frame
        // What the image held is not needed. The copy of the frame before must have ended.
        gpu.change_layout(
            trace,
            (image, whole, Layout::UNDEFINED, Layout::GENERAL),
            (Stage::COPY, Access::NONE),
            (Stage::RAY_TRACING_SHADER_KHR, Access::SHADER_STORAGE_WRITE),
        );
        let point = vk::PipelineBindPoint::RAY_TRACING_KHR;
        device.cmd_bind_pipeline(trace, point, pipeline);
        push_descriptor.cmd_push_descriptor_set(trace, point, layout, 0, &descriptors);
        if has_clock {
            device.cmd_reset_query_pool(trace, clock, 0, 2);
            device.cmd_write_timestamp2(trace, Stage::ALL_COMMANDS, clock, 0);
        }
        ray_tracing.cmd_trace_rays(trace, &raygen, &miss, &hit, &callable, width, height, 1);
        if has_clock {
            device.cmd_write_timestamp2(trace, Stage::ALL_COMMANDS, clock, 1);
        }
        // The copy reads what the shaders stored.
        gpu.change_layout(
            trace,
            (image, whole, Layout::GENERAL, Layout::TRANSFER_SRC_OPTIMAL),
            (Stage::RAY_TRACING_SHADER_KHR, Access::SHADER_STORAGE_WRITE),
            (Stage::COPY, Access::TRANSFER_READ),
        );
        let (from, to) = (Layout::TRANSFER_SRC_OPTIMAL, readback.handle);
        device.cmd_copy_image_to_buffer(trace, image, from, to, &pixel_copy);
        // The host reads what the copy wrote. A fence alone would only say that it is finished.
        gpu.barrier(trace, (Stage::COPY, Access::TRANSFER_WRITE), (Stage::HOST, Access::HOST_READ));
        // ANCHOR_END: frame
        device.end_command_buffer(trace)?;
        clock
    };

    // ---- 10. The frame, submitted as often as asked for

    let mut times = Vec::new();
    let mut first_frame_milliseconds = 0.0;
    for frame in 1..=args.frames {
        let submitted = Instant::now();
        gpu.submit(trace)?;
        // The host's clock does where the queue has none; it also counts the copy.
        let mut time = milliseconds(submitted);
        if frame == 1 {
            first_frame_milliseconds = milliseconds(start);
        }
        if has_clock {
            let mut ticks = [0u64; 2];
            // SAFETY: both timestamps were written by the submission that is done.
            unsafe {
                let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
                device.get_query_pool_results(clock, 0, &mut ticks, flags)?;
            }
            // Some queues count in fewer than 64 bits, and start again from 0.
            let passed =
                ticks[1].wrapping_sub(ticks[0]) & (u64::MAX >> (64 - chosen.timestamp_bits));
            time = passed as f64 * f64::from(limits.timestamp_period) * 1e-6;
        }
        story.tell("frame", format!("{frame}: {pixels} rays in {time:.3} ms"));
        times.push(time);
    }
    let picture = Picture { width, height, pixels: gpu.read(&readback)? };

    let spread = Milliseconds::of(&times);
    let seconds = spread.median / 1e3;
    let report = Report {
        sample: NAME.to_owned(),
        device: chosen.name.clone(),
        driver: chosen.driver.clone(),
        width,
        height,
        frames: args.frames,
        gpu_milliseconds: spread,
        primary_rays_per_second: if seconds > 0.0 { pixels as f64 / seconds } else { 0.0 },
        first_frame_milliseconds,
        acceleration_structure_milliseconds: build_milliseconds,
        acceleration_structure_bytes: bottom.size + top.size,
        pipeline_milliseconds,
        stages: shaders.into_iter().map(|shader| shader.path).collect(),
        groups: groups.len(),
        bytes_allocated: gpu.allocated,
        ..Report::default()
    };
    Ok((picture, report))
}

// ---- The helpers of these steps: memory, buffers, builds, barriers, submission

/// A buffer with memory of its own. `offset` is that of its first aligned byte, `address` its device address.
struct Buffer {
    handle: vk::Buffer,
    memory: vk::DeviceMemory,
    address: vk::DeviceAddress,
    offset: u64,
    size: u64,
}

/// An acceleration structure of either level.
struct Structure {
    handle: vk::AccelerationStructureKHR,
    address: vk::DeviceAddress,
    size: u64,
    scratch: u64,
}

impl std::fmt::Display for Structure {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let Self { address, size, scratch, .. } = self;
        write!(f, "structure of {size} bytes at {address:#x}, built with {scratch} of scratch")
    }
}

/// Memory by its writer and its reader.
#[derive(Clone, Copy)]
enum Place {
    /// The device alone.
    Device,
    /// The host writes once; the device reads.
    ToDevice,
    /// The device writes; the host reads.
    ToHost,
}

/// The handles that the helpers share, and every object made, to be destroyed in reverse order.
struct Gpu<'a> {
    device: &'a Device,
    structures: &'a khr::acceleration_structure::Device,
    memory: vk::PhysicalDeviceMemoryProperties,
    queue: vk::Queue,
    allocated: u64,
    undo: Vec<Box<dyn FnOnce() + 'a>>,
}

impl Drop for Gpu<'_> {
    fn drop(&mut self) {
        while let Some(destroy) = self.undo.pop() {
            destroy();
        }
    }
}

impl<'a> Gpu<'a> {
    /// Notes that `handle` is to be destroyed, whether the story ends well or not.
    ///
    /// # Safety
    /// `handle` was made by `maker`, is destroyed nowhere else, and the device is idle when `self` goes.
    unsafe fn own<M, H: Copy + 'a>(
        &mut self,
        maker: &'a M,
        handle: H,
        destroy: unsafe fn(&M, H, Option<&vk::AllocationCallbacks>),
    ) -> H {
        // SAFETY: the caller's promise.
        self.undo.push(Box::new(move || unsafe { destroy(maker, handle, None) }));
        handle
    }

    /// Memory of the best kind for its place, and with device addresses if needed.
    fn allocate(
        &mut self,
        what: &str,
        needs: vk::MemoryRequirements,
        place: Place,
        addressed: bool,
    ) -> Result<vk::DeviceMemory> {
        use vk::MemoryPropertyFlags as Kind;
        // Coherent memory needs no flushes.
        let mapped = Kind::HOST_VISIBLE | Kind::HOST_COHERENT;
        let wanted = match place {
            Place::Device => [Kind::DEVICE_LOCAL; 2],
            // A card reads its own memory faster than the host's, and most let the host write there.
            Place::ToDevice => [mapped | Kind::DEVICE_LOCAL, mapped],
            // Cached memory, where there is some, is faster for the host to read.
            Place::ToHost => [mapped | Kind::HOST_CACHED, mapped],
        };
        let types = self.memory.memory_types_as_slice();
        let find = |kind: Kind| {
            let allowed = |i: usize| needs.memory_type_bits & (1 << i) != 0;
            (0..types.len()).find(|&i| allowed(i) && types[i].property_flags.contains(kind))
        };
        let index = wanted.into_iter().find_map(find);
        let index = index.with_context(|| format!("no kind of memory suits {what}"))?;
        let mut flags = vk::MemoryAllocateFlagsInfo::default();
        if addressed {
            flags = flags.flags(vk::MemoryAllocateFlags::DEVICE_ADDRESS);
        }
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(needs.size)
            .memory_type_index(index as u32)
            .push_next(&mut flags);
        // SAFETY: the type is one that the device has; what is bound to it is destroyed with it.
        let memory = unsafe {
            let memory = self.device.allocate_memory(&info, None);
            let memory =
                memory.with_context(|| format!("no {} bytes of memory for {what}", needs.size))?;
            self.own(self.device, memory, Device::free_memory)
        };
        self.allocated += needs.size;
        Ok(memory)
    }

    /// A buffer whose address, if it has one, is a multiple of `alignment`.
    fn buffer(
        &mut self,
        what: &str,
        size: u64,
        usage: vk::BufferUsageFlags,
        place: Place,
        alignment: u64,
    ) -> Result<Buffer> {
        // Vulkan aligns memory for the buffer, not its address for its use: with room to spare it can
        // be rounded up.
        let info = vk::BufferCreateInfo::default().size(size + alignment).usage(usage);
        let addressed = usage.contains(vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS);
        // SAFETY: the memory is made for this buffer and lives as long.
        unsafe {
            let handle = self.device.create_buffer(&info, None)?;
            self.own(self.device, handle, Device::destroy_buffer);
            let needs = self.device.get_buffer_memory_requirements(handle);
            let memory = self.allocate(what, needs, place, addressed)?;
            self.device.bind_buffer_memory(handle, memory, 0)?;
            let info = vk::BufferDeviceAddressInfo::default().buffer(handle);
            let start = if addressed { self.device.get_buffer_device_address(&info) } else { 0 };
            let address = start.next_multiple_of(alignment);
            Ok(Buffer { handle, memory, address, offset: address - start, size })
        }
    }

    /// An addressed buffer that holds `data`.
    fn upload<T: Copy>(
        &mut self,
        what: &str,
        data: &[T],
        usage: vk::BufferUsageFlags,
        alignment: u64,
    ) -> Result<Buffer> {
        let usage = usage | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let size = size_of_val(data);
        let buffer = self.buffer(what, size as u64, usage, Place::ToDevice, alignment)?;
        let all = vk::MemoryMapFlags::empty();
        // SAFETY: the memory is visible to the host, not mapped, and has `size` bytes after `offset`.
        // A submission makes what the host wrote before it visible to the device.
        unsafe {
            let mapped = self.device.map_memory(buffer.memory, 0, vk::WHOLE_SIZE, all)?;
            let target = mapped.cast::<u8>().add(buffer.offset as usize);
            std::ptr::copy_nonoverlapping(data.as_ptr().cast(), target, size);
            self.device.unmap_memory(buffer.memory);
        }
        Ok(buffer)
    }

    /// The pixels in a buffer that the host can map.
    fn read(&self, buffer: &Buffer) -> Result<Vec<[f32; 4]>> {
        let mut pixels = vec![[0.0; 4]; buffer.size as usize / size_of::<[f32; 4]>()];
        let all = vk::MemoryMapFlags::empty();
        // SAFETY: as in `upload`; the copy into the buffer is done and visible to the host.
        unsafe {
            let mapped = self.device.map_memory(buffer.memory, 0, vk::WHOLE_SIZE, all)?;
            std::ptr::copy_nonoverlapping(mapped.cast(), pixels.as_mut_ptr(), pixels.len());
            self.device.unmap_memory(buffer.memory);
        }
        Ok(pixels)
    }

    /// Records the build of a structure with one geometry of one primitive.
    fn build(
        &mut self,
        commands: vk::CommandBuffer,
        level: vk::AccelerationStructureTypeKHR,
        geometry: vk::AccelerationStructureGeometryKHR,
        scratch_alignment: u64,
    ) -> Result<Structure> {
        let geometries = [geometry];
        let mut info = vk::AccelerationStructureBuildGeometryInfoKHR::default()
            .ty(level)
            .mode(vk::BuildAccelerationStructureModeKHR::BUILD)
            .flags(vk::BuildAccelerationStructureFlagsKHR::PREFER_FAST_TRACE)
            .geometries(&geometries);
        // First the driver says how large the result and its scratch space may become.
        let mut sizes = vk::AccelerationStructureBuildSizesInfoKHR::default();
        // SAFETY: the geometry describes one primitive.
        unsafe {
            self.structures.get_acceleration_structure_build_sizes(
                vk::AccelerationStructureBuildTypeKHR::DEVICE,
                &info,
                &[1],
                &mut sizes,
            );
        }
        let (size, scratch) = (sizes.acceleration_structure_size, sizes.build_scratch_size);
        use vk::BufferUsageFlags as Usage;
        let addressed = Usage::SHADER_DEVICE_ADDRESS;
        let storage = Usage::ACCELERATION_STRUCTURE_STORAGE_KHR | addressed;
        let storage = self.buffer("an acceleration structure", size, storage, Place::Device, 1)?;
        let usage = Usage::STORAGE_BUFFER | addressed;
        let space = self.buffer("scratch", scratch, usage, Place::Device, scratch_alignment)?;
        let create = vk::AccelerationStructureCreateInfoKHR::default()
            .ty(level)
            .buffer(storage.handle)
            .size(size);
        let range = vk::AccelerationStructureBuildRangeInfoKHR::default().primitive_count(1);
        // SAFETY: both buffers have the sizes that the driver asked for; they and the geometry's
        // data live until `self` is dropped, after the build.
        unsafe {
            let handle = self.structures.create_acceleration_structure(&create, None)?;
            let destroy = khr::acceleration_structure::Device::destroy_acceleration_structure;
            self.own(self.structures, handle, destroy);
            info = info
                .dst_acceleration_structure(handle)
                .scratch_data(vk::DeviceOrHostAddressKHR { device_address: space.address });
            self.structures.cmd_build_acceleration_structures(commands, &[info], &[&[range]]);
            let name = vk::AccelerationStructureDeviceAddressInfoKHR::default()
                .acceleration_structure(handle);
            let address = self.structures.get_acceleration_structure_device_address(&name);
            Ok(Structure { handle, address, size, scratch })
        }
    }

    /// Records that what `from` wrote is finished and visible before `to` reads it.
    fn barrier(&self, commands: vk::CommandBuffer, from: (Stage, Access), to: (Stage, Access)) {
        let barriers = [vk::MemoryBarrier2::default()
            .src_stage_mask(from.0)
            .src_access_mask(from.1)
            .dst_stage_mask(to.0)
            .dst_access_mask(to.1)];
        let dependency = vk::DependencyInfo::default().memory_barriers(&barriers);
        // SAFETY: the command buffer is being recorded, synchronization2 is on.
        unsafe { self.device.cmd_pipeline_barrier2(commands, &dependency) };
    }

    /// The same for one image, whose pixels change from the old layout to the new one.
    fn change_layout(
        &self,
        commands: vk::CommandBuffer,
        (image, range, old, new): (vk::Image, vk::ImageSubresourceRange, Layout, Layout),
        from: (Stage, Access),
        to: (Stage, Access),
    ) {
        let barriers = [vk::ImageMemoryBarrier2::default()
            .image(image)
            .subresource_range(range)
            .old_layout(old)
            .new_layout(new)
            .src_stage_mask(from.0)
            .src_access_mask(from.1)
            .dst_stage_mask(to.0)
            .dst_access_mask(to.1)];
        let dependency = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: as in `barrier`.
        unsafe { self.device.cmd_pipeline_barrier2(commands, &dependency) };
    }

    /// Submits recorded commands and waits until the device has executed them.
    fn submit(&self, commands: vk::CommandBuffer) -> Result<()> {
        let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(commands)];
        let submit = [vk::SubmitInfo2::default().command_buffer_infos(&buffers)];
        // SAFETY: the commands are recorded and not in flight.
        unsafe {
            let fence = self.device.create_fence(&vk::FenceCreateInfo::default(), None)?;
            let submitted = self.device.queue_submit2(self.queue, &submit, fence);
            let done =
                submitted.and_then(|()| self.device.wait_for_fences(&[fence], true, PATIENCE));
            if done == Err(vk::Result::TIMEOUT) {
                // Every other way out of here destroys what the device may still use.
                complain("error: the device has not answered for ten minutes");
                std::process::exit(1);
            }
            if done.is_err() {
                // A wait may fail while the device works on, with what is destroyed from here on.
                let _ = self.device.device_wait_idle();
            }
            self.device.destroy_fence(fence, None);
            done.context("the device failed while it worked")
        }
    }
}

// ---- Choice of the device

/// A physical device, and what it lacks; nothing if it will do.
struct Candidate {
    handle: vk::PhysicalDevice,
    index: usize,
    name: String,
    driver: String,
    kind: vk::PhysicalDeviceType,
    queue_family: u32,
    timestamp_bits: u32,
    missing: Vec<String>,
}

impl Candidate {
    fn line(&self) -> String {
        let Self { index, name, driver, kind, missing, .. } = self;
        let verdict = match missing.as_slice() {
            [] => "suitable".to_owned(),
            _ => format!("lacks {}", missing.join(", ")),
        };
        format!("{index}: {name} ({kind:?}; {driver}): {verdict}")
    }
}

fn candidates(instance: &Instance) -> Result<Vec<Candidate>> {
    // SAFETY: the instance is alive.
    let devices = match unsafe { instance.enumerate_physical_devices() } {
        // The error of loaders if drivers are installed but none finds its device.
        Err(vk::Result::ERROR_INITIALIZATION_FAILED) => Vec::new(),
        devices => devices?,
    };
    ensure!(!devices.is_empty(), "no Vulkan device: run ./setup, or update your GPU's driver");
    devices.into_iter().enumerate().map(|(index, handle)| judge(instance, index, handle)).collect()
}

fn judge(instance: &Instance, index: usize, handle: vk::PhysicalDevice) -> Result<Candidate> {
    // SAFETY: the handle is one of the instance's, here and below.
    let (properties, families, extensions) = unsafe {
        (
            instance.get_physical_device_properties(handle),
            instance.get_physical_device_queue_family_properties(handle),
            instance.enumerate_device_extension_properties(handle)?,
        )
    };
    let text = |name: &CStr| name.to_string_lossy().into_owned();
    let name = text(properties.device_name_as_c_str().unwrap_or_default());
    let has = |name: &&CStr| extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(*name));
    let mut missing: Vec<String> =
        EXTENSIONS.iter().filter(|name| !has(name)).map(|name| text(name)).collect();
    if properties.api_version < vk::API_VERSION_1_3 {
        missing.push("Vulkan 1.3".to_owned());
    }
    // Every queue with compute can trace rays.
    let computes =
        |family: &vk::QueueFamilyProperties| family.queue_flags.contains(vk::QueueFlags::COMPUTE);
    let family = families.iter().position(computes).unwrap_or_else(|| {
        missing.push("a compute queue".to_owned());
        0
    });
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    if missing.is_empty() {
        let mut more = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
        // SAFETY: as above; Vulkan 1.3 and the extensions whose structures are chained are there.
        let ((), offered) = with_features(false, |features| unsafe {
            instance.get_physical_device_properties2(handle, &mut more);
            instance.get_physical_device_features2(handle, features);
        });
        // An extension can be there with its features off.
        let off = offered.iter().filter(|(_, offered)| *offered == vk::FALSE);
        missing.extend(off.map(|(name, _)| format!("feature {name}")));
    }
    let maker = text(driver.driver_name_as_c_str().unwrap_or_default());
    Ok(Candidate {
        handle,
        index,
        name,
        driver: format!("{maker} {}", text(driver.driver_info_as_c_str().unwrap_or_default())),
        kind: properties.device_type,
        queue_family: family as u32,
        timestamp_bits: families.get(family).map_or(0, |family| family.timestamp_valid_bits),
        missing,
    })
}

/// The device selected by `asked`, by number or part of its name, or else the best suitable one.
fn choose(candidates: Vec<Candidate>, asked: Option<&str>) -> Result<Candidate> {
    let all = candidates.iter().map(Candidate::line).collect::<Vec<_>>().join(" · ");
    let matches = |candidate: &Candidate| match (asked, asked.map(str::parse::<usize>)) {
        (_, Some(Ok(number))) => candidate.index == number,
        (Some(part), _) => candidate.name.to_lowercase().contains(&part.to_lowercase()),
        (None, _) => true,
    };
    if let (Some(asked), false) = (asked, candidates.iter().any(matches)) {
        return Err(UsageError(format!("no device '{asked}'; there is {all}")).into());
    }
    let rank = |candidate: &Candidate| match candidate.kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => 0,
        vk::PhysicalDeviceType::INTEGRATED_GPU => 1,
        vk::PhysicalDeviceType::VIRTUAL_GPU => 2,
        vk::PhysicalDeviceType::CPU => 4,
        _ => 3,
    };
    let suitable = candidates.into_iter().filter(|c| matches(c) && c.missing.is_empty());
    suitable.min_by_key(rank).ok_or_else(|| {
        anyhow!("no device can run this: {all}; run ./setup, or update your GPU's driver")
    })
}

// ---- Messages of validation

/// Warnings and errors from validation, in order.
type Messages = Mutex<Vec<String>>;

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Collects validation messages while `then` runs.
fn hear<R>(
    entry: &Entry,
    instance: &Instance,
    messages: &Messages,
    then: impl FnOnce(&Instance) -> Result<R>,
) -> Result<R> {
    use vk::{
        DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type,
    };
    let utils = ext::debug_utils::Instance::new(entry, instance);
    let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::WARNING | Severity::ERROR)
        .message_type(Type::GENERAL | Type::VALIDATION | Type::PERFORMANCE)
        .pfn_user_callback(Some(on_message))
        .user_data(std::ptr::from_ref(messages).cast_mut().cast());
    // SAFETY: `messages` outlives the messenger, which is destroyed below.
    let messenger = unsafe { utils.create_debug_utils_messenger(&info, None)? };
    let result = then(instance);
    // SAFETY: made above.
    unsafe { utils.destroy_debug_utils_messenger(messenger, None) };
    result
}

unsafe extern "system" fn on_message(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _types: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer passes valid data with NUL-terminated strings; `messages` is what
    // `hear` gave, which outlives the messenger.
    let (id, text, messages) = unsafe {
        let data = &*data;
        let messages = &*messages.cast::<Messages>();
        (data.message_id_name_as_c_str(), data.message_as_c_str(), messages)
    };
    let [id, text] = [id, text].map(|t| t.unwrap_or_default().to_string_lossy().into_owned());
    // The loader and drivers talk about the machine, not about this program.
    if id != "Loader Message" && !id.starts_with("MESA") {
        let _ = writeln!(std::io::stderr(), "validation: {text}");
        messages.lock().unwrap_or_else(PoisonError::into_inner).push(text);
    }
    vk::FALSE
}

// ---- Report of the steps

/// The program's account of its work, one line per step. Silent where the report is on standard output.
struct Story {
    lines: Vec<String>,
    silent: bool,
}

impl Story {
    fn tell(&mut self, step: &str, what: String) {
        let line = format!("{step:<10}  {what}");
        if !self.silent {
            // A reader who closed the pipe does not stop the program.
            let _ = writeln!(std::io::stdout(), "{line}");
        }
        self.lines.push(line);
    }
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
