//! The images of a window: acquired, drawn to, presented, and recreated when the window changes.

use anyhow::{Context, Result};
use ash::{khr, vk};

use super::{Gpu, Vulkan, WindowHandles};

/// Timeout for acquiring an image, in nanoseconds; a hidden window may provide none as long as it is hidden.
const PATIENCE: u64 = 100_000_000;

/// 8-bit sRGB formats, each with the UNORM format of the same bits.
const FORMATS: [(vk::Format, vk::Format); 3] = [
    (vk::Format::B8G8R8A8_SRGB, vk::Format::B8G8R8A8_UNORM),
    (vk::Format::R8G8B8A8_SRGB, vk::Format::R8G8B8A8_UNORM),
    (vk::Format::A8B8G8R8_SRGB_PACK32, vk::Format::A8B8G8R8_UNORM_PACK32),
];

/// 10-bit formats in sRGB, the only ones on some desktops. They have no sibling that converts.
const DEEP_FORMATS: [vk::Format; 2] =
    [vk::Format::A2B10G10R10_UNORM_PACK32, vk::Format::A2R10G10B10_UNORM_PACK32];

/// A `VkSwapchainKHR` and its surface, destroyed on drop; drop it before its window.
pub struct Swapchain {
    /// The format in which a copy converts linear colour to the window's encoding.
    pub srgb: vk::Format,
    /// The same bits without conversion.
    pub unorm: vk::Format,
    /// True if the images have more than 8 bits: then blit `unorm` to them; otherwise copy either format.
    pub deep: bool,
    window: WindowHandles,
    surfaces: khr::surface::Instance,
    swapchains: khr::swapchain::Device,
    surface: vk::SurfaceKHR,
    handle: vk::SwapchainKHR,
    extent: vk::Extent2D,
    stale: bool,
    /// True if new images of this size were no better: a window system may report any as suboptimal for ever.
    resigned: bool,
    images: Vec<vk::Image>,
    /// One per image: presentation may still wait for it while another image is drawn.
    drawn: Vec<vk::Semaphore>,
    acquired: vk::Semaphore,
    gpu: Gpu,
}

/// An image of the window to copy a picture to; its contents are undefined.
#[derive(Clone, Copy)]
pub struct Acquired {
    /// The Vulkan handle.
    pub image: vk::Image,
    /// Wait for this before the copy.
    pub before: vk::Semaphore,
    /// Signal this after the copy.
    pub after: vk::Semaphore,
    index: u32,
}

impl Swapchain {
    /// A swapchain for a window that `gpu` was made for; it has no images until [`Swapchain::fit`].
    ///
    /// # Errors
    /// If the window supports no sRGB colour of 8 or 10 bits.
    pub fn new(gpu: &Gpu, window: WindowHandles) -> Result<Self> {
        let mut swapchain = Self {
            srgb: vk::Format::UNDEFINED,
            unorm: vk::Format::UNDEFINED,
            deep: false,
            window,
            surfaces: khr::surface::Instance::new(&gpu.vulkan.entry, &gpu.vulkan.instance),
            swapchains: khr::swapchain::Device::new(&gpu.vulkan.instance, &gpu.device),
            surface: vk::SurfaceKHR::null(),
            handle: vk::SwapchainKHR::null(),
            extent: vk::Extent2D::default(),
            stale: true,
            resigned: false,
            images: Vec::new(),
            drawn: Vec::new(),
            acquired: vk::Semaphore::null(),
            gpu: gpu.clone(),
        };
        // SAFETY: the device is alive; the semaphore is destroyed on drop.
        swapchain.acquired = unsafe { gpu.device.create_semaphore(&Default::default(), None)? };
        gpu.name_object(swapchain.acquired, "image acquired");
        swapchain.make_surface()?;
        let (format, (srgb, unorm)) = swapchain.format()?;
        (swapchain.srgb, swapchain.unorm) = (srgb, unorm);
        swapchain.deep = DEEP_FORMATS.contains(&format);
        Ok(swapchain)
    }

    /// Makes the images as large as the window, if they are not yet, and returns their size.
    ///
    /// `wanted` is used if the window system lets the program choose the size. `None` while the window has no
    /// area, for example minimised, or if it has just changed: an event reports both.
    ///
    /// # Errors
    /// If the window system or the device fails.
    pub fn fit(&mut self, wanted: vk::Extent2D) -> Result<Option<vk::Extent2D>> {
        // If the surface was lost while its images were created, a new one has replaced it by now.
        for _ in 0..2 {
            let Some((capabilities, extent)) = self.size(wanted)? else { return Ok(None) };
            let fits = !self.stale && extent == self.extent;
            if fits || self.make(&capabilities, extent)? {
                return Ok(Some(extent));
            }
        }
        Ok(None)
    }

