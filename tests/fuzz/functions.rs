//! Readers in this process.

use fuzz::format::{Format, Function};
use fuzz::formats::FUNCTIONS;
use fuzz::session::Session;
use fuzz::watch::Watch;

use crate::{SEED, tried};

/// The session of a format.
pub fn session((format, function, _): (Format, Function, usize), seed: u64) -> Session<Watch> {
    Session::new(format.name, format, Watch::new(format, function), seed)
}

macro_rules! tests {
    ($($name:ident: $number:literal,)*) => {$(
        #[test]
        fn $name() {
            tried(session(FUNCTIONS[$number], SEED), FUNCTIONS[$number].2);
        }
    )*};
}

tests! {
    models: 0,
    material_files: 1,
    textures: 2,
    scene_files: 3,
    games: 4,
    files_of_legs: 5,
    files_of_sums: 6,
    settings_of_controls: 7,
    gltf_files: 8,
}
