//! Colours of an EXR file, which is untrusted.

use std::io::Cursor;
use std::path::Path;

use anyhow::{Result, anyhow, ensure};
use exr::meta::MetaData;
use exr::prelude::{ReadChannels, ReadLayers, read as exr_reader};

use super::text::{self, shown};

/// The red, green and blue channels of a file, as they are there.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrFile {
    /// Texels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width × height` texels, from the top row to the bottom row.
    pub texels: Vec<[f32; 3]>,
}

/// Bytes of a file.
const FILE_BYTES: u64 = 512 << 20;

/// Width and height.
const SIDE: usize = 16384;

/// Number of texels: with twice as many, a random number of 24 bits no longer chooses each of them.
const TEXELS: usize = 1 << 23;

/// Bytes of one texel with all its channels, of which three are read.
const TEXEL_BYTES: usize = 256;

/// A texel that no part of the file has set: a NaN that files do not have.
const UNREAD: [f32; 3] = [f32::from_bits(0x7fc5_a5a5); 3];

/// The bytes of a file, and its name in messages.
pub(super) fn bytes(path: &Path) -> Result<(Vec<u8>, String)> {
    let name = shown(path).to_string();
    Ok((text::read(path, &name, FILE_BYTES)?, name))
}

impl ExrFile {
    /// Reads a file.
    ///
    /// # Errors
    /// One line, if it is missing, too large, or not such a file.
    pub fn open(path: &Path) -> Result<Self> {
        let (bytes, name) = bytes(path)?;
        Self::decode(&bytes, &name)
    }

    /// Decodes the bytes of a file, which messages call `name`.
    ///
    /// # Errors
    /// One line that begins with the name.
    pub fn decode(bytes: &[u8], name: &str) -> Result<Self> {
        ensure!(
            bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]),
            "{name}: this is not an EXR file; save it as .exr, because 8 bits per channel cannot hold all light"
        );
        let broken = |error: exr::error::Error| match error {
            exr::error::Error::NotSupported(what) => {
                anyhow!("{name}: is an EXR file of a kind that is not read: {what}")
            }
            _ => anyhow!("{name}: cannot be decoded, it is damaged or cut off; save it again"),
        };
        let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(broken)?;
        for header in &meta.headers {
            let (width, height) = (header.layer_size.width(), header.layer_size.height());
            ensure!(
                width.max(height) <= SIDE,
                "{name}: is {width} x {height} texels; at most {SIDE} per side are read"
            );
            ensure!(
                width * height <= TEXELS,
                "{name}: is {width} x {height} texels; at most {TEXELS} are read, such as 4096 x 2048"
            );
            ensure!(!header.deep, "{name}: has deep data, which are not read; save it flat");
            let all = header.channels.bytes_per_pixel;
            ensure!(
                all <= TEXEL_BYTES,
                "{name}: has {all} bytes per texel, at most {TEXEL_BYTES} are read"
            );
            let of_sky = header.channels.list.iter();
            let of_sky =
                of_sky.filter(|channel| ["R", "G", "B"].iter().any(|it| channel.name.eq(it)));
            ensure!(
                of_sky.count() == 3,
                "{name}: has no channels R, G and B; save it as a picture of colours"
            );
        }
        let image = exr_reader()
            .no_deep_data()
            .largest_resolution_level()
            .rgb_channels(
                |size, _| (size.width(), vec![UNREAD; size.area()]),
                |(width, texels): &mut (usize, Vec<[f32; 3]>), at, (r, g, b): (f32, f32, f32)| {
                    texels[at.y() * *width + at.x()] = [r, g, b];
                },
            )
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(Cursor::new(bytes))
            .map_err(broken)?;
        let size = image.layer_data.size;
        let (_, texels) = image.layer_data.channel_data.pixels;
        let (width, height) = (size.width() as u32, size.height() as u32);
        let is_unread = |texel: &[f32; 3]| texel[0].to_bits() == UNREAD[0].to_bits();
        ensure!(
            !texels.iter().any(is_unread),
            "{name}: leaves out some of its {width} x {height} texels, it is damaged; save it again"
        );
        Ok(Self { width, height, texels })
    }
}
