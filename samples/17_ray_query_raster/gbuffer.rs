//! The G-buffer: what the rasteriser sees in each pixel, which instance, which triangle, and where on it.

use anyhow::{Context, Result};
use ash::vk;
use common::gpu::{Address, Buffer, Gpu, GraphicsPipeline, Image, TextureTable};
use common::scene::{CameraBasis, Scene, SceneAddresses, SceneOnGpu, input_usage};
use common::{Controls, Frame, Variant, Variants};
use glam::{DMat4, Vec3};

/// Four numbers of 32 bits: a format that every device draws to and has as a storage image.
const SEEN: vk::Format = vk::Format::R32G32B32A32_UINT;
/// No instance has this number.
const NOTHING: [u32; 4] = [u32::MAX; 4];

common::shader_enum! {
    /// The quantity that the depth test compares.
    pub enum Depth: DEPTH {
        Reversed = "reversed float", Usual = "usual float", Short = "usual 16 bits",
    }
}

impl Depth {
    fn format(self) -> vk::Format {
        match self {
            Self::Reversed | Self::Usual => vk::Format::D32_SFLOAT,
            Self::Short => vk::Format::D16_UNORM,
        }
    }

    /// The depth at infinity, and what nearer is.
    fn farthest(self) -> (f32, vk::CompareOp) {
        match self {
            Self::Reversed => (0.0, vk::CompareOp::GREATER),
            Self::Usual | Self::Short => (1.0, vk::CompareOp::LESS),
        }
    }
}

common::shader_struct! {
    /// The transform of an instance: both matrices by columns.
    pub struct Placed {
        to_world: [Vec3; 4],
        to_object: [Vec3; 4],
    }
}

common::shader_struct! {
    /// Push constants of the vertex shader.
    struct Draw {
        camera: CameraBasis,
        scene: SceneAddresses,
        placed: Address<Placed>,
        near: f32,
    }
}

/// The images that are drawn to, what is drawn, and how.
pub struct GBuffer {
    targets: Option<Targets>,
    pipelines: Variants<Depth, GraphicsPipeline>,
    placed: Buffer,
    /// Number of triangles of each instance.
    triangles: Vec<u32>,
    depth: Depth,
    near: f32,
}

/// Images of the picture's size.
struct Targets {
    seen: Image,
    depth: Image,
}

impl GBuffer {
    /// Records the transform of each instance, and its number of triangles.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self> {
        let placed = scene.instances.iter().map(|instance| {
            let columns =
                |matrix: DMat4| [0, 1, 2, 3].map(|column| matrix.col(column).truncate().as_vec3());
            let to_world = DMat4::from(instance.transform.as_daffine3());
            Placed { to_world: columns(to_world), to_object: columns(to_world.inverse()) }
        });
        let placed = Buffer::with_data(gpu, "places", &placed.collect::<Vec<_>>(), input_usage())?;
        let count = |mesh: usize| scene.model.meshes[mesh].triangles.len() as u32;
        Ok(Self {
            targets: None,
            pipelines: Variants::default(),
            placed,
            triangles: scene.instances.iter().map(|instance| count(instance.mesh)).collect(),
            depth: Depth::Reversed,
            near: 0.05,
        })
    }

    /// Declares what may be set.
    pub fn controls(&mut self, c: &mut Controls) {
        c.choice("depth", &mut self.depth);
        c.slider("near plane", &mut self.near, 0.001..=1.0);
    }

    /// The address of the instances' transforms.
    pub fn placed(&self) -> Address<Placed> {
        self.placed.address.into()
    }

    /// The image of visible surfaces, in layout `GENERAL`.
    pub fn seen(&self) -> Result<&Image> {
        Ok(&self.targets.as_ref().context("no G-buffer")?.seen)
    }

    /// Has images of the frame's size, and draws into them what a camera sees, if there is one.
    pub fn prepare(
        &mut self,
        frame: &Frame,
        camera: Option<CameraBasis>,
        scene: &SceneOnGpu,
    ) -> Result<()> {
        let Variant { pipeline, key, .. } =
            self.pipelines.choose(frame, &scene.textures, self.depth, pipeline)?;
        let fits = |targets: &Targets| {
            targets.seen.extent == frame.image.extent && targets.depth.format == key.format()
        };
        if !self.targets.as_ref().is_some_and(fits) {
            self.targets = Some(Targets::new(frame.gpu, frame.image.extent, *key)?);
        }
        let (Some(camera), Some(targets)) = (camera, &self.targets) else { return Ok(()) };
        let placed = self.placed.address.into();
        let push = Draw { camera, scene: scene.addresses, placed, near: self.near };
        targets.begin(frame, *key);
        pipeline.bind(frame.cmd, &[], &push)?;
        // ANCHOR: draw
        for (instance, triangles) in self.triangles.iter().enumerate() {
            // SAFETY: rendering has begun, and the pipeline is bound; all that it reads outlives the frame.
            unsafe { frame.gpu.device.cmd_draw(frame.cmd, 3 * triangles, 1, 0, instance as u32) };
        }
        // ANCHOR_END: draw
        targets.end(frame);
        Ok(())
    }
}

