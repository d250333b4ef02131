//! The passes after the trace: history, variance, filter, composition.

use anyhow::Result;
use common::gpu::{Address, Binding, ComputePipeline, Descriptor, Gpu, TextureTable, barrier};
use common::scene::{CameraBasis, SceneAddresses};
use common::{Frame, Variant, Variants};
use glam::Vec3;

use super::back::Back;
use super::levels::Levels;
use super::pixels::{Estimate, PixelAddresses, Pixels};

common::shader_enum! {
    /// The quantity shown per pixel.
    pub enum Show: SHOW {
        Picture, Light, Length = "history length", Deviation, Refused, Movement, Hit,
    }
}

/// Specialization constants of the pass that takes the history over.
#[derive(Clone, Copy, PartialEq)]
pub struct Tests {
    pub show: Show,
    pub follow: bool,
    pub instance: bool,
    pub plane: bool,
    pub normal: bool,
}

common::shader_struct! {
    /// Push constants of `history.comp`.
    struct History {
        camera: CameraBasis,
        pixels: Address<PixelAddresses>,
        back: Address<Back>,
        memory: u32,
        rounding: f32,
    }
}

common::shader_struct! {
    /// A camera, as far as the filter needs it.
    pub struct Eye {
        origin: Vec3,
        /// The distance between the rays of two neighbours, at distance 1.
        apart: f32,
    }
}

common::shader_struct! {
    /// Push constants of `variance.comp`.
    struct Variance {
        eye: Eye,
        pixels: Address<PixelAddresses>,
        to: Address<Estimate>,
    }
}

common::shader_struct! {
    /// Push constants of `filter.comp`.
    struct Filter {
        eye: Eye,
        pixels: Address<PixelAddresses>,
        from: Address<Estimate>,
        to: Address<Estimate>,
        apart: u32,
    }
}

common::shader_struct! {
    /// Push constants of `compose.comp`.
    struct Compose {
        scene: SceneAddresses,
        pixels: Address<PixelAddresses>,
        from: Address<Estimate>,
        memory: u32,
    }
}

/// The inputs of the passes besides the pixels.
pub struct Given<'a> {
    pub levels: &'a Levels,
    pub pixels: &'a Pixels,
    pub camera: CameraBasis,
    /// The camera of the last frame.
    pub before: CameraBasis,
    pub tests: Tests,
    /// The longest history, in frames; 1 for none.
    pub memory: u32,
    /// The length of a history that is shown as white.
    pub white: u32,
    /// Number of passes of the filter.
    pub filters: u32,
}

/// The pipelines of all passes.
#[derive(Default)]
pub struct Passes {
    history: Variants<Tests, ComputePipeline>,
    variance: Variants<(), ComputePipeline>,
    filter: Variants<(), ComputePipeline>,
    compose: Variants<Show, ComputePipeline>,
}

/// Number of passes, with so many of the filter.
pub fn count(filters: u32) -> u32 {
    3 + filters
}

/// The names of the passes.
pub fn names(filters: u32) -> Vec<&'static str> {
    let filters = vec!["filter"; filters as usize];
    [vec!["history", "variance"], filters, vec!["compose"]].concat()
}

impl Passes {
    /// Records a pass: the history, the variance, so many of the filter, and the composition. Returns the tests of the
    /// history: in a window, these may be those of the old controls.
    ///
    /// # Errors
    /// If its pipeline cannot be built.
    pub fn record(&mut self, frame: &Frame, number: u32, given: &Given) -> Result<Tests> {
        let scene = &given.levels.scene;
        let (textures, pixels) = (&scene.textures, given.pixels.addresses());
        let apart = 2.0 * given.camera.right.length() / given.pixels.size.x as f32;
        let eye = Eye { origin: given.camera.origin, apart };
        // Variance and filter go to the one and to the other in turns.
        let for_filter = given.pixels.for_filter();
        let between = |number: u32| for_filter[number as usize % 2];
        let picture = [Descriptor::StorageImage(frame.image)];
        let mut used = given.tests;
        // ANCHOR: passes
        // This pass reads the results of the one before.
        barrier::trace_to_trace(frame.gpu, frame.cmd);
        if number == 0 {
            let history = History {
                camera: given.before,
                pixels,
                back: given.levels.back.address.into(),
                memory: given.memory,
                rounding: given.levels.rounding,
            };
            let Variant { pipeline, key, .. } =
                self.history.choose(frame, textures, given.tests, history_pass)?;
            used = *key;
            pipeline.bind(frame.cmd, &picture, &history)?;
            pipeline.dispatch(frame.cmd, frame.area);
        } else if number == 1 {
            let Variant { pipeline, .. } =
                self.variance.choose(frame, textures, (), variance_pass)?;
            pipeline.bind(frame.cmd, &[], &Variance { eye, pixels, to: between(0) })?;
            pipeline.dispatch(frame.cmd, frame.area);
        } else if number < 2 + given.filters {
            let pass = number - 2;
            let filter = Filter {
                eye,
                pixels,
                from: between(pass),
                to: between(pass + 1),
                apart: 1 << pass,
            };
            let Variant { pipeline, .. } = self.filter.choose(frame, textures, (), filter_pass)?;
            pipeline.bind(frame.cmd, &[], &filter)?;
            pipeline.dispatch(frame.cmd, frame.area);
        } else {
            let from = between(given.filters);
            let Variant { pipeline, .. } =
                self.compose.choose(frame, textures, given.tests.show, compose_pass)?;
            let memory = given.white;
            let compose = Compose { scene: scene.addresses, pixels, from, memory };
            pipeline.bind(frame.cmd, &picture, &compose)?;
            pipeline.dispatch(frame.cmd, frame.area);
        }
        // ANCHOR_END: passes
        Ok(used)
    }
}

fn history_pass(gpu: &Gpu, _: &TextureTable, tests: Tests) -> Result<ComputePipeline> {
    ComputePipeline::builder(env!("CARGO_BIN_NAME"))
        .compute("history.comp")
        .workgroup(0, [8, 8])
        .constant(2, tests.show)
        .constant(3, tests.instance)
        .constant(4, tests.plane)
        .constant(5, tests.normal)
        .constant(6, tests.follow)
        .binding(Binding::StorageImage)
        .push_constants::<History>()
        .build_compute(gpu)
}

fn variance_pass(gpu: &Gpu, _: &TextureTable, (): ()) -> Result<ComputePipeline> {
    ComputePipeline::builder(env!("CARGO_BIN_NAME"))
        .compute("variance.comp")
        .workgroup(0, [8, 8])
        .push_constants::<Variance>()
        .build_compute(gpu)
}

fn filter_pass(gpu: &Gpu, _: &TextureTable, (): ()) -> Result<ComputePipeline> {
    ComputePipeline::builder(env!("CARGO_BIN_NAME"))
        .compute("filter.comp")
        .workgroup(0, [8, 8])
        .push_constants::<Filter>()
        .build_compute(gpu)
}

fn compose_pass(gpu: &Gpu, _: &TextureTable, show: Show) -> Result<ComputePipeline> {
    ComputePipeline::builder(env!("CARGO_BIN_NAME"))
        .compute("compose.comp")
        .workgroup(0, [8, 8])
        .constant(2, show)
        .binding(Binding::StorageImage)
        .push_constants::<Compose>()
        .build_compute(gpu)
}
