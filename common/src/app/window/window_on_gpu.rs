//! A window, the device that draws to it, and egui between them.

use anyhow::{Context, Result};
use ash::vk;
use egui::{FullOutput, Ui, ViewportId};
use winit::event::WindowEvent;
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::Window;

use super::Of;
use super::darkroom::Darkroom;
use super::painter::Painter;
use super::style;
use crate::app::check_validation;
use crate::gpu::{Gpu, Image, Swapchain, WindowHandles};

/// The resources for drawing to a window. Dropped in this order, the window last.
pub struct WindowOnGpu {
    painter: Painter,
    /// Develops pictures, if that changes them.
    darkroom: Option<Darkroom>,
    swapchain: Swapchain,
    egui: egui_winit::State,
    /// The device.
    pub gpu: Gpu,
    /// The window.
    pub window: Window,
}

/// The result of presenting an image in the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presented {
    /// The window shows it.
    Shown,
    /// The window shows it, but needs other images from now on.
    ShownStale,
    /// It was drawn, but the window had changed by then. Wayland does not allow another redraw before a frame was
    /// shown ([`Window::pre_present_notify`]), so the caller must draw again at once.
    Lost,
    /// The window had no image.
    NoImage,
}

impl WindowOnGpu {
    /// Opens the selected device, to draw to a window.
    ///
    /// # Errors
    /// If no device supports it, or the window shows no sRGB colour.
    pub fn new(window: Window, Of { program, args, hooks }: Of) -> Result<Self> {
        let handles = WindowHandles {
            display: window.display_handle().context("the window has no display")?.as_raw(),
            window: window.window_handle().context("the window has no handle")?.as_raw(),
        };
        let requirements = (program.requirements)().window().compiler_figures_where_offered();
        let mut options = args.device(requirements);
        options.window = Some(handles);
        hooks.device(&mut options);
        let gpu = Gpu::new(&options)?;
        let swapchain = Swapchain::new(&gpu, handles)?;
        let context = egui::Context::default();
        style::apply(&context);
        // With slow frames, a click may take long: press and release arrive in different frames.
        context.options_mut(|options| options.input_options.max_click_duration = f64::INFINITY);
        Ok(Self {
            painter: Painter::new(&gpu, &swapchain)?,
            darkroom: Darkroom::new(&gpu, args.development)?,
            swapchain,
            egui: egui_winit::State::new(
                context,
                ViewportId::ROOT,
                &window,
                Some(window.scale_factor() as f32),
                None,
                Some(gpu.limits.core.max_image_dimension2_d as usize),
            ),
            gpu,
            window,
        })
    }

    /// Passes an event to the panel; returns true if the window needs a redraw.
    pub fn take(&mut self, event: &WindowEvent) -> bool {
        self.egui.on_window_event(&self.window, event).repaint
    }

    /// The required size of a drawing; `None` while there is nothing to draw to.
    ///
    /// # Errors
    /// If the window system or the device fails.
    pub fn fit(&mut self) -> Result<Option<vk::Extent2D>> {
        let size = self.window.inner_size();
        self.swapchain.fit(vk::Extent2D { width: size.width, height: size.height })
    }

    /// Lets `show` declare the contents over the picture.
    ///
    /// # Errors
    /// If memory is short for its textures.
    pub fn over(&mut self, show: impl FnMut(&mut Ui)) -> Result<FullOutput> {
        let input = self.egui.take_egui_input(&self.window);
        let context = self.egui.egui_ctx().clone();
        let mut drawing = context.run_ui(input, show);
        let platform = std::mem::take(&mut drawing.platform_output);
        self.egui.handle_platform_output(&self.window, platform);
        self.painter.textures(std::mem::take(&mut drawing.textures_delta))?;
        Ok(drawing)
    }

    /// Draws a picture, scaled to its area, and the contents over it to the window.
    ///
    /// # Errors
    /// If the window system or the device fails.
    pub fn present(
        &mut self,
        extent: vk::Extent2D,
        picture: (&Image, vk::Extent2D),
        drawing: FullOutput,
    ) -> Result<Presented> {
        let scale = drawing.pixels_per_point;
        let triangles = self.egui.egui_ctx().tessellate(drawing.shapes, scale);
        let Some(target) = self.swapchain.acquire()? else { return Ok(Presented::NoImage) };
        let (image, area) = picture;
        let image = self.darkroom.as_mut().map_or(Ok(image), |darkroom| darkroom.develop(image))?;
        self.painter.paint(extent, (image, area), (&triangles, scale), target)?;
        self.window.pre_present_notify();
        Ok(match (self.swapchain.present(target)?, self.swapchain.is_stale()) {
            (true, false) => Presented::Shown,
            (true, true) => Presented::ShownStale,
            (false, _) => Presented::Lost,
        })
    }

    /// Closes the device and the window.
    ///
    /// # Errors
    /// If validation had something to say.
    pub fn close(self) -> Result<()> {
        let Self { painter, darkroom, swapchain, egui, gpu, window: _window } = self;
        // Messages about what was never destroyed come when the device is.
        let validation = gpu.validation();
        drop((painter, darkroom, swapchain, egui, gpu));
        check_validation(&validation)
    }
}
