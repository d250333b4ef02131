//! Builds: their input is checked against the rules and read, and passed on without micromaps.

use std::ffi::c_void;
use std::fmt::Write;

use ash::vk;

use crate::device::function;
use crate::record::{Record, finest, record};
use crate::structures::{
    BUILD_FLAGS, MICROMAP, MICROMAP_DATA, MicromapData, TRIANGLES_MICROMAP, Triangle,
    TrianglesMicromap, UsageError,
};

/// `VK_OPACITY_MICROMAP_FORMAT_4_STATE_KHR`.
const FOUR_STATES: u32 = 2;

/// The input of a micromap's build.
pub struct Input<'a> {
    data: &'a MicromapData,
    usages: &'a [UsageError],
}

impl<'a> Input<'a> {
    /// The input of a build, if it is for a micromap; everything that does not depend on addresses is
    /// checked.
    ///
    /// # Safety
    /// The build is valid in Vulkan.
    pub unsafe fn of(
        info: &vk::AccelerationStructureBuildGeometryInfoKHR<'a>,
        record: &mut Record,
    ) -> Option<Self> {
        record.hold(info.geometry_count == 1 && info.pp_geometries.is_null(), "one geometry");
        record.hold(info.flags.as_raw() & !BUILD_FLAGS == 0, "four build flags");
        // SAFETY: the caller's promise.
        unsafe {
            let geometry = info.p_geometries.as_ref()?;
            record.hold(geometry.geometry_type.as_raw() == MICROMAP, "geometryType");
            record.hold(geometry.flags.is_empty(), "no geometry flags");
            let data = geometry.p_next.cast::<MicromapData>().as_ref()?;
            record.hold(data.kind == MICROMAP_DATA && data.next.is_null(), "MicromapData");
            record.hold(data.usage_pointers.is_null(), "one of the two arrays of usages");
            let usages = std::slice::from_raw_parts(data.usages, data.usage_count as usize);
            let fits = |usage: &UsageError| usage.format == FOUR_STATES && usage.level <= finest();
            record.hold(usages.iter().all(fits), "format and level of usages");
            let stride = data.stride;
            record.hold(stride >= 8 && stride.is_multiple_of(4), "triangleArrayStride");
            Some(Self { data, usages })
        }
    }

    fn triangles(&self) -> u32 {
        self.usages.iter().map(|usage| usage.count).sum()
    }

    /// The size of a micromap of it, in bytes.
    pub fn needed(&self) -> u64 {
        let states: u64 = self.usages.iter().map(|u| u64::from(u.count) << (2 * u.level)).sum();
        256 + states.div_ceil(4) + 8 * u64::from(self.triangles())
    }

    /// The states of all triangles, and their finest level.
    ///
    /// # Safety
    /// Device addresses are host addresses, as in the software driver.
    unsafe fn read(&self, record: &mut Record) -> (u16, Vec<u8>) {
        let (data, triangles) = (self.data.data, self.data.triangles);
        record.hold(data != 0 && data.is_multiple_of(128), "data of 128");
        record.hold(triangles != 0 && triangles.is_multiple_of(128), "triangleArray of 128");
        let mut bytes = Vec::new();
        let mut counts: Vec<_> = self.usages.iter().map(|usage| (usage, 0)).collect();
        let mut finest = 0;
        for number in 0..u64::from(self.triangles()) {
            // SAFETY: the caller's promise.
            unsafe {
                let Triangle { offset, level, format } =
                    *((triangles + number * self.data.stride) as *const Triangle);
                let size = (1usize << (2 * level)).div_ceil(4);
                let at = (data + u64::from(offset)) as *const u8;
                bytes.extend_from_slice(std::slice::from_raw_parts(at, size));
                finest = finest.max(level);
                let is = |usage: &UsageError| {
                    (usage.level, usage.format) == (level.into(), format.into())
                };
                if let Some((_, count)) = counts.iter_mut().find(|(usage, _)| is(usage)) {
                    *count += 1;
                }
            }
        }
        let agrees = counts.iter().all(|(usage, count)| usage.count == *count);
        record.hold(agrees, "triangles and usages agree");
        (finest, bytes)
    }
}

/// The geometries of another kind of build as passed to the driver; and, if there are any, the first one's
/// micromap.
///
/// # Safety
/// The build is valid in Vulkan.
pub unsafe fn passed_on<'a>(
    info: &vk::AccelerationStructureBuildGeometryInfoKHR<'a>,
) -> (Vec<vk::AccelerationStructureGeometryKHR<'a>>, Option<&'a TrianglesMicromap>) {
    // SAFETY: the caller's promise; the triangles of a geometry of triangles may be read.
    unsafe {
        let count = info.geometry_count as usize;
        let mut all: Vec<_> = if !info.pp_geometries.is_null() {
            let pointers = std::slice::from_raw_parts(info.pp_geometries, count);
            pointers.iter().map(|&pointer| *pointer).collect()
        } else if count == 0 {
            Vec::new()
        } else {
            std::slice::from_raw_parts(info.p_geometries, count).to_vec()
        };
        let mut found = None;
        let triangles = vk::GeometryTypeKHR::TRIANGLES;
        for one in all.iter_mut().filter(|one| one.geometry_type == triangles) {
            let next = one.geometry.triangles.p_next.cast::<TrianglesMicromap>();
            if next.as_ref().is_some_and(|next| next.kind == TRIANGLES_MICROMAP) {
                found = next.as_ref();
                one.geometry.triangles.p_next = (*next).next.cast::<c_void>();
            }
        }
        (all, found)
    }
}

