//! 30_own_tree: trees and walks held to what they promise.

mod hunts;
mod rate;
mod rig;
