//! What the validation layers said: every message is counted, kept and shown once.

use std::collections::HashSet;
use std::ffi::{CStr, c_void};
use std::io::Write;
use std::sync::{Arc, Mutex};

use anyhow::{Result, bail};
use ash::{Entry, ext, vk};

/// The Khronos layer, which holds core and synchronization validation.
pub const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// The layer of Debian 12. It is older than `VK_KHR_ray_tracing_position_fetch`, and a newer one is believed.
const DEBIAN_12: u32 = vk::make_api_version(0, 1, 3, 239);

/// What [`DEBIAN_12`] says because it does not know position fetch: the message's id, and words that only this
/// message has.
const KNOWN_FALSE: [(&str, &str); 8] = [
    ("VUID_Undefined", "VK_KHR_ray_tracing_position_fetch is not supported by this layer"),
    // VkPhysicalDeviceRayTracingPositionFetchFeaturesKHR.
    ("VUID-VkDeviceCreateInfo-pNext-pNext", "unknown VkStructureType (1000481000)"),
    // VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_DATA_ACCESS_BIT_KHR.
    (
        "VUID-VkAccelerationStructureBuildGeometryInfoKHR-flags-parameter",
        "flags contains flag bits that are not recognized",
    ),
    // RayTracingPositionFetchKHR.
    ("UNASSIGNED-CoreValidation-Shader-InconsistentSpirv", "Invalid capability operand: 5336"),
    ("VUID-VkPipelineShaderStageCreateInfo-module-parameter", "Invalid capability operand: 5336"),
    ("VUID-VkShaderModuleCreateInfo-pCode-01090", "(Unhandled OpCapability)"),
    ("VUID-VkShaderModuleCreateInfo-pCode-04146", "(SPV_KHR_ray_tracing_position_fetch)"),
    (
        "VUID-VkPipelineShaderStageCreateInfo-pSpecializationInfo-06719",
        "attempted to apply specialization constants with spirv-opt but failed",
    ),
];

/// Whether a layer says this only because it is too old.
fn is_known_false(layer_version: u32, id_name: &str, text: &str) -> bool {
    let says = |(id, words): &(&str, &str)| *id == id_name && text.contains(words);
    layer_version == DEBIAN_12 && KNOWN_FALSE.iter().any(says)
}

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
    pub fn new(entry: &Entry) -> Result<Arc<Self>> {
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
        Ok(Arc::new(Self { layer_version: layer.spec_version, ..Self::default() }))
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
        // The loader and drivers talk about the machine, not about this program's use of Vulkan.
        let about_the_machine = id_name == "Loader Message" || id_name.starts_with("MESA");
        if about_the_machine || is_known_false(self.layer_version, id_name, text) {
            return;
        }
        let message = format!("{severity}: {text}");
        let mut seen = self.seen.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if seen.insert(id) {
            // A panic may not leave a callback, and `eprintln!` panics where nobody listens.
            let _ = writeln!(std::io::stderr(), "{message}");
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
    // SAFETY: the layer passes valid data, and the user data outlives the messenger.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_an_old_layer_does_not_know_is_believed_of_a_newer_one() {
        let (id, words) = KNOWN_FALSE[1];
        assert!(is_known_false(DEBIAN_12, id, words));
        assert!(!is_known_false(DEBIAN_12 + 1, id, words));
        assert!(!is_known_false(DEBIAN_12, id, "unknown VkStructureType (1)"));
        assert!(!is_known_false(DEBIAN_12, "VUID-another", words));
    }
}
