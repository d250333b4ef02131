//! The formats of images that shaders read and write: their names in SPIR-V, GLSL and Vulkan.

use ash::vk;
use rspirv::spirv::ImageFormat;

/// SPIR-V's name, GLSL's in `layout(…)`, and Vulkan's.
const FORMATS: [(ImageFormat, &str, vk::Format); 15] = [
    (ImageFormat::Rgba32f, "rgba32f", vk::Format::R32G32B32A32_SFLOAT),
    (ImageFormat::Rgba16f, "rgba16f", vk::Format::R16G16B16A16_SFLOAT),
    (ImageFormat::Rg32f, "rg32f", vk::Format::R32G32_SFLOAT),
    (ImageFormat::Rg16f, "rg16f", vk::Format::R16G16_SFLOAT),
    (ImageFormat::R32f, "r32f", vk::Format::R32_SFLOAT),
    (ImageFormat::R16f, "r16f", vk::Format::R16_SFLOAT),
    (ImageFormat::Rgba16, "rgba16", vk::Format::R16G16B16A16_UNORM),
    (ImageFormat::Rgba8, "rgba8", vk::Format::R8G8B8A8_UNORM),
    (ImageFormat::R8, "r8", vk::Format::R8_UNORM),
    (ImageFormat::Rgba32i, "rgba32i", vk::Format::R32G32B32A32_SINT),
    (ImageFormat::R32i, "r32i", vk::Format::R32_SINT),
    (ImageFormat::Rgba32ui, "rgba32ui", vk::Format::R32G32B32A32_UINT),
    (ImageFormat::Rg32ui, "rg32ui", vk::Format::R32G32_UINT),
    (ImageFormat::R32ui, "r32ui", vk::Format::R32_UINT),
    (ImageFormat::Rgba8ui, "rgba8ui", vk::Format::R8G8B8A8_UINT),
];

/// GLSL's name for a format; `None` for one that is not declared, or not known here.
pub fn layout(format: ImageFormat) -> Option<&'static str> {
    FORMATS.iter().find(|(spirv, ..)| *spirv == format).map(|(_, layout, _)| *layout)
}

/// As [`layout`], for Vulkan's name.
pub fn layout_of(format: vk::Format) -> Option<&'static str> {
    FORMATS.iter().find(|(.., vulkan)| *vulkan == format).map(|(_, layout, _)| *layout)
}
