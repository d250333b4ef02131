//! The options a sample is created with.

use std::cell::Cell;
use std::path::{Path, PathBuf};

use anyhow::Result;

use super::Args;
use crate::UsageError;
use crate::model::text::shown;
use crate::scene::{Look, Scene, SceneOptions};
use crate::{output, paths};

/// The options a sample is created with.
pub struct Setup {
    /// Options for building acceleration structures: in spatial order, unless `--unordered` is given.
    pub options: SceneOptions,
    scene: Option<PathBuf>,
    scene_taken: Cell<bool>,
    sky: Option<PathBuf>,
    sky_taken: Cell<bool>,
}

impl Setup {
    /// The setup requested by arguments.
    pub fn new(args: &Args) -> Self {
        let options = SceneOptions { ordering: !args.unordered, ..SceneOptions::default() };
        Self {
            options,
            scene: args.scene.clone(),
            scene_taken: Cell::new(false),
            sky: args.sky.clone(),
            sky_taken: Cell::new(false),
        }
    }

    /// The file named by `--scene`, for a sample that accepts more than models.
    pub fn scene(&self) -> Option<&Path> {
        self.scene_taken.set(true);
        self.scene.as_deref()
    }

    /// The file named by `--sky`, for a sample that is lit by a picture.
    pub fn sky(&self) -> Option<&Path> {
        self.sky_taken.set(true);
        self.sky.as_deref()
    }

    /// The scene named by `--scene`, else the chapter's own. Warnings about a file go to standard error.
    ///
    /// # Errors
    /// If a file is missing or wrong; for a scene file of chapter 25, [`UsageError`].
    pub fn scene_or(&self, own: impl FnOnce() -> Result<Scene>) -> Result<Scene> {
        self.scene_with(&[], own)
    }

    /// As [`Setup::scene_or`], for a chapter that shows these looks of a material. A file that needs another has a
    /// warning.
    ///
    /// # Errors
    /// As [`Setup::scene_or`].
    pub fn scene_with(&self, looks: &[Look], own: impl FnOnce() -> Result<Scene>) -> Result<Scene> {
        let Some(path) = self.scene() else {
            return own().inspect(|scene| output::warn(&scene.model.warnings));
        };
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml")) {
            let what = match paths::folder() {
                None => {
                    "a scene file, which 25_scene_effects alone reads; this chapter takes an OBJ or glTF file"
                }
                Some(_) => "a scene file of the book; this program takes an OBJ or glTF file",
            };
            return Err(UsageError(format!("{}: {what}", shown(path))).into());
        }
        let mut scene = Scene::open(path)?;
        let lights = scene.model.lights.len();
        if lights > 0 {
            let lit = "this chapter has its own; 25_scene_effects shows them";
            scene
                .model
                .warnings
                .push(format!("{}: has lights; {lit} ({lights} in all)", shown(path)));
        }
        scene.show_only(looks, &shown(path).to_string());
        output::warn(&scene.model.warnings);
        Ok(scene)
    }

    /// Fails if a scene or a sky was given to a sample that does not accept one.
    pub(super) fn check(&self) -> Result<(), UsageError> {
        let what = if paths::folder().is_none() { "chapter" } else { "program" };
        for (thing, is_given, is_taken) in [
            ("scene", self.scene.is_some(), self.scene_taken.get()),
            ("sky", self.sky.is_some(), self.sky_taken.get()),
        ] {
            if is_given && !is_taken {
                let line = format!("this {what} brings its own {thing} and takes no --{thing}");
                return Err(UsageError(line));
            }
        }
        Ok(())
    }
}
