//! Scene files, version 1, and what they describe. Read by chapter 25 alone.

mod bounded;
mod compose;
mod composition;
mod description;
mod polytope;
mod source;

pub use composition::{
    BoardPlane, Box, Composition, Face, Heightfield, MAX_LIGHTS, SceneLight, Solid, Sphere,
};
