//! Light with history: the last frame, and whether its light may be used again.

use anyhow::Result;
use ash::vk;
use bytemuck::Zeroable;
use common::Frame;
use common::gpu::{Address, Buffer, Gpu, ShaderStruct, StructLayout, barrier};
use common::scene::{Camera, CameraBasis, input_usage};
use effects::Composition;
use glam::{Affine3A, UVec2};

use crate::back::Back;
use crate::pixels::{Estimate, PixelAddresses, Pixels, Seen};
use crate::recipe::Recipe;
use crate::world::{Board, World};

common::shader_struct! {
    /// The last frame, as far as this one needs it.
    pub struct Past {
        camera: CameraBasis,
        pixels: Address<PixelAddresses>,
        back: Address<Back>,
        back_count: u32,
        memory: u32,
        stands: u32,
        divide: u32,
        rounding: f32,
    }
}

/// Layouts of the structures behind its addresses.
pub const LAYOUTS: [StructLayout; 5] =
    [Past::LAYOUT, PixelAddresses::LAYOUT, Seen::LAYOUT, Estimate::LAYOUT, Back::LAYOUT];

/// The longest history, in frames: as in 31 while something moves, and as long as a pixel can count while all stands.
const MEMORY: [u32; 2] = [32, 255];
/// The most frames that a window leaves out and still goes on with its history: a quarter of a second.
const MAX_STEP: u32 = 15;

/// The state from frame to frame.
pub struct History {
    /// A [`Past`].
    pub past: Buffer,
    /// The state of pixels, and the motion of each placed mesh; `None` where nothing moves.
    state: Option<(Pixels, Buffer)>,
    /// The last complete frame, and the one whose rays are traced.
    done: Option<Done>,
    next: Option<Done>,
}

/// A frame, as far as the next one needs to know it.
struct Done {
    recipe: Recipe,
    /// The world, without what follows from the camera.
    world: World,
    camera: Camera,
    places: Vec<Affine3A>,
    number: u32,
    /// Number of frames since the history began.
    age: u32,
}

impl Done {
    /// Tests whether a frame may use this one's light: nothing but camera and time has changed, and neither has jumped.
    fn goes_on_to(&self, next: &Self) -> bool {
        self.recipe == next.recipe
            && bytemuck::bytes_of(&self.world) == bytemuck::bytes_of(&next.world)
            && self.places.len() == next.places.len()
            && !next.camera.is_cut_from(&self.camera)
            && next.number.wrapping_sub(self.number) <= MAX_STEP
    }
}

impl History {
    /// No history yet.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu) -> Result<Self> {
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let past = Buffer::new(gpu, "past", size_of::<Past>() as u64, usage)?;
        Ok(Self { past, state: None, done: None, next: None })
    }

    /// Forgets the light of earlier frames; returns whether there is any.
    pub fn forget(&mut self) -> bool {
        (self.done, self.next) = (None, None);
        self.state.is_some()
    }

    /// Frames whose light the last one holds.
    pub fn is_full(&self) -> bool {
        self.done.as_ref().is_some_and(|done| done.age >= MEMORY[1])
    }

    /// Records that a frame without history follows.
    ///
    /// # Errors
    /// If the device fails.
    pub fn none(&mut self, frame: &Frame) -> Result<()> {
        (self.state, self.done, self.next) = (None, None, None);
        self.past.update(frame.cmd, &[Past::zeroed()])
    }

    /// Records the past of a frame, and returns the number of frames since its history began.
    ///
    /// # Errors
    /// If the device fails, or memory is short.
    pub fn begin(
        &mut self,
        frame: &Frame,
        scene: &Composition,
        recipe: Recipe,
        camera: &Camera,
        (world, number, rounding): (World, u32, f32),
    ) -> Result<u32> {
        let (gpu, extent) = (frame.gpu, frame.image.extent);
        let size = UVec2::new(extent.width, extent.height);
        let places: Vec<_> = scene.scene.instances.iter().map(|placed| placed.transform).collect();
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let bytes = (places.len().max(1) * size_of::<Back>()) as u64;
        let state = self.state.take();
        let state = state.filter(|(pixels, back)| pixels.size == size && back.size == bytes);
        let (pixels, back) = match state {
            Some(state) => state,
            None => {
                self.done = None;
                (Pixels::new(gpu, size)?, Buffer::new(gpu, "back", bytes, usage)?)
            }
        };
        // A history survives what follows from the camera alone.
        let board = Board { anchor: Zeroable::zeroed(), ..world.board };
        let world =
            World { plane: Zeroable::zeroed(), board, media: [0; 4], first_sample: 0, ..world };
        let mut next = Done { recipe, world, camera: *camera, places, number, age: 0 };
        let last = self.done.as_ref().filter(|done| done.goes_on_to(&next));
        next.age = last.map_or(0, |done| done.age.saturating_add(1));
        let before = last.unwrap_or(&next);
        let ways: Vec<_> = next
            .places
            .iter()
            .zip(&before.places)
            .map(|(now, last)| Back::new(now, last))
            .collect();
        let stands = last.is_some() && before.places == next.places && before.camera == next.camera;
        let past = Past {
            camera: before.camera.basis(frame.aspect()),
            pixels: pixels.addresses(),
            back: back.address.into(),
            back_count: ways.len() as u32,
            memory: if last.is_some() { MEMORY[usize::from(stands)] } else { 1 },
            stands: stands.into(),
            // Only of one surface is there one colour.
            divide: (scene.samples == 1 && scene.lens.diameter == 0.0 && scene.moving() == 0)
                .into(),
            rounding,
        };
        // The last frame has read what this one writes.
        barrier::trace_to_trace(gpu, frame.cmd);
        if !ways.is_empty() {
            back.update(frame.cmd, &ways)?;
        }
        self.past.update(frame.cmd, &[past])?;
        let age = next.age;
        (self.state, self.next) = (Some((pixels, back)), Some(next));
        Ok(age)
    }

    /// Ends a band. After the last one, this frame becomes the last frame, if its own pipeline has traced it.
    pub fn end(&mut self, frame: &Frame, is_own: bool) {
        let (area, extent) = (frame.area, frame.image.extent);
        if area.offset.y as u32 + area.extent.height < extent.height {
            return;
        }
        self.done = self.next.take().filter(|_| is_own);
        if let Some((pixels, _)) = &mut self.state {
            pixels.swap();
        }
    }
}