    /// The surface's capabilities, and the required size of its images; `None` while the window has no area.
    fn size(
        &mut self,
        wanted: vk::Extent2D,
    ) -> Result<Option<(vk::SurfaceCapabilitiesKHR, vk::Extent2D)>> {
        let capabilities = match self.capabilities() {
            Err(vk::Result::ERROR_SURFACE_LOST_KHR) => {
                self.make_surface()?;
                self.capabilities()
            }
            other => other,
        }
        .context("cannot ask for the window's size")?;
        let (least, most) = (capabilities.min_image_extent, capabilities.max_image_extent);
        let extent = match capabilities.current_extent {
            vk::Extent2D { width: u32::MAX, .. } => vk::Extent2D {
                width: wanted.width.clamp(least.width, most.width),
                height: wanted.height.clamp(least.height, most.height),
            },
            current => current,
        };
        Ok((extent.width > 0 && extent.height > 0).then_some((capabilities, extent)))
    }

    /// The next image, or `None` if none is available now: try again after [`Swapchain::fit`].
    ///
    /// # Errors
    /// If the device was lost.
    pub fn acquire(&mut self) -> Result<Option<Acquired>> {
        // SAFETY: `fit` has made the swapchain; no earlier acquire is pending on the semaphore, because
        // every acquired image's work has been waited for.
        let result = unsafe {
            let fence = vk::Fence::null();
            self.swapchains.acquire_next_image(self.handle, PATIENCE, self.acquired, fence)
        };
        match result {
            Ok((index, suboptimal)) => {
                self.stale |= suboptimal && !self.resigned;
                Ok(Some(Acquired {
                    image: self.images[index as usize],
                    before: self.acquired,
                    after: self.drawn[index as usize],
                    index,
                }))
            }
            Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) => Ok(None),
            Err(error) => self.outdated(error).map(|()| None),
        }
    }

    /// Presents an image that was drawn to and left in `PRESENT_SRC_KHR`; returns true if it was shown. It may not
    /// be if the window has changed.
    ///
    /// # Errors
    /// If the device was lost.
    pub fn present(&mut self, acquired: Acquired) -> Result<bool> {
        let (wait, handles, indices) = ([acquired.after], [self.handle], [acquired.index]);
        let info = vk::PresentInfoKHR::default()
            .wait_semaphores(&wait)
            .swapchains(&handles)
            .image_indices(&indices);
        // SAFETY: the image was acquired from this swapchain, and its semaphore is signalled.
        match unsafe { self.swapchains.queue_present(self.gpu.queue, &info) } {
            Ok(suboptimal) => {
                self.stale |= suboptimal && !self.resigned;
                Ok(true)
            }
            Err(error) => self.outdated(error).map(|()| false),
        }
    }

    /// True if new images are needed: [`Swapchain::fit`] creates them.
    pub fn is_stale(&self) -> bool {
        self.stale
    }

    fn outdated(&mut self, error: vk::Result) -> Result<()> {
        match error {
            vk::Result::ERROR_OUT_OF_DATE_KHR => self.stale = true,
            vk::Result::ERROR_SURFACE_LOST_KHR => self.make_surface()?,
            error => return Err(error).context("cannot draw to the window"),
        }
        Ok(())
    }

    fn capabilities(&self) -> ash::prelude::VkResult<vk::SurfaceCapabilitiesKHR> {
        // SAFETY: the surface is alive and supported by the device, here and below.
        unsafe {
            self.surfaces
                .get_physical_device_surface_capabilities(self.gpu.physical_device, self.surface)
        }
    }

    /// The window's format, and the pair that it belongs to or, for 10 bits, the pair to blit from.
    fn format(&self) -> Result<(vk::Format, (vk::Format, vk::Format))> {
        // SAFETY: as above.
        let offered = unsafe {
            self.surfaces
                .get_physical_device_surface_formats(self.gpu.physical_device, self.surface)?
        };
        let has = |format: vk::Format| {
            offered.iter().any(|offer| {
                offer.format == format && offer.color_space == vk::ColorSpaceKHR::SRGB_NONLINEAR
            })
        };
        let pair = FORMATS.into_iter().find(|&(srgb, unorm)| has(srgb) || has(unorm));
        if let Some((srgb, unorm)) = pair {
            return Ok((if has(srgb) { srgb } else { unorm }, (srgb, unorm)));
        }
        let blit = |&format: &vk::Format| {
            let (instance, device) = (&self.gpu.vulkan.instance, self.gpu.physical_device);
            // SAFETY: as above.
            let known = unsafe { instance.get_physical_device_format_properties(device, format) };
            known.optimal_tiling_features.contains(vk::FormatFeatureFlags::BLIT_DST)
        };
        let deep = DEEP_FORMATS.into_iter().filter(|&format| has(format)).find(blit);
        deep.map(|format| (format, FORMATS[0])).context(
            "this window shows no sRGB colour of 8 bits, nor one of 10 that the device can blit to: add \
             --headless to render without it",
        )
    }

    fn make_surface(&mut self) -> Result<()> {
        self.destroy();
        let Vulkan { entry, instance, .. } = &self.gpu.vulkan;
        let WindowHandles { display, window } = self.window;
        // SAFETY: the caller of `new` keeps the window alive longer.
        self.surface =
            unsafe { ash_window::create_surface(entry, instance, display, window, None) }
                .context("cannot draw to the window")?;
        (self.stale, self.extent) = (true, vk::Extent2D::default());
        Ok(())
    }

    /// Creates the images; `false` if the window has changed since its capabilities were queried.
    fn make(
        &mut self,
        capabilities: &vk::SurfaceCapabilitiesKHR,
        extent: vk::Extent2D,
    ) -> Result<bool> {
        let alpha = [vk::CompositeAlphaFlagsKHR::OPAQUE, vk::CompositeAlphaFlagsKHR::INHERIT]
            .into_iter()
            .find(|&flag| capabilities.supported_composite_alpha.contains(flag))
            .unwrap_or(vk::CompositeAlphaFlagsKHR::PRE_MULTIPLIED);
        let old = self.handle;
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(self.surface)
            // Each additional image would be one more picture in the queue, showing older input.
            .min_image_count(capabilities.min_image_count)
            .image_format(self.format()?.0)
            .image_color_space(vk::ColorSpaceKHR::SRGB_NONLINEAR)
            .image_extent(extent)
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::TRANSFER_DST)
            .image_sharing_mode(vk::SharingMode::EXCLUSIVE)
            .pre_transform(capabilities.current_transform)
            .composite_alpha(alpha)
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(true)
            .old_swapchain(old);
        // SAFETY: the surface is alive; the old swapchain is retired here and destroyed below, once the
        // queue has presented its last image.
        unsafe {
            let made = self.swapchains.create_swapchain(&info, None);
            // The old one is retired even if creation fails.
            self.destroy_images()?;
            self.stale = true;
            let handle = match made {
                Ok(handle) => handle,
                Err(error) => return self.outdated(error).map(|()| false),
            };
            self.handle = handle;
            self.images = self.swapchains.get_swapchain_images(handle)?;
            for &image in &self.images {
                self.gpu.name_object(image, "image of the window");
                let semaphore = self.gpu.device.create_semaphore(&Default::default(), None)?;
                self.gpu.name_object(semaphore, "image drawn");
                self.drawn.push(semaphore);
            }
        }
        self.resigned = extent == self.extent;
        self.extent = extent;
        self.stale = false;
        Ok(true)
    }

    fn destroy_images(&mut self) -> Result<()> {
        let idle = self.gpu.wait_for_queue();
        // SAFETY: a queue that is idle, or whose device is lost, uses neither image nor semaphore.
        unsafe {
            for semaphore in self.drawn.drain(..) {
                self.gpu.device.destroy_semaphore(semaphore, None);
            }
            self.swapchains.destroy_swapchain(self.handle, None);
        }
        self.handle = vk::SwapchainKHR::null();
        Ok(idle?)
    }

    fn destroy(&mut self) {
        // A lost device must not keep the window from closing.
        let _ = self.destroy_images();
        // SAFETY: the surface's swapchain is gone.
        unsafe { self.surfaces.destroy_surface(self.surface, None) };
        self.surface = vk::SurfaceKHR::null();
    }
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        self.destroy();
        // SAFETY: the queue is idle.
        unsafe { self.gpu.device.destroy_semaphore(self.acquired, None) };
    }
}
