//! The input of acceleration structure builds: triangles, boxes, instances.

use std::fmt::{Display, Formatter};

use ash::vk;

/// Input of an acceleration structure build: triangles and boxes for a bottom level, instances for a top level.
#[derive(Clone, Copy, PartialEq)]
pub enum Geometry {
    /// Indexed triangles: three `u32` each, over positions of three `f32`.
    Triangles {
        /// Address of the first position.
        vertices: vk::DeviceAddress,
        /// Bytes from one position to the next.
        vertex_stride: u64,
        /// Number of positions.
        vertex_count: u32,
        /// Address of the first index.
        indices: vk::DeviceAddress,
        /// Number of triangles.
        count: u32,
        /// Never call an any-hit shader for it.
        opaque: bool,
        /// Call it at most once per triangle and ray, even if the device stores a triangle twice.
        no_duplicate_any_hit: bool,
    },
    /// Axis-aligned boxes for an intersection shader: six `f32` each, the low corner first.
    Aabbs {
        /// Address of the first box.
        boxes: vk::DeviceAddress,
        /// Number of boxes.
        count: u32,
        /// Never call an any-hit shader for it.
        opaque: bool,
    },
    /// Instances of bottom levels: a top level's only geometry.
    Instances {
        /// Address of the first `VkAccelerationStructureInstanceKHR`.
        instances: vk::DeviceAddress,
        /// Number of instances.
        count: u32,
    },
}

impl Geometry {
    /// Number of triangles, boxes or instances.
    pub fn count(&self) -> u32 {
        let (Self::Triangles { count, .. }
        | Self::Aabbs { count, .. }
        | Self::Instances { count, .. }) = *self;
        count
    }

    /// The kind of geometry.
    pub(in crate::gpu) fn kind(&self) -> vk::GeometryTypeKHR {
        match self {
            Self::Triangles { .. } => vk::GeometryTypeKHR::TRIANGLES,
            Self::Aabbs { .. } => vk::GeometryTypeKHR::AABBS,
            Self::Instances { .. } => vk::GeometryTypeKHR::INSTANCES,
        }
    }

    /// The part that an update must not change: everything except the addresses.
    pub(in crate::gpu) fn without_addresses(&self) -> Self {
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
            Self::Instances { count, .. } => Self::Instances { instances: 0, count },
        }
    }

    /// In Vulkan's form.
    pub(in crate::gpu) fn described(&self) -> vk::AccelerationStructureGeometryKHR<'static> {
        let address = |device_address| vk::DeviceOrHostAddressConstKHR { device_address };
        let data = match *self {
            Self::Triangles { vertices, vertex_stride, vertex_count, indices, .. } => {
                vk::AccelerationStructureGeometryDataKHR {
                    triangles: vk::AccelerationStructureGeometryTrianglesDataKHR::default()
                        .vertex_format(vk::Format::R32G32B32_SFLOAT)
                        .vertex_data(address(vertices))
                        .vertex_stride(vertex_stride)
                        .max_vertex(vertex_count.saturating_sub(1))
                        .index_type(vk::IndexType::UINT32)
                        .index_data(address(indices)),
                }
            }
            // ANCHOR: aabbs
            Self::Aabbs { boxes, .. } => vk::AccelerationStructureGeometryDataKHR {
                aabbs: vk::AccelerationStructureGeometryAabbsDataKHR::default()
                    .data(address(boxes))
                    .stride(size_of::<vk::AabbPositionsKHR>() as u64),
            },
            // ANCHOR_END: aabbs
            Self::Instances { instances, .. } => vk::AccelerationStructureGeometryDataKHR {
                instances: vk::AccelerationStructureGeometryInstancesDataKHR::default()
                    .data(address(instances)),
            },
        };
        vk::AccelerationStructureGeometryKHR::default()
            .geometry_type(self.kind())
            .geometry(data)
            .flags(self.flags())
    }

    fn flags(&self) -> vk::GeometryFlagsKHR {
        let (opaque, once) = match *self {
            Self::Triangles { opaque, no_duplicate_any_hit, .. } => (opaque, no_duplicate_any_hit),
            Self::Aabbs { opaque, .. } => (opaque, false),
            Self::Instances { .. } => (false, false),
        };
        let mut flags = vk::GeometryFlagsKHR::empty();
        if opaque {
            flags |= vk::GeometryFlagsKHR::OPAQUE;
        }
        if once {
            flags |= vk::GeometryFlagsKHR::NO_DUPLICATE_ANY_HIT_INVOCATION;
        }
        flags
    }
}

impl Display for Geometry {
    /// Prints the part that an update must not change.
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let opaque = |opaque: bool| if opaque { "opaque" } else { "not opaque" };
        match *self {
            Self::Triangles { vertex_count, count, opaque: is, no_duplicate_any_hit, .. } => {
                let once = if no_duplicate_any_hit { ", each any-hit once" } else { "" };
                write!(f, "{count} triangles of {vertex_count} vertices, {}{once}", opaque(is))
            }
            Self::Aabbs { count, opaque: is, .. } => write!(f, "{count} boxes, {}", opaque(is)),
            Self::Instances { count, .. } => write!(f, "{count} instances"),
        }
    }
}
