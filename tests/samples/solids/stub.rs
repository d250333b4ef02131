//! Solids without pieces, and the rays of their views.

use std::sync::Arc;

use common::app::Picture;
use common::scene::Camera;
use glam::DVec3;
use reference::Ray;

use super::{FIELD_OF_VIEW, NAME, SIZE, View};
use run::Chapter;
use run::primary_hits::rays;

/// Solids without the pieces.
pub struct Stub;

impl Stub {
    /// A picture of one solid.
    pub fn seen(&self, (eye, target): View, name: &str, sets: &[&str]) -> Arc<Picture> {
        let one = Chapter::new(NAME).size(SIZE).sets(&["preset=one solid"]).set("solid", name);
        let seen = one.set("camera eye", text(eye)).set("camera target", text(target));
        seen.sets(sets).shared_picture()
    }

    /// The hits of rays: instance, face, t, and whether the ray was inside; -1 for a miss.
    pub fn hits(&self, view: View, name: &str, sets: &[&str]) -> Picture {
        let mut hits = (*self.seen(view, name, &[sets, &["show=hit"]].concat())).clone();
        with_kinds(&mut hits, &self.seen(view, name, &[sets, &["show=hit kind"]].concat()));
        hits
    }

    pub fn rays(&self, view: View) -> Vec<Ray> {
        let directions = self.seen(view, "cube", &["show=ray direction"]);
        rays(&Camera::new(view.0, view.1, FIELD_OF_VIEW), &directions).collect()
    }
}

/// Replaces the materials of hits by their kinds.
pub fn with_kinds(hits: &mut Picture, kinds: &Picture) {
    for (hit, kind) in hits.pixels.iter_mut().zip(&kinds.pixels) {
        hit[3] = kind[3];
    }
}

pub fn text(v: DVec3) -> String {
    format!("{:?},{:?},{:?}", v.x, v.y, v.z)
}
