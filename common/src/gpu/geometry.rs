//! What acceleration structures are built from: triangles, boxes, instances.

use std::fmt::{Display, Formatter};

use ash::vk;

/// What a bottom level is built from.
#[derive(Clone, Copy, PartialEq)]
pub enum Geometry {
    /// Indexed triangles: three `u32` each, over positions of three `f32`.
    Triangles {
        /// Address of the first position.
        vertices: vk::DeviceAddress,
        /// Bytes from one position to the next.
        vertex_stride: u64,
        /// How many positions there are.
        vertex_count: u32,
        /// Address of the first index.
        indices: vk::DeviceAddress,
        /// How many triangles there are.
        count: u32,
        /// Never call an any-hit shader for it.
        opaque: bool,
        /// Call it at most once a triangle and ray, even where the device holds a triangle twice.
        no_duplicate_any_hit: bool,
    },
    /// Axis-aligned boxes for an intersection shader: six `f32` each, the low corner first.
    Aabbs {
        /// Address of the first box.
        boxes: vk::DeviceAddress,
        /// How many boxes there are.
        count: u32,
        /// Never call an any-hit shader for it.
        opaque: bool,
    },
}

impl Geometry {
    /// How many triangles or boxes there are.
    pub fn count(&self) -> u32 {
        let (Self::Triangles { count, .. } | Self::Aabbs { count, .. }) = *self;
        count
    }

    /// What of it an update must not change: all but where it lies.
    pub(super) fn without_addresses(&self) -> Self {
        match *self {
            Self::Triangles { vertex_count, count, opaque, no_duplicate_any_hit, .. } => {
                let (vertices, indices, vertex_stride) = (0, 0, 0);
                Self::Triangles {
                    vertices,
                    vertex_stride,
                    vertex_count,
                    indices,
                    count,
                    opaque,
                    no_duplicate_any_hit,
                }
            }
            Self::Aabbs { count, opaque, .. } => Self::Aabbs { boxes: 0, count, opaque },
        }
    }

    /// As Vulkan takes it.
    pub(super) fn described(&self) -> vk::AccelerationStructureGeometryKHR<'static> {
        let address = |device_address| vk::DeviceOrHostAddressConstKHR { device_address };
        let (kind, data, opaque, once) = match *self {
            Self::Triangles {
                vertices,
                vertex_stride,
                vertex_count,
                indices,
                opaque,
                no_duplicate_any_hit,
                ..
            } => (
                vk::GeometryTypeKHR::TRIANGLES,
                vk::AccelerationStructureGeometryDataKHR {
                    triangles: vk::AccelerationStructureGeometryTrianglesDataKHR::default()
                        .vertex_format(vk::Format::R32G32B32_SFLOAT)
                        .vertex_data(address(vertices))
                        .vertex_stride(vertex_stride)
                        .max_vertex(vertex_count.saturating_sub(1))
                        .index_type(vk::IndexType::UINT32)
                        .index_data(address(indices)),
                },
                opaque,
                no_duplicate_any_hit,
            ),
            Self::Aabbs { boxes, opaque, .. } => (
                vk::GeometryTypeKHR::AABBS,
                vk::AccelerationStructureGeometryDataKHR {
                    aabbs: vk::AccelerationStructureGeometryAabbsDataKHR::default()
                        .data(address(boxes))
                        .stride(size_of::<vk::AabbPositionsKHR>() as u64),
                },
                opaque,
                false,
            ),
        };
        let mut flags = vk::GeometryFlagsKHR::empty();
        if opaque {
            flags |= vk::GeometryFlagsKHR::OPAQUE;
        }
        if once {
            flags |= vk::GeometryFlagsKHR::NO_DUPLICATE_ANY_HIT_INVOCATION;
        }
        vk::AccelerationStructureGeometryKHR::default()
            .geometry_type(kind)
            .geometry(data)
            .flags(flags)
    }
}

impl Display for Geometry {
    /// What of it an update must not change.
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let opaque = |opaque: bool| if opaque { "opaque" } else { "not opaque" };
        match *self {
            Self::Triangles { vertex_count, count, opaque: is, no_duplicate_any_hit, .. } => {
                let once = if no_duplicate_any_hit { ", each any-hit once" } else { "" };
                write!(f, "{count} triangles of {vertex_count} vertices, {}{once}", opaque(is))
            }
            Self::Aabbs { count, opaque: is, .. } => write!(f, "{count} boxes, {}", opaque(is)),
        }
    }
}

/// A top level's only geometry, as Vulkan takes it.
pub(super) fn of_instances(
    instances: vk::DeviceAddress,
) -> vk::AccelerationStructureGeometryKHR<'static> {
    let data = vk::DeviceOrHostAddressConstKHR { device_address: instances };
    vk::AccelerationStructureGeometryKHR::default()
        .geometry_type(vk::GeometryTypeKHR::INSTANCES)
        .geometry(vk::AccelerationStructureGeometryDataKHR {
            instances: vk::AccelerationStructureGeometryInstancesDataKHR::default().data(data),
        })
}
