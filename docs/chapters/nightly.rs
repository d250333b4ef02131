//! `chapters nightly`: runs the tests that plain `cargo test` leaves out, one test program after the other,
//! each with its time, and then `chapters verify`.
//!
//! The first words of an ignored test's reason say how it is run:
//!
//! - `nightly: WHY; quick: NAME`: by this command. The test NAME is quick and finds the same fault in a
//!   simple case.
//! - `nightly only: WHY`: by this command; no quick test would find its fault.
//! - `by hand: WHY`: it measures, draws, or needs arguments.
//! - `run by NAME`: by another test.

use std::path::Path;
use std::time::Instant;

use anyhow::{Result, bail};
use common::UsageError;
use common::output::print;
use manuscript::fault::Fault;
use manuscript::project::Project;

use crate::pages::book::Book;
use crate::programs::program::Programs;
use crate::programs::test::{self, Test};
use crate::programs::{child, interrupt};
use crate::verify;

/// The name of the run that compares all pictures and values.
const VERIFY: &str = "verify";

/// The tests of a program that are run here.
struct Group {
    program: String,
    tests: Vec<Test>,
}

/// Runs the groups of these names, or all.
///
/// # Errors
/// If there is no such group, or a test fails.
pub fn run(project: &Project, names: &[String], list: bool) -> Result<()> {
    let mut groups = groups(project);
    let is_known = |name: &&String| *name == VERIFY || groups.iter().any(|g| g.program == **name);
    if let Some(name) = names.iter().find(|name| !is_known(name)) {
        let mut known: Vec<_> = groups.into_iter().map(|group| group.program).collect();
        known.push(VERIFY.to_owned());
        return Err(UsageError(format!("no group '{name}'; there is {}", known.join(", "))).into());
    }
    groups.retain(|group| names.is_empty() || names.contains(&group.program));
    if list {
        return print(&groups.iter().map(Group::list).collect::<String>());
    }
    interrupt::listen();
    let mut failed = Vec::new();
    for group in &groups {
        if !group.pass(&project.root)? {
            failed.push(group.program.as_str());
        }
    }
    if names.is_empty() || names.iter().any(|name| name == VERIFY) {
        let programs = Programs::beside_this(project)?;
        if let Err(error) = verify::run(&Book::open(&programs)?, &[], false) {
            print(&format!("verify: {error:#}\n"))?;
            failed.push(VERIFY);
        }
    }
    if failed.is_empty() { Ok(()) } else { bail!("{} failed", failed.join(", ")) }
}

fn groups(project: &Project) -> Vec<Group> {
    let group = |program: &String| {
        let mut tests = test::of(project, program);
        tests.retain(|test| test.ignored.as_ref().is_some_and(|why| why.starts_with("nightly")));
        Group { program: program.clone(), tests }
    };
    let programs = project.tests.iter().map(|target| &target.name);
    programs.map(group).filter(|group| !group.tests.is_empty()).collect()
}

impl Group {
    fn list(&self) -> String {
        let line = |test: &Test| {
            let why = test.ignored.as_deref().unwrap_or_default();
            format!("{} {}\n    {why}\n", self.program, test.name)
        };
        self.tests.iter().map(line).collect()
    }

    /// Runs the group's tests, which print as they go, and prints their time; returns whether all passed.
    fn pass(&self, root: &Path) -> Result<bool> {
        let mut cargo = child::cargo(root);
        cargo.args(["test", "--test", &self.program, "--"]);
        cargo.args(["--ignored", "--exact"]).args(self.tests.iter().map(|test| &test.name));
        let start = Instant::now();
        let passed = child::show(&mut cargo)?.success();
        let (count, seconds) = (self.tests.len(), start.elapsed().as_secs());
        let word = if passed { "passed" } else { "FAILED" };
        print(&format!("{}: {count} tests, {seconds} s: {word}\n", self.program))?;
        Ok(passed)
    }
}

/// The faults of ignored tests that do not say how they are run, or name a quick test that does not exist.
pub fn check(project: &Project) -> Vec<Fault> {
    let mut faults = Vec::new();
    for target in &project.tests {
        let tests = test::of(project, &target.name);
        for test in &tests {
            let Some(why) = &test.ignored else { continue };
            let fault = |what: String, remedy| Fault::new(&test.file, test.line, what, remedy);
            let is_known = |name: &str| {
                let named = |test: &Test| test.ignored.is_none() && test.name == name;
                match name.split_once(' ') {
                    Some((program, name)) => {
                        test::of(project, program).iter().any(|test| test.name == name)
                    }
                    None => tests.iter().any(named),
                }
            };
            let quick = why.strip_prefix("nightly: ").map(|why| why.rsplit_once("; quick: "));
            match quick {
                Some(Some((_, name))) if is_known(name) => {}
                Some(Some((_, name))) => {
                    faults.push(fault(format!("no quick test '{name}'"), "correct its name"));
                }
                Some(None) => faults.push(fault(
                    format!("'{}' names no quick test", test.name),
                    "add `; quick: NAME`, or say `nightly only: `",
                )),
                None if ["nightly only: ", "by hand: ", "run by "]
                    .iter()
                    .any(|how| why.starts_with(how)) => {}
                None => faults.push(fault(
                    format!("'{}' is left out and does not say how it is run", test.name),
                    "begin with `nightly: `, `nightly only: `, `by hand: ` or `run by `",
                )),
            }
        }
    }
    faults
}
