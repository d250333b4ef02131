//! What scenes call for: effects, found from a scene alone, and the scene files that say what there is.
//!
//! Nothing here knows a device. The chapter makes its pipelines from these bits; its tests make scenes from
//! them.

mod composition;
mod effect;
mod file;
mod finding;
mod finish;
mod glass;
mod shapes;

pub use composition::{BoardPlane, Composition, FOCUS, Heightfield, Lens, MAX_LIGHTS, SceneLight};
pub use effect::{Effect, Effects};
pub use file::open;
pub use finding::{Finding, findings, needed};
pub use finish::{Finish, Pattern};
pub use glass::{Glass, GlassKind, is_glass};
pub use shapes::{Box, Face, Solid, Sphere};
