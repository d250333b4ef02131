//! Shaders edited while the window is open: noticed, compiled in the background, compared.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;
use std::thread::Builder;
use std::time::{Duration, Instant};

use anyhow::Result;
use notify::{RecommendedWatcher, RecursiveMode, Watcher};
use winit::event_loop::EventLoopProxy;

use super::Wake;
use crate::gpu::{Bound, PipelineDesc, Reflection, shader};

/// Editors save in several steps; compile once they are done.
const DEBOUNCE: Duration = Duration::from_millis(60);

/// Watches the source files of a sample's shaders.
pub struct Reload {
    /// The stages of each pipeline, by path below `shaders/`, and the bindings that they declare together.
    pipelines: BTreeMap<BTreeSet<String>, Vec<Bound>>,
    /// True if the set of included files may have changed.
    stale: bool,
    files: Vec<String>,
    due: Option<Instant>,
    compiling: bool,
    failed: bool,
    proxy: EventLoopProxy<Wake>,
    _watcher: Option<RecommendedWatcher>,
}

impl Reload {
    /// Watches the shader folders. If the system does not support it, F5 still reloads.
    pub fn new(proxy: EventLoopProxy<Wake>) -> Self {
        Self {
            pipelines: BTreeMap::new(),
            stale: false,
            files: Vec::new(),
            due: None,
            compiling: false,
            failed: false,
            _watcher: watch(proxy.clone()).ok(),
            proxy,
        }
    }

    /// Adds the shaders of pipelines that have come into use.
    ///
    /// # Errors
    /// If one of them no longer compiles.
    pub fn learn(&mut self, new: &[Arc<PipelineDesc>]) -> Result<()> {
        let known = self.pipelines.len();
        for desc in new {
            let stages = desc.stages.iter().map(|stage| stage.path.clone()).collect();
            self.pipelines.entry(stages).or_default();
        }
        if self.pipelines.len() == known && !self.stale {
            return Ok(());
        }
        // Until all of them have been read.
        self.stale = true;
        let (mut files, mut pipelines) = (Vec::new(), BTreeMap::new());
        for stages in self.pipelines.keys() {
            let mut bound = Vec::new();
            for stage in stages {
                // They have just been compiled, so this only reads the cache.
                let shader = shader::compile(stage)?;
                files.extend(shader.files());
                bound.extend(Reflection::of(&shader.spirv)?.descriptors());
            }
            pipelines.insert(stages.clone(), bound);
        }
        (self.files, self.pipelines, self.stale) = (files, pipelines, false);
        Ok(())
    }

    /// A file has changed.
    pub fn saved(&mut self, path: &str, now: Instant) {
        // The fix for a failure may be in a file that nothing included before.
        let matters = self.failed || self.files.iter().any(|file| file == path);
        if matters {
            self.due = Some(now + DEBOUNCE);
        }
    }

    /// Requests a compilation, even if nothing has changed.
    pub fn ask(&mut self, now: Instant) {
        self.due = Some(now);
    }

    /// Begins a compilation if one is due; returns the time of the next call.
    pub fn poll(&mut self, now: Instant) -> Option<Instant> {
        let due = self.due?;
        if self.compiling {
            return None;
        }
        if now < due {
            return Some(due);
        }
        (self.due, self.compiling) = (None, true);
        let stages: BTreeSet<_> = self.pipelines.keys().flatten().cloned().collect();
        let proxy = self.proxy.clone();
        // A closed event loop ignores the result.
        let work = move || _ = proxy.send_event(Wake::Compiled(compile(&stages)));
        if let Err(error) = Builder::new().name("shaders".to_owned()).spawn(work) {
            let why = format!("no thread to compile shaders with: {error}");
            let _ = self.proxy.send_event(Wake::Compiled(Err(why)));
        }
        None
    }

    /// Receives the compiler's result; returns the reason if the new shaders cannot be used.
    pub fn compiled(&mut self, result: Result<(), String>) -> Result<(), String> {
        self.compiling = false;
        let result = result.and_then(|()| self.compare());
        self.failed = result.is_err();
        if result.is_ok() {
            self.stale = true;
        }
        result
    }

    /// The sample could not be created with the new shaders.
    pub fn refused(&mut self) {
        self.failed = true;
    }

    /// The program defines the bindings of each pipeline; a shader that needs others must wait for it.
    fn compare(&self) -> Result<(), String> {
        let stages = |(stages, bound)| std::iter::repeat(bound).zip(stages);
        for (bound, stage) in self.pipelines.iter().flat_map(stages) {
            let one_line = |error: anyhow::Error| format!("{error:#}");
            let spirv = shader::compile(stage).map_err(one_line)?.spirv;
            for new in Reflection::of(&spirv).map_err(one_line)?.descriptors() {
                let Bound { set, binding, kind } = new;
                let place = |old: &&Bound| (old.set, old.binding) == (set, binding);
                let was = match bound.iter().find(place) {
                    Some(old) if old.kind == kind => continue,
                    Some(old) => format!("where the program binds {}", old.kind),
                    None => "where the program binds nothing".to_owned(),
                };
                return Err(format!(
                    "{stage}: set {set}, binding {binding} is {kind}, {was}; bindings belong to \
                     main.rs: change both, build and start again"
                ));
            }
        }
        Ok(())
    }
}

fn watch(proxy: EventLoopProxy<Wake>) -> notify::Result<RecommendedWatcher> {
    let folders = shader::folders().into_iter();
    let folders: Vec<_> = folders.map(|folder| folder.canonicalize().unwrap_or(folder)).collect();
    let tops = folders.clone();
    let mut watcher = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
        let Ok(event) = event else { return };
        // Compiling reads the files: read accesses are not changes.
        if event.kind.is_access() {
            return;
        }
        let below = |path| tops.iter().find_map(|top| Path::strip_prefix(path, top).ok());
        for path in event.paths.iter().filter_map(|path| below(path)) {
            let path = path.to_string_lossy().replace('\\', "/");
            let _ = proxy.send_event(Wake::Saved(path));
        }
    })?;
    folders.iter().try_for_each(|folder| watcher.watch(folder, RecursiveMode::Recursive))?;
    Ok(watcher)
}

/// Compiles all of them and stores the results in the cache.
fn compile(stages: &BTreeSet<String>) -> Result<(), String> {
    let compiled = stages.iter().try_for_each(|stage| shader::compile(stage).map(drop));
    compiled.map_err(|error| format!("{error:#}"))
}
