//! A scene file, version 1: camera, lights, materials, placed objects, a plane, spheres and boxes.
//!
//! TOML. Every table but `camera` may be missing; an unknown key is an error, and so is a number that is
//! not finite or out of bounds. `model` names an OBJ file in the scene file's folder or below it: each of
//! its meshes is placed where the file has it, unless `[[piece]]` tables place meshes by name. Without
//! `model`, pieces are those of the book's own chess set, or of none if there is no `[[piece]]`. The page
//! of chapter 25 lists every key.

use common::scene::LightKind;
use glam::{DVec3, Vec2, Vec3};
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use toml::{Spanned, Value};

use super::bounded;
use crate::{GlassKind, Pattern};

/// A scene file as written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Description {
    #[serde(rename = "version")]
    pub(super) _version: i64,
    pub(super) model: Option<Spanned<String>>,
    pub(super) position: Option<Spanned<String>>,
    pub(super) sky: Option<Spanned<Sky>>,
    #[serde(default)]
    pub(super) picture: PictureTable,
    pub(super) camera: Spanned<CameraTable>,
    #[serde(default)]
    pub(super) light: Vec<Spanned<LightTable>>,
    #[serde(default)]
    pub(super) material: Vec<Spanned<MaterialTable>>,
    #[serde(default)]
    pub(super) piece: Vec<Spanned<PieceTable>>,
    pub(super) plane: Option<PlaneTable>,
    #[serde(default)]
    pub(super) sphere: Vec<Spanned<SphereTable>>,
    #[serde(default, rename = "box")]
    pub(super) boxes: Vec<Spanned<BoxTable>>,
    #[serde(default)]
    pub(super) solid: Vec<Spanned<SolidTable>>,
    #[serde(default)]
    pub(super) strand: Vec<Spanned<StrandTable>>,
    #[serde(default)]
    pub(super) torus: Vec<Spanned<TorusTable>>,
    pub(super) heightfield: Option<Spanned<HeightfieldTable>>,
}

/// The sky: a brightness, or a table that names a picture.
pub(super) enum Sky {
    Brightness(f32),
    Picture(SkyTable),
}

