//! 30_own_tree: checks the promises of trees and walks.

mod device;
mod embree;
mod growth;
mod host;
mod hunts;
mod instances;
mod peer;
mod rate;
mod rig;
mod scenes;
