//! A screenshot of a window's view.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use ash::vk;

use crate::app::{Development, Picture};
use crate::gpu::Image;
use crate::output;

/// The picture to write.
#[derive(Default)]
pub struct Shot {
    /// True if a screenshot was requested and is not written yet.
    pub is_due: bool,
}

impl Shot {
    /// Writes the picture if it was requested and is `ready`, and returns its file.
    ///
    /// # Errors
    /// If the current folder is not writable.
    pub fn take(
        &mut self,
        ready: bool,
        image: &Image,
        (name, development): (&str, Development),
    ) -> Option<Result<PathBuf>> {
        let ready = self.is_due && ready;
        self.is_due &= !ready;
        ready.then(|| {
            let path = free_name(Path::new("."), name)?;
            let vk::Extent2D { width, height } = image.extent;
            let picture = Picture { width, height, pixels: image.read()? };
            output::warn(picture.not_finite().as_slice());
            development.save(picture, &path)?;
            Ok(path)
        })
    }
}

/// The first of `NAME-001.png`, `NAME-002.png`, … that does not exist.
fn free_name(folder: &Path, name: &str) -> Result<PathBuf> {
    for number in 1..1000 {
        let path = folder.join(format!("{name}-{number:03}.png"));
        if !path.try_exists().with_context(|| format!("cannot look for '{}'", path.display()))? {
            return Ok(path);
        }
    }
    bail!("there are 999 pictures of {name} here already")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_never_takes_the_name_of_another() {
        let folder = tempfile::tempdir().unwrap();
        for number in 1..=3 {
            let path = free_name(folder.path(), "02_basic").unwrap();
            assert_eq!(path, folder.path().join(format!("02_basic-00{number}.png")));
            std::fs::write(path, b"").unwrap();
        }
    }
}
