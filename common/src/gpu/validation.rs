//! What the validation layers said: every message is counted, kept and shown once.

use std::collections::HashSet;
use std::ffi::{CStr, c_void};
use std::sync::Mutex;

use anyhow::{Result, bail};
use ash::{Entry, ext, vk};

/// The Khronos layer, which holds core and synchronization validation.
pub const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Messages that are known to be wrong: (layer version, message id name, why it is let through).
///
/// A line here needs the layer's version, so that a newer layer is believed again.
const KNOWN_FALSE: &[(u32, &str, &str)] = &[];

/// Messages collected while a device lived.
#[derive(Default)]
pub struct Messages {
    layer_version: u32,
    kept: Mutex<Vec<String>>,
    seen: Mutex<HashSet<i32>>,
}

impl Messages {
    /// Every warning and error so far, in order.
    pub fn all(&self) -> Vec<String> {
        self.kept.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).clone()
    }

    /// An empty collection for the installed layer.
    ///
    /// # Errors
    /// If the layer is not installed, with what to install.
    pub fn new(entry: &Entry) -> Result<Box<Self>> {
        // SAFETY: the entry was loaded from a Vulkan loader and is alive.
        let layers = unsafe { entry.enumerate_instance_layer_properties()? };
        let Some(layer) = layers.iter().find(|layer| layer.layer_name_as_c_str() == Ok(LAYER))
        else {
            bail!(
                "--validate needs {}, which is not installed: run ./setup, or install your system's \
                 Vulkan validation layers (Debian: vulkan-validationlayers)",
                LAYER.to_string_lossy()
            );
        };
        Ok(Box::new(Self { layer_version: layer.spec_version, ..Self::default() }))
    }

    /// A messenger that reports to `self`, to chain into instance creation or to create alone.
    ///
    /// `self` must outlive the messenger and stay where it is: its address is the callback's user data.
    pub fn messenger_info(&self) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
        use vk::{
            DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type,
        };
        let address: *const Self = self;
        vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(Severity::WARNING | Severity::ERROR)
            .message_type(Type::GENERAL | Type::VALIDATION | Type::PERFORMANCE)
            .pfn_user_callback(Some(on_message))
            .user_data(address.cast_mut().cast())
    }

    fn record(&self, id_name: &str, id: i32, severity: &str, text: &str) {
        let known = |(version, name, _): &&(u32, &str, &str)| {
            *version == self.layer_version && *name == id_name
        };
        // The loader and drivers talk about the machine, not about this program's use of Vulkan.
        let about_the_machine = id_name == "Loader Message" || id_name.starts_with("MESA");
        if about_the_machine || KNOWN_FALSE.iter().any(|line| known(&line)) {
            return;
        }
        let message = format!("{severity}: {text}");
        let mut seen = self.seen.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if seen.insert(id) {
            eprintln!("{message}");
        }
        self.kept.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(message);
    }
}

/// The instance extensions that validation adds.
pub const EXTENSIONS: [&CStr; 1] = [ext::validation_features::NAME];

/// What the layer shall check: synchronization validation on top of its defaults.
pub const ENABLED: [vk::ValidationFeatureEnableEXT; 1] =
    [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];

unsafe extern "system" fn on_message(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _types: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layer passes valid data, and the user data is the box that outlives the messenger.
    let (data, messages) = unsafe { (&*data, &*messages.cast::<Messages>()) };
    let text = |pointer: *const std::ffi::c_char| {
        if pointer.is_null() {
            return String::new();
        }
        // SAFETY: a non-null string of the callback data is NUL-terminated and lives for this call.
        unsafe { CStr::from_ptr(pointer) }.to_string_lossy().into_owned()
    };
    let is_error = severity.contains(vk::DebugUtilsMessageSeverityFlagsEXT::ERROR);
    messages.record(
        &text(data.p_message_id_name),
        data.message_id_number,
        if is_error { "validation error" } else { "validation warning" },
        &text(data.p_message),
    );
    vk::FALSE
}
