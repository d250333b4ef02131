//! `--pixel`: the rays of one pixel as text, with the values in shaders, and the output of `PRINT`.
//!
//! The pixel is traced alone, so shaders need not compare pixels. Each shader is compiled with additional lines from
//! [`stages`], which log its work; the files of shaders are not changed.

mod float;
mod log;
mod stages;

use std::fmt::Write;
use std::sync::Arc;

use anyhow::{Result, bail};
use common::UsageError;
use common::app::{Args, Clicked, Run};
use common::gpu::GpuOptions;
use common::output;

use self::log::{Log, WORDS};
use self::stages::Stages;
use crate::idle;

/// The options of `--pixel`.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub struct Options {
    /// Print the rays of this pixel, and the output of PRINT in its shaders, instead of a picture; `click`: of each
    /// pixel clicked in the window with Ctrl held
    #[arg(
        long,
        value_name = "X,Y|click",
        value_parser = which,
        allow_hyphen_values = true,
        conflicts_with_all = [
            "validate", "out", "report", "compare", "samples", "compile_for", "arithmetic", "animate", "then",
            "list_controls", "list_records",
        ]
    )]
    pub pixel: Option<Which>,
}

/// The selected pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    /// The pixel in this column and row.
    At([u32; 2]),
    /// The pixels clicked in the window.
    Clicked,
}

fn which(text: &str) -> Result<Which, String> {
    let numbers = text.split_once(',').map(|(x, y)| (x.trim().parse(), y.trim().parse()));
    match numbers {
        _ if text == "click" => Ok(Which::Clicked),
        Some((Ok(x), Ok(y))) => Ok(Which::At([x, y])),
        _ => Err("a pixel is a column and a row, such as 480,300, from the top left corner 0,0; or click"
            .to_owned()),
    }
}

impl Options {
    /// Refuses a pixel outside the picture.
    ///
    /// # Errors
    /// States the mistake.
    pub fn check(&self, args: &Args) -> Result<(), UsageError> {
        let (width, height) = (args.size.width, args.size.height);
        match self.pixel {
            Some(Which::Clicked) if args.headless => Err(UsageError(
                "--pixel click is for a window; without one, name a pixel, such as --pixel 480,300"
                    .to_owned(),
            )),
            Some(Which::At([x, y])) if x >= width || y >= height => Err(UsageError(format!(
                "pixel {x},{y} lies outside the picture of {width}x{height}: the last is {},{}",
                width - 1,
                height - 1
            ))),
            _ => Ok(()),
        }
    }
}

/// Logs the rays of a pixel.
#[derive(Default)]
pub struct Probe {
    stages: Arc<Stages>,
}

impl Drop for Probe {
    fn drop(&mut self) {
        self.stages.close();
    }
}

impl Probe {
    /// Changes the options for opening the device.
    pub fn device(&self, options: &mut GpuOptions) {
        options.prints = true;
        options.driver_shim = self.stages.clone();
    }

    /// Prints the rays of a pixel, frame after frame.
    ///
    /// # Errors
    /// If nothing was traced or printed, or the sample or the device fails.
    pub fn frames(&self, run: &mut Run, pixel: [u32; 2]) -> Result<()> {
        let size = [run.image.extent.width, run.image.extent.height];
        run.sample.changed(&run.gpu)?;
        for index in 0..run.args.frames {
            if let (true, Some(playback)) = (index > 0, run.sample.playback()) {
                playback.advance(1);
            }
            let told = self.told(&mut || {
                run.trace_pixel(pixel, index)?;
                Ok(Clicked { pixel, size, passes: run.sample.passes() })
            })?;
            output::print(&format!("{} · frame {index} · {told}", run.name))?;
        }
        Ok(())
    }

    /// Prints the rays of a clicked pixel, and returns a message.
    ///
    /// # Errors
    /// If the sample or the device fails.
    pub fn clicked(&self, trace: &mut dyn FnMut() -> Result<Clicked>) -> Result<String> {
        Ok(match self.told(trace) {
            Ok(told) => {
                output::print(&told)?;
                "the pixel's rays are printed".to_owned()
            }
            Err(error) => format!("{error:#}"),
        })
    }

    /// The text of the shaders' log while `trace` traces a pixel.
    fn told(&self, trace: &mut dyn FnMut() -> Result<Clicked>) -> Result<String> {
        let opened = self.stages.opened();
        let Some((gpu, log)) = &*opened else { bail!("no device was opened") };
        let layer = gpu.validation();
        layer.take_printed();
        log.write(0, &[0u32])?;
        let Clicked { pixel: [x, y], size: [width, height], mut passes } = trace()?;
        let (words, printed, known) =
            (log.read::<u32>()?, layer.take_printed(), self.stages.known());
        let written = words[0] as usize;
        let room = written.min(WORDS as usize);
        if Log::is_of_many(&words[1..1 + room]) {
            bail!(
                "this program traces whole rows at once: --pixel cannot tell one pixel's rays from the others'"
            );
        }
        let (text, rays) = Log::text(&words[1..1 + room], &known, &printed);
        let mut told = format!("pixel {x},{y} of {width}x{height}\n{text}");
        if written > room {
            let _ =
                writeln!(told, "the log is full: {written} words, and there is room for {WORDS}");
        }
        if !passes.is_empty() {
            passes.dedup();
            let _ = writeln!(
                told,
                "these are the rays of the first pass alone: the picture's value also depends on other pixels and on \
                 earlier frames, by the passes that follow ({}), which --pixel does not run",
                passes.join(", ")
            );
        }
        if written == 0 {
            idle::refuse(gpu, "there are no rays to print")?;
        }
        let printing = known.iter().find(|known| known.prints);
        if let (Some(shader), true) = (printing, gpu.vulkan.messenger.is_none()) {
            bail!(
                "PRINT in '{}' needs VK_LAYER_KHRONOS_validation, which is not installed: run ./setup, or \
                 install your system's Vulkan validation layers",
                shader.path
            );
        }
        match (rays, printed.is_empty(), printing) {
            (0, true, _) => bail!(
                "no shader called traceRayEXT or printed anything for pixel {x},{y}, and the rays of a rayQueryEXT \
                 are not recorded: write PRINT(\"t = %f\", t); where the shader runs"
            ),
            (_, true, Some(shader)) => {
                let _ = writeln!(
                    told,
                    "no shader printed anything for pixel {x},{y}: PRINT(...) in '{}' was not reached, or its stage \
                     is one from which the validation layer tells nothing",
                    shader.path
                );
            }
            _ => {}
        }
        Ok(told)
    }
}
