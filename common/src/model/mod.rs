//! Files from untrusted sources: OBJ and glTF models, MTL materials, PNG and JPEG textures, read within limits, with a
//! warning about faults that other loaders ignore.

mod elements;
mod encoding;
mod exr_file;
mod face;
mod folder;
mod glass;
pub mod gltf;
mod index;
mod limits;
mod load;
mod mtl;
mod mtl_keywords;
mod mtl_value;
mod number;
pub mod obj;
mod obj_check;
pub mod panorama;
mod parts;
mod polygon;
mod positions;
mod smoothing;
mod tally;
pub mod text;
mod texture;
mod unseen;
mod warnings;

pub use exr_file::ExrFile;
pub use glass::turn_outwards;
pub use obj::Model;
pub use texture::Texture;
