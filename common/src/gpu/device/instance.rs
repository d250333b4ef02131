//! The Vulkan loader, and its instance.

use std::ffi::OsString;
use std::path::PathBuf;

use anyhow::{Context, Result, anyhow};
use ash::{Entry, Instance, ext, khr, vk};
use winit::raw_window_handle::{RawDisplayHandle, RawWindowHandle};

use crate::gpu::check::validation::{self, Heard, Messages, Messenger, Way};

/// The Vulkan loader and an instance, destroyed on drop: drop everything created from it first.
pub struct Vulkan {
    /// The loader.
    pub entry: Entry,
    /// The instance's commands.
    pub instance: Instance,
    /// Receives validation messages.
    pub messenger: Option<Messenger>,
}

impl Vulkan {
    /// An instance, with the validation layer if its messages are wanted, and with window support if there is a window.
    ///
    /// # Errors
    /// If there is no loader, no driver or no validation layer, or none that supports the window.
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

/// A window's native handles. The window must outlive everything created from it.
#[derive(Clone, Copy)]
pub struct WindowHandles {
    /// The connection to the window system.
    pub display: RawDisplayHandle,
    /// The window.
    pub window: RawWindowHandle,
}

/// Loads the Vulkan loader: the system's, or the library that `VULKAN_LOADER` names.
fn load() -> Result<Entry> {
    // SAFETY: the Vulkan loader's initialisation has no preconditions, here and below.
    let from = |path| unsafe { Entry::load_from(path) };
    let entry = match std::env::var_os("VULKAN_LOADER") {
        Some(path) => from(path),
        // SAFETY: as above.
        None => unsafe { Entry::load() }.or_else(|error| {
            let elsewhere = elsewhere(std::env::consts::OS, std::env::var_os("VULKAN_SDK"));
            elsewhere.into_iter().find_map(|path| from(path.into()).ok()).ok_or(error)
        }),
    };
    entry.map_err(|error| {
        anyhow!("no Vulkan loader ({error}): run ./setup, or install your system's libvulkan")
    })
}

/// Paths of the loader on a system that does not search them by itself.
///
/// macOS searches none of the folders in which the Vulkan SDK and Homebrew install it
/// (<https://github.com/KhronosGroup/Vulkan-Samples/issues/1001>,
/// <https://github.com/KhronosGroup/Vulkan-Hpp/pull/2383>). MoltenVK alone works as well, but only the loader has
/// layers.
fn elsewhere(system: &str, sdk: Option<OsString>) -> Vec<PathBuf> {
    if system != "macos" {
        return Vec::new();
    }
    let sdk = sdk.map(PathBuf::from).filter(|sdk| sdk.is_absolute()).map(|sdk| sdk.join("lib"));
    let folders = sdk.into_iter().chain(["/opt/homebrew/lib", "/usr/local/lib"].map(PathBuf::from));
    let folders: Vec<_> = folders.collect();
    let names = ["libvulkan.1.dylib", "libMoltenVK.dylib"];
    names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).collect()
}

/// Creates an instance that supports object names: with the validation layer if there are `messages`, and with
/// window support if there is a window.
fn create(
    entry: &Entry,
    messages: Option<&Messages>,
    window: Option<&WindowHandles>,
) -> Result<Instance> {
    // Every loader has it, whatever the drivers support.
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
    // Without it, the loader hides incomplete implementations, as on Macs; MoltenVK alone, without a loader, hides
    // nothing and does not know it.
    let mut flags = vk::InstanceCreateFlags::empty();
    // SAFETY: the loader is loaded.
    let offered = unsafe { entry.enumerate_instance_extension_properties(None) };
    let portability = khr::portability_enumeration::NAME;
    let is_it = |e: &vk::ExtensionProperties| e.extension_name_as_c_str() == Ok(portability);
    if offered.is_ok_and(|offered| offered.iter().any(is_it)) {
        extensions.push(portability.as_ptr());
        flags |= vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR;
    }
    let application = vk::ApplicationInfo::default()
        .application_name(c"ray tracing")
        .api_version(vk::API_VERSION_1_3);
    let mut info = vk::InstanceCreateInfo::default()
        .flags(flags)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_mac_is_searched_for_the_loader_before_the_driver_alone() {
        let found = elsewhere("macos", Some("/Users/ada/VulkanSDK/1.4.341.0/macOS".into()));
        let found: Vec<_> = found.iter().map(|path| path.to_str().unwrap()).collect();
        assert_eq!(
            found,
            [
                "/Users/ada/VulkanSDK/1.4.341.0/macOS/lib/libvulkan.1.dylib",
                "/opt/homebrew/lib/libvulkan.1.dylib",
                "/usr/local/lib/libvulkan.1.dylib",
                "/Users/ada/VulkanSDK/1.4.341.0/macOS/lib/libMoltenVK.dylib",
                "/opt/homebrew/lib/libMoltenVK.dylib",
                "/usr/local/lib/libMoltenVK.dylib",
            ]
        );
        assert!(elsewhere("linux", Some("/opt/vulkan".into())).is_empty());
    }
}
