//! Messages of the validation layers: each is counted, kept and shown once.

use std::collections::HashSet;
use std::ffi::{CStr, c_void};
use std::io::Write;
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{Result, bail};
use ash::{Entry, Instance, ext, vk};

/// The Khronos layer, with core and synchronization validation.
pub const LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// The layer of Debian 12. It is older than `VK_KHR_ray_tracing_position_fetch`; messages of newer ones are not filtered.
const DEBIAN_12: u32 = vk::make_api_version(0, 1, 3, 239);

/// False messages of [`DEBIAN_12`], which does not know position fetch: the message's id, and words that occur
/// only in this message.
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

/// True if a layer reports this only because it is too old.
fn is_known_false(layer_version: u32, id_name: &str, text: &str) -> bool {
    let says = |(id, words): &(&str, &str)| *id == id_name && text.contains(words);
    layer_version == DEBIAN_12 && KNOWN_FALSE.iter().any(says)
}

/// The purpose the layer is enabled for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Heard {
    /// Mistakes in the use of Vulkan.
    #[default]
    Mistakes,
    /// Output of shaders by `debugPrintfEXT` alone: the layer instruments shaders differently for each purpose.
    Prints,
}

/// Messages collected while a device lived.
#[derive(Default)]
pub struct Messages {
    layer_version: u32,
    /// The way the layer is configured.
    way: Way,
    heard: Heard,
    printed: Mutex<Vec<String>>,
    kept: Mutex<Vec<String>>,
    seen: Mutex<HashSet<i32>>,
}

impl Messages {
    /// Every warning and error so far, in order.
    pub fn all(&self) -> Vec<String> {
        self.kept.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).clone()
    }

    /// Lines printed by shaders since the last call.
    pub fn take_printed(&self) -> Vec<String> {
        std::mem::take(&mut self.printed.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// An empty collection for the installed layer.
    ///
    /// # Errors
    /// If the layer is not installed; says what to install.
    pub fn new(entry: &Entry, heard: Heard) -> Result<Arc<Self>> {
        // SAFETY: the entry was loaded from a Vulkan loader and is alive.
        let layers = unsafe { entry.enumerate_instance_layer_properties()? };
        let Some(layer) = layers.iter().find(|layer| layer.layer_name_as_c_str() == Ok(LAYER))
        else {
            bail!(
                "--validate needs {}, which is not installed: run ./setup, or install your system's \
                 Vulkan validation layers (Debian: vulkan-validationlayers; Windows: the Vulkan SDK)",
                LAYER.to_string_lossy()
            );
        };
        // SAFETY: as above; the layer has just been listed.
        let offered = unsafe { entry.enumerate_instance_extension_properties(Some(LAYER))? };
        let settings = offered
            .iter()
            .any(|offer| offer.extension_name_as_c_str() == Ok(ext::layer_settings::NAME));
        let way = if settings { Way::Settings } else { Way::Features };
        Ok(Arc::new(Self { layer_version: layer.spec_version, way, heard, ..Self::default() }))
    }

    /// The purpose the layer is enabled for.
    pub fn heard(&self) -> Heard {
        self.heard
    }

    /// The way the layer is configured.
    pub fn way(&self) -> Way {
        self.way
    }

    /// A messenger that reports to `self`, to chain into instance creation or to create alone.
    ///
    /// `self` must outlive the messenger and must not move: its address is the callback's user data.
    pub fn messenger_info(&self) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
        use vk::{
            DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type,
        };
        let address: *const Self = self;
        let printed = match self.heard {
            Heard::Mistakes => Severity::empty(),
            Heard::Prints => Severity::INFO,
        };
        vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(Severity::WARNING | Severity::ERROR | printed)
            .message_type(Type::GENERAL | Type::VALIDATION | Type::PERFORMANCE)
            .pfn_user_callback(Some(on_message))
            .user_data(address.cast_mut().cast())
    }

    fn record(&self, id_name: &str, id: i32, severity: &str, text: &str) {
        if self.heard == Heard::Prints {
            // Messages about the layer itself have the same name, for example that its buffer is full.
            if id_name.to_ascii_uppercase().contains("DEBUG-PRINTF") {
                let mut printed = self.printed.lock().unwrap_or_else(PoisonError::into_inner);
                printed.push(said(text).to_owned());
            }
            return;
        }
        // Messages of the loader and drivers are about the machine, not about this program's use of Vulkan.
        let about_the_machine = id_name == "Loader Message" || id_name.starts_with("MESA");
        if about_the_machine || is_known_false(self.layer_version, id_name, text) {
            return;
        }
        // The id finds a message in the specification and on the pages. Not every layer includes it in the text.
        let message = if text.contains(id_name) {
            format!("{severity}: {text}")
        } else {
            format!("{severity}: [ {id_name} ] {text}")
        };
        let mut seen = self.seen.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if seen.insert(id) {
            // A panic must not leave a callback, and `eprintln!` panics if standard error is closed.
            let _ = writeln!(std::io::stderr(), "{message}");
        }
        self.kept.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(message);
    }
}

