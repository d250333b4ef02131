//! Camera bookmarks of a chapter's reader, one per digit.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::DVec3;

use crate::files::{cache, read_cached, write_whole};
use crate::scene::Camera;

/// Cameras by digit, stored in the cache `bookmarks` between runs.
pub struct Bookmarks {
    /// `None` if the system has no place for caches.
    file: Option<PathBuf>,
    /// Eye, target, up, field of view.
    places: BTreeMap<usize, [f64; 10]>,
}

impl Bookmarks {
    /// The bookmarks of a chapter; empty if there is no file, or it cannot be read.
    pub fn open(name: &str) -> Self {
        Self::open_in(cache::folder("bookmarks").as_deref(), name)
    }

    fn open_in(folder: Option<&Path>, name: &str) -> Self {
        let file = folder.map(|folder| folder.join(name).with_extension("json"));
        let read = file.as_deref().and_then(read_cached);
        let places = read.and_then(|bytes| serde_json::from_slice(&bytes).ok());
        Self { file, places: places.unwrap_or_default() }
    }

    /// The camera that was stored under a digit.
    pub fn get(&self, digit: usize) -> Option<Camera> {
        let place = self.places.get(&digit)?;
        let point = |at: usize| DVec3::from_slice(&place[at..at + 3]);
        Some(Camera { eye: point(0), target: point(3), up: point(6), fov_y: place[9] })
    }

    /// Stores a camera.
    pub fn set(&mut self, digit: usize, camera: Camera) {
        let mut place = [camera.fov_y; 10];
        for (part, point) in place.chunks_mut(3).zip([camera.eye, camera.target, camera.up]) {
            part.copy_from_slice(&point.to_array());
        }
        self.places.insert(digit, place);
        // Bookmarks that cannot be written still work during this run.
        let Some(file) = &self.file else { return };
        let _ = file.parent().map(std::fs::create_dir_all);
        let _ = serde_json::to_vec(&self.places).map(|bytes| write_whole(file, &bytes));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_there_again_in_the_next_run() {
        let folder = tempfile::tempdir().unwrap();
        let camera = Camera::new(DVec3::new(0.1, 2.0, 1e9), DVec3::splat(1.0 / 3.0), 30.0);
        let mut bookmarks = Bookmarks::open_in(Some(folder.path()), "02_basic");
        assert_eq!(bookmarks.get(3), None);
        bookmarks.set(3, camera);
        assert_eq!(Bookmarks::open_in(Some(folder.path()), "02_basic").get(3), Some(camera));
        assert_eq!(Bookmarks::open_in(Some(folder.path()), "03_any_hit").get(3), None);
    }

    #[cfg(unix)]
    #[test]
    fn what_could_deliver_without_end_holds_no_bookmarks() {
        let folder = tempfile::tempdir().unwrap();
        std::os::unix::fs::symlink("/dev/zero", folder.path().join("02_basic.json")).unwrap();
        assert_eq!(Bookmarks::open_in(Some(folder.path()), "02_basic").get(3), None);
    }
}
