//! All instruments on one run.

use std::sync::Arc;

use anyhow::Result;
use clap::{ArgMatches, Args as _, Command};
use common::UsageError;
use common::app::{self, Args, Clicked, Picture, Program, Run, RunHooks};
use common::gpu::GpuOptions;
use common::output;

use crate::compare::{self, Comparison, Reference};
use crate::options::of_the_book;
use crate::pixel::{Probe, Which};
use crate::report::Report;
use crate::sums::{Gather, Sums, resumed};
use crate::{Options, compile_for};

/// All instruments, and their results so far.
pub struct Instruments {
    options: Options,
    /// The compared control, and its values.
    compared: Option<(String, Vec<String>)>,
    /// The picture that `--against` names.
    reference: Option<Reference>,
    /// Sums of an earlier run.
    resumed: Option<Sums>,
    gather: Option<Gather>,
    comparison: Option<Comparison>,
    probe: Option<Probe>,
}

/// All instruments, for a program to run with.
pub fn all() -> Instruments {
    Instruments::new(Options::default())
}

impl Instruments {
    /// Instruments without results yet.
    pub fn new(options: Options) -> Self {
        let probe = options.pixel.pixel.map(|_| Probe::default());
        Self {
            options,
            probe,
            compared: None,
            reference: None,
            resumed: None,
            gather: None,
            comparison: None,
        }
    }

    /// Does the work that needs no device; `false` if nothing else is left.
    ///
    /// # Errors
    /// States the mistake.
    pub fn prepare(&mut self, program: &Program, args: &mut Args) -> Result<bool> {
        if args.list_devices {
            return Ok(true);
        }
        let Options { report, compare, sums, compile_for, pixel, .. } = &self.options;
        if compile_for.answer_compile_for {
            compile_for::answer(&(program.requirements)())?;
            return Ok(false);
        }
        let no_window = compare.compare.is_some()
            || sums.samples.is_some()
            || compile_for.compile_for.is_some()
            || matches!(pixel.pixel, Some(Which::At(_)));
        args.headless |= no_window;
        if args.headless || args.list_controls {
            // One file that two options name is the first to be told of.
            app::files::check(args)?;
            report.check()?;
            self.resumed = resumed(sums)?;
            self.compared = compare.compare.as_deref().map(compare::parse).transpose()?;
            let against = compare.against.as_deref();
            self.reference = against.map(|file| Reference::open(file, args.size)).transpose()?;
        } else if report.report.is_some() {
            // One that goes to standard output is no file, which a window refuses itself.
            return Err(UsageError("--report needs --headless".to_owned()).into());
        }
        Ok(true)
    }

    /// Prints a table, unless the report goes to standard output.
    fn print(&self, table: &str) -> Result<()> {
        if self.options.report.takes_output() { Ok(()) } else { output::print(table) }
    }
}

/// Refuses early, before the work, options that would fail after it; for a program that renders by itself.
///
/// # Errors
/// If a file cannot be written, or is named twice; if a pixel's rays or long renders are requested.
pub fn check_files(args: &Args, options: &Options) -> Result<()> {
    if options.pixel.pixel.is_some() {
        let why = "this program makes its own pipeline: --pixel works from 02 on";
        return Err(UsageError(why.to_owned()).into());
    }
    if args.list_records {
        let why = "this program makes its own table: --list-records works from 02 on";
        return Err(UsageError(why.to_owned()).into());
    }
    if args.animate {
        let why =
            "this program has no animation: use --animate with one that does, such as 14_animation";
        return Err(UsageError(why.to_owned()).into());
    }
    app::files::check(args)?;
    Ok(options.report.check()?)
}

impl RunHooks for Instruments {
    fn options(&self, command: Command) -> Command {
        Options::augment_args(of_the_book(command))
    }

    fn asked(&mut self, program: &Program, matches: &ArgMatches, args: &mut Args) -> Result<bool> {
        *self = Self::new(Options::read(matches, args)?);
        self.prepare(program, args)
    }

    fn device(&self, options: &mut GpuOptions) {
        if self.options.report.compiler_figures {
            options.requirements =
                std::mem::take(&mut options.requirements).compiler_figures_where_offered();
        }
        options.driver_shim = Arc::new(self.options.arithmetic.or_seeded());
        if let Some(probe) = &self.probe {
            probe.device(options);
        }
    }

    fn has_result(&self) -> bool {
        !self.options.are_none()
    }

    fn begin(&mut self, run: &mut Run) -> Result<()> {
        if let (Some(probe), Some(Which::At(pixel))) = (&self.probe, self.options.pixel.pixel) {
            probe.frames(run, pixel)?;
            run.frames.clear();
        }
        if let Some((control, values)) = &self.compared {
            self.comparison = Some(compare::of_run(run, control, values, self.reference.as_ref())?);
            run.frames = std::iter::once(0..1).collect();
        }
        if let Some(samples) = self.options.sums.samples.clone() {
            let gather = Gather::begin(&self.options.sums, samples, run, self.resumed.take())?;
            run.between_bands = gather.stop();
            // Samples are separate pictures: the sums have their mean.
            (run.frames, run.apart) = (gather.missing().ranges().to_vec(), true);
            self.gather = Some(gather);
        }
        Ok(())
    }

    fn frame(&mut self, run: &Run, index: u32) -> Result<()> {
        self.gather.as_mut().map_or(Ok(()), |gather| gather.add(&run.gpu, &run.image, index))
    }

    fn end(&mut self, run: &Run) -> Result<Option<Picture>> {
        let sums = self.gather.take().map(Gather::finish).transpose()?;
        if let Some(comparison) = &self.comparison {
            let (name, driver) = (&run.gpu.name, &run.gpu.driver);
            self.print(&format!("{name} · {driver}\n\n{}", comparison.table()))?;
            if let (Some(out), Some(first)) = (&run.args.out, comparison.values.first()) {
                let (control, value) = (&comparison.control, &first.value);
                self.print(&format!("\n{} shows {control}={value}\n", out.display()))?;
            }
        }
        let mut compiled_for = Vec::new();
        if let Some(family) = self.options.compile_for.compile_for {
            compiled_for = compile_for::compile_for(family, &run.gpu.statistics().descs)?;
            self.print(&compile_for::table(family, &compiled_for))?;
        }
        // Its buffer must be freed before the device.
        self.probe = None;
        if let Some(path) = &self.options.report.report {
            let comparison = self.comparison.take();
            Report { comparison, compiled_for, ..Report::of(run)? }.save(path)?;
        }
        Ok(sums.filter(|_| run.args.out.is_some()).map(|sums| sums.mean()))
    }

    fn clicked(&self, trace: &mut dyn FnMut() -> Result<Clicked>) -> Result<Option<String>> {
        self.probe.as_ref().map(|probe| probe.clicked(trace)).transpose()
    }
}
