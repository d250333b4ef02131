//! 30_own_tree: trees and walks held to what they promise.

mod device;
mod growth;
mod host;
mod hunts;
mod instances;
mod peer;
mod rate;
mod rig;
mod scenes;
