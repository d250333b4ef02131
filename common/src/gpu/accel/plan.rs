//! The input and options of an acceleration structure, and the part that an update must not change.

use std::ptr;

use anyhow::{Result, bail, ensure};
use ash::vk;

use super::{BuildOptions, Input, input};
use crate::gpu::{Geometry, Gpu};

/// The description of a structure before it is built, needed again to rebuild or update it.
#[derive(Clone)]
pub(super) struct Plan {
    pub(super) name: String,
    pub(super) options: BuildOptions,
    pub(super) geometries: Vec<Geometry>,
    /// Bytes a build needs for the structure, more than after compaction; and bytes of scratch for a build and for
    /// an update.
    pub(super) sizes: vk::AccelerationStructureBuildSizesInfoKHR<'static>,
}

impl Plan {
    /// # Errors
    /// If a count exceeds the device's limit, or the input is in no buffer.
    pub(super) fn new(gpu: &Gpu, (name, list): Input, options: BuildOptions) -> Result<Self> {
        let mut sizes = vk::AccelerationStructureBuildSizesInfoKHR::default();
        let (name, geometries) = (name.to_owned(), list.to_vec());
        let plan = Self { name, options, geometries, sizes };
        let described = plan.described(&plan.geometries);
        let counts: Vec<_> = plan.geometries.iter().map(Geometry::count).collect();
        let limits = &gpu.limits.acceleration_structure;
        let (what, limit) = match plan.level() {
            vk::AccelerationStructureTypeKHR::TOP_LEVEL => ("instances", limits.max_instance_count),
            _ => ("primitives", limits.max_primitive_count),
        };
        let total: u64 = counts.iter().map(|&count| u64::from(count)).sum();
        let name = &plan.name;
        ensure!(total <= limit, "'{name}' has {total} {what}; {} takes {limit}", gpu.name);
        let (parts, most) = (plan.geometries.len() as u64, limits.max_geometry_count);
        ensure!(parts <= most, "'{name}' has {parts} geometries; {} takes {most}", gpu.name);
        input::check_arrays(gpu, name, &plan.geometries)?;
        if gpu.is_validated() {
            input::check_contents(gpu, name, &plan.geometries)?;
        }
        // SAFETY: info and counts describe the same geometries.
        unsafe {
            gpu.acceleration_structure.get_acceleration_structure_build_sizes(
                vk::AccelerationStructureBuildTypeKHR::DEVICE,
                &plan.info(&described),
                &counts,
                &mut sizes,
            );
        }
        Ok(Self { sizes, ..plan })
    }

    /// The level of the structure.
    pub(super) fn level(&self) -> vk::AccelerationStructureTypeKHR {
        match self.geometries[..] {
            [Geometry::Instances { .. }] => vk::AccelerationStructureTypeKHR::TOP_LEVEL,
            _ => vk::AccelerationStructureTypeKHR::BOTTOM_LEVEL,
        }
    }

