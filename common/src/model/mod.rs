//! Files from untrusted sources: OBJ models, MTL materials, PNG and JPEG textures, read within limits, with a warning
//! about faults that other loaders ignore.

mod encoding;
mod folder;
mod glass;
mod index;
mod limits;
mod mtl;
pub mod obj;
mod obj_check;
mod tally;
pub mod text;
mod texture;
mod warnings;

pub use glass::turn_outwards;
pub use obj::Model;
pub use texture::Texture;
