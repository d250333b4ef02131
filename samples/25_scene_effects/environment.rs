//! The sky as a picture (46).

use std::path::Path;
use std::sync::Arc;

use anyhow::Result;
use common::model::panorama::Panorama;
use common::scene::assets;

/// A sky that is a picture.
#[derive(Clone, Debug)]
pub struct Environment {
    /// Its light from all directions.
    pub map: Arc<Panorama>,
    /// Degrees by which it is turned around the vertical.
    pub rotation: f32,
    /// Factor of its light.
    pub brightness: f32,
}

/// Names of the project's own skies, those of chapter 46.
pub const SKIES: [&str; 2] = ["day", "evening"];

impl Environment {
    /// Reads a file, and returns also what a user should know of it.
    ///
    /// # Errors
    /// If it is missing or not a picture of the sky.
    pub fn open(path: &Path) -> Result<(Self, Vec<String>)> {
        let (map, warnings) = Panorama::open(path)?;
        Ok((Self { map: Arc::new(map), rotation: 0.0, brightness: 1.0 }, warnings))
    }

    /// One of [`SKIES`].
    ///
    /// # Errors
    /// If its file is missing.
    pub fn own(name: &str) -> Result<Self> {
        Ok(Self::open(&assets().join(name).with_extension("exr"))?.0)
    }
}
