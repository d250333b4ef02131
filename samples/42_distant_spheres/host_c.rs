//! The constant term of each sphere's quadratic for rays from the eye, computed on the host.

use anyhow::Result;
use ash::vk;
use common::Frame;
use common::gpu::{Address, Buffer};
use common::scene::input_usage;
use glam::Vec3;

use super::shapes::Sphere;

/// |eye - center|² - radius² of each sphere, for the eye of the last frame that needed it.
pub struct HostC {
    spheres: Vec<Sphere>,
    known: Option<(Vec3, Buffer)>,
}

impl HostC {
    pub fn new(spheres: Vec<Sphere>) -> Self {
        Self { spheres, known: None }
    }

    /// Computes it for an eye: products and sums of f32 numbers, in f64.
    pub fn compute(&mut self, frame: &Frame, eye: Vec3) -> Result<()> {
        if self.known.as_ref().is_some_and(|(known, _)| *known == eye) {
            return Ok(());
        }
        let c = self.spheres.iter().map(|sphere| {
            let radius = f64::from(sphere.radius);
            let distance = (eye.as_dvec3() - sphere.center.as_dvec3()).length();
            ((distance - radius) * (distance + radius)) as f32
        });
        let c: Vec<f32> = c.collect();
        let buffer = match self.known.take() {
            Some((_, buffer)) => buffer,
            None => {
                let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
                Buffer::new(frame.gpu, "c of spheres", 4 * c.len() as u64, usage)?
            }
        };
        buffer.update(frame.cmd, &c)?;
        self.known = Some((eye, buffer));
        Ok(())
    }

    /// The address of the numbers, null before they are computed.
    pub fn address(&self) -> Address {
        self.known.as_ref().map_or(0, |(_, buffer)| buffer.address).into()
    }
}
