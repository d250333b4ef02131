//! Creates and destroys a device, and the objects on it that the driver must not see.

use std::ffi::CStr;

use ash::vk;
use layer::below;

use crate::physical::{EXTENSIONS, below_extensions, each, has};
use crate::record::record;
use crate::structures::{ADDRESS_COMMANDS_FEATURES, FEATURES, Feature, PIPELINE_FLAG};

pub unsafe extern "system" fn create(
    physical: vk::PhysicalDevice,
    info: *const vk::DeviceCreateInfo,
    allocator: *const vk::AllocationCallbacks,
    device: *mut vk::Device,
) -> vk::Result {
    // SAFETY: the loader calls this once per device; the other arguments are the caller's.
    unsafe {
        let (Some(get_proc_addr), Ok(known)) =
            (layer::below_device(info), below_extensions(physical))
        else {
            return vk::Result::ERROR_INITIALIZATION_FAILED;
        };
        let asked = &*info;
        let names = std::slice::from_raw_parts(
            asked.pp_enabled_extension_names,
            asked.enabled_extension_count as usize,
        );
        let is_below = |name: &CStr| !EXTENSIONS.contains(&name) || has(&known, name);
        let passed: Vec<_> =
            names.iter().copied().filter(|&name| is_below(CStr::from_ptr(name))).collect();
        let narrow = vk::DeviceCreateInfo {
            enabled_extension_count: passed.len() as u32,
            pp_enabled_extension_names: passed.as_ptr(),
            ..*asked
        };
        // A driver that knows the features rejects those it does not have.
        let mut own = Vec::new();
        each(narrow.p_next.cast_mut(), |kind, link| match kind {
            FEATURES => own.push((0, link.cast::<Feature>())),
            ADDRESS_COMMANDS_FEATURES => {
                own.push((u32::from(has(&known, EXTENSIONS[0])), link.cast::<Feature>()));
            }
            _ => {}
        });
        let asked: Vec<_> = own.iter().map(|(_, feature)| (**feature).on).collect();
        own.iter().for_each(|(on, feature)| (**feature).on &= on);
        let create = below::instance(physical).core.fp_v1_0().create_device;
        let result = create(physical, &raw const narrow, allocator, device);
        own.iter().zip(asked).for_each(|((_, feature), on)| (**feature).on = on);
        if result == vk::Result::SUCCESS {
            below::add_device(physical, *device, get_proc_addr);
        }
        result
    }
}

pub unsafe extern "system" fn destroy(
    device: vk::Device,
    allocator: *const vk::AllocationCallbacks,
) {
    if device == vk::Device::null() {
        return;
    }
    record().write();
    if let Some(below) = below::remove_device(device) {
        // SAFETY: the caller destroys a device of its own.
        unsafe { (below.core.fp_v1_0().destroy_device)(device, allocator) };
    }
}

/// The driver's function with a name, for a device or one of its command buffers.
///
/// # Safety
/// `T` is the type of that function.
pub unsafe fn function<T: Copy>(of: impl vk::Handle, name: &CStr) -> Option<T> {
    // SAFETY: the device is alive, and the caller's promise.
    unsafe {
        let below = below::device(of);
        let found = (below.get_proc_addr)(below.core.handle(), name.as_ptr());
        found.map(|found| std::mem::transmute_copy(&found))
    }
}

pub unsafe extern "system" fn create_pipelines(
    device: vk::Device,
    operation: vk::DeferredOperationKHR,
    cache: vk::PipelineCache,
    count: u32,
    infos: *const vk::RayTracingPipelineCreateInfoKHR,
    allocator: *const vk::AllocationCallbacks,
    pipelines: *mut vk::Pipeline,
) -> vk::Result {
    // SAFETY: the arguments are the caller's.
    unsafe {
        let mut infos = std::slice::from_raw_parts(infos, count as usize).to_vec();
        for info in &mut infos {
            let flag = vk::PipelineCreateFlags::from_raw(PIPELINE_FLAG);
            if info.flags.contains(flag) {
                record().tell("pipeline".to_owned());
            }
            info.flags &= !flag;
        }
        let name = c"vkCreateRayTracingPipelinesKHR";
        let create: vk::PFN_vkCreateRayTracingPipelinesKHR =
            function(device, name).expect("it was asked for");
        create(device, operation, cache, count, infos.as_ptr(), allocator, pipelines)
    }
}

pub unsafe extern "system" fn name_object(
    device: vk::Device,
    info: *const vk::DebugUtilsObjectNameInfoEXT,
) -> vk::Result {
    // SAFETY: the arguments are the caller's.
    unsafe {
        let kind = vk::ObjectType::ACCELERATION_STRUCTURE_KHR;
        let handle = (*info).object_handle;
        if (*info).object_type == kind && record().has(handle) {
            return vk::Result::SUCCESS;
        }
        let instance = below::instance(below::device(device).physical);
        let name = c"vkSetDebugUtilsObjectNameEXT".as_ptr();
        let set = (instance.get_proc_addr)(instance.core.handle(), name);
        let set: Option<vk::PFN_vkSetDebugUtilsObjectNameEXT> = std::mem::transmute(set);
        set.map_or(vk::Result::SUCCESS, |set| set(device, info))
    }
}
