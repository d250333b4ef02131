//! The command line, the same for every sample.

use std::path::PathBuf;

use ash::vk;
use clap::builder::NonEmptyStringValueParser;
use clap::parser::ValueSource;
use clap::{ArgMatches, Command, CommandFactory, FromArgMatches, Parser};

use super::Development;
use super::files::Files;

use crate::UsageError;
use crate::gpu::{GpuOptions, Requirements, named_device};
use crate::output;

/// The command line of a sample, parsed.
#[derive(Clone, Debug, Parser)]
#[command(disable_version_flag = true, about = "Shows its scene in a window, or renders a picture")]
pub struct Args {
    /// Render without a window, write the requested files, and exit
    #[arg(long)]
    pub headless: bool,

    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "960x600", value_parser = size, allow_hyphen_values = true)]
    pub size: vk::Extent2D,

    /// True if --size was given
    #[arg(skip)]
    pub size_given: bool,

    /// Frames to render; the last one is the picture. If given, a window closes after that many
    #[arg(long, value_name = "N", default_value = "1", value_parser = frames, allow_hyphen_values = true)]
    pub frames: u32,

    /// True if --frames was given: without it, a window stays open
    #[arg(skip)]
    pub frames_given: bool,

    /// Input and output files besides --scene and --out
    #[arg(skip)]
    pub files: Files,

    /// Write the last frame (with --headless; in a window, F2 writes one): .png (8-bit sRGB) or .exr (linear, unclamped)
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,

    /// With --headless, --frames and --out FILE.png: write all frames as an animated PNG
    #[arg(long, requires = "headless")]
    pub animate: bool,

    /// Set a control, as its name and a value; repeatable. Settings apply in the order of --list-controls, not in
    /// the order given; a repeated name applies after everything before it
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    pub sets: Vec<(String, String)>,

    /// With --headless: set a control just before a frame, as if it were moved in the window; repeatable. The first
    /// frame is number 0
    #[arg(long, value_name = "FRAME:NAME=VALUE", value_parser = later, allow_hyphen_values = true, requires = "headless")]
    pub then: Vec<(u32, (String, String))>,

    /// Print the controls: name, kind, possible values, value; other options are checked, and nothing is rendered
    #[arg(long, conflicts_with = "list_devices")]
    pub list_controls: bool,

    /// Print the records of the shader binding tables: pipeline, record, shaders, what asks for it; nothing is rendered
    #[arg(long, conflicts_with_all = ["list_controls", "list_devices"])]
    pub list_records: bool,

    /// Use this device: its number in --list-devices or a part of its name
    #[arg(long, value_name = "N|NAME", value_parser = NonEmptyStringValueParser::new(), allow_negative_numbers = true)]
    pub device: Option<String>,

    /// Print the devices and the features each one lacks, and nothing else
    #[arg(long)]
    pub list_devices: bool,

    /// Run with validation and synchronization validation; any message fails the run
    #[arg(long)]
    pub validate: bool,

    /// Open this model (.obj, .gltf, .glb) instead of the program's own
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,

    /// Light the scene by this picture of the sky: an .exr of all directions, twice as wide as high; only 46_environment
    #[arg(long, value_name = "FILE")]
    pub sky: Option<PathBuf>,

    /// Exposure and tone of a PNG and of the window; an EXR stays as it was rendered
    #[command(flatten)]
    pub development: Development,

    /// Build acceleration structures in the model's order instead of sorting in space
    #[arg(long)]
    pub unordered: bool,
}

impl Args {
    /// Options for opening the chosen device with these features.
    pub fn device(&self, requirements: Requirements) -> GpuOptions<'_> {
        let (device, validate) = (self.device.as_deref(), self.validate);
        GpuOptions { requirements, device, validate, ..GpuOptions::default() }
    }

    /// Fails if a file and a control both name the scene, or the sky: one of them would be ignored.
    fn named_once(&self) -> Result<(), UsageError> {
        let then = self.then.iter().map(|(_, set)| ("--then", set));
        let sets = self.sets.iter().map(|set| ("--set", set)).chain(then);
        for (option, (name, value)) in sets {
            let (file, many) = match name.as_str() {
                "scene" => (&self.scene, "scenes"),
                "sky" => (&self.sky, "skies"),
                _ => continue,
            };
            if let Some(file) = file.as_ref().filter(|_| value != "file") {
                return Err(UsageError(format!(
                    "--{name} {} and {option} \"{name}={value}\" are two {many}; leave one of them out",
                    file.display()
                )));
            }
        }
        Ok(())
    }

    /// Parses the process's arguments, with the options that `more` adds.
    ///
    /// Prints the help and ends the process if the user asked for it.
    ///
    /// # Errors
    /// One line with the mistake and where to look.
    pub fn parse(
        name: &'static str,
        more: impl FnOnce(Command) -> Command,
    ) -> Result<(Self, ArgMatches), UsageError> {
        let command = Self::command().name(name);
        // Added options would replace the first line of the help with their own.
        let about = command.get_about().cloned().unwrap_or_default();
        let matches = more(command).about(about).try_get_matches();
        let parsed = matches.and_then(|matches| {
            let mut args = Self::from_arg_matches(&matches)?;
            args.device = args.device.or_else(|| named_device().map(str::to_owned));
            let is_given = |name| matches.value_source(name) == Some(ValueSource::CommandLine);
            args.frames_given = is_given("frames");
            args.size_given = is_given("size");
            Ok((args, matches))
        });
        let (args, matches) = parsed.map_err(|error| usage_error(&error))?;
        args.named_once()?;
        Ok((args, matches))
    }
}

/// Reduces a command-line error to one line. Prints the help and ends the process if the user asked for it.
pub fn usage_error(error: &clap::Error) -> UsageError {
    if !error.use_stderr() {
        output::print_and_exit(&error.to_string());
    }
    // clap spreads an error over a paragraph; its first block contains everything.
    let text = error.to_string();
    let block: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).collect();
    let line = block.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ");
    UsageError(format!("{}; --help lists the options", line.trim_start_matches("error: ")))
}

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

fn later(text: &str) -> Result<(u32, (String, String)), String> {
    let parts = text.split_once(':').map(|(frame, set)| (frame.trim().parse(), assignment(set)));
    match parts {
        Some((Ok(frame), Ok(set))) => Ok((frame, set)),
        _ => Err("it takes the number of a frame and a setting, such as \"12:sun elevation=30\""
            .to_owned()),
    }
}

fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("a setting is a name and a value, such as \"sun elevation=30\"".to_owned()),
    }
}
