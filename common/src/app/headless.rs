//! A run without a window: renders every frame and writes the requested files.

use std::time::Instant;

use anyhow::Result;

use super::animated::{self, Animated};
use super::{Args, Program, Progress, Run, RunHooks, files};
use crate::{UsageError, output};

/// Renders the frames of a sample, and writes the last one, or all of them for an animation.
///
/// # Errors
/// On wrong arguments ([`UsageError`](crate::UsageError)), if anything fails, or if validation reported a message.
pub fn run(program: &Program, args: &Args, hooks: &mut dyn RunHooks) -> Result<()> {
    let start = Instant::now();
    files::check(args)?;
    animated::check(args)?;
    check_later(args)?;
    let mut run = Run::new(program, args, hooks, start)?;
    if args.list_controls {
        return run.list_controls();
    }
    if args.list_records {
        run.list_records()?;
        return run.close();
    }
    hooks.begin(&mut run)?;
    let mut animated = args.animate.then(|| Animated::begin(&mut run)).transpose()?;
    run.sample.changed(&run.gpu)?;
    let frames = run.frames.clone();
    let count = frames.iter().map(|range| u64::from(range.end - range.start)).sum();
    let mut progress = Progress::new(count, if run.apart { "samples" } else { "frames" });
    let mut begun = 0;
    for (number, index) in (0..).zip(frames.into_iter().flatten()) {
        if let (true, Some(playback)) = (number > 0, run.sample.playback()) {
            playback.advance(1);
        }
        if run.set_before(number)? {
            // As in a window, a moved control begins a picture.
            begun = index;
        }
        run.render(index - begun)?;
        hooks.frame(&run, index)?;
        if let Some(animated) = &mut animated {
            animated.add(&args.development.of(run.picture()?))?;
        }
        progress.step();
    }
    drop(progress);
    let picture = hooks.end(&run)?;
    if let Some(out) = &args.out {
        match animated {
            Some(animated) => animated.save(out)?,
            None => {
                let picture = picture.map_or_else(|| run.picture(), Ok)?;
                output::warn(picture.not_finite().as_slice());
                args.development.save(picture, out)?;
            }
        }
    }
    run.close()?;
    if args.out.is_none() && args.files.outputs.is_empty() && !args.validate && !hooks.has_result()
    {
        let line = "the picture is not written: add --out FILE.png or --out FILE.exr";
        output::warn(&[line.to_owned()]);
    }
    Ok(())
}

/// Refuses `--then` for a frame that is not rendered.
fn check_later(args: &Args) -> Result<(), UsageError> {
    let frames = args.frames;
    match args.then.iter().find(|(at, _)| *at >= frames) {
        Some((at, _)) => Err(UsageError(format!(
            "--then names frame {at}, but the run has frames 0 to {}: give it more by --frames",
            frames - 1
        ))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use clap::Parser;

    use super::*;
    use crate::app::{Controls, Frame, Sample, Setup};
    use crate::gpu::{Gpu, Requirements};

    /// A sample that records the builds and frames requested of it.
    #[derive(Default)]
    struct Noting {
        preset: u32,
        height: u32,
    }

    static NOTES: Mutex<Vec<String>> = Mutex::new(Vec::new());

    impl Sample for Noting {
        fn requirements() -> Requirements {
            Requirements::ray_tracing()
        }

        fn new(_: &Gpu, _: &Setup) -> Result<Self> {
            Ok(Self::default())
        }

        fn controls(&mut self, c: &mut Controls) {
            if c.integer("preset", &mut self.preset, 0..=9) {
                self.height = 10 * self.preset;
            }
            c.integer("height", &mut self.height, 0..=99);
        }

        fn changed(&mut self, _: &Gpu) -> Result<()> {
            NOTES.lock().unwrap().push(format!("build {}, {}", self.preset, self.height));
            Ok(())
        }

        fn render(&mut self, frame: &Frame) -> Result<()> {
            NOTES.lock().unwrap().push(format!("frame {}", frame.index));
            Ok(())
        }
    }

    fn notes(args: &[&str]) -> Vec<String> {
        let args = ["test", "--headless", "--size", "8x8"].iter().chain(args);
        run(&Program::of::<Noting>("test"), &Args::try_parse_from(args).unwrap(), &mut ()).unwrap();
        let mut notes = std::mem::take(&mut *NOTES.lock().unwrap());
        // `render` is called once per band.
        notes.dedup();
        notes
    }

    #[test]
    fn what_settings_ask_for_is_built_once_before_the_first_frame() {
        assert_eq!(notes(&[]), ["build 0, 0", "frame 0"]);
        for sets in [["height=3", "preset=2"], ["preset=2", "height=3"]] {
            let built = notes(&["--set", sets[0], "--set", sets[1], "--frames", "2"]);
            assert_eq!(built, ["build 2, 3", "frame 0", "frame 1"], "{sets:?}");
        }
        let then = ["--frames", "4", "--then", "2:height=7", "--then", "2:preset=1"];
        let built = ["build 0, 0", "frame 0", "frame 1", "build 1, 7", "frame 0", "frame 1"];
        assert_eq!(notes(&then), built, "a moved control begins a picture");
    }
}
