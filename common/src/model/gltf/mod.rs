//! glTF 2.0: models of many meshes and nodes, as most programs write them today.
//!
//! The `gltf` crate parses the JSON. Everything it leads to, buffers and images, accessors and the tree of nodes, is
//! read here within limits, because the files are untrusted.
//!
//! Source: Khronos Group, "glTF 2.0 Specification", 2021, <https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html>.

mod accessor;
mod camera;
mod container;
mod extensions;
mod extent;
mod features;
mod file;
mod image;
mod lights;
mod load;
mod material;
mod name;
mod nodes;
mod pose;
mod primitive;
mod range;
mod tally;
mod uri;

pub use load::{is_gltf, load};

#[cfg(test)]
mod tests;
