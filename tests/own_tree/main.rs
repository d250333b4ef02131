//! 30_own_tree: trees held to what they promise.

mod host;
mod peer;
mod scenes;
