//! Develops a picture on the device, as [`Development`] does for a file.

use anyhow::Result;
use ash::vk;
use glam::UVec2;

use crate::app::Development;
use crate::gpu::{Binding, ComputePipeline, Descriptor, Gpu, Image};

crate::shader_struct! {
    /// Push constants of the shader that develops.
    struct Push {
        size: UVec2,
        scale: f32,
        tone: u32,
    }
}

/// Width and height of a workgroup.
const WORKGROUP: [u32; 2] = [8, 8];

/// A pipeline that develops pictures, and the last one it developed.
pub struct Darkroom {
    development: Development,
    pipeline: ComputePipeline,
    developed: Option<Image>,
    gpu: Gpu,
}

impl Darkroom {
    /// A darkroom, if the development changes pictures.
    ///
    /// # Errors
    /// If the device rejects its pipeline.
    pub fn new(gpu: &Gpu, development: Development) -> Result<Option<Self>> {
        if development == Development::default() {
            return Ok(None);
        }
        let pipeline = ComputePipeline::builder("common")
            .compute("develop.comp")
            .workgroup(0, WORKGROUP)
            .binding(Binding::StorageImage)
            .binding(Binding::StorageImage)
            .push_constants::<Push>()
            .build_compute(gpu)?;
        Ok(Some(Self { development, pipeline, developed: None, gpu: gpu.clone() }))
    }

    /// The developed picture.
    ///
    /// # Errors
    /// If memory is short or the device fails.
    pub fn develop(&mut self, picture: &Image) -> Result<&Image> {
        let extent = picture.extent;
        let developed = match self.developed.take().filter(|image| image.extent == extent) {
            Some(image) => image,
            None => Image::storage(&self.gpu, "developed picture", extent)?,
        };
        let push = Push {
            size: UVec2::new(extent.width, extent.height),
            scale: self.development.exposure.exp2(),
            tone: self.development.tone as u32,
        };
        self.gpu.submit(|cmd| {
            let general = vk::ImageLayout::GENERAL;
            for image in [picture, &developed] {
                image.transition(cmd, general, general);
            }
            let descriptors =
                [Descriptor::StorageImage(picture), Descriptor::StorageImage(&developed)];
            self.pipeline.bind(cmd, &descriptors, &push)?;
            self.pipeline.dispatch(cmd, extent.into());
            Ok(())
        })?;
        Ok(self.developed.insert(developed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::{Picture, Tone};
    use crate::gpu::{GpuOptions, Requirements};

    #[test]
    fn the_window_shows_what_the_png_shows() {
        let requirements = Requirements::ray_tracing();
        let gpu = Gpu::new(&GpuOptions { requirements, ..GpuOptions::default() }).unwrap();
        let extent = vk::Extent2D { width: 24, height: 20 };
        let image = Image::storage(&gpu, "picture", extent).unwrap();
        let color = vk::ClearColorValue { float32: [0.3, 2.5, 40.0, 1.0] };
        gpu.submit(|cmd| {
            let general = vk::ImageLayout::GENERAL;
            // SAFETY: the image is in GENERAL and outlives the submission.
            unsafe {
                let ranges = [image.range()];
                gpu.device.cmd_clear_color_image(cmd, image.handle, general, &color, &ranges);
            }
            image.transition(cmd, general, general);
            Ok(())
        })
        .unwrap();
        let read = |image: &Image| Picture {
            width: extent.width,
            height: extent.height,
            pixels: image.read().unwrap(),
        };
        for tone in [Tone::Clamp, Tone::Reinhard, Tone::Aces] {
            let development = Development { exposure: -1.5, tone };
            let expected = development.of(read(&image));
            let mut darkroom = Darkroom::new(&gpu, development).unwrap().unwrap();
            let shown = read(darkroom.develop(&image).unwrap());
            for (one, other) in expected.pixels.iter().zip(&shown.pixels) {
                for (one, other) in one.iter().zip(other) {
                    assert!((one - other).abs() <= 1e-5 * one.abs(), "{tone:?}: {one}, {other}");
                }
            }
        }
        assert!(Darkroom::new(&gpu, Development::default()).unwrap().is_none());
    }
}
