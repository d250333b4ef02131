//! The Vulkan loader, and the instance that is made from it.

use anyhow::{Context, Result, anyhow};
use ash::{Entry, Instance, ext, vk};
use winit::raw_window_handle::{RawDisplayHandle, RawWindowHandle};

use super::validation::{self, Messages, Way};

/// A window as its system knows it. It must outlive whatever is made from it.
#[derive(Clone, Copy)]
pub struct WindowHandles {
    /// The connection to the window system.
    pub display: RawDisplayHandle,
    /// The window.
    pub window: RawWindowHandle,
}

/// Loads the Vulkan loader: the system's, or the library that `VULKAN_LOADER` names.
///
/// # Errors
/// If there is none, with what to install.
pub fn load() -> Result<Entry> {
    let entry = match std::env::var_os("VULKAN_LOADER") {
        // SAFETY: the Vulkan loader's initialisation has no preconditions, here and below.
        Some(path) => unsafe { Entry::load_from(path) },
        // SAFETY: as above.
        None => unsafe { Entry::load() },
    };
    entry.map_err(|error| {
        anyhow!("no Vulkan loader ({error}): run ./setup, or install your system's libvulkan")
    })
}

/// Creates an instance, and says whether it has `VK_EXT_debug_utils`: with validation if there are
/// `messages`, and with what a window needs if there is one.
///
/// # Errors
/// If there is no driver, or it cannot draw to the window.
pub fn create(
    entry: &Entry,
    messages: Option<&Messages>,
    window: Option<&WindowHandles>,
) -> Result<(Instance, bool)> {
    // SAFETY: the loader is alive.
    let offered = unsafe { entry.enumerate_instance_extension_properties(None) }.context(
        "the Vulkan loader cannot read what is installed: run ./setup, or reinstall your GPU's \
             driver",
    )?;
    let has_debug_utils =
        offered.iter().any(|e| e.extension_name_as_c_str() == Ok(ext::debug_utils::NAME));
    let mut extensions = Vec::new();
    let mut layers = Vec::new();
    if let Some(window) = window {
        let needed = ash_window::enumerate_required_extensions(window.display)
            .context("Vulkan does not know this window system")?;
        extensions.extend_from_slice(needed);
    }
    if has_debug_utils || messages.is_some() {
        extensions.push(ext::debug_utils::NAME.as_ptr());
    }
    if let Some(messages) = messages {
        layers.push(validation::LAYER.as_ptr());
        extensions.push(messages.way().extension().as_ptr());
    }
    let application = vk::ApplicationInfo::default()
        .application_name(c"ray tracing")
        .api_version(vk::API_VERSION_1_3);
    let mut info = vk::InstanceCreateInfo::default()
        .application_info(&application)
        .enabled_layer_names(&layers)
        .enabled_extension_names(&extensions);
    let (setting, mut settings, mut features, mut messenger);
    if let Some(messages) = messages {
        info = match messages.way() {
            Way::Settings => {
                setting = validation::settings();
                settings = vk::LayerSettingsCreateInfoEXT::default().settings(&setting);
                info.push_next(&mut settings)
            }
            Way::Features => {
                features = vk::ValidationFeaturesEXT::default()
                    .enabled_validation_features(&validation::FEATURES);
                info.push_next(&mut features)
            }
        };
        messenger = messages.messenger_info();
        info = info.push_next(&mut messenger);
    }
    // SAFETY: every name and structure of the chain lives until the call returns.
    let instance = unsafe { entry.create_instance(&info, None) };
    match instance {
        Ok(instance) => Ok((instance, has_debug_utils || messages.is_some())),
        Err(vk::Result::ERROR_INCOMPATIBLE_DRIVER) => Err(anyhow!(
            "no Vulkan driver: run ./setup to install a software driver with ray tracing, or install \
             your GPU's driver"
        )),
        Err(vk::Result::ERROR_EXTENSION_NOT_PRESENT) if window.is_some() => Err(anyhow!(
            "Vulkan cannot draw to this window system: add --headless to render without a window"
        )),
        Err(error) => Err(error).context("cannot create a Vulkan instance"),
    }
}
