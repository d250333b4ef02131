//! Runs a process, and checks its exit code, its message, its time, its memory and its folder.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use tempfile::TempDir;
use time_limit::{GLANCE, Limit, Work};

use crate::fault::Fault;
use crate::format::{Answer, Format, Reader};

/// The limit of a run.
const PATIENCE: Limit = Limit::worked(180);
/// The largest number of bytes of a process, including a device and its shader compiler.
const MEMORY: u64 = 1 << 30;
/// The largest number of letters of a message: `output` cuts at 2000, and escapes them before.
const LETTERS: usize = 30_000;

/// A program that reads an input.
pub struct Program {
    folder: TempDir,
    /// The directory of its temporary files.
    passing: TempDir,
    format: Format,
    command: fn(folder: &Path, input: &[u8]) -> Command,
    /// The files that it may write.
    writes: &'static [&'static str],
    patience: Limit,
}

impl Program {
    /// A program in its own folder; `beside` writes the files that inputs refer to.
    pub fn new(
        format: Format,
        beside: fn(&Path),
        command: fn(folder: &Path, input: &[u8]) -> Command,
        writes: &'static [&'static str],
    ) -> Self {
        let [folder, passing] = [(); 2].map(|()| tempfile::tempdir().expect("a temporary folder"));
        beside(folder.path());
        Self { folder, passing, format, command, writes, patience: PATIENCE }
    }

    /// The same with a shorter limit.
    #[must_use]
    pub fn within(self, patience: Limit) -> Self {
        Self { patience, ..self }
    }

    fn run(&self, input: &[u8]) -> Result<(i32, Vec<u8>), Fault> {
        let said = tempfile::tempdir().expect("a temporary folder");
        let [out, err] = ["out", "err"].map(|name| said.path().join(name));
        let into = |path: &Path| Stdio::from(File::create(path).expect("a file"));
        let mut command = (self.command)(self.folder.path(), input);
        command.env("TMPDIR", self.passing.path()).current_dir(&self.folder);
        command.stdin(Stdio::null()).stdout(into(&out)).stderr(into(&err));
        let mut child = command.spawn().expect("the program starts");
        let ended = end(&mut child, self.patience);
        if ended.is_err() {
            let _ = child.kill();
        }
        let status = child.wait().expect("it ends");
        ended?;
        match status.code() {
            Some(code @ 0..=2) => Ok((code, fs::read(&err).expect("what it said"))),
            _ => Err(Fault::Exit(status.to_string())),
        }
    }
}

/// Waits for its end, and checks its memory meanwhile.
fn end(child: &mut Child, patience: Limit) -> Result<(), Fault> {
    let (start, work) = (Instant::now(), Work::from(&*child));
    while child.try_wait().expect("a child can be waited for").is_none() {
        if patience.is_over(work, start) {
            return Err(Fault::Endless(patience));
        }
        if memory(child.id()).is_some_and(|bytes| bytes > MEMORY) {
            return Err(Fault::Memory(MEMORY));
        }
        std::thread::sleep(GLANCE);
    }
    Ok(())
}

/// The largest memory of a process in bytes, if the system reports it.
fn memory(id: u32) -> Option<u64> {
    let status = fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.parse::<u64>().ok().map(|kilobytes| kilobytes << 10)
}

impl Reader for Program {
    fn ask(&mut self, input: &[u8]) -> Result<Answer, Fault> {
        if !self.format.file.is_empty() {
            let file = self.folder.path().join(self.format.file);
            fs::write(file, input).expect("an input can be written");
        }
        let before = files(self.folder.path());
        let (code, said) = self.run(input)?;
        let mut after = files(self.folder.path());
        for name in self.writes {
            if after.remove(Path::new(name)) && !before.contains(Path::new(name)) {
                fs::remove_file(self.folder.path().join(name)).expect("it can be removed");
            }
        }
        let mut left: Vec<_> = before.symmetric_difference(&after).cloned().collect();
        left.retain(|path| !self.writes.iter().any(|name| path == Path::new(name)));
        left.extend(files(self.passing.path()));
        if !left.is_empty() {
            return Err(Fault::Left(left.iter().map(|path| path.display().to_string()).collect()));
        }
        answer(code, &said)
    }
}

/// The answer: refused with one line, or accepted with warnings, one line each.
fn answer(code: i32, said: &[u8]) -> Result<Answer, Fault> {
    let Ok(text) = std::str::from_utf8(said) else {
        return Err(Fault::Line(String::from_utf8_lossy(said).into_owned()));
    };
    let plain = |line: &str| line.chars().all(|c| !c.is_control()) && line.len() < LETTERS;
    let right = match code {
        0 => text.lines().all(|line| line.starts_with("warning: ") && plain(line)),
        _ => {
            let refusals = text.lines().filter(|line| line.starts_with("error: ") && plain(line));
            let others = text.lines().filter(|line| !line.starts_with("error: "));
            let warned = others.clone().all(|line| line.starts_with("warning: ") && plain(line));
            refusals.count() == 1 && warned
        }
    };
    if run::MISTAKES.iter().any(|mistake| text.contains(mistake)) {
        return Err(Fault::Panic(text.trim().chars().take(1000).collect()));
    }
    match (right, code) {
        (false, _) => Err(Fault::Line(text.chars().take(1000).collect())),
        (true, 0) => Ok(Answer::Taken(text.to_owned())),
        (true, _) => Ok(Answer::Refused(text.to_owned())),
    }
}

/// The files below a folder.
fn files(folder: &Path) -> BTreeSet<PathBuf> {
    let mut files = BTreeSet::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(next) = waiting.pop() {
        for entry in next.read_dir().expect("a folder can be read") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                waiting.push(path.clone());
            }
            files.insert(path.strip_prefix(folder).expect("it lies below").to_owned());
        }
    }
    files
}

/// The words of an input's lines as arguments, without those that cannot be arguments.
pub fn lines(input: &[u8]) -> Vec<OsString> {
    let text = String::from_utf8_lossy(input).replace('\0', "");
    text.lines().filter(|line| !line.is_empty()).map(OsString::from).collect()
}
