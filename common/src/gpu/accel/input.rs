//! What an acceleration structure is built from, and what of it an update must leave as it was.

use anyhow::{Result, ensure};
use ash::vk;

use crate::gpu::geometry::{self, Geometry};

/// What a build or an update reads.
#[derive(Clone, Copy)]
pub enum Input<'a> {
    /// The geometries of a bottom level; their order is their `gl_GeometryIndexEXT`.
    Geometries(&'a [Geometry]),
    /// The instances of a top level: the address of the first `VkAccelerationStructureInstanceKHR`, and how
    /// many there are.
    Instances(vk::DeviceAddress, u32),
}

/// What a build fixes: how many geometries there are, and of each what [`Geometry`] says but addresses and the
/// stride; or how many instances.
#[derive(Clone, PartialEq)]
pub(super) enum Shape {
    /// Of a bottom level.
    Geometries(Vec<Geometry>),
    /// Of a top level.
    Instances(u32),
}

impl Input<'_> {
    /// Of which level the structure is.
    pub(super) fn level(&self) -> vk::AccelerationStructureTypeKHR {
        match self {
            Self::Geometries(_) => vk::AccelerationStructureTypeKHR::BOTTOM_LEVEL,
            Self::Instances(..) => vk::AccelerationStructureTypeKHR::TOP_LEVEL,
        }
    }

    /// As Vulkan takes it.
    pub(super) fn described(&self) -> Vec<vk::AccelerationStructureGeometryKHR<'static>> {
        match self {
            Self::Geometries(list) => list.iter().map(Geometry::described).collect(),
            Self::Instances(address, _) => vec![geometry::of_instances(*address)],
        }
    }

    /// How many primitives each geometry has.
    pub(super) fn counts(&self) -> Vec<u32> {
        match self {
            Self::Geometries(list) => list.iter().map(Geometry::count).collect(),
            Self::Instances(_, count) => vec![*count],
        }
    }

    /// What a build from this fixes.
    pub(super) fn shape(&self) -> Shape {
        match self {
            Self::Geometries(list) => {
                Shape::Geometries(list.iter().map(Geometry::without_addresses).collect())
            }
            Self::Instances(_, count) => Shape::Instances(*count),
        }
    }
}

impl Shape {
    /// Of which level the structure is.
    pub(super) fn level(&self) -> vk::AccelerationStructureTypeKHR {
        match self {
            Self::Geometries(_) => vk::AccelerationStructureTypeKHR::BOTTOM_LEVEL,
            Self::Instances(_) => vk::AccelerationStructureTypeKHR::TOP_LEVEL,
        }
    }

    /// Fails unless the structure 'name', which was built with this, may be updated to that.
    ///
    /// # Errors
    /// With the first thing that differs, as it was and as it would be.
    pub(super) fn check(&self, name: &str, new: &Self) -> Result<()> {
        match (self, new) {
            (Self::Instances(was), Self::Instances(is)) => ensure!(
                was == is,
                "'{name}' was built of {was} instances and cannot be updated to {is}: build another"
            ),
            (Self::Geometries(was), Self::Geometries(is)) => {
                ensure!(
                    was.len() == is.len(),
                    "'{name}' was built of {} geometries and cannot be updated to {}: build another",
                    was.len(),
                    is.len()
                );
                for (index, (was, is)) in was.iter().zip(is).enumerate() {
                    ensure!(
                        was == is,
                        "geometry {index} of '{name}' was built as {was} and cannot be updated to {is}: \
                         build another"
                    );
                }
            }
            _ => anyhow::bail!("'{name}' is of the other level: no update changes that"),
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

    fn refused(was: &[Geometry], is: &[Geometry]) -> String {
        let [was, is] = [was, is].map(|list| Input::Geometries(list).shape());
        was.check("flag", &is).unwrap_err().to_string()
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
        let [was, is] =
            [&[triangles(9, 8, true)], &[elsewhere]].map(|list| Input::Geometries(list).shape());
        was.check("flag", &is).unwrap();
    }

    #[test]
    fn what_a_build_has_fixed_no_update_changes() {
        let built = [triangles(9, 8, true)];
        let boxes = [Geometry::Aabbs { boxes: 0x1000, count: 8, opaque: true }];
        for (new, words) in [
            (
                &[triangles(9, 7, true)][..],
                "8 triangles of 9 vertices, opaque and cannot be updated to 7 triangles",
            ),
            (&[triangles(10, 8, true)], "updated to 8 triangles of 10 vertices, opaque"),
            (&[triangles(9, 8, false)], "updated to 8 triangles of 9 vertices, not opaque"),
            (&boxes, "updated to 8 boxes, opaque"),
            (&[built[0], built[0]], "built of 1 geometries and cannot be updated to 2"),
            (&[], "cannot be updated to 0"),
        ] {
            let line = refused(&built, new);
            assert!(line.contains(words) && line.ends_with(": build another"), "{line}");
        }
        let [few, many] = [3, 4].map(|count| Input::Instances(0x1000, count).shape());
        let line = few.check("top level", &many).unwrap_err().to_string();
        assert_eq!(
            line,
            "'top level' was built of 3 instances and cannot be updated to 4: build another"
        );
        let level = few.check("top level", &Input::Geometries(&built).shape()).unwrap_err();
        assert!(level.to_string().contains("the other level"), "{level}");
    }
}
