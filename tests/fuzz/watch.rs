//! A reader on a thread of this process, which may panic, hang, or exceed its memory.

use std::cell::RefCell;
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::TempDir;
use time_limit::{GLANCE, Limit, Work};

use crate::fault::Fault;
use crate::format::{Answer, Format, Function, Reader};
use crate::meter;

/// The longest processor time of an answer.
const QUICK: Duration = Duration::from_secs(1);
/// The limit of a wait.
const PATIENCE: Limit = Limit::worked(20);

/// The threads' name.
const READER: &str = "reader";

thread_local! {
    /// The message of this thread's last panic.
    static PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// A watched function that reads files.
pub struct Watch {
    folder: TempDir,
    format: Format,
    function: Function,
    worker: Option<Worker>,
    patience: Limit,
}

struct Worker {
    inputs: Sender<()>,
    answers: Receiver<(Result<Answer, Fault>, Duration)>,
    work: Work,
    exceeded: &'static AtomicBool,
}

impl Watch {
    /// The reader of a format, in its own folder.
    pub fn new(format: Format, function: Function) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        (function.beside)(folder.path());
        Self { folder, format, function, worker: None, patience: PATIENCE }
    }

    /// The same with a shorter limit.
    #[must_use]
    pub fn within(self, patience: Limit) -> Self {
        Self { patience, ..self }
    }

    fn file(&self) -> PathBuf {
        self.folder.path().join(self.format.file)
    }

    fn once(&mut self) -> Result<(Answer, Duration), Fault> {
        let (file, function) = (self.file(), self.function);
        let worker = self.worker.get_or_insert_with(|| Worker::start(file, function));
        worker.inputs.send(()).expect("the worker waits for inputs");
        let (start, before) = (Instant::now(), worker.work.done());
        let limit = Limit {
            processor: self.patience.processor.saturating_add(before.unwrap_or_default()),
            ..self.patience
        };
        let answer = loop {
            match worker.answers.recv_timeout(GLANCE) {
                Ok((answer, took)) => break answer.map(|answer| (answer, took)),
                Err(RecvTimeoutError::Timeout) if worker.exceeded.load(Ordering::Acquire) => {
                    break Err(Fault::Memory(self.function.memory as u64));
                }
                Err(RecvTimeoutError::Timeout) if !limit.is_over(worker.work, start) => {}
                Err(RecvTimeoutError::Timeout) => break Err(Fault::Endless(self.patience)),
                Err(RecvTimeoutError::Disconnected) => {
                    break Err(Fault::Panic("the thread is gone".to_owned()));
                }
            }
        };
        // A hanging thread is abandoned; another one continues with the next input.
        if answer.is_err() {
            self.worker = None;
        }
        answer
    }
}

impl Reader for Watch {
    fn ask(&mut self, input: &[u8]) -> Result<Answer, Fault> {
        std::fs::write(self.file(), input).expect("an input can be written");
        let (answer, worked) = self.once()?;
        if worked > QUICK {
            return Err(Fault::Slow(worked));
        }
        if let Answer::Refused(line) = &answer {
            // Newlines from a file are shown as \n, and so are all control characters of terminals.
            let is_line = !line.trim().is_empty() && !line.contains('\n');
            let names_file = line.contains(&*folder_name(&self.folder));
            if !is_line || !names_file {
                return Err(Fault::Line(line.chars().take(400).collect()));
            }
        }
        Ok(answer)
    }
}

impl Worker {
    fn start(file: PathBuf, function: Function) -> Self {
        static QUIET: Once = Once::new();
        QUIET.call_once(quiet);
        let (inputs, wanted) = channel::<()>();
        let (done, answers) = channel();
        let (tell, told) = channel();
        let exceeded: &'static AtomicBool = Box::leak(Box::new(AtomicBool::new(false)));
        let work = move || {
            let (work, start) = (Work::of_this_thread(), Instant::now());
            tell.send(work).expect("it is waited for");
            let worked = || work.done().unwrap_or(start.elapsed());
            for () in wanted {
                let before = worked();
                meter::allow(function.memory, exceeded);
                let read = catch_unwind(AssertUnwindSafe(|| match (function.read)(&file) {
                    Ok(what) => Answer::Taken(what),
                    Err(error) => Answer::Refused(format!("{error:#}")),
                }));
                meter::allow_all();
                let answer = read.map_err(|_| Fault::Panic(PANIC.take()));
                if done.send((answer, worked() - before)).is_err() {
                    return;
                }
            }
        };
        thread::Builder::new().name(READER.to_owned()).spawn(work).expect("a thread");
        let work = told.recv().expect("a thread that begins");
        Self { inputs, answers, work, exceeded }
    }
}

/// Records a reader's panic with its place, to be printed with the input that caused it. A backtrace would
/// use the memory that the reader may have.
fn quiet() {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if thread::current().name() != Some(READER) {
            return usual(info);
        }
        meter::allow_all();
        let place = info.location().map(ToString::to_string).unwrap_or_default();
        PANIC.set(format!("{place}: {}", info.payload_as_str().unwrap_or("no reason given")));
    }));
}

/// The folder's name, which occurs in every path inside it.
fn folder_name(folder: &TempDir) -> String {
    folder.path().file_name().expect("it has one").to_string_lossy().into_owned()
}
