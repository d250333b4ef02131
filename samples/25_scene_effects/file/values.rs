//! Converts a table of a scene file to its value.

use common::scene::{DiskLight, Light, LightKind, Material, Microfacet, PointLight, Sun};

use super::description::{HeightfieldTable, LightTable, MaterialTable, PlaneTable};
use crate::{BoardPlane, Finish, GlassKind, Heightfield, SceneLight};

impl LightTable {
    pub(super) fn light(&self) -> Result<SceneLight, &'static str> {
        let light = match *self {
            Self {
                kind: LightKind::Directional,
                azimuth: Some(azimuth),
                elevation: Some(elevation),
                radiance: Some(radiance),
                position: None,
                intensity: None,
                ..
            } => Light::directional(&Sun { azimuth, elevation, radiance }),
            Self {
                kind: LightKind::Point,
                position: Some(position),
                intensity: Some(intensity),
                azimuth: None,
                elevation: None,
                radiance: None,
                ..
            } => Light::point(&PointLight { position, intensity }),
            Self { kind: LightKind::Directional, .. } => {
                return Err("a directional light has `azimuth`, `elevation` and `radiance`");
            }
            Self { kind: LightKind::Point, .. } => {
                return Err("a point light has `position` and `intensity`");
            }
        };
        let disk = DiskLight { light, radius: self.size, samples: 1 };
        Ok(SceneLight { disk, shadows: self.shadows })
    }
}

impl PlaneTable {
    pub(super) fn plane(&self) -> BoardPlane {
        let &Self { normal, distance, light, dark, square, reflection } = self;
        BoardPlane { normal, distance, light, dark, square, reflection }
    }
}

impl HeightfieldTable {
    pub(super) fn heightfield(&self) -> Result<Heightfield, &'static str> {
        let &Self { low, high, hills, hill, ridges, ridge, light, dark, rock, square } = self;
        if low.cmplt(high).all() && hills + ridges > 0.0 {
            Ok(Heightfield { low, high, hills, hill, ridges, ridge, light, dark, rock, square })
        } else {
            Err("a heightfield has its `high` above its `low`, and `hills` or `ridges` above 0")
        }
    }
}

impl MaterialTable {
    pub(super) fn apply(&self, material: &mut Material) {
        material.base_color = self.color.unwrap_or(material.base_color);
        material.specular = self.specular.unwrap_or(material.specular);
        material.shininess = self.shininess.unwrap_or(material.shininess);
        material.emission = self.emission.unwrap_or(material.emission);
        material.opacity = self.opacity.unwrap_or(material.opacity);
        material.blended = self.blended.unwrap_or(material.blended);
        material.normal_scale = self.normal_scale.unwrap_or(material.normal_scale);
        if let Some(mirror) = self.mirror {
            material.illumination = if mirror { 3 } else { 2 };
        }
        if let Some(glass) = self.glass {
            material.illumination = if glass == GlassKind::Thin { 9 } else { 7 };
            material.refraction = 1.5;
        }
        if self.mirror.is_some() || self.glass.is_some() {
            material.microfacet = None;
        }
        if self.roughness.is_some() || self.metallic.is_some() {
            let usual = Microfacet { color: material.base_color, ..Microfacet::default() };
            material.microfacet.get_or_insert(usual);
        }
        if let Some(microfacet) = &mut material.microfacet {
            microfacet.color = self.color.unwrap_or(microfacet.color);
            microfacet.roughness = self.roughness.unwrap_or(microfacet.roughness);
            microfacet.metallic = self.metallic.unwrap_or(microfacet.metallic);
        }
        material.refraction = self.index.unwrap_or(material.refraction);
        material.transmission = self.through.unwrap_or(material.transmission);
    }

    /// Checks that a surface is not of two kinds.
    pub(super) fn check_rough(&self) -> Result<(), &'static str> {
        let &Self { mirror, glass, roughness, metallic, .. } = self;
        if roughness.or(metallic).is_some() && (mirror == Some(true) || glass.is_some()) {
            return Err(
                "a mirror and glass have no `roughness` and no `metallic`; take one of them out",
            );
        }
        Ok(())
    }

    /// Checks that nothing is said of glass that it cannot be.
    pub(super) fn check_glass(&self) -> Result<(), &'static str> {
        let &Self { mirror, opacity, pattern, lines, .. } = self;
        match (mirror, opacity, pattern.is_some() || lines.is_some_and(|width| width > 0.0)) {
            (Some(true), ..) => {
                Err("a material is a mirror or glass; take `mirror` or `glass` out")
            }
            (_, Some(_), _) => Err("glass has `through` in place of `opacity`"),
            (.., true) => Err("glass shows neither a `pattern` nor `lines`; take them out"),
            _ => Ok(()),
        }
    }

    pub(super) fn finish(&self) -> Result<Finish, &'static str> {
        let &Self { pattern, second, scale, lines, ink, .. } = self;
        match (pattern, second, scale) {
            (None, None, None) | (Some(_), Some(_), _) => {}
            (Some(_), None, _) => return Err("a pattern has a `second` colour"),
            _ => return Err("`second` and `scale` are of a `pattern`: marble, wood or checker"),
        }
        if lines.is_none() && ink.is_some() {
            return Err("`ink` is the colour of `lines`, which are so many pixels wide");
        }
        Ok(Finish {
            second: second.unwrap_or(Finish::NONE.second),
            scale: scale.unwrap_or(Finish::NONE.scale),
            ink: ink.unwrap_or(Finish::NONE.ink),
            lines: lines.unwrap_or(Finish::NONE.lines),
            pattern: pattern.map_or(Finish::NONE.pattern, u32::from),
            ..Finish::NONE
        })
    }
}
