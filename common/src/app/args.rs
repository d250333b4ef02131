//! The command line, the same for every sample.

use std::ops::Range;
use std::path::PathBuf;

use ash::vk;
use clap::Parser;
use clap::builder::NonEmptyStringValueParser;

use super::compile_for::Family;
use super::output;
use super::samples::range;
use crate::gpu::{Arithmetic, named_device};
use crate::usage::Usage;

/// What a sample was asked to do.
#[derive(Clone, Debug, Parser)]
#[command(disable_version_flag = true, about = "Renders one chapter")]
pub struct Args {
    /// Render without a window, write what is asked for, and exit
    #[arg(long)]
    pub headless: bool,

    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "960x600", value_parser = size, allow_hyphen_values = true)]
    pub size: vk::Extent2D,

    /// Frames to render; the last one is the picture. A window closes after so many, if given
    #[arg(long, value_name = "N", default_value = "1", value_parser = frames, allow_hyphen_values = true)]
    pub frames: u32,

    /// Whether --frames was given: without it, a window stays open
    #[arg(skip)]
    pub frames_given: bool,

    /// Write the last frame (with --headless; in a window, F2 writes one): .png (8-bit sRGB) or .exr (linear, unclamped)
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,

    /// With --headless, write device, times, stages and messages as JSON; - is standard output
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,

    /// Render the samples A to B-1 of a picture that is the mean of many, without a window; their exact mean is the picture
    #[arg(long, value_name = "A..B", value_parser = range, allow_hyphen_values = true, conflicts_with_all = ["frames", "compare"])]
    pub samples: Option<Range<u32>>,

    /// With --samples, keep their exact sums in this file: every --save-every seconds, at the end, and at Ctrl-C
    #[arg(long, value_name = "FILE", requires = "samples")]
    pub save: Option<PathBuf>,

    /// With --samples, begin with the sums of this file and render what it lacks; with --save of the same name, it need not be there yet
    #[arg(long, value_name = "FILE", requires = "samples")]
    pub resume: Option<PathBuf>,

    /// Seconds from one --save to the next; 0 saves after each sample
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = seconds, requires = "save", allow_hyphen_values = true)]
    pub save_every: u64,

    /// Set a control, as its name and a value; repeatable. Settings act in the order of --list-controls,
    /// whatever theirs; a name given again acts after all before it
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    pub sets: Vec<(String, String)>,

    /// Time a control's values in turns, --frames rounds, and print a table
    #[arg(long, value_name = "NAME=A|B|…")]
    pub compare: Option<String>,

    /// Print the controls: name, kind, possible values, value
    #[arg(long, conflicts_with = "compare")]
    pub list_controls: bool,

    /// Use this device: a number of --list-devices or a part of its name
    #[arg(long, value_name = "N|NAME", value_parser = NonEmptyStringValueParser::new(), allow_negative_numbers = true)]
    pub device: Option<String>,

    /// Print the devices and what each lacks
    #[arg(long)]
    pub list_devices: bool,

    /// Run under validation and synchronization validation; a message fails the run
    #[arg(long)]
    pub validate: bool,

    /// Open this model (.obj) instead of the chapter's own; 14 takes a game's moves instead (.txt), 25 also scene files (.toml)
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,

    /// Have Mesa's compiler for AMD GPUs make the pipelines too, and print what it says; no such GPU is needed
    #[arg(long, value_name = "FAMILY", value_enum)]
    pub compile_for: Option<Family>,

    /// Ask the device's own compiler about the pipelines, for the report, where it tells
    #[arg(long, hide = true)]
    pub compiler_figures: bool,

    /// Make the pipelines on standard input for the family there: the child of --compile-for
    #[arg(long, hide = true)]
    pub answer_compile_for: bool,

    /// Compute as the driver does, or as badly as Vulkan lets any driver: what must hold everywhere holds here
    #[arg(long, value_name = "WHOSE", value_enum, default_value = "driver")]
    pub arithmetic: Arithmetic,

    /// Build acceleration structures in the model's order instead of a spatial one
    #[arg(long)]
    pub unordered: bool,
}

impl Args {
    /// Whether no window is to be opened.
    pub fn is_headless(&self) -> bool {
        self.headless
            || self.list_controls
            || self.compare.is_some()
            || self.compile_for.is_some()
            || self.samples.is_some()
    }

