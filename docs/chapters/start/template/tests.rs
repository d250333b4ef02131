//! The test that `cargo chapters start` writes, here on the driver of all tests.

use device as _;

#[path = "tests/picture.rs"]
mod picture;
