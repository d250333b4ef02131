//! Solids without pieces, and the rays that look at them.

use common::app::Picture;
use common::scene::Camera;
use glam::DVec3;
use reference::Ray;

use super::{FIELD_OF_VIEW, NAME, SIZE, View};
use run::primary_hits::rays;
use run::render;

/// A model that loads faster than the pieces; solids alone do not need them.
pub struct Stub(tempfile::TempDir);

impl Stub {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mtl = "newmtl a\nKd 1 1 1\n";
        std::fs::write(folder.path().join("a.mtl"), mtl).unwrap();
        let obj = "mtllib a.mtl\no a\nusemtl a\nv 0 0 1e9\nv 1 0 1e9\nv 0 1 1e9\nf 1 2 3\n";
        std::fs::write(folder.path().join("a.obj"), obj).unwrap();
        Self(folder)
    }

    pub fn picture(&self, size: &str, sets: &[&str]) -> Picture {
        let scene = self.0.path().join("a.obj").display().to_string();
        let sets = sets.iter().flat_map(|&set| ["--set", set]);
        render(NAME, size, &sets.chain(["--scene", &scene]).collect::<Vec<_>>()).picture
    }

    /// One solid.
    pub fn seen(&self, (eye, target): View, name: &str, sets: &[&str]) -> Picture {
        let solid = format!("solid={name}");
        let [eye, target] =
            [format!("camera eye={}", text(eye)), format!("camera target={}", text(target))];
        let one = ["preset=one solid", &solid, &eye, &target];
        self.picture(SIZE, &[&one, sets].concat())
    }

    /// What rays meet of it: instance, face, t, and whether the ray was inside; -1 for a miss.
    pub fn hits(&self, view: View, name: &str, sets: &[&str]) -> Picture {
        let mut hits = self.seen(view, name, &[sets, &["show=hit"]].concat());
        with_kinds(&mut hits, &self.seen(view, name, &[sets, &["show=hit kind"]].concat()));
        hits
    }

    pub fn rays(&self, view: View) -> Vec<Ray> {
        let directions = self.seen(view, "cube", &["show=ray direction"]);
        rays(&Camera::new(view.0, view.1, FIELD_OF_VIEW), &directions).collect()
    }
}

/// Puts the kinds of hits where their materials were.
pub fn with_kinds(hits: &mut Picture, kinds: &Picture) {
    for (hit, kind) in hits.pixels.iter_mut().zip(&kinds.pixels) {
        hit[3] = kind[3];
    }
}

pub fn text(v: DVec3) -> String {
    format!("{:?},{:?},{:?}", v.x, v.y, v.z)
}
