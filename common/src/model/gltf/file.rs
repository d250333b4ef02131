//! A glTF file in memory, with its buffers.

use std::cell::{OnceCell, RefCell};
use std::ops::Range;
use std::path::Path;

use anyhow::{Context, Result, anyhow, ensure};
use gltf::json::extensions::texture::TextureTransform;
use gltf::json::{Buffer, Index, Root, buffer};

use super::container::{Parts, normal_transforms, other_version, parse};
use super::uri::Uri;
use crate::model::limits::Limits;
use crate::model::text::{Folder, read, shown};

/// A glTF file, its JSON part parsed.
pub(super) struct File {
    /// The file in messages.
    pub shown: String,
    /// Its JSON part.
    pub root: Root,
    /// The `KHR_texture_transform` of each material's normal map.
    pub normal_transforms: Vec<Option<TextureTransform>>,
    /// The folder that its buffers and images are in.
    pub folder: Folder,
    bytes: Vec<u8>,
    /// The place of the buffer that a GLB file brings.
    embedded: Option<Range<usize>>,
    /// Files found beside the model instead of where it says, in messages.
    elsewhere: RefCell<Vec<String>>,
    /// The other buffers; read when something first needs them.
    buffers: Vec<OnceCell<Result<Vec<u8>, String>>>,
    limits: Limits,
}

impl File {
    /// Reads a file and parses its JSON part. Buffers are read later.
    ///
    /// # Errors
    /// If it is missing, too large, cut off, or not glTF 2.
    pub fn read(path: &Path, limits: &Limits) -> Result<Self> {
        let folder = Folder::of(path)?;
        let shown = shown(path);
        let bytes = read(path, &shown, limits.obj_bytes)?;
        let in_file = |error: anyhow::Error| anyhow!("{shown}: {error}");
        let parts = Parts::of(&bytes).map_err(in_file)?;
        let is_text = parts.json.start < 4;
        let json = &bytes[parts.json];
        let root = parse(json, is_text, limits.memory).map_err(in_file)?;
        let version = root.asset.version.as_str();
        ensure!(version.starts_with("2."), "{shown}: {}", other_version(version));
        let mut maps =
            root.materials.iter().filter_map(|material| material.normal_texture.as_ref());
        let is_moved = maps.any(|map| map.extensions.is_some());
        let normal_transforms = if is_moved { normal_transforms(json) } else { Vec::new() };
        let buffers = root.buffers.iter().map(|_| OnceCell::new()).collect();
        let limits = *limits;
        let elsewhere = RefCell::default();
        let embedded = parts.buffer;
        Ok(Self {
            shown,
            root,
            normal_transforms,
            folder,
            bytes,
            embedded,
            elsewhere,
            buffers,
            limits,
        })
    }

    /// A line about each buffer that was found elsewhere.
    pub fn elsewhere(&self) -> Vec<String> {
        self.elsewhere.take()
    }

    /// The bytes of a buffer view.
    ///
    /// # Errors
    /// If it is missing or reaches beyond its buffer, or the buffer cannot be read.
    pub fn view(&self, index: Index<buffer::View>) -> Result<(&[u8], &buffer::View)> {
        let view = self.root.get(index);
        let view = view.with_context(|| missing("buffer view", index, &self.root.buffer_views))?;
        let bytes = self.buffer(view.buffer)?;
        let start = view.byte_offset.unwrap_or_default().0;
        let range = start.checked_add(view.byte_length.0).map(|end| start as usize..end as usize);
        let part = range.and_then(|range| bytes.get(range)).with_context(|| {
            format!(
                "buffer view {} reaches beyond the {} bytes of buffer {}",
                index.value(),
                bytes.len(),
                view.buffer.value()
            )
        })?;
        Ok((part, view))
    }

    fn buffer(&self, index: Index<Buffer>) -> Result<&[u8]> {
        let number = index.value();
        let buffer = self.root.get(index);
        let buffer = buffer.with_context(|| missing("buffer", index, &self.root.buffers))?;
        if buffer.uri.is_none() {
            let range = self.embedded.clone().filter(|_| number == 0);
            let range = range.with_context(|| format!("buffer {number} has no data"))?;
            return Ok(&self.bytes[range]);
        }
        let contents = self.buffers[number].get_or_init(|| {
            let uri = buffer.uri.as_deref().unwrap_or_default();
            self.contents(&format!("buffer {number}"), uri).map_err(|error| error.to_string())
        });
        contents.as_deref().map_err(|error| anyhow!("{error}"))
    }

    /// The bytes that a URI leads to.
    fn contents(&self, what: &str, uri: &str) -> Result<Vec<u8>> {
        let path = match Uri::of(uri).map_err(|error| anyhow!("{what} {error}"))? {
            Uri::Data(bytes) => return Ok(bytes),
            Uri::Path(path) => path,
        };
        let named = self.folder.find(what, &path, None);
        let named = named.map_err(|error| anyhow!("{}", of_gltf(&error.to_string())))?;
        if let Some(instead) = &named.instead {
            let what = "the file of that name beside the model is taken";
            self.elsewhere.borrow_mut().push(format!("{}; {what}", of_gltf(instead)));
        }
        // All files of a model together: each may be as large as the model's own.
        let taken = self.buffers.iter().filter_map(|buffer| buffer.get()?.as_ref().ok());
        let taken: u64 = taken.map(|bytes| bytes.len() as u64).sum();
        let left = self.limits.obj_bytes.saturating_sub(taken);
        read(&named.path, &named.shown, left)
    }
}

/// The folder's messages, which speak of an OBJ file.
pub(super) fn of_gltf(message: &str) -> String {
    message.replace("the OBJ file's folder", "the glTF file's folder")
}

/// The message for a number that leads nowhere.
pub(super) fn missing<T>(what: &str, index: Index<T>, list: &[T]) -> String {
    format!("{what} {} is not there; there are {}, counted from 0", index.value(), list.len())
}
