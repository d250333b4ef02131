//! Panel with the material's controls and the notes on effects.

use common::Controls;
use common::Variant;
use effects::{Environment, Finding, SKIES, is_glass, is_rough};
use glam::Vec3;

use crate::Demo;
use crate::costs::Costs;

impl Demo {
    /// Replaces the scene's sky by a picture, and turns it.
    pub fn choose_sky(&mut self, c: &mut Controls) {
        if c.one_of("sky", &mut self.sky, &["own", SKIES[0], SKIES[1]]) {
            let chosen = SKIES.get((self.sky as usize).wrapping_sub(1));
            match chosen.map(|name| Environment::own(name)).transpose() {
                Ok(sky) => self.scene.environment = sky.or(self.own_sky.clone()),
                Err(error) => self.trouble = Some(error),
            }
            self.repainted = true;
        }
        if let Some(sky) = &mut self.scene.environment {
            c.slider("sky rotation", &mut sky.rotation, -360.0..=360.0);
        }
    }

    /// Makes a material a mirror or glass, or no longer.
    pub fn polish(&mut self, c: &mut Controls) {
        let names: Vec<String> =
            self.scene.materials_in_use().map(|material| material.name.clone()).collect();
        if names.is_empty() {
            return;
        }
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        c.one_of("material", &mut self.material, &names);
        let chosen = names[self.material as usize];
        let materials = &self.scene.scene.model.materials;
        let Some(number) = materials.iter().position(|m| m.name == chosen) else { return };
        let may_be_glass = self.scene.may_be_glass(number as u32);
        let material = &mut self.scene.scene.model.materials[number];
        let mut glass = is_glass(material);
        if may_be_glass && c.checkbox("glass", &mut glass) {
            material.illumination = if glass { 7 } else { 2 };
            if glass && material.refraction == 1.0 {
                material.refraction = 1.5;
            }
            self.repainted = true;
        }
        let mut mirror = material.is_mirror() && !glass;
        // A rough surface is more or less of a mirror already.
        if !is_rough(material) && c.checkbox("mirror", &mut mirror) {
            material.illumination = if mirror { 3 } else { 2 };
            if mirror && material.specular == Vec3::ZERO {
                material.specular = Vec3::splat(0.5);
            }
            self.repainted = true;
        }
    }

    /// The effects, why they are in or out, and what they cost.
    pub fn tell(&self, c: &mut Controls) {
        for warning in &self.scene.scene.model.warnings {
            c.note("warning", warning);
        }
        let costs = self.costs.as_ref().map(Costs::all).unwrap_or_default();
        for Finding { effect, needed, why } in self.findings() {
            let cost = costs.iter().find(|cost| cost.effect == effect);
            let cost = cost.map_or(String::new(), |cost| format!(" · {:.1} ms", cost.milliseconds));
            let sign = if needed { "✔" } else { "–" };
            c.note(effect.name(), &format!("{sign} {why}{cost}"));
        }
        if let Some(Variant { pipeline, sbt, .. }) = self.pipelines.current() {
            let groups: usize = pipeline.groups.iter().sum();
            let milliseconds = pipeline.build_time.as_secs_f64() * 1e3;
            c.note("stages", &format!("{} in {groups} groups", pipeline.desc.stages.len()));
            c.note("SBT", &format!("{} bytes", sbt.layout.size));
            c.note("compiled in", &format!("{milliseconds:.0} ms"));
        }
    }
}