pub unsafe extern "system" fn build(
    commands: vk::CommandBuffer,
    count: u32,
    infos: *const vk::AccelerationStructureBuildGeometryInfoKHR,
    ranges: *const *const vk::AccelerationStructureBuildRangeInfoKHR,
) {
    // SAFETY: the arguments are the caller's. The data read here was uploaded by commands that have ended,
    // because the samples wait for each submission.
    unsafe {
        let infos = std::slice::from_raw_parts(infos, count as usize);
        let ranges = std::slice::from_raw_parts(ranges, count as usize);
        let (mut kept, mut kept_ranges) = (Vec::new(), Vec::new());
        let mut geometries = Vec::new();
        for (info, &range) in infos.iter().zip(ranges) {
            if info.ty.as_raw() == MICROMAP {
                record().hold(range.is_null(), "ppBuildRangeInfos is NULL");
                micromap(info);
                continue;
            }
            let (passed, micromap) = passed_on(info);
            if let Some(micromap) = micromap {
                bottom_level(&passed[0], micromap, (*range).primitive_count);
            }
            geometries.push(passed);
            kept.push(*info);
            kept_ranges.push(range);
        }
        for (info, geometries) in kept.iter_mut().zip(&geometries) {
            info.p_geometries = geometries.as_ptr();
            info.pp_geometries = std::ptr::null();
        }
        if !kept.is_empty() {
            let build: vk::PFN_vkCmdBuildAccelerationStructuresKHR =
                function(commands, c"vkCmdBuildAccelerationStructuresKHR")
                    .expect("it was asked for");
            build(commands, kept.len() as u32, kept.as_ptr(), kept_ranges.as_ptr());
        }
    }
}

/// # Safety
/// As for [`Input::read`].
unsafe fn micromap(info: &vk::AccelerationStructureBuildGeometryInfoKHR) {
    let mut record = record();
    record.hold(info.mode == vk::BuildAccelerationStructureModeKHR::BUILD, "mode");
    let source = info.src_acceleration_structure;
    record.hold(source == vk::AccelerationStructureKHR::null(), "no source");
    // SAFETY: the caller's promise; any address may be read as a number.
    let (input, scratch) =
        unsafe { (Input::of(info, &mut record), info.scratch_data.device_address) };
    record.hold(scratch != 0, "scratch");
    let Some(input) = input else { return record.hold(false, "a micromap's data") };
    // SAFETY: the caller's promise.
    let (level, states) = unsafe { input.read(&mut record) };
    let (triangles, needed) = (input.triangles(), input.needed());
    let fits = record.get(info.dst_acceleration_structure).is_some_and(|built| {
        built.triangles = Some(triangles);
        built.size >= needed
    });
    record.hold(fits, "a destination that is a micromap with room for it");
    let mut line = format!("micromap {level} ");
    states.iter().for_each(|byte| write!(line, "{byte:02x}").expect("a text takes all"));
    record.tell(line);
}

/// # Safety
/// As for [`Input::read`].
unsafe fn bottom_level(
    geometry: &vk::AccelerationStructureGeometryKHR,
    micromap: &TrianglesMicromap,
    count: u32,
) {
    let mut record = record();
    let is_u32 = micromap.index_type == vk::IndexType::UINT32.as_raw();
    record.hold(is_u32 && micromap.stride == 4 && micromap.indices != 0, "indices of 32 bits");
    record.hold(micromap.next.is_null(), "TrianglesMicromap pNext");
    let known = record.get(micromap.micromap).and_then(|known| known.triangles);
    record.hold(known.is_some(), "a micromap that is built");
    // SAFETY: the caller's promise; indices have 32 bits.
    let (corners, indices) = unsafe {
        let corners = geometry.geometry.triangles.index_data.device_address as *const u32;
        let indices = micromap.indices as *const u32;
        (
            std::slice::from_raw_parts(corners, 3 * count as usize),
            std::slice::from_raw_parts(indices, count as usize),
        )
    };
    let last = indices.iter().max().map_or(0, |last| last + micromap.base);
    record.hold(known.is_some_and(|known| last < known), "indices of triangles that there are");
    let numbers = |all: &[u32]| all.iter().map(u32::to_string).collect::<Vec<_>>().join(",");
    record.tell(format!("level {} {}", numbers(corners), numbers(indices)));
}
