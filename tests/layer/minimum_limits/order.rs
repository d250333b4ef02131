//! The order of commands, as established by barriers.
//!
//! A driver that runs commands one after the other, like the software driver, never reveals a missing
//! barrier, and the validation layer of Debian 12 tracks neither builds nor addresses. This model therefore
//! ends the process if a command uses the result of an earlier one, or overwrites what an earlier one reads,
//! and no memory barrier between them has both stages and both accesses (Vulkan specification, "Memory
//! Dependencies").
//!
//! It is coarse, like the barriers of the samples: a [`Kind`] stands for all resources of that kind. Commands
//! count in recording order, which in the samples is also the order of submission. Image layouts are left to
//! the validation layer.

use std::sync::{Mutex, PoisonError};

use ash::vk::{AccessFlags2 as Access, PipelineStageFlags2 as Stage};

/// The resources covered by one barrier of the samples.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// Built acceleration structures.
    Built,
    /// Copied acceleration structures.
    Copied,
    /// The results of copies and updates: geometry, transforms, materials.
    Filled,
    /// Shader binding tables.
    Tables,
    /// Cleared resources to which shaders add.
    Cleared,
    /// The results of shaders that trace rays.
    Traced,
    /// The results of compute shaders.
    Computed,
    /// The results of drawing.
    Drawn,
    /// Results that the host reads.
    ReadBack,
}

/// A stage, and its access to memory.
pub type Use = (Stage, Access);

/// The last writes of a kind, and the accesses since.
struct Known {
    written: Option<Use>,
    /// The uses that barriers have made safe since.
    seen_by: Vec<Use>,
    /// The stages that have read them, each with the stages that wait for it, according to the barriers
    /// since.
    read: Vec<(Stage, Stage)>,
}

static KNOWN: Mutex<[Known; 9]> = Mutex::new([const { Known::new() }; 9]);

/// Records that a command reads, or adds to, earlier results. Ends the process unless a barrier makes them
/// visible.
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

/// Checks that a command may overwrite. Ends the process unless it waits for all stages that may still read.
pub fn waits(command: &str, kind: Kind, by: Stage) {
    with(kind, |known| {
        for &(reader, waiting) in &known.read {
            let waits = waiting.contains(by);
            assert!(waits, "{command} overwrites {kind:?}, and does not wait for {reader:?}");
        }
    });
}

/// Records that a command writes.
pub fn writes(kind: Kind, by: Use) {
    with(kind, |known| {
        let unseen = known.written.filter(|_| known.seen_by.is_empty());
        known.written = Some(unseen.map_or(by, |(stage, access)| (stage | by.0, access | by.1)));
        known.seen_by.clear();
        known.read.clear();
    });
}

/// Records a memory barrier.
pub fn barrier(from: Use, to: Use) {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    apply(&mut known[..], from, to);
}

/// Records an image barrier: in the samples, only those for drawn images do more than change a layout.
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
            // A stage also waits if it waits for one that waits (Vulkan specification, "Execution and Memory
            // Dependencies": a dependency chain).
            if from.0.contains(*reader) || from.0.intersects(*waiting) {
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

/// The stages included in a name, as far as the model distinguishes them.
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

/// The accesses included in a name, as far as the model distinguishes them.
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