    /// Geometries in Vulkan's form, triangles with the plan's micromap.
    pub(super) fn described(
        &self,
        list: &[Geometry],
    ) -> Vec<vk::AccelerationStructureGeometryKHR<'_>> {
        let mut all: Vec<_> = list.iter().map(Geometry::described).collect();
        for one in all.iter_mut().filter(|one| one.geometry_type == vk::GeometryTypeKHR::TRIANGLES)
        {
            let micromap = self.options.micromap.as_ref();
            one.geometry.triangles.p_next =
                micromap.map_or(ptr::null(), |one| ptr::from_ref(one).cast());
        }
        all
    }

    /// The build info, the same for the size query, the build and every update.
    pub(super) fn info<'a>(
        &self,
        geometries: &'a [vk::AccelerationStructureGeometryKHR],
    ) -> vk::AccelerationStructureBuildGeometryInfoKHR<'a> {
        use vk::BuildAccelerationStructureFlagsKHR as Flags;
        // ANCHOR: flags
        let mut flags = Flags::PREFER_FAST_TRACE;
        if self.options.updatable {
            flags |= Flags::ALLOW_UPDATE;
        }
        if self.options.compact {
            flags |= Flags::ALLOW_COMPACTION;
        }
        if self.options.data_access {
            flags |= Flags::ALLOW_DATA_ACCESS;
        }
        // ANCHOR_END: flags
        vk::AccelerationStructureBuildGeometryInfoKHR::default()
            .ty(self.level())
            .flags(flags)
            .geometries(geometries)
    }

    /// Fails unless the structure can be updated with these geometries: only the addresses may differ.
    ///
    /// # Errors
    /// Names the first difference, with both values.
    pub(super) fn check(&self, new: &[Geometry]) -> Result<()> {
        let name = &self.name;
        let is_top = |list: &[Geometry]| matches!(list, [Geometry::Instances { .. }]);
        match (&self.geometries[..], new) {
            ([Geometry::Instances { count: was, .. }], [Geometry::Instances { count: is, .. }]) => {
                ensure!(
                    was == is,
                    "'{name}' was built of {was} instances and cannot be updated to {is}: build another"
                )
            }
            (was, is) if is_top(was) != is_top(is) => {
                bail!("'{name}' is of the other level: no update changes that")
            }
            (was, is) => {
                ensure!(
                    was.len() == is.len(),
                    "'{name}' was built of {} geometries and cannot be updated to {}: build another",
                    was.len(),
                    is.len()
                );
                for (index, (was, is)) in was.iter().zip(is).enumerate() {
                    ensure!(
                        was.without_addresses() == is.without_addresses(),
                        "geometry {index} of '{name}' was built as {was} and cannot be updated to {is}: \
                         build another"
                    );
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangles(vertex_count: u32, count: u32, opaque: bool) -> Geometry {
        Geometry::Triangles {
            vertices: 0x1000,
            vertex_stride: 12,
            vertex_count,
            indices: 0x2000,
            count,
            opaque,
            no_duplicate_any_hit: false,
        }
    }

    fn built(name: &str, geometries: &[Geometry]) -> Plan {
        let (name, geometries) = (name.into(), geometries.to_vec());
        Plan { name, options: BuildOptions::default(), geometries, sizes: Default::default() }
    }

    fn refused(was: &[Geometry], is: &[Geometry]) -> String {
        built("flag", was).check(is).unwrap_err().to_string()
    }

    #[test]
    fn an_update_may_move_what_there_is_and_read_it_from_elsewhere() {
        let Geometry::Triangles { vertex_count, count, opaque, no_duplicate_any_hit, .. } =
            triangles(9, 8, true)
        else {
            unreachable!()
        };
        let elsewhere = Geometry::Triangles {
            vertices: 0x5000,
            vertex_stride: 32,
            vertex_count,
            indices: 0x6000,
            count,
            opaque,
            no_duplicate_any_hit,
        };
        built("flag", &[triangles(9, 8, true)]).check(&[elsewhere]).unwrap();
    }

    #[test]
    fn what_a_build_has_fixed_no_update_changes() {
        let flag = [triangles(9, 8, true)];
        let boxes = [Geometry::Aabbs { boxes: 0x1000, count: 8, opaque: true }];
        for (new, words) in [
            (
                &[triangles(9, 7, true)][..],
                "8 triangles of 9 vertices, opaque and cannot be updated to 7 triangles",
            ),
            (&[triangles(10, 8, true)], "updated to 8 triangles of 10 vertices, opaque"),
            (&[triangles(9, 8, false)], "updated to 8 triangles of 9 vertices, not opaque"),
            (&boxes, "updated to 8 boxes, opaque"),
            (&[flag[0], flag[0]], "built of 1 geometries and cannot be updated to 2"),
            (&[], "cannot be updated to 0"),
        ] {
            let line = refused(&flag, new);
            assert!(line.contains(words) && line.ends_with(": build another"), "{line}");
        }
        let instances = |count| [Geometry::Instances { instances: 0x1000, count }];
        let few = built("top level", &instances(3));
        let line = few.check(&instances(4)).unwrap_err().to_string();
        assert_eq!(
            line,
            "'top level' was built of 3 instances and cannot be updated to 4: build another"
        );
        let level = few.check(&flag).unwrap_err();
        assert!(level.to_string().contains("the other level"), "{level}");
    }
}