impl Targets {
    fn new(gpu: &Gpu, extent: vk::Extent2D, depth: Depth) -> Result<Self> {
        let read = vk::ImageUsageFlags::STORAGE;
        let none = vk::ImageUsageFlags::empty();
        let seen = Image::attachment(gpu, "G-buffer", extent, SEEN, read)?;
        let depth = Image::attachment(gpu, "depth", extent, depth.format(), none)?;
        gpu.submit(|cmd| {
            // The compute shader binds it even where it does not read it.
            seen.transition(cmd, vk::ImageLayout::UNDEFINED, vk::ImageLayout::GENERAL);
            Ok(())
        })?;
        Ok(Self { seen, depth })
    }

    /// Begins to draw: what the images held is of no more use.
    fn begin(&self, frame: &Frame, depth: Depth) {
        use vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};
        let (farthest, _) = depth.farthest();
        let device = &frame.gpu.device;
        let tests = Stage::EARLY_FRAGMENT_TESTS | Stage::LATE_FRAGMENT_TESTS;
        let both = Access::DEPTH_STENCIL_ATTACHMENT_READ | Access::DEPTH_STENCIL_ATTACHMENT_WRITE;
        let barriers = [
            // The last frame's compute shader has read it; drawing waits for that.
            barrier(&self.seen, Layout::UNDEFINED, Layout::ATTACHMENT_OPTIMAL)
                .src_stage_mask(Stage::COMPUTE_SHADER)
                .dst_stage_mask(Stage::COLOR_ATTACHMENT_OUTPUT)
                .dst_access_mask(Access::COLOR_ATTACHMENT_WRITE),
            // The last frame's depth tests have written it.
            barrier(&self.depth, Layout::UNDEFINED, Layout::ATTACHMENT_OPTIMAL)
                .src_stage_mask(tests)
                .src_access_mask(Access::DEPTH_STENCIL_ATTACHMENT_WRITE)
                .dst_stage_mask(tests)
                .dst_access_mask(both),
        ];
        // ANCHOR: rendering
        let clear = vk::ClearColorValue { uint32: NOTHING };
        let colors = [vk::RenderingAttachmentInfo::default()
            .image_view(self.seen.view)
            .image_layout(Layout::ATTACHMENT_OPTIMAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
            .clear_value(vk::ClearValue { color: clear })];
        let farthest = vk::ClearDepthStencilValue { depth: farthest, stencil: 0 };
        let depth = vk::RenderingAttachmentInfo::default()
            .image_view(self.depth.view)
            .image_layout(Layout::ATTACHMENT_OPTIMAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::DONT_CARE)
            .clear_value(vk::ClearValue { depth_stencil: farthest });
        let extent = self.seen.extent;
        let info = vk::RenderingInfo::default()
            .render_area(extent.into())
            .layer_count(1)
            .color_attachments(&colors)
            .depth_attachment(&depth);
        let (width, height) = (extent.width as f32, extent.height as f32);
        let viewport = vk::Viewport { width, height, max_depth: 1.0, ..Default::default() };
        let dependency = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: the images outlive the submission, and rendering is ended by `end`.
        unsafe {
            device.cmd_pipeline_barrier2(frame.cmd, &dependency);
            device.cmd_begin_rendering(frame.cmd, &info);
            // ANCHOR_END: rendering
            device.cmd_set_viewport(frame.cmd, 0, &[viewport]);
            device.cmd_set_scissor(frame.cmd, 0, &[extent.into()]);
        }
    }

    /// Ends drawing: what was drawn becomes visible to the compute shader.
    fn end(&self, frame: &Frame) {
        use vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};
        let drawn = [barrier(&self.seen, Layout::ATTACHMENT_OPTIMAL, Layout::GENERAL)
            .src_stage_mask(Stage::COLOR_ATTACHMENT_OUTPUT)
            .src_access_mask(Access::COLOR_ATTACHMENT_WRITE)
            .dst_stage_mask(Stage::COMPUTE_SHADER)
            .dst_access_mask(Access::SHADER_STORAGE_READ)];
        let dependency = vk::DependencyInfo::default().image_memory_barriers(&drawn);
        // SAFETY: rendering was begun by `begin`, and the image outlives the submission.
        unsafe {
            frame.gpu.device.cmd_end_rendering(frame.cmd);
            frame.gpu.device.cmd_pipeline_barrier2(frame.cmd, &dependency);
        }
    }
}

/// A change of an image's layout, whose stages are still to be named.
fn barrier(
    image: &Image,
    from: vk::ImageLayout,
    to: vk::ImageLayout,
) -> vk::ImageMemoryBarrier2<'_> {
    vk::ImageMemoryBarrier2::default()
        .image(image.handle)
        .subresource_range(image.range())
        .old_layout(from)
        .new_layout(to)
}

/// Two stages, and the formats of what they draw to. There is no vertex input: corners are read by address.
fn pipeline(gpu: &Gpu, _: &TextureTable, depth: Depth) -> Result<GraphicsPipeline> {
    let (_, nearer) = depth.farthest();
    GraphicsPipeline::builder(env!("CARGO_BIN_NAME"))
        .vertex("draw.vert")
        .fragment("draw.frag")
        .color(SEEN)
        .depth(depth.format(), nearer)
        .constant(0, depth)
        .push_constants::<Draw>()
        .build_graphics(gpu)
}
