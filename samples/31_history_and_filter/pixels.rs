//! The state of every pixel, from frame to frame.

use anyhow::Result;
use common::gpu::{Address, Buffer, Gpu};
use common::scene::input_usage;
use glam::{UVec2, Vec3};

common::shader_struct! {
    /// The surface that a pixel sees.
    pub struct Seen {
        position: Vec3,
        normal: u32,
        rest: u32,
    }
}

common::shader_struct! {
    /// The light of a pixel, and its scatter.
    pub struct Estimate {
        light: Vec3,
        square: f32,
    }
}

common::shader_struct! {
    /// The addresses of the buffers.
    pub struct PixelAddresses {
        surfaces: Address<Seen>,
        estimates: Address<Estimate>,
        last_surfaces: Address<Seen>,
        last_estimates: Address<Estimate>,
        colors: Address<u32>,
        /// The size of the picture.
        pub size: UVec2,
    }
}

/// The buffers of all pixels: 92 bytes each.
pub struct Pixels {
    /// Their number, across and down.
    pub size: UVec2,
    /// This frame's estimates, and the last one's, which the filter overwrites.
    estimates: [Buffer; 2],
    /// For the filter.
    spare: Buffer,
    /// The addresses for frames of even and of odd numbers, which exchange this frame's buffers and the last one's.
    addresses: [Buffer; 2],
    is_odd: bool,
    _others: [Buffer; 3],
}

impl Pixels {
    /// The buffers for a picture.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, size: UVec2) -> Result<Self> {
        let count = u64::from(size.x) * u64::from(size.y);
        let buffer = |name: &str, stride: usize| {
            Buffer::new(gpu, name, count * stride as u64, input_usage())
        };
        let estimate = |name| buffer(name, size_of::<Estimate>());
        let estimates = [estimate("even estimates")?, estimate("odd estimates")?];
        let even = buffer("even surfaces", size_of::<Seen>())?;
        let odd = buffer("odd surfaces", size_of::<Seen>())?;
        let colors = buffer("colors", size_of::<u32>())?;
        let addresses = |now: usize| {
            let surfaces = [even.address, odd.address];
            let addresses = PixelAddresses {
                surfaces: surfaces[now].into(),
                estimates: estimates[now].address.into(),
                last_surfaces: surfaces[1 - now].into(),
                last_estimates: estimates[1 - now].address.into(),
                colors: colors.address.into(),
                size,
            };
            Buffer::with_data(gpu, "pixel addresses", &[addresses], input_usage())
        };
        Ok(Self {
            size,
            addresses: [addresses(0)?, addresses(1)?],
            estimates,
            spare: estimate("filtered")?,
            is_odd: false,
            _others: [even, odd, colors],
        })
    }

    /// The addresses for this frame.
    pub fn addresses(&self) -> Address<PixelAddresses> {
        self.addresses[usize::from(self.is_odd)].address.into()
    }

    /// Two buffers that the filter may overwrite: the last frame's estimates, and one more.
    pub fn for_filter(&self) -> [Address<Estimate>; 2] {
        [&self.estimates[usize::from(!self.is_odd)], &self.spare].map(|one| one.address.into())
    }

    /// This frame's buffers become the last one's.
    pub fn swap(&mut self) {
        self.is_odd = !self.is_odd;
    }
}
