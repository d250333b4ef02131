//! What a picture or a figure is made from, as a hash: whether it would come out the same is known without a run.

pub mod essence;
pub mod hash;
