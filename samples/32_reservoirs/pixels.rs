//! The state of every pixel, from frame to frame.

use anyhow::Result;
use common::gpu::{Address, Buffer, Gpu};
use common::scene::input_usage;
use glam::{UVec2, Vec3};

common::shader_struct! {
    /// A place that light arrives at.
    pub struct Receiver {
        from: Vec3,
        normal: u32,
        face: u32,
    }
}

common::shader_struct! {
    /// One sample of many, and how many it speaks for.
    pub struct Reservoir {
        emitter: u32,
        at: u32,
        weight: f32,
        count: u32,
    }
}

common::shader_struct! {
    /// The addresses of the buffers.
    pub struct PixelAddresses {
        receivers: Address<Receiver>,
        last_receivers: Address<Receiver>,
        fresh: Address<Reservoir>,
        kept: Address<Reservoir>,
        colors: Address<Vec3>,
        means: Address<Vec3>,
        /// The size of the picture.
        pub size: UVec2,
    }
}

/// The buffers of all pixels: 96 bytes each.
pub struct Pixels {
    /// Their number, across and down.
    pub size: UVec2,
    /// The addresses for frames of even and of odd numbers, which exchange this frame's receivers and the last one's.
    addresses: [Buffer; 2],
    is_odd: bool,
    _others: [Buffer; 6],
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
        let others = [
            buffer("even receivers", size_of::<Receiver>())?,
            buffer("odd receivers", size_of::<Receiver>())?,
            buffer("fresh reservoirs", size_of::<Reservoir>())?,
            buffer("kept reservoirs", size_of::<Reservoir>())?,
            buffer("colors", size_of::<Vec3>())?,
            buffer("means", size_of::<Vec3>())?,
        ];
        let addresses = |now: usize| {
            let addresses = PixelAddresses {
                receivers: others[now].address.into(),
                last_receivers: others[1 - now].address.into(),
                fresh: others[2].address.into(),
                kept: others[3].address.into(),
                colors: others[4].address.into(),
                means: others[5].address.into(),
                size,
            };
            Buffer::with_data(gpu, "pixel addresses", &[addresses], input_usage())
        };
        Ok(Self { size, addresses: [addresses(0)?, addresses(1)?], is_odd: false, _others: others })
    }

    /// The addresses for this frame.
    pub fn addresses(&self) -> Address<PixelAddresses> {
        self.addresses[usize::from(self.is_odd)].address.into()
    }

    /// This frame's receivers become the last one's.
    pub fn swap(&mut self) {
        self.is_odd = !self.is_odd;
    }
}
