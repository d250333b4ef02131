//! The extensions of glTF: those that are read, and a line about the others.

use anyhow::{Result, ensure};
use gltf::json::Root;

use super::features::Features;
use crate::model::text::quoted;

/// Extensions that are read, or change nothing of what is shown.
const READ: [&str; 11] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    // The default ones are shown.
    "KHR_materials_variants",
    "KHR_materials_volume",
    // Accessors of all component types are read.
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    // Metadata.
    "KHR_xmp_json_ld",
];

/// Copies of a mesh that are not nodes.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";
/// Compression of geometry, which may be used without being required.
pub(super) const COMPRESSED: [&str; 3] =
    ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Checks the extensions of a file. Those that it merely uses get a warning.
///
/// # Errors
/// Names one that the file requires and that is not read, and what to do about it.
pub(super) fn check(root: &Root, features: &mut Features) -> Result<()> {
    let is_read = |name: &&String| READ.contains(&name.as_str());
    if let Some(name) = root.extensions_required.iter().find(|name| !is_read(name)) {
        let cure = match name.as_str() {
            name if COMPRESSED.contains(&name) => {
                "its geometry is compressed; export it without compression"
            }
            "KHR_texture_basisu" => "its textures are KTX files; export it with PNG or JPEG",
            "EXT_texture_webp" | "EXT_texture_avif" | "MSFT_texture_dds" => {
                "its textures are of a kind that is not read; export it with PNG or JPEG"
            }
            _ => "export it without",
        };
        ensure!(false, "requires the extension {}, which is not read: {cure}", quoted(name));
    }
    if root.extensions_used.iter().any(|name| name == INSTANCING) {
        features.note("instancing", 1, || {
            format!(
                "places meshes many times by {INSTANCING}, which is not read; one of each is shown"
            )
        });
    }
    const NAMED: usize = 4;
    let mut others: Vec<_> = root.extensions_used.iter().filter(|name| !is_read(name)).collect();
    others.sort_unstable();
    others.dedup();
    if !others.is_empty() {
        let names: Vec<_> = others.iter().take(NAMED).map(|name| quoted(name)).collect();
        let more = if others.len() > NAMED { " and others" } else { "" };
        let names = names.join(", ");
        features.note("extensions", others.len(), || {
            format!("uses extensions that are not read, {names}{more}; the model is shown without")
        });
    }
    Ok(())
}
