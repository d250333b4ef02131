//! A graphics pipeline: a vertex and a fragment shader, and the formats of its attachments.

use std::ops::Deref;

use super::{Pipeline, PipelineBuilder};

/// A pipeline of a vertex and a fragment shader, for dynamic rendering.
pub struct GraphicsPipeline {
    pub(super) pipeline: Pipeline,
}

impl GraphicsPipeline {
    /// An empty pipeline, to be filled line by line; its shaders are in `shaders/{name}/`.
    pub fn builder(name: &str) -> PipelineBuilder<'_> {
        PipelineBuilder::new(name)
    }
}

impl Deref for GraphicsPipeline {
    type Target = Pipeline;

    fn deref(&self) -> &Pipeline {
        &self.pipeline
    }
}
