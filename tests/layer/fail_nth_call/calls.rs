//! The functions that may fail, the number of calls of each, and the single call that fails.

use std::collections::BTreeMap;
use std::ffi::{CStr, c_char, c_void};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

use ash::vk;

/// A function that returns a `VkResult`, and the layer's replacement.
pub struct Function {
    /// Its name.
    pub name: &'static CStr,
    /// The address that the layer returns for it.
    pub own: *const c_void,
    below: AtomicUsize,
    calls: AtomicUsize,
}

// SAFETY: the pointer is that of a function.
unsafe impl Sync for Function {}

/// Declares [`FUNCTIONS`]: each name with its number of arguments, spelled out as letters.
///
/// Arguments are passed on unchanged, each as a machine word: handles, pointers, numbers and flags are no
/// larger, and the calling conventions of 64-bit systems pass them all in the same way.
macro_rules! functions {
    ($($name:ident($($argument:ident)*))*) => {
        #[allow(non_camel_case_types, clippy::upper_case_acronyms, reason = "the functions' own names")]
        #[derive(Clone, Copy)]
        enum Number { $($name),* }

        $(
            #[allow(non_snake_case, reason = "the function's own name")]
            unsafe extern "system" fn $name($($argument: usize),*) -> vk::Result {
                let function = &FUNCTIONS[Number::$name as usize];
                type Below = unsafe extern "system" fn($($argument: functions!(@word $argument)),*) -> vk::Result;
                // SAFETY: the address is that of the function below, which takes these arguments.
                function.answer(&[$($argument),*], |address| unsafe {
                    std::mem::transmute::<usize, Below>(address)($($argument),*)
                })
            }
        )*

        /// Every function that the samples call and that may fail.
        pub static FUNCTIONS: [Function; [$(stringify!($name)),*].len()] = [$(Function {
            // SAFETY: the text ends in a zero byte.
            name: unsafe { CStr::from_bytes_with_nul_unchecked(concat!(stringify!($name), "\0").as_bytes()) },
            own: $name as *const c_void,
            below: AtomicUsize::new(0),
            calls: AtomicUsize::new(0),
        }),*];
    };
    (@word $argument:ident) => { usize };
}

functions! {
    vkCreateInstance(a b c)
    vkEnumeratePhysicalDevices(a b c)
    vkEnumerateDeviceExtensionProperties(a b c d)
    vkCreateDevice(a b c d)
    vkCreateDebugUtilsMessengerEXT(a b c d)
    vkGetPhysicalDeviceSurfaceSupportKHR(a b c d)
    vkGetPhysicalDeviceSurfaceCapabilitiesKHR(a b c)
    vkGetPhysicalDeviceSurfaceFormatsKHR(a b c d)
    vkGetPhysicalDeviceSurfacePresentModesKHR(a b c d)
    vkCreateXlibSurfaceKHR(a b c d)
    vkCreateXcbSurfaceKHR(a b c d)
    vkCreateWaylandSurfaceKHR(a b c d)
    vkAllocateMemory(a b c d)
    vkMapMemory(a b c d e f)
    vkBindBufferMemory(a b c d)
    vkBindImageMemory(a b c d)
    vkCreateBuffer(a b c d)
    vkCreateImage(a b c d)
    vkCreateImageView(a b c d)
    vkCreateSampler(a b c d)
    vkCreateShaderModule(a b c d)
    vkCreatePipelineCache(a b c d)
    vkGetPipelineCacheData(a b c d)
    vkCreatePipelineLayout(a b c d)
    vkCreateDescriptorSetLayout(a b c d)
    vkCreateDescriptorPool(a b c d)
    vkAllocateDescriptorSets(a b c)
    vkFreeDescriptorSets(a b c d)
    vkCreateComputePipelines(a b c d e f)
    vkCreateGraphicsPipelines(a b c d e f)
    vkCreateRayTracingPipelinesKHR(a b c d e f g)
    vkGetRayTracingShaderGroupHandlesKHR(a b c d e f)
    vkCreateAccelerationStructureKHR(a b c d)
    vkCreateQueryPool(a b c d)
    vkGetQueryPoolResults(a b c d e f g h)
    vkCreateFence(a b c d)
    vkResetFences(a b c)
    vkGetFenceStatus(a b)
    vkWaitForFences(a b c d e)
    vkCreateSemaphore(a b c d)
    vkCreateCommandPool(a b c d)
    vkResetCommandPool(a b c)
    vkAllocateCommandBuffers(a b c)
    vkBeginCommandBuffer(a b)
    vkEndCommandBuffer(a)
    vkQueueSubmit(a b c d)
    vkQueueSubmit2(a b c d)
    vkQueueWaitIdle(a)
    vkDeviceWaitIdle(a)
    vkCreateSwapchainKHR(a b c d)
    vkGetSwapchainImagesKHR(a b c d)
    vkAcquireNextImageKHR(a b c d e f)
    vkQueuePresentKHR(a b)
    vkGetPipelineExecutablePropertiesKHR(a b c d)
    vkGetPipelineExecutableStatisticsKHR(a b c d)
    vkSetDebugUtilsObjectNameEXT(a b)
}

