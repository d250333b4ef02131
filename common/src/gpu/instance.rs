//! The Vulkan loader, and the instance that is made from it.

use anyhow::{Context, Result, anyhow};
use ash::{Entry, Instance, ext, vk};
use winit::raw_window_handle::{RawDisplayHandle, RawWindowHandle};

use super::validation::{self, Heard, Messages, Messenger, Way};

/// The Vulkan loader and an instance, destroyed on drop: drop what was made from it before.
pub struct Vulkan {
    /// The loader.
    pub entry: Entry,
    /// The instance's commands.
    pub instance: Instance,
    /// What tells of messages, under validation.
    pub messenger: Option<Messenger>,
}

impl Vulkan {
    /// An instance, with the validation layer if it is to be heard, and with what a window needs if there is
    /// one.
    ///
    /// # Errors
    /// If there is no loader, no driver or no validation layer, or none that can draw to the window.
    pub fn new(heard: Option<Heard>, window: Option<&WindowHandles>) -> Result<Self> {
        let entry = load()?;
        let messages = match heard.map(|heard| Messages::new(&entry, heard)) {
            // Shaders that print nothing need no layer.
            Some(Err(_)) if heard == Some(Heard::Prints) => None,
            messages => messages.transpose()?,
        };
        let instance = create(&entry, messages.as_deref(), window)?;
        let messenger = messages.map(|m| Messenger::new(&entry, &instance, m)).transpose()?;
        Ok(Self { entry, instance, messenger })
    }
}

impl Drop for Vulkan {
    fn drop(&mut self) {
        drop(self.messenger.take());
        // SAFETY: whoever made something from it has destroyed that.
        unsafe { self.instance.destroy_instance(None) };
    }
}

/// A window as its system knows it. It must outlive whatever is made from it.
#[derive(Clone, Copy)]
pub struct WindowHandles {
    /// The connection to the window system.
    pub display: RawDisplayHandle,
    /// The window.
    pub window: RawWindowHandle,
}

/// Loads the Vulkan loader: the system's, or the library that `VULKAN_LOADER` names.
fn load() -> Result<Entry> {
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

/// Creates an instance that gives objects names: with the validation layer if there are `messages`, and with what a
/// window needs if there is one.
fn create(
    entry: &Entry,
    messages: Option<&Messages>,
    window: Option<&WindowHandles>,
) -> Result<Instance> {
    // Every loader has it, whatever drivers have.
    let mut extensions = vec![ext::debug_utils::NAME.as_ptr()];
    let mut layers = Vec::new();
    if let Some(window) = window {
        let needed = ash_window::enumerate_required_extensions(window.display)
            .context("Vulkan does not know this window system")?;
        extensions.extend_from_slice(needed);
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
    let (setting, mut settings, feature, mut features, mut messenger);
    if let Some(messages) = messages {
        info = match messages.way() {
            Way::Settings => {
                setting = validation::settings(messages.heard());
                settings = vk::LayerSettingsCreateInfoEXT::default().settings(&setting);
                info.push_next(&mut settings)
            }
            Way::Features => {
                feature = validation::features(messages.heard());
                features =
                    vk::ValidationFeaturesEXT::default().enabled_validation_features(&feature);
                info.push_next(&mut features)
            }
        };
        messenger = messages.messenger_info();
        info = info.push_next(&mut messenger);
    }
    // SAFETY: every name and structure of the chain lives until the call returns.
    let instance = unsafe { entry.create_instance(&info, None) };
    match instance {
        Ok(instance) => Ok(instance),
        Err(vk::Result::ERROR_INCOMPATIBLE_DRIVER) => Err(anyhow!(
            "no Vulkan driver: run ./setup to install a software driver with ray tracing, or install \
             your GPU's driver"
        )),
        Err(vk::Result::ERROR_EXTENSION_NOT_PRESENT) if window.is_some() => Err(anyhow!(
            "Vulkan cannot draw to this window system: add --headless to render without a window"
        )),
        Err(error) => Err(error).context(
            "the Vulkan loader makes no instance of what is installed: run ./setup, or reinstall your \
             GPU's driver",
        ),
    }
}
