//! A sample: one chapter's program, and the frame that it renders.

use std::sync::Arc;

use anyhow::Result;
use ash::vk;

use super::variants::Background;
use super::{Controls, Playback, Setup};
use crate::gpu::{Gpu, Image, Requirements};

/// One chapter's program. The order of the items is the order of every chapter's `main.rs`.
pub trait Sample: 'static {
    /// Features and extensions to ask for: the baseline, unless a chapter needs more.
    fn requirements() -> Requirements
    where
        Self: Sized,
    {
        Requirements::ray_tracing()
    }

    /// Makes everything that lasts: scene, pipeline, shader binding table.
    ///
    /// # Errors
    /// If the device or a file is not up to it.
    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self>
    where
        Self: Sized;

    /// Declares the controls. One that brings values of others, as a preset does, sets those; all else that
    /// a change causes belongs in [`Sample::changed`].
    fn controls(&mut self, controls: &mut Controls);

    /// Builds what the controls ask for: called once before the first frame, when all settings are made,
    /// and once before each frame that shows other values.
    ///
    /// # Errors
    /// If it cannot be built. A window tells that and keeps its last picture until something is changed.
    fn changed(&mut self, _: &Gpu) -> Result<()> {
        Ok(())
    }

    /// Records one band of a frame into `frame.cmd`, writing `frame.area` of `frame.image`.
    ///
    /// A frame is as many bands as the device needs to answer in time: what all of them share is to be
    /// made once.
    ///
    /// # Errors
    /// If something is missing and cannot be made.
    fn render(&mut self, frame: &Frame) -> Result<()>;

    /// Whether further frames of an unchanged view improve the picture, as with accumulation.
    ///
    /// Without it, a window at rest renders nothing.
    fn accumulates(&self) -> bool {
        false
    }

    /// Whether a frame whose [`Frame::accumulated`] is 0 shows one sample, found from [`Frame::index`]
    /// alone: then `--samples` gathers them.
    fn gathers(&self) -> bool {
        self.accumulates()
    }

    /// The frame that an animation shows. Time goes on between two pictures: `render` then records what
    /// moves, and [`Sample::changed`] is not called.
    fn playback(&mut self) -> Option<&mut Playback> {
        None
    }

    /// What the chapter itself has to tell after the last frame; part of `--report`.
    ///
    /// # Errors
    /// If it cannot be read back.
    fn report(&self) -> Result<serde_json::Value> {
        Ok(serde_json::Value::Null)
    }
}

/// A frame that is to be rendered: the device, the picture, and where commands go.
pub struct Frame<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// Where commands are recorded.
    pub cmd: vk::CommandBuffer,
    /// Where the picture goes: linear RGBA, four 32-bit floats, layout `GENERAL`.
    pub image: &'a Image,
    /// The band of it that is to be traced: whole rows.
    pub area: vk::Rect2D,
    /// Frames since anything changed: 0 is the first after a start, a resize or a moved control. With
    /// `--samples`, the number of a sample.
    pub index: u32,
    /// How many of the frames before belong to the same picture: all of them, or with `--samples` none, as
    /// each sample is a picture alone.
    pub accumulated: u32,
    /// True before the first band of this frame was traced.
    pub(super) first_band: bool,
    /// Where pipelines are made while the old picture stays: in a window.
    pub(super) background: Option<&'a Arc<Background>>,
}

impl Frame<'_> {
    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.image.extent.width) / f64::from(self.image.extent.height)
    }

    /// The number of the frame that the picture begins with: 0, or with `--samples` this one's.
    pub fn first(&self) -> u32 {
        self.index - self.accumulated
    }

    /// True before the first band of this frame was traced.
    pub fn is_first_band(&self) -> bool {
        self.first_band
    }
}
