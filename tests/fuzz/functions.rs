//! Readers in this process.

use fuzz::format::{Format, Function};
use fuzz::formats::{game, object, scene, settings, sums, texture};
use fuzz::session::Session;
use fuzz::watch::Watch;

use crate::{SEED, tried};

/// All of them, each with how many inputs `cargo test` tries: a few seconds' worth.
pub const ALL: [(Format, Function, usize); 7] = [
    (object::FORMAT, object::FUNCTION, 8000),
    (object::MATERIAL_FORMAT, object::MATERIAL_FUNCTION, 8000),
    (texture::FORMAT, texture::FUNCTION, 2000),
    (scene::FORMAT, scene::FUNCTION, 2000),
    (game::FORMAT, game::FUNCTION, 3000),
    (sums::FORMAT, sums::FUNCTION, 8000),
    (settings::FORMAT, settings::FUNCTION, 8000),
];

/// The session of a format.
pub fn session((format, function, _): (Format, Function, usize), seed: u64) -> Session<Watch> {
    Session::new(format.name, format, Watch::new(format, function), seed)
}

macro_rules! tests {
    ($($name:ident: $number:literal,)*) => {$(
        #[test]
        fn $name() {
            tried(session(ALL[$number], SEED), ALL[$number].2);
        }
    )*};
}

tests! {
    models: 0,
    material_files: 1,
    textures: 2,
    scene_files: 3,
    games: 4,
    files_of_sums: 5,
    settings_of_controls: 6,
}