    /// Fails if a file and a control both name the scene: one of them would be passed over.
    fn one_scene(&self) -> Result<(), Usage> {
        let set = self.sets.iter().find(|(name, value)| name == "scene" && value != "file");
        match (&self.scene, set) {
            (Some(file), Some((_, chosen))) => Err(Usage(format!(
                "--scene {} and --set \"scene={chosen}\" are two scenes; leave one of them out",
                file.display()
            ))),
            _ => Ok(()),
        }
    }

    /// Fails if the sums are to go where one would look for a picture: no viewer opens them.
    fn sums_are_no_picture(&self) -> Result<(), Usage> {
        let Some(path) = &self.save else { return Ok(()) };
        let ends = |end: &&str| path.extension().is_some_and(|it| it.eq_ignore_ascii_case(end));
        let others = ["png", "exr", "jpg", "jpeg", "tif", "tiff", "json"];
        match others.iter().any(ends) || path.as_os_str() == "-" {
            true => Err(Usage(format!(
                "--save {}: sums of samples are no picture; name the file .sums, and the picture by --out",
                path.display()
            ))),
            false => Ok(()),
        }
    }

    /// Fails if a render would keep nothing of its samples, perhaps after days.
    fn samples_are_kept(&self) -> Result<(), Usage> {
        let asked = self.list_controls || self.compile_for.is_some();
        let kept = self.out.is_some() || self.save.is_some() || self.report.is_some();
        match self.samples.is_none() || asked || kept {
            true => Ok(()),
            false => Err(Usage(
                "--samples keeps nothing: name a file for the picture, --out, or for the sums, --save"
                    .to_owned(),
            )),
        }
    }

    /// Parses the process's arguments.
    ///
    /// Prints the help and ends the process if that is asked for.
    ///
    /// # Errors
    /// One line that says what is wrong and where to look.
    pub fn parse_for(name: &'static str) -> Result<Self, Usage> {
        Ok(Self::parse_with::<Nothing>(name)?.0)
    }

    /// As [`Args::parse_for`], for a sample with arguments of its own.
    ///
    /// # Errors
    /// As [`Args::parse_for`].
    pub fn parse_with<More: clap::Args>(name: &'static str) -> Result<(Self, More), Usage> {
        use clap::{CommandFactory, FromArgMatches, parser::ValueSource};
        let command = Self::command().name(name);
        // Arguments of a sample's own would bring their own first line of the help.
        let about = command.get_about().cloned().unwrap_or_default();
        let command = More::augment_args(command).about(about);
        let matches = command.try_get_matches().and_then(|matches| {
            let mut args = Self::from_arg_matches(&matches)?;
            args.device = args.device.or_else(|| named_device().map(str::to_owned));
            args.frames_given = matches.value_source("frames") == Some(ValueSource::CommandLine);
            Ok((args, More::from_arg_matches(&matches)?))
        });
        let (args, more) = matches.map_err(|error| {
            if !error.use_stderr() {
                output::print_and_exit(&error.to_string());
            }
            // clap spreads an error over a paragraph; its first block says it all.
            let text = error.to_string();
            let block: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).collect();
            let line = block.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ");
            Usage(format!("{}; --help lists the options", line.trim_start_matches("error: ")))
        })?;
        args.one_scene()?;
        args.sums_are_no_picture()?;
        args.samples_are_kept()?;
        Ok((args, more))
    }
}

/// No arguments of its own.
#[derive(clap::Args)]
struct Nothing {}

fn size(text: &str) -> Result<vk::Extent2D, String> {
    let sides = text.split_once('x').map(|(w, h)| (w.parse::<u32>(), h.parse::<u32>()));
    match sides {
        Some((Ok(width), Ok(height))) if width > 0 && height > 0 => {
            Ok(vk::Extent2D { width, height })
        }
        _ => Err("a size is two whole numbers of at least 1, such as 640x400".to_owned()),
    }
}

fn frames(text: &str) -> Result<u32, String> {
    let number = text.parse().ok().filter(|&number| number > 0);
    number.ok_or_else(|| format!("frames are a whole number from 1 to {}", u32::MAX))
}

fn seconds(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| "seconds are a whole number, such as 60".to_owned())
}

fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("a setting is a name and a value, such as \"sun elevation=30\"".to_owned()),
    }
}
