//! The order of commands, as far as barriers make it.
//!
//! A driver that runs one command after the other, as the software driver does, never shows that a barrier is missing,
//! and the validation layer of Debian 12 follows neither builds nor addresses. So this model ends the process where a
//! command uses what an earlier one wrote, or overwrites what an earlier one reads, and no memory barrier between them
//! names both stages and both accesses (Vulkan specification, "Memory Dependencies").
//!
//! It is coarse, as the barriers of the samples are: a [`Kind`] stands for all resources of that kind. Commands count
//! in the order of recording, which is that of submission in the samples. Layouts of images are left to the validation
//! layer.

use std::sync::{Mutex, PoisonError};

use ash::vk::{AccessFlags2 as Access, PipelineStageFlags2 as Stage};

/// Resources that one barrier of the samples is about.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Acceleration structures that were built.
    Built,
    /// Acceleration structures that were copied.
    Copied,
    /// What copies and updates write: geometry, transforms, materials.
    Filled,
    /// Shader binding tables.
    Tables,
    /// What is cleared for shaders to add to.
    Cleared,
    /// What shaders write that trace rays.
    Traced,
    /// What compute shaders write.
    Computed,
    /// What is drawn.
    Drawn,
    /// What the host reads.
    ReadBack,
}

/// A stage, and how it touches memory.
pub type Use = (Stage, Access);

/// The last writes of a kind, and what happened since.
struct Known {
    written: Option<Use>,
    /// What may use them, by the barriers since.
    seen_by: Vec<Use>,
    /// Stages that have read them, each with those that wait for it, by the barriers since.
    read: Vec<(Stage, Stage)>,
}

static KNOWN: Mutex<[Known; 9]> = Mutex::new([const { Known::new() }; 9]);

/// A command reads, or adds to what was written. Ends the process unless a barrier shows it that.
pub fn reads(command: &str, kind: Kind, by: Use) {
    with(kind, |known| {
        if let Some(written) = known.written {
            let sees = |to: &Use| to.0.contains(by.0) && to.1.contains(by.1);
            let seen = known.seen_by.iter().any(sees);
            assert!(seen, "{command} uses {kind:?} as {by:?}, and no barrier shows it {written:?}");
        }
        known.read.push((by.0, Stage::NONE));
    });
}

/// A command is about to overwrite. Ends the process unless it waits for all that may still read.
pub fn waits(command: &str, kind: Kind, by: Stage) {
    with(kind, |known| {
        for &(reader, waiting) in &known.read {
            let waits = waiting.contains(by);
            assert!(waits, "{command} overwrites {kind:?}, and does not wait for {reader:?}");
        }
    });
}

/// A command writes.
pub fn writes(kind: Kind, by: Use) {
    with(kind, |known| {
        let unseen = known.written.filter(|_| known.seen_by.is_empty());
        known.written = Some(unseen.map_or(by, |(stage, access)| (stage | by.0, access | by.1)));
        known.seen_by.clear();
        known.read.clear();
    });
}

/// A memory barrier.
pub fn barrier(from: Use, to: Use) {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    apply(&mut known[..], from, to);
}

/// A barrier of an image: in the samples only those of what is drawn say more than a layout.
pub fn image_barrier(from: Use, to: Use) {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    apply(std::slice::from_mut(&mut known[Kind::Drawn as usize]), from, to);
}

fn apply(to_all: &mut [Known], from: Use, to: Use) {
    let [from, to] = [from, to].map(|(stage, access)| (stages(stage), accesses(access)));
    for known in to_all {
        let covered = |own: Use| from.0.contains(own.0) && from.1.contains(own.1);
        if known.written.is_some_and(covered) {
            known.seen_by.push(to);
        }
        for (reader, waiting) in &mut known.read {
            if from.0.contains(*reader) {
                *waiting |= to.0;
            }
        }
    }
}

impl Known {
    const fn new() -> Self {
        Self { written: None, seen_by: Vec::new(), read: Vec::new() }
    }
}

fn with(kind: Kind, act: impl FnOnce(&mut Known)) {
    act(&mut KNOWN.lock().unwrap_or_else(PoisonError::into_inner)[kind as usize]);
}

/// The stages that a name stands for, as far as the model has them.
fn stages(named: Stage) -> Stage {
    let transfer = Stage::COPY | Stage::CLEAR | Stage::BLIT | Stage::RESOLVE;
    let all = transfer
        | Stage::COMPUTE_SHADER
        | Stage::VERTEX_SHADER
        | Stage::ACCELERATION_STRUCTURE_BUILD_KHR
        | Stage::RAY_TRACING_SHADER_KHR;
    let mut meant = named;
    if named.contains(Stage::ALL_TRANSFER) {
        meant |= transfer;
    }
    if named.contains(Stage::ALL_COMMANDS) {
        meant |= all;
    }
    meant
}

/// The accesses that a name stands for, as far as the model has them.
fn accesses(named: Access) -> Access {
    let mut meant = named;
    if named.contains(Access::SHADER_READ) {
        meant |= Access::SHADER_STORAGE_READ;
    }
    if named.contains(Access::SHADER_WRITE) {
        meant |= Access::SHADER_STORAGE_WRITE;
    }
    if named.contains(Access::MEMORY_READ) {
        meant |= Access::SHADER_STORAGE_READ
            | Access::TRANSFER_READ
            | Access::HOST_READ
            | Access::ACCELERATION_STRUCTURE_READ_KHR;
    }
    if named.contains(Access::MEMORY_WRITE) {
        meant |= Access::SHADER_STORAGE_WRITE
            | Access::TRANSFER_WRITE
            | Access::ACCELERATION_STRUCTURE_WRITE_KHR;
    }
    meant
}
