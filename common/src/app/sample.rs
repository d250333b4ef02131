//! A sample: one chapter's program, and the frame that it renders.

use std::sync::Arc;

use anyhow::Result;
use ash::vk;

use super::variants::Background;
use super::{Controls, Playback, Setup};
use crate::gpu::{Gpu, Image, Requirements};

/// One chapter's program. The order of the items is the order of every chapter's `main.rs`.
pub trait Sample: 'static {
    /// Features and extensions to enable: the baseline, unless a chapter needs more.
    fn requirements() -> Requirements
    where
        Self: Sized,
    {
        Requirements::ray_tracing()
    }

    /// Creates everything that lasts: scene, pipeline, shader binding table.
    ///
    /// # Errors
    /// If the device lacks something, or a file is missing or wrong.
    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self>
    where
        Self: Sized;

    /// Declares the controls. One that sets others, as a preset does, does so here; all other consequences of a
    /// change belong in [`Sample::changed`].
    fn controls(&mut self, controls: &mut Controls);

    /// Builds what depends on the controls: called once before the first frame, after all settings, and once
    /// before each frame with changed values.
    ///
    /// # Errors
    /// If building fails. A window shows the error and keeps its last picture until something changes.
    fn changed(&mut self, _: &Gpu) -> Result<()> {
        Ok(())
    }

    /// Records one band of a frame into `frame.cmd`, writing `frame.area` of `frame.image`.
    ///
    /// A frame consists of as many bands as the device needs to stay responsive, so anything shared by all of them
    /// should be made once.
    ///
    /// # Errors
    /// If something is missing and cannot be made.
    fn render(&mut self, frame: &Frame) -> Result<()>;

    /// The passes over the whole picture that follow its last band, by name: the panel shows the time of each.
    fn passes(&self) -> Vec<&'static str> {
        Vec::new()
    }

    /// Records one of these passes into `frame.cmd`. Each is a submission of its own, after everything that bands and
    /// earlier passes wrote.
    ///
    /// # Errors
    /// If something is missing and cannot be made.
    fn pass(&mut self, _frame: &Frame, _number: u32) -> Result<()> {
        Ok(())
    }

    /// True if further frames of an unchanged view improve the picture, as with accumulation.
    ///
    /// Otherwise an idle window renders nothing.
    fn accumulates(&self) -> bool {
        false
    }

    /// Forgets the light of earlier frames, if the sample has any; then true. The next frame begins a new picture,
    /// which a [`Frame::index`] of 0 does not: the camera may have moved.
    fn forget(&mut self) -> bool {
        false
    }

    /// True if a frame whose [`Frame::accumulated`] is 0 shows one sample that depends on [`Frame::index`] alone;
    /// `--samples` can then sum them.
    fn gathers(&self) -> bool {
        self.accumulates()
    }

    /// The frame of an animation. Between two pictures, time advances: `render` then records whatever moves, and
    /// [`Sample::changed`] is not called.
    fn playback(&mut self) -> Option<&mut Playback> {
        None
    }

    /// The chapter's own part of `--report`, after the last frame.
    ///
    /// # Errors
    /// If it cannot be read back.
    fn report(&self) -> Result<serde_json::Value> {
        Ok(serde_json::Value::Null)
    }
}

/// A frame to render: the device, the image, and the command buffer.
pub struct Frame<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// The command buffer to record into.
    pub cmd: vk::CommandBuffer,
    /// The image to write: linear RGBA, four 32-bit floats, layout `GENERAL`.
    pub image: &'a Image,
    /// The band of it to trace: whole rows.
    pub area: vk::Rect2D,
    /// Frames since anything changed: 0 is the first after a start, a resize or a moved control. With
    /// `--samples`, the number of a sample.
    pub index: u32,
    /// Number of earlier frames that belong to the same picture: all of them, or none with `--samples`, where each
    /// sample is a separate picture.
    pub accumulated: u32,
    /// True before the first band of this frame was traced.
    pub(super) first_band: bool,
    /// In a window: builds pipelines in the background while the old picture stays.
    pub(super) background: Option<&'a Arc<Background>>,
}

impl Frame<'_> {
    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.image.extent.width) / f64::from(self.image.extent.height)
    }

    /// The number of the first frame of the picture: 0, or this one's with `--samples`.
    pub fn first(&self) -> u32 {
        self.index - self.accumulated
    }

    /// True before the first band of this frame was traced.
    pub fn is_first_band(&self) -> bool {
        self.first_band
    }
}
