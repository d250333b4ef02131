//! The picture of the sky, and the table that chooses its texels.

use std::f64::consts::PI;

use anyhow::Result;
use common::UsageError;
use common::gpu::{Address, Buffer, Gpu};
use common::model::panorama::Panorama;
use common::scene::input_usage;
use glam::{UVec2, Vec3};

use super::alias::{AliasTable, Column};

common::shader_enum! {
    /// The way to add up the weights of all texels.
    pub enum Sum {
        /// Floats, one after the other.
        Floats,
        /// Floats, in pairs, and pairs of pairs.
        Pairwise,
        /// Whole numbers, as the alias table adds them.
        Exact,
    }
}

common::shader_struct! {
    /// A texel.
    pub struct Texel {
        /// Its light.
        pub radiance: Vec3,
        /// The density of shadow rays in its directions, by solid angle.
        pub density: f32,
    }
}

common::shader_struct! {
    /// The edges of a row.
    pub struct SkyRow {
        /// The cosine of the angle from straight up, at the upper edge.
        pub top: f32,
        /// By how much it is smaller at the lower edge.
        pub height: f32,
    }
}

common::shader_struct! {
    /// Addresses of the sky.
    pub struct SkyAddresses {
        /// The texels, rows from above to below.
        pub texels: Address<Texel>,
        /// The table that chooses a texel.
        pub columns: Address<Column>,
        /// The rows.
        pub rows: Address<SkyRow>,
        /// Width and height of the picture.
        pub size: UVec2,
        /// Number of columns.
        pub column_count: u32,
    }
}

/// Maximum number of texels of a divided picture.
const TEXELS: usize = 1 << 23;

/// A picture of the sky, ready for shadow rays.
pub struct SkyTable {
    /// The texels.
    pub texels: Vec<Texel>,
    /// The rows.
    pub rows: Vec<SkyRow>,
    /// The table that chooses a texel.
    pub columns: Vec<Column>,
    /// Width and height.
    pub size: UVec2,
}

impl SkyTable {
    /// The table of a picture. A texel is chosen as often as its share of the light.
    pub fn new(map: &Panorama, sum: Sum) -> Self {
        // ANCHOR: weights
        let angles: Vec<f64> = (0..map.height).map(|row| solid_angle(map, row)).collect();
        let luminance = |[r, g, b]: [f32; 3]| {
            0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
        };
        let angle = |i: usize| angles[i / map.width as usize];
        let weight = |(i, texel): (usize, &[f32; 3])| luminance(*texel) * angle(i);
        let weights: Vec<f64> = map.texels.iter().enumerate().map(weight).collect();
        // ANCHOR_END: weights
        let table = AliasTable::of(&weights);
        // ANCHOR: density
        let total = f64::from(add(&weights, sum));
        let probability = |i: usize| match sum {
            Sum::Exact => table.probability(i),
            Sum::Floats | Sum::Pairwise => weights[i] / total.max(f64::MIN_POSITIVE),
        };
        // ANCHOR_END: density
        let texel = |(i, texel): (usize, &[f32; 3])| Texel {
            radiance: Vec3::from(*texel),
            density: (probability(i) / angle(i)) as f32,
        };
        let texels = map.texels.iter().enumerate().map(texel).collect();
        let row = |row| {
            let [top, bottom] = edges(map.height, row);
            SkyRow { top: top.cos() as f32, height: height(top, bottom) as f32 }
        };
        let rows = (0..map.height).map(row).collect();
        Self { texels, rows, columns: table.columns, size: UVec2::new(map.width, map.height) }
    }
}

// ANCHOR: sum
/// The sum of weights in 32-bit floats.
pub fn add(weights: &[f64], sum: Sum) -> f32 {
    match sum {
        Sum::Pairwise if weights.len() > 1 => {
            let (one, other) = weights.split_at(weights.len() / 2);
            add(one, sum) + add(other, sum)
        }
        _ => weights.iter().fold(0.0, |all, weight| all + *weight as f32),
    }
}
// ANCHOR_END: sum

/// The angles of a row's edges from straight up.
fn edges(height: u32, row: u32) -> [f64; 2] {
    [row, row + 1].map(|edge| PI * f64::from(edge) / f64::from(height))
}

/// The difference of two cosines, without cancellation.
fn height(top: f64, bottom: f64) -> f64 {
    2.0 * (0.5 * (top + bottom)).sin() * (0.5 * (bottom - top)).sin()
}

/// The solid angle of a texel of a row: rows near the poles are narrow.
pub fn solid_angle(map: &Panorama, row: u32) -> f64 {
    let [top, bottom] = edges(map.height, row);
    2.0 * PI / f64::from(map.width) * height(top, bottom)
}

/// The same picture with each texel divided into `cut` by `cut`.
///
/// # Errors
/// If these are too many.
pub fn divided(map: &Panorama, cut: u32) -> Result<Panorama> {
    let (width, height) = (map.width * cut, map.height * cut);
    let count = width as usize * height as usize;
    if count > TEXELS {
        let line = format!(
            "cut={cut} makes {count} texels of the sky; at most {TEXELS} can be chosen from"
        );
        return Err(UsageError(line).into());
    }
    let texel = |i: usize| {
        let (x, y) = (i % width as usize / cut as usize, i / width as usize / cut as usize);
        map.texels[y * map.width as usize + x]
    };
    Ok(Panorama { width, height, texels: (0..count).map(texel).collect() })
}

/// The sky on the device.
pub struct SkyOnGpu {
    /// A [`SkyAddresses`].
    pub sky: Buffer,
    _parts: [Buffer; 3],
}

impl SkyOnGpu {
    /// Uploads a sky.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, table: &SkyTable) -> Result<Self> {
        let texels = Buffer::with_data(gpu, "texels of the sky", &table.texels, input_usage())?;
        let columns = Buffer::with_data(gpu, "columns of the sky", &table.columns, input_usage())?;
        let rows = Buffer::with_data(gpu, "rows of the sky", &table.rows, input_usage())?;
        let addresses = SkyAddresses {
            texels: texels.address.into(),
            columns: columns.address.into(),
            rows: rows.address.into(),
            size: table.size,
            column_count: table.columns.len() as u32,
        };
        let sky = Buffer::with_data(gpu, "addresses of the sky", &[addresses], input_usage())?;
        Ok(Self { sky, _parts: [texels, columns, rows] })
    }
}