/// The layer's replacement for the function below if it may fail; otherwise the function below.
///
/// # Safety
/// `name` ends in a zero byte, and `below` is the function of that name.
pub unsafe fn over(name: *const c_char, below: vk::PFN_vkVoidFunction) -> vk::PFN_vkVoidFunction {
    // SAFETY: the caller's promise.
    unsafe {
        let (name, found) = (CStr::from_ptr(name), below?);
        match FUNCTIONS.iter().find(|function| function.name == name) {
            Some(function) => {
                function.below.store(found as usize, Ordering::Relaxed);
                layer::function(function.own)
            }
            None => below,
        }
    }
}

impl Function {
    /// Counts a call, and makes it fail if it is the chosen one.
    fn answer(&self, arguments: &[usize], below: impl Fn(usize) -> vk::Result) -> vk::Result {
        let number = self.calls.fetch_add(1, Ordering::Relaxed) + 1;
        let below = || below(self.below.load(Ordering::Relaxed));
        match chosen() {
            Some(fault) if fault.meets(self.name, number) => {
                // A lost device does not recover.
                if fault.result == vk::Result::ERROR_DEVICE_LOST && self.name == c"vkWaitForFences"
                {
                    let _ = below();
                }
                if fault.result == vk::Result::SUCCESS && self.name == c"vkMapMemory" {
                    let result = below();
                    // SAFETY: the last argument is the output pointer. `MAP_FAILED` is -1.
                    unsafe { *(arguments[5] as *mut usize) = usize::MAX };
                    return result;
                }
                fault.result
            }
            _ => below(),
        }
    }
}

/// The fault in the variable `FAIL`.
struct Fault {
    name: String,
    when: When,
    result: vk::Result,
}

/// The call that fails.
enum When {
    /// The call with this number.
    At(usize),
    /// The call with this number, and all after it.
    From(usize),
    /// The first call after this file exists; the file is removed.
    File(PathBuf),
}

impl Fault {
    fn meets(&self, name: &CStr, number: usize) -> bool {
        self.name.as_bytes() == name.to_bytes()
            && match &self.when {
                When::At(first) => number == *first,
                When::From(first) => number >= *first,
                When::File(file) => std::fs::remove_file(file).is_ok(),
            }
    }
}

impl When {
    fn parse(text: &str) -> Option<Self> {
        if text.starts_with('/') {
            return Some(Self::File(text.into()));
        }
        let first = text.trim_end_matches('+').parse().ok()?;
        Some(if text.ends_with('+') { Self::From(first) } else { Self::At(first) })
    }
}

fn chosen() -> Option<&'static Fault> {
    static CHOSEN: OnceLock<Option<Fault>> = OnceLock::new();
    let parse = || {
        let text = std::env::var("FAIL").ok()?;
        let mut words = text.split(':');
        let (name, when, result) = (words.next()?, words.next()?, words.next()?);
        Some(Fault {
            name: name.to_owned(),
            when: When::parse(when)?,
            result: vk::Result::from_raw(result.parse().ok()?),
        })
    };
    CHOSEN.get_or_init(parse).as_ref()
}

/// Writes the number of calls of each function to the file in `CALLS`, one line per function.
pub fn tell() {
    static TOLD: Mutex<()> = Mutex::new(());
    let Some(file) = std::env::var_os("CALLS") else { return };
    let _alone = TOLD.lock();
    let counts: BTreeMap<_, _> = FUNCTIONS
        .iter()
        .map(|function| (function.name.to_string_lossy(), function.calls.load(Ordering::Relaxed)))
        .filter(|(_, calls)| *calls > 0)
        .collect();
    let lines: String = counts.iter().map(|(name, calls)| format!("{name} {calls}\n")).collect();
    // If this fails, the test misses the file and fails.
    let _ = std::fs::write(file, lines);
}