impl<'de> Deserialize<'de> for Sky {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(from)?;
        let sky = match value {
            Value::Table(_) => SkyTable::deserialize(value).map(Self::Picture),
            Value::Array(_) => return Err(D::Error::custom("there is one sky; write it as [sky]")),
            _ => bounded::part(value).map(Self::Brightness),
        };
        sky.map_err(|error| D::Error::custom(error.message()))
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [sky]")]
pub(super) struct SkyTable {
    pub(super) file: Option<String>,
    pub(super) name: Option<String>,
    #[serde(default, deserialize_with = "bounded::degrees")]
    pub(super) rotation: f32,
    #[serde(default = "one", deserialize_with = "bounded::factor")]
    pub(super) brightness: f32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [picture]", default)]
pub(super) struct PictureTable {
    #[serde(deserialize_with = "bounded::samples")]
    pub(super) samples: u32,
    #[serde(deserialize_with = "bounded::samples")]
    pub(super) light_samples: u32,
    #[serde(deserialize_with = "bounded::depth")]
    pub(super) depth: u32,
    #[serde(deserialize_with = "bounded::bounces")]
    pub(super) bounces: u32,
    pub(super) filtered: bool,
    #[serde(deserialize_with = "bounded::frames")]
    pub(super) frames: u32,
}

impl Default for PictureTable {
    fn default() -> Self {
        Self { samples: 1, light_samples: 16, depth: 4, bounces: 0, filtered: false, frames: 120 }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [camera]")]
pub(super) struct CameraTable {
    #[serde(deserialize_with = "bounded::far_point")]
    pub(super) eye: DVec3,
    #[serde(deserialize_with = "bounded::far_point")]
    pub(super) target: DVec3,
    #[serde(deserialize_with = "bounded::view")]
    pub(super) field_of_view: f64,
    pub(super) lens: Option<LensTable>,
    #[serde(default, deserialize_with = "bounded::degrees")]
    pub(super) orbit: f32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, { diameter = 0.1 }")]
pub(super) struct LensTable {
    #[serde(deserialize_with = "bounded::part")]
    pub(super) diameter: f32,
    #[serde(default, deserialize_with = "bounded::maybe_focus")]
    pub(super) focus: Option<f32>,
    #[serde(default, deserialize_with = "bounded::blades")]
    pub(super) blades: u32,
}

/// A light of either kind; which keys go with which is checked when it is made.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[light]]")]
pub(super) struct LightTable {
    #[serde(deserialize_with = "bounded::light_kind")]
    pub(super) kind: LightKind,
    #[serde(default, deserialize_with = "bounded::maybe_degrees")]
    pub(super) azimuth: Option<f32>,
    #[serde(default, deserialize_with = "bounded::maybe_degrees")]
    pub(super) elevation: Option<f32>,
    #[serde(default, deserialize_with = "bounded::maybe_strength")]
    pub(super) radiance: Option<Vec3>,
    #[serde(default, deserialize_with = "bounded::maybe_point")]
    pub(super) position: Option<Vec3>,
    #[serde(default, deserialize_with = "bounded::maybe_strength")]
    pub(super) intensity: Option<Vec3>,
    #[serde(default, deserialize_with = "bounded::part")]
    pub(super) size: f32,
    #[serde(default = "yes")]
    pub(super) shadows: bool,
}

fn yes() -> bool {
    true
}

/// A new material, or what differs from the model's of that name.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[material]]")]
pub(super) struct MaterialTable {
    pub(super) name: String,
    #[serde(default, deserialize_with = "bounded::maybe_color")]
    pub(super) color: Option<Vec3>,
    #[serde(default, deserialize_with = "bounded::maybe_color")]
    pub(super) specular: Option<Vec3>,
    #[serde(default, deserialize_with = "bounded::maybe_exponent")]
    pub(super) shininess: Option<f32>,
    #[serde(default, deserialize_with = "bounded::maybe_strength")]
    pub(super) emission: Option<Vec3>,
    #[serde(default, deserialize_with = "bounded::maybe_part")]
    pub(super) opacity: Option<f32>,
    pub(super) blended: Option<bool>,
    pub(super) mirror: Option<bool>,
    #[serde(default, deserialize_with = "bounded::maybe_part")]
    pub(super) roughness: Option<f32>,
    #[serde(default, deserialize_with = "bounded::maybe_part")]
    pub(super) metallic: Option<f32>,
    #[serde(default, deserialize_with = "bounded::maybe_normal_map")]
    pub(super) normal_map: Option<usize>,
    #[serde(default, deserialize_with = "bounded::maybe_steepness")]
    pub(super) normal_scale: Option<f32>,
    #[serde(default, deserialize_with = "bounded::maybe_glass")]
    pub(super) glass: Option<GlassKind>,
    #[serde(default, deserialize_with = "bounded::maybe_index")]
    pub(super) index: Option<f32>,
    #[serde(default, deserialize_with = "bounded::maybe_color")]
    pub(super) through: Option<Vec3>,
    #[serde(default, deserialize_with = "bounded::maybe_pattern")]
    pub(super) pattern: Option<Pattern>,
    #[serde(default, deserialize_with = "bounded::maybe_color")]
    pub(super) second: Option<Vec3>,
    #[serde(default, deserialize_with = "bounded::maybe_length")]
    pub(super) scale: Option<f32>,
    #[serde(default, deserialize_with = "bounded::maybe_width")]
    pub(super) lines: Option<f32>,
    #[serde(default, deserialize_with = "bounded::maybe_color")]
    pub(super) ink: Option<Vec3>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[piece]]")]
pub(super) struct PieceTable {
    pub(super) mesh: Spanned<String>,
    #[serde(deserialize_with = "bounded::point")]
    pub(super) at: Vec3,
    #[serde(default, deserialize_with = "bounded::degrees")]
    pub(super) turn: f32,
    #[serde(default = "one", deserialize_with = "bounded::length")]
    pub(super) size: f32,
    pub(super) material: Option<Spanned<String>>,
    #[serde(default, deserialize_with = "bounded::point")]
    pub(super) way: Vec3,
    #[serde(default, deserialize_with = "bounded::degrees")]
    pub(super) spin: f32,
}

fn one() -> f32 {
    1.0
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [plane]")]
pub(super) struct PlaneTable {
    #[serde(deserialize_with = "bounded::direction")]
    pub(super) normal: Vec3,
    #[serde(default, deserialize_with = "bounded::coordinate")]
    pub(super) distance: f32,
    #[serde(deserialize_with = "bounded::color")]
    pub(super) light: Vec3,
    #[serde(deserialize_with = "bounded::color")]
    pub(super) dark: Vec3,
    #[serde(default = "one", deserialize_with = "bounded::length")]
    pub(super) square: f32,
    #[serde(default, deserialize_with = "bounded::part")]
    pub(super) reflection: f32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[sphere]]")]
pub(super) struct SphereTable {
    #[serde(deserialize_with = "bounded::point")]
    pub(super) center: Vec3,
    #[serde(deserialize_with = "bounded::length")]
    pub(super) radius: f32,
    #[serde(default, deserialize_with = "bounded::point")]
    pub(super) moves: Vec3,
    pub(super) material: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[box]]")]
pub(super) struct BoxTable {
    #[serde(deserialize_with = "bounded::point")]
    pub(super) low: Vec3,
    #[serde(deserialize_with = "bounded::point")]
    pub(super) high: Vec3,
    pub(super) material: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[solid]]")]
pub(super) struct SolidTable {
    #[serde(deserialize_with = "bounded::point")]
    pub(super) center: Vec3,
    #[serde(deserialize_with = "bounded::faces")]
    pub(super) planes: Vec<[f64; 4]>,
    pub(super) material: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[strand]]")]
pub(super) struct StrandTable {
    #[serde(deserialize_with = "bounded::nodes")]
    pub(super) nodes: Vec<[f32; 4]>,
    pub(super) material: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [[torus]]")]
pub(super) struct TorusTable {
    #[serde(deserialize_with = "bounded::point")]
    pub(super) center: Vec3,
    #[serde(deserialize_with = "bounded::direction")]
    pub(super) axis: Vec3,
    #[serde(deserialize_with = "bounded::length")]
    pub(super) radius: f32,
    #[serde(deserialize_with = "bounded::length")]
    pub(super) tube: f32,
    pub(super) material: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table, [heightfield]")]
pub(super) struct HeightfieldTable {
    #[serde(deserialize_with = "bounded::place")]
    pub(super) low: Vec2,
    #[serde(deserialize_with = "bounded::place")]
    pub(super) high: Vec2,
    #[serde(deserialize_with = "bounded::height")]
    pub(super) hills: f32,
    #[serde(deserialize_with = "bounded::lengths")]
    pub(super) hill: Vec2,
    #[serde(default, deserialize_with = "bounded::height")]
    pub(super) ridges: f32,
    #[serde(default = "ones", deserialize_with = "bounded::lengths")]
    pub(super) ridge: Vec2,
    #[serde(deserialize_with = "bounded::color")]
    pub(super) light: Vec3,
    #[serde(deserialize_with = "bounded::color")]
    pub(super) dark: Vec3,
    #[serde(deserialize_with = "bounded::color")]
    pub(super) rock: Vec3,
    #[serde(default = "one", deserialize_with = "bounded::length")]
    pub(super) square: f32,
}

fn ones() -> Vec2 {
    Vec2::ONE
}