/// A shader's output, without the prefix that the layer adds.
fn said(text: &str) -> &str {
    let rest = text.split_once("| MessageID = ").map(|(_, rest)| rest);
    rest.and_then(|rest| rest.split_once("| ")).map_or(text, |(_, rest)| rest).trim()
}

/// Reports to [`Messages`] while an instance lives; dropped before it.
pub struct Messenger {
    /// The reported messages.
    pub messages: Arc<Messages>,
    handle: vk::DebugUtilsMessengerEXT,
    utils: ext::debug_utils::Instance,
}

impl Messenger {
    /// A messenger of an instance.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(entry: &Entry, instance: &Instance, messages: Arc<Messages>) -> Result<Self> {
        let utils = ext::debug_utils::Instance::new(entry, instance);
        let info = messages.messenger_info();
        // SAFETY: the user data is kept beside the messenger.
        let handle = unsafe { utils.create_debug_utils_messenger(&info, None)? };
        Ok(Self { messages, handle, utils })
    }
}

impl Drop for Messenger {
    fn drop(&mut self) {
        // SAFETY: the instance is alive, and its last message has been said.
        unsafe { self.utils.destroy_debug_utils_messenger(self.handle, None) };
    }
}

/// The way to configure the layer, in addition to its defaults.
#[derive(Clone, Copy, Default)]
pub enum Way {
    /// `VK_EXT_layer_settings`: a setting of the layer's own.
    Settings,
    /// `VK_EXT_validation_features`: the only way in old layers, which new ones may drop.
    #[default]
    Features,
}

impl Way {
    /// The instance extension it needs.
    pub fn extension(self) -> &'static CStr {
        match self {
            Self::Settings => ext::layer_settings::NAME,
            Self::Features => ext::validation_features::NAME,
        }
    }
}

/// For [`Way::Settings`]: enables synchronization validation or shader prints.
pub fn settings(heard: Heard) -> [vk::LayerSettingEXT<'static>; 1] {
    const ON: vk::Bool32 = vk::TRUE;
    let mut setting = vk::LayerSettingEXT::default()
        .layer_name(LAYER)
        .setting_name(match heard {
            Heard::Mistakes => c"validate_sync",
            Heard::Prints => c"printf_enable",
        })
        .ty(vk::LayerSettingTypeEXT::BOOL32);
    // One value: ash would count its bytes.
    (setting.value_count, setting.p_values) = (1, std::ptr::from_ref(&ON).cast());
    [setting]
}

/// For [`Way::Features`].
pub fn features(heard: Heard) -> [vk::ValidationFeatureEnableEXT; 1] {
    [match heard {
        Heard::Mistakes => vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION,
        Heard::Prints => vk::ValidationFeatureEnableEXT::DEBUG_PRINTF,
    }]
}

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
    fn a_print_is_told_without_its_layers_words() {
        let old = "Validation Information: [ UNASSIGNED-DEBUG-PRINTF ] Object 0: handle = 0x5, type = \
                   VK_OBJECT_TYPE_DEVICE; | MessageID = 0x92394c89 | a | b = 1";
        assert_eq!(said(old), "a | b = 1");
        assert_eq!(said("t = 2\n"), "t = 2");
    }

    #[test]
    fn what_an_old_layer_does_not_know_is_believed_of_a_newer_one() {
        let (id, words) = KNOWN_FALSE[1];
        assert!(is_known_false(DEBIAN_12, id, words));
        assert!(!is_known_false(DEBIAN_12 + 1, id, words));
        assert!(!is_known_false(DEBIAN_12, id, "unknown VkStructureType (1)"));
        assert!(!is_known_false(DEBIAN_12, "VUID-another", words));
    }
}
