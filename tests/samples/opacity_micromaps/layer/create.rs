//! Creates, measures and destroys structures.

use ash::vk::{self, Handle};

use crate::builds::{Input, passed_on};
use crate::device::function;
use crate::record::record;
use crate::structures::{CREATE_INFO_2, CreateInfo2, MICROMAP};

pub unsafe extern "system" fn create2(
    device: vk::Device,
    info: *const CreateInfo2,
    allocator: *const vk::AllocationCallbacks,
    structure: *mut vk::AccelerationStructureKHR,
) -> vk::Result {
    type Create = unsafe extern "system" fn(
        vk::Device,
        *const CreateInfo2,
        *const vk::AllocationCallbacks,
        *mut vk::AccelerationStructureKHR,
    ) -> vk::Result;
    // SAFETY: the arguments are the caller's, here and below.
    unsafe {
        let asked = &*info;
        if asked.structure != MICROMAP {
            let create: Option<Create> = function(device, c"vkCreateAccelerationStructure2KHR");
            return match create {
                Some(create) => create(device, info, allocator, structure),
                None => vk::Result::ERROR_FEATURE_NOT_PRESENT,
            };
        }
        let mut record = record();
        record
            .hold(asked.kind == CREATE_INFO_2 && asked.next.is_null(), "CreateInfo2 sType, pNext");
        record.hold(asked.flags == 0, "createFlags");
        record.hold(asked.address != 0 && asked.address.is_multiple_of(256), "address of 256");
        record.hold(asked.size > 0, "size");
        // Its buffer is not a storage buffer.
        record.hold(asked.address_flags == 0, "addressFlags");
        *structure = record.make(asked.size);
        vk::Result::SUCCESS
    }
}

pub unsafe extern "system" fn create(
    device: vk::Device,
    info: *const vk::AccelerationStructureCreateInfoKHR,
    allocator: *const vk::AllocationCallbacks,
    structure: *mut vk::AccelerationStructureKHR,
) -> vk::Result {
    // SAFETY: as above.
    unsafe {
        record().hold((*info).ty.as_raw() != MICROMAP, "a micromap by the older call");
        let create: vk::PFN_vkCreateAccelerationStructureKHR =
            function(device, c"vkCreateAccelerationStructureKHR").expect("it was asked for");
        create(device, info, allocator, structure)
    }
}

pub unsafe extern "system" fn destroy(
    device: vk::Device,
    structure: vk::AccelerationStructureKHR,
    allocator: *const vk::AllocationCallbacks,
) {
    if record().remove(structure.as_raw()) {
        return;
    }
    // SAFETY: as above.
    unsafe {
        let destroy: vk::PFN_vkDestroyAccelerationStructureKHR =
            function(device, c"vkDestroyAccelerationStructureKHR").expect("it was asked for");
        destroy(device, structure, allocator);
    }
}

pub unsafe extern "system" fn sizes(
    device: vk::Device,
    kind: vk::AccelerationStructureBuildTypeKHR,
    info: *const vk::AccelerationStructureBuildGeometryInfoKHR,
    counts: *const u32,
    sizes: *mut vk::AccelerationStructureBuildSizesInfoKHR,
) {
    // SAFETY: as above.
    unsafe {
        if (*info).ty.as_raw() == MICROMAP {
            let mut record = record();
            record.hold(counts.is_null(), "pMaxPrimitiveCounts is NULL");
            record.hold(kind == vk::AccelerationStructureBuildTypeKHR::DEVICE, "buildType");
            if let Some(input) = Input::of(&*info, &mut record) {
                (*sizes).acceleration_structure_size = input.needed();
                (*sizes).update_scratch_size = 0;
                (*sizes).build_scratch_size = 256;
            }
            return;
        }
        let (geometries, _) = passed_on(&*info);
        let info = vk::AccelerationStructureBuildGeometryInfoKHR {
            p_geometries: geometries.as_ptr(),
            pp_geometries: std::ptr::null(),
            ..*info
        };
        let ask: vk::PFN_vkGetAccelerationStructureBuildSizesKHR =
            function(device, c"vkGetAccelerationStructureBuildSizesKHR").expect("it was asked for");
        ask(device, kind, &raw const info, counts, sizes);
    }
}
