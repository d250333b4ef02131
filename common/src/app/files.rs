//! The files a run reads and writes, checked before the work begins.

use std::path::PathBuf;

use anyhow::Result;
use ash::vk;

use super::{Args, Format};
use crate::UsageError;
use crate::files;
use crate::gpu::Gpu;
use crate::model::text;

/// Files, each with the option that names it.
#[derive(Clone, Debug, Default)]
pub struct Files {
    /// Input files.
    pub inputs: Vec<(&'static str, PathBuf)>,
    /// Output files.
    pub outputs: Vec<(&'static str, PathBuf)>,
    /// The options of an input and an output that may be the same file: the run updates it.
    pub updated: Option<(&'static str, &'static str)>,
}

/// Refuses early, before the work, any output file that cannot be written or that is named twice.
///
/// # Errors
/// Names the file and the reason.
pub fn check(args: &Args) -> Result<()> {
    args.out.as_deref().map(Format::of).transpose()?;
    let Files { inputs, outputs, updated } = all(args);
    for (i, (name, file)) in outputs.iter().enumerate() {
        files::check_writable(file)?;
        let inputs = inputs.iter().filter(|(input, _)| updated != Some((*input, *name)));
        let mut others = outputs[..i].iter().chain(inputs);
        if let Some((other, _)) = others.find(|(_, other)| files::same(other, file)) {
            let file = file.display();
            return Err(UsageError(format!("{other} and {name} both name '{file}'")).into());
        }
    }
    Ok(())
}

/// All files the run reads and writes.
fn all(args: &Args) -> Files {
    let Files { mut inputs, mut outputs, updated } = args.files.clone();
    inputs.splice(0..0, args.sky.clone().map(|file| ("--sky", file)));
    inputs.splice(0..0, args.scene.clone().map(|file| ("--scene", file)));
    outputs.splice(0..0, args.out.clone().map(|file| ("--out", file)));
    Files { inputs, outputs, updated }
}

/// Fails if an output is one of the scene's files, which are known only once the scene has been opened.
///
/// # Errors
/// Names the file.
pub fn check_scene(args: &Args) -> Result<(), UsageError> {
    let opened = text::opened();
    let mut outputs = all(args).outputs.into_iter();
    match outputs.find(|(_, file)| opened.iter().any(|read| files::same(read, file))) {
        Some((name, file)) => {
            Err(UsageError(format!("{name} names '{}', a file of the scene", file.display())))
        }
        None => Ok(()),
    }
}

/// Fails if a picture is larger than the device allows.
///
/// # Errors
/// States the limit.
pub fn check_size(gpu: &Gpu, size: vk::Extent2D) -> Result<(), UsageError> {
    if gpu.limits.fits(size) {
        return Ok(());
    }
    let (side, pixels) = (gpu.limits.core.max_image_dimension2_d, gpu.limits.max_pixels());
    let (width, height) = (size.width, size.height);
    Err(UsageError(format!(
        "{width}x{height} is too large for {}: at most {side} a side and {pixels} pixels",
        gpu.name
    )))
}
