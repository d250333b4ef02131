//! The looks of a material that a chapter may not show.

use std::collections::BTreeSet;

use super::{Material, Scene};
use crate::model::text::quoted;

/// A look of a material that only some chapters show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Its surroundings are reflected: [`Material::is_mirror`].
    Mirror,
    /// A texture says where it has holes.
    Holes,
    /// Its opacity is below 1.
    Transparency,
    /// Light passes through it: [`Material::is_glass`].
    Glass,
}

impl Look {
    const ALL: [Self; 4] = [Self::Mirror, Self::Holes, Self::Transparency, Self::Glass];

    /// True if a material needs this look. Glass reflects and may have an opacity, but counts as glass alone.
    fn is_of(self, material: &Material) -> bool {
        match self {
            Self::Glass => material.is_glass(),
            Self::Mirror => material.is_mirror() && !material.is_glass(),
            Self::Holes => material.opacity_texture.is_some() && !material.is_glass(),
            Self::Transparency => material.opacity < 1.0 && !material.is_glass(),
        }
    }

    /// The words for a material that is shown without this look.
    fn left_out(self) -> &'static str {
        match self {
            Self::Mirror => {
                "is a mirror; this chapter shows its colour and highlight; 06_reflection shows it"
            }
            Self::Holes => "has holes; this chapter shows it whole; 03_any_hit shows them",
            Self::Transparency => {
                "is half transparent; this chapter shows it opaque; 25_scene_effects shows it"
            }
            Self::Glass => "is glass; this chapter shows it solid; 25_scene_effects shows it",
        }
    }
}

impl Scene {
    /// A warning for each look that the scene's instances need and a chapter does not show: the first such material,
    /// and the number of them.
    pub(crate) fn looks_left_out(&self, shown: &[Look]) -> Vec<String> {
        let used: BTreeSet<_> = self.instances.iter().map(|instance| instance.material).collect();
        let used = used.into_iter().filter_map(|number| self.model.materials.get(number));
        let used: Vec<_> = used.collect();
        let warning = |look: Look| {
            let with_look: Vec<_> = used.iter().filter(|material| look.is_of(material)).collect();
            let first = with_look.first()?;
            Some(format!(
                "material {} {} ({} in all)",
                quoted(&first.name),
                look.left_out(),
                with_look.len()
            ))
        };
        Look::ALL.into_iter().filter(|look| !shown.contains(look)).filter_map(warning).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::{Affine3A, Vec3};

    use super::*;
    use crate::model::Model;
    use crate::scene::{Camera, Instance};

    fn material(name: &str, illumination: u32, opacity: f32) -> Material {
        let specular = Vec3::splat(0.5);
        Material { name: name.to_owned(), illumination, opacity, specular, ..Material::default() }
    }

    #[test]
    fn each_look_that_is_used_and_not_shown_has_one_warning() {
        let materials = vec![
            material("matte", 2, 1.0),
            material("chrome", 3, 1.0),
            Material { opacity_texture: Some(0), ..material("leaf", 2, 1.0) },
            material("veil", 2, 0.5),
            material("lens", 7, 0.5),
            material("silver", 5, 1.0),
            material("unused", 3, 0.5),
        ];
        let used = [0, 5, 1, 2, 2, 3, 4].map(|material| Instance {
            mesh: 0,
            transform: Affine3A::IDENTITY,
            material,
            record_offset: 0,
        });
        let model = Model { materials, ..Model::default() };
        let scene = Scene { model, instances: used.to_vec(), camera: Camera::default() };
        let told = scene.looks_left_out(&[]);
        let starts = [
            ("material \"chrome\" is a mirror; ", "(2 in all)"),
            ("material \"leaf\" has holes; ", "(1 in all)"),
            ("material \"veil\" is half transparent; ", "(1 in all)"),
            ("material \"lens\" is glass; ", "(1 in all)"),
        ];
        assert_eq!(told.len(), starts.len(), "{told:?}");
        for (line, (start, end)) in told.iter().zip(starts) {
            assert!(line.starts_with(start) && line.ends_with(end), "{line}");
        }
        let told = scene.looks_left_out(&[Look::Mirror, Look::Transparency, Look::Glass]);
        assert!(told.len() == 1 && told[0].contains("\"leaf\""), "{told:?}");
    }
}
