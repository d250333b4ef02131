//! A program around a sample: arguments, controls, a headless run or a window, a picture.

mod animated;
mod args;
pub mod bands;
pub mod chart;
pub mod controls;
mod development;
pub mod files;
mod headless;
mod lighting;
mod picture;
mod playback;
mod program;
mod progress;
mod run;
mod run_hooks;
mod sample;
mod setup;
mod variants;
mod window;

pub use args::{Args, usage_error};
pub use bands::Bands;
pub use controls::Controls;
pub use development::{Development, Tone};
pub use files::Files;
pub use lighting::Lighting;
pub use picture::{Format, Picture};
pub use playback::Playback;
pub use program::{Program, run, run_at};
pub use progress::Progress;
pub use run::{Run, check_validation};
pub use run_hooks::{Clicked, RunHooks};
pub use sample::{Frame, Sample};
pub use setup::Setup;
pub use variants::{Variant, Variants};
