//! The looks of a material that a chapter may not show.

use std::collections::BTreeSet;

use super::{Material, Scene};
use crate::model::Model;
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
    /// It has a metalness and a roughness.
    Microfacet,
    /// A texture turns its normals.
    NormalMap,
}

impl Look {
    const ALL: [Self; 6] = [
        Self::Mirror,
        Self::Holes,
        Self::Transparency,
        Self::Glass,
        Self::Microfacet,
        Self::NormalMap,
    ];

    /// True if a material needs this look. Glass reflects and may have an opacity, but counts as glass alone.
    fn is_of(self, material: &Material) -> bool {
        match self {
            Self::Glass => material.is_glass(),
            // One line is enough for a polished metal.
            Self::Mirror => {
                material.is_mirror() && !material.is_glass() && !Self::Microfacet.is_of(material)
            }
            Self::Holes => material.opacity_texture.is_some() && !material.is_glass(),
            Self::Transparency => material.opacity < 1.0 && !material.is_glass(),
            // A matte surface is the same without.
            Self::Microfacet => material.microfacet.as_ref().is_some_and(|microfacet| {
                !material.is_glass() && (microfacet.metallic > 0.0 || microfacet.roughness < 1.0)
            }),
            Self::NormalMap => material.normal_texture.is_some(),
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
            Self::Microfacet => {
                "has a metalness and a roughness; this chapter shows a colour, a highlight or a mirror instead; 45_rough_metal shows them"
            }
            Self::NormalMap => {
                "has a normal map; this chapter shows it smooth; 47_normal_maps shows it"
            }
        }
    }
}

impl Scene {
    /// Adds a warning for each look that the scene's instances need and a chapter does not show; `file` begins the line.
    /// Textures that only such a look reads are no longer kept.
    pub fn show_only(&mut self, shown: &[Look], file: &str) {
        let left_out = self.left_out(shown).into_iter().map(|what| format!("{file}: {what}"));
        let left_out: Vec<_> = left_out.collect();
        self.model.warnings.extend(left_out);
        self.model.remove_all_but(shown);
    }

    /// For each look that is needed and not shown, the first such material, and the number of them.
    fn left_out(&self, shown: &[Look]) -> Vec<String> {
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

impl Model {
    /// Removes metalness, roughness and normal maps that are not shown. A texture that nothing else reads becomes a
    /// single texel: it keeps its number, because the others keep theirs.
    fn remove_all_but(&mut self, shown: &[Look]) {
        let [microfacets, normals] =
            [Look::Microfacet, Look::NormalMap].map(|l| shown.contains(&l));
        if microfacets && normals {
            return;
        }
        for material in &mut self.materials {
            material.microfacet = material.microfacet.take().filter(|_| microfacets);
            material.normal_texture = material.normal_texture.filter(|_| normals);
        }
        let materials = self.materials.iter_mut();
        let read: BTreeSet<usize> =
            materials.flat_map(|material| material.textures().filter_map(|t| *t)).collect();
        for (number, texture) in self.textures.iter_mut().enumerate() {
            if !read.contains(&number) {
                (texture.width, texture.height, texture.rgba) = (1, 1, vec![255; 4]);
                texture.slopes = false;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{Affine3A, Vec3};

    use super::*;
    use crate::gpu::Sampling;
    use crate::model::Texture;
    use crate::scene::{Camera, Instance, Microfacet};

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
        let told = scene.left_out(&[]);
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
        let told = scene.left_out(&[Look::Mirror, Look::Transparency, Look::Glass]);
        assert!(told.len() == 1 && told[0].contains("\"leaf\""), "{told:?}");
    }

    #[test]
    fn a_chapter_without_microfacets_says_so_and_keeps_no_texture_of_them() {
        let texture = |name: &str| Texture {
            name: name.to_owned(),
            width: 2,
            height: 1,
            rgba: vec![7; 8],
            srgb: false,
            slopes: false,
            sampling: Sampling::default(),
        };
        let rough =
            Microfacet { metallic: 1.0, roughness_texture: Some(0), ..Microfacet::default() };
        let materials = vec![
            Material { microfacet: Some(rough.clone()), ..material("chrome", 3, 1.0) },
            Material {
                base_texture: Some(1),
                microfacet: Some(Microfacet::default()),
                ..material("matte", 2, 1.0)
            },
        ];
        let instances = [0, 1].map(|material| Instance {
            mesh: 0,
            transform: Affine3A::IDENTITY,
            material,
            record_offset: 0,
        });
        let model =
            Model { materials, textures: ["a", "b"].map(texture).into(), ..Model::default() };
        let scene = Scene { model, instances: instances.to_vec(), camera: Camera::default() };
        let mut shown = scene.clone();
        shown.show_only(&[Look::Microfacet], "a.obj");
        assert!(shown.model.warnings.is_empty() && shown.model.textures == scene.model.textures);
        assert_eq!(shown.model.materials[0].microfacet, Some(rough));
        let mut bumpy = scene.clone();
        bumpy.model.materials[1].normal_texture = Some(0);
        let mut smooth = bumpy.clone();
        bumpy.show_only(&[Look::Microfacet, Look::NormalMap], "a.obj");
        assert!(bumpy.model.warnings.is_empty() && bumpy.model.textures == scene.model.textures);
        smooth.model.materials[0].microfacet = None;
        smooth.show_only(&[Look::Mirror, Look::Microfacet], "a.obj");
        let line = "a.obj: material \"matte\" has a normal map; this chapter shows it smooth; 47_normal_maps shows it \
                    (1 in all)";
        assert_eq!(smooth.model.warnings, [line]);
        assert_eq!(smooth.model.materials[1].normal_texture, None);
        assert_eq!(smooth.model.textures[0].rgba.len(), 4);
        let mut without = scene.clone();
        without.show_only(&[], "a.obj");
        let line = "a.obj: material \"chrome\" has a metalness and a roughness; this chapter shows a colour, a \
                    highlight or a mirror instead; 45_rough_metal shows them (1 in all)";
        assert_eq!(without.model.warnings, [line]);
        let sizes: Vec<_> =
            without.model.textures.iter().map(|texture| texture.rgba.len()).collect();
        assert_eq!(sizes, [4, 8]);
        assert!(without.model.materials.iter().all(|material| material.microfacet.is_none()));
    }
}
