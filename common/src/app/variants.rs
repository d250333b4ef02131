//! One pipeline per set of constants, built when it is first needed.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Builder, JoinHandle};

use anyhow::{Context, Result, anyhow};

use super::Frame;
use crate::gpu::{
    ComputePipeline, Gpu, GraphicsPipeline, RayTracingPipeline, ShaderBindingTable, TextureTable,
};

/// Builds a window's pipelines in the background, while the old picture is shown.
#[derive(Default)]
pub struct Background {
    /// Number of pipelines being built by other threads.
    building: AtomicUsize,
    /// Number of pipelines they have built.
    built: AtomicUsize,
    refused: Mutex<Vec<String>>,
}

impl Background {
    /// True while a pipeline is being built: the picture will change once it is ready.
    pub fn is_building(&self) -> bool {
        self.building.load(Ordering::Relaxed) > 0
    }

    /// Number of pipelines built in the background and put to use.
    pub fn built(&self) -> usize {
        self.built.load(Ordering::Relaxed)
    }

    /// Takes the error messages of pipelines that could not be built.
    pub fn refused(&self) -> Vec<String> {
        std::mem::take(&mut *self.refused.lock().unwrap_or_else(PoisonError::into_inner))
    }

    fn refuse(&self, why: &anyhow::Error) {
        self.refused.lock().unwrap_or_else(PoisonError::into_inner).push(format!("{why:#}"));
    }
}

/// A kind of pipeline, with the table that its launches need.
pub trait Launch: Sized + Send + 'static {
    /// The table; `()` if it needs none.
    type Table;

    /// A table of this pipeline.
    ///
    /// # Errors
    /// If memory is short.
    fn table(&self, gpu: &Gpu) -> Result<Self::Table>;
}

impl Launch for RayTracingPipeline {
    type Table = ShaderBindingTable;

    fn table(&self, gpu: &Gpu) -> Result<ShaderBindingTable> {
        ShaderBindingTable::new(gpu, self)
    }
}

impl Launch for ComputePipeline {
    type Table = ();

    fn table(&self, _: &Gpu) -> Result<()> {
        Ok(())
    }
}

impl Launch for GraphicsPipeline {
    type Table = ();

    fn table(&self, _: &Gpu) -> Result<()> {
        Ok(())
    }
}

/// Builds the pipeline of a variant: the chapter's own `pipeline`.
pub type Make<V, P> = fn(&Gpu, &TextureTable, V) -> Result<P>;

/// The most pipelines a window keeps, the most recently chosen ones.
const MOST: usize = 32;

/// The pipelines of a sample, by variant.
///
/// In a window, another thread builds a missing variant while the old picture stays; a run without a window waits
/// for it.
pub struct Variants<V, P: Launch = RayTracingPipeline> {
    /// In the order in which they were chosen, the current one last.
    made: Vec<Variant<V, P>>,
    order: Option<Order<V, P>>,
    /// The variant that could not be built, until another one is chosen.
    refused: Option<V>,
}

/// A pipeline being built by another thread, counted until it is taken.
struct Order<V, P> {
    key: V,
    thread: Option<JoinHandle<Result<P>>>,
    background: Arc<Background>,
}

/// A pipeline, its table, and the variant it was built for.
pub struct Variant<V, P: Launch = RayTracingPipeline> {
    /// The variant it was built for.
    pub key: V,
    /// The pipeline.
    pub pipeline: P,
    /// Its table.
    pub sbt: P::Table,
}

impl<V, P: Launch> Default for Variants<V, P> {
    fn default() -> Self {
        Self { made: Vec::new(), order: None, refused: None }
    }
}

impl<V: Copy + PartialEq + Send + 'static, P: Launch> Variants<V, P> {
    /// The pipeline for `wanted`; in a window, the last one for as long as it is being made.
    ///
    /// # Errors
    /// If it cannot be built. A window with a picture shows the error and keeps using the last pipeline.
    pub fn choose(
        &mut self,
        frame: &Frame,
        textures: &Arc<TextureTable>,
        wanted: V,
        make: Make<V, P>,
    ) -> Result<&Variant<V, P>> {
        let &Frame { gpu, background, .. } = frame;
        if let Some(mut order) = self.order.take_if(|order| order.is_finished()) {
            match order.finish() {
                Ok(pipeline) => self.keep(frame, order.key, pipeline)?,
                Err(error) => {
                    order.background.refuse(&error);
                    self.refused = Some(order.key);
                }
            }
        }
        if let Some(known) = self.made.iter().position(|variant| variant.key == wanted) {
            let chosen = self.made.remove(known);
            self.made.push(chosen);
        } else if let Some(background) = background.filter(|_| !self.made.is_empty()) {
            if self.order.is_none() && self.refused != Some(wanted) {
                match Order::begin(gpu, background, textures, wanted, make) {
                    Ok(order) => (self.order, self.refused) = (Some(order), None),
                    Err(error) => {
                        background.refuse(&error);
                        self.refused = Some(wanted);
                    }
                }
            }
        } else {
            let pipeline = make(gpu, textures, wanted)?;
            self.keep(frame, wanted, pipeline)?;
        }
        self.made.last().context("no pipeline")
    }

    /// The variant chosen last.
    pub fn current(&self) -> Option<&Variant<V, P>> {
        self.made.last()
    }

    fn keep(&mut self, frame: &Frame, key: V, pipeline: P) -> Result<()> {
        let sbt = pipeline.table(frame.gpu)?;
        // A window session may request many variants; a comparison cycles through its values.
        if frame.background.is_some() && self.made.len() == MOST {
            self.made.remove(0);
        }
        self.made.push(Variant { key, pipeline, sbt });
        Ok(())
    }
}

impl<V: Copy + Send + 'static, P: Launch> Order<V, P> {
    fn begin(
        gpu: &Gpu,
        background: &Arc<Background>,
        textures: &Arc<TextureTable>,
        key: V,
        make: Make<V, P>,
    ) -> Result<Self> {
        let (device, textures) = (gpu.clone(), textures.clone());
        let build = move || make(&device, &textures, key);
        let thread = Builder::new().name("pipeline".to_owned()).spawn(build);
        let thread = Some(thread.context("no thread to make a pipeline with")?);
        background.building.fetch_add(1, Ordering::Relaxed);
        Ok(Self { key, thread, background: background.clone() })
    }

    fn is_finished(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    fn finish(&mut self) -> Result<P> {
        let thread = self.thread.take().context("taken before")?;
        thread.join().unwrap_or_else(|_| Err(anyhow!("making a pipeline panicked")))
    }
}

impl<V, P> Drop for Order<V, P> {
    fn drop(&mut self) {
        // A pipeline still being built must not outlive the window.
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
        self.background.building.fetch_sub(1, Ordering::Relaxed);
        self.background.built.fetch_add(1, Ordering::Relaxed);
    }
}
