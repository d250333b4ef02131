//! 30_own_tree: trees held to what they promise.

mod device;
