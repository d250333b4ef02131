//! Effects that scenes need, found from a scene alone, and the scene files that describe them.
//!
//! Nothing here knows a device. The chapter makes its pipelines from these bits; its tests make scenes from
//! them. What chapters 18, 27, 28, 29 and 33 teach of the host is read from their own files.

#[path = "../29_emitters/alias.rs"]
mod alias;
mod composition;
mod effect;
#[path = "../29_emitters/emitters.rs"]
mod emitters;
mod environment;
mod file;
mod finding;
mod finish;
mod glass;
#[path = "../27_glass/glass.rs"]
mod glass_of_27;
mod lamps;
#[path = "../28_depth_of_field/lens.rs"]
mod lens;
mod motion;
mod normal_maps;
mod rough;
mod shapes;
#[path = "../18_swept_spheres/strands.rs"]
mod strands;
#[allow(dead_code, reason = "33 also has a chain, and materials of its own")]
#[path = "../33_roots/tori.rs"]
mod tori;

pub use alias::Column;
pub use composition::{BoardPlane, Composition, FOCUS, Heightfield, MAX_LIGHTS, SceneLight};
pub use effect::{Effect, Effects};
pub use emitters::{Emitter, EmitterAddresses, Emitters};
pub use environment::{Environment, SKIES};
pub use file::open;
pub use finding::{Finding, findings, needed};
pub use finish::{Finish, Pattern, is_blended};
pub use glass::{Glass, GlassKind, is_body, is_glass};
pub use lamps::Lamps;
pub use lens::{Lens, ThinLens};
pub use motion::{Motion, Way};
pub use normal_maps::NORMAL_MAPS;
pub use rough::{is_rough, rough_textures};
pub use shapes::{Box, Face, Solid, Sphere};
pub use strands::{Node, Segment, Strands};
pub use tori::Torus;
