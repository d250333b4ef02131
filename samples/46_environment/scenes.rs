//! The scenes of 45, and the skies of this chapter.

use anyhow::{Context, Result};
use common::model::panorama::Panorama;
use common::output;
use common::scene::{Scene, assets};
use common::{Setup, UsageError};

use super::rough_scenes::{self, SceneName, Sky, Staged};

common::shader_enum! {
    /// The names of the skies.
    pub enum SkyName {
        /// A clear sky with a small sun.
        Day,
        /// The last light behind clouds.
        Evening,
        /// White from all sides.
        White,
        /// The file of `--sky`.
        File,
    }
}

/// The skies to choose from.
pub struct Skies {
    day: Panorama,
    evening: Panorama,
    file: Option<Panorama>,
}

impl Skies {
    /// Reads the book's own skies and the one named by `--sky`.
    ///
    /// # Errors
    /// If a file is missing or wrong.
    pub fn open(setup: &Setup) -> Result<Self> {
        let own = |name: &str| Ok::<_, anyhow::Error>(Panorama::open(&assets().join(name))?.0);
        let file = setup.sky().map(Panorama::open).transpose()?;
        let file = file.map(|(file, warnings)| {
            output::warn(&warnings);
            file
        });
        Ok(Self { day: own("day.exr")?, evening: own("evening.exr")?, file })
    }

    /// The sky to begin with.
    pub fn first(&self) -> SkyName {
        if self.file.is_some() { SkyName::File } else { SkyName::Day }
    }

    /// The picture of a sky.
    ///
    /// # Errors
    /// If it is that of a file, and there is none.
    pub fn picture(&self, name: SkyName) -> Result<Panorama> {
        Ok(match name {
            SkyName::Day => self.day.clone(),
            SkyName::Evening => self.evening.clone(),
            SkyName::White => Panorama { width: 2, height: 1, texels: vec![[1.0; 3]; 2] },
            SkyName::File => {
                let what =
                    || UsageError("sky=file shows the file of --sky FILE.exr; name one".to_owned());
                self.file.clone().with_context(what)?
            }
        })
    }
}

/// A scene of 45, and the sky that belongs to it: white for a furnace, and the first otherwise.
pub fn staged(name: SceneName, source: &Scene, first: SkyName) -> (Scene, SkyName) {
    let Staged { scene, sky, sun: _sun } = Staged::new(name, source);
    (scene, if sky == Sky::White { SkyName::White } else { first })
}

/// The royals of 45.
///
/// # Errors
/// If the model cannot be read.
pub fn chess() -> Result<Scene> {
    rough_scenes::chess()
}
