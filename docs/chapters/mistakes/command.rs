//! `cargo chapters mistake`: the commands for readers and authors of mistakes.

use std::path::Path;

use anyhow::{Result, bail};
use common::UsageError;
use common::output::print;
use common::workers;
use manuscript::project::Project;

use super::mistake::Mistake;
use super::reproduction::Reproduction;
use crate::programs::program::Programs;

/// Lists mistakes, makes a patched copy, or checks them.
///
/// # Errors
/// If there is no mistake of that name, the copy cannot be made, or a mistake does not match its file.
pub fn run(
    project: &Project,
    name: Option<&str>,
    list: bool,
    out: Option<&Path>,
    check: bool,
) -> Result<()> {
    let mistakes = match name {
        Some(name) => vec![Mistake::named(project, name)?],
        None => Mistake::whole(project)?,
    };
    if list {
        let line = |m: &Mistake| format!("{:24} {:20} {}\n", m.name, m.chapter, m.title);
        return print(&mistakes.iter().map(line).collect::<String>());
    }
    if check {
        let programs = Programs::beside_this(project)?;
        let wanted = |mistake: &Mistake| name.is_some() || mistake.is_in_shaders();
        let mistakes: Vec<Mistake> = mistakes.into_iter().filter(wanted).collect();
        return check_mistakes(&programs, &mistakes);
    }
    let (Some(name), [mistake]) = (name, &mistakes[..]) else {
        let names: Vec<String> = mistakes.into_iter().map(|mistake| mistake.name).collect();
        return Err(
            UsageError(format!("no mistake is named; there is {}", names.join(", "))).into()
        );
    };
    let folder = out.map_or_else(|| format!("target/mistakes/{name}").into(), Path::to_owned);
    mistake.copy_to(project, &std::path::absolute(&folder)?)?;
    print(&format!("{}: {}\n{}\n", mistake.title, mistake.cause, mistake.run(&folder)))
}

fn check_mistakes(programs: &Programs, mistakes: &[Mistake]) -> Result<()> {
    let mut failed = 0;
    let check = |mistake: &Mistake| Reproduction::new(programs, mistake).check();
    for line in workers::each(mistakes, check) {
        failed += usize::from(line.is_err());
        print(&format!("{}\n", line.unwrap_or_else(|error| format!("{error:#}"))))?;
    }
    match failed {
        0 => Ok(()),
        _ => bail!("{failed} of {} mistakes are not what their files say", mistakes.len()),
    }
}
