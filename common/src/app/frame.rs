//! What a frame is rendered with.

use std::sync::Arc;

use ash::vk;

use super::variants::Background;
use crate::gpu::{Gpu, Image};

/// What a frame is rendered with.
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
    /// Whether no band of this frame was traced yet.
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

    /// Whether no band of this frame was traced yet.
    pub fn is_first_band(&self) -> bool {
        self.first_band
    }
}
