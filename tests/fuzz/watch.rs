//! A reader in this process: on a thread of its own, which may panic, hang, or ask for more memory than it gets.

use std::cell::RefCell;
use std::panic::{self, AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use tempfile::TempDir;

use crate::fault::Fault;
use crate::format::{Answer, Format, Function, Reader};
use crate::meter;

/// An answer is to come within this time, the quickest of three times: another program may have the machine.
const QUICK: Duration = Duration::from_secs(1);
/// After this time nobody waits any longer.
const PATIENCE: Duration = Duration::from_secs(20);

/// The threads' name.
const READER: &str = "reader";

thread_local! {
    /// What the last panic of this thread said.
    static PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// A function that reads files, watched.
pub struct Watch {
    folder: TempDir,
    format: Format,
    function: Function,
    worker: Option<Worker>,
    patience: Duration,
}

struct Worker {
    inputs: Sender<()>,
    answers: Receiver<(Result<Answer, Fault>, Duration)>,
    exceeded: &'static AtomicBool,
}

impl Watch {
    /// The reader of a format, in a folder of its own.
    pub fn new(format: Format, function: Function) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        (function.beside)(folder.path());
        Self { folder, format, function, worker: None, patience: PATIENCE }
    }

    /// The same, with less patience.
    #[must_use]
    pub fn within(self, patience: Duration) -> Self {
        Self { patience, ..self }
    }

    fn file(&self) -> PathBuf {
        self.folder.path().join(self.format.file)
    }

    fn once(&mut self) -> Result<(Answer, Duration), Fault> {
        let (file, function) = (self.file(), self.function);
        let worker = self.worker.get_or_insert_with(|| Worker::start(file, function));
        worker.inputs.send(()).expect("the worker waits for inputs");
        let start = Instant::now();
        let answer = loop {
            match worker.answers.recv_timeout(Duration::from_millis(20)) {
                Ok((answer, took)) => break answer.map(|answer| (answer, took)),
                Err(RecvTimeoutError::Timeout) if worker.exceeded.load(Ordering::Acquire) => {
                    break Err(Fault::Memory(self.function.memory as u64));
                }
                Err(RecvTimeoutError::Timeout) if start.elapsed() < self.patience => {}
                Err(RecvTimeoutError::Timeout) => break Err(Fault::Endless(self.patience)),
                Err(RecvTimeoutError::Disconnected) => {
                    break Err(Fault::Panic("the thread is gone".to_owned()));
                }
            }
        };
        // Who hangs, hangs on; another goes on with the next input.
        if answer.is_err() {
            self.worker = None;
        }
        answer
    }
}

impl Reader for Watch {
    fn ask(&mut self, input: &[u8]) -> Result<Answer, Fault> {
        std::fs::write(self.file(), input).expect("an input can be written");
        let (answer, mut quickest) = self.once()?;
        for _ in 0..2 {
            if quickest > QUICK {
                quickest = quickest.min(self.once()?.1);
            }
        }
        if quickest > QUICK {
            return Err(Fault::Slow(quickest));
        }
        if let Answer::Refused(line) = &answer {
            // Newlines that a file holds are shown as \n, as is all that a terminal would act on.
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
        let exceeded: &'static AtomicBool = Box::leak(Box::new(AtomicBool::new(false)));
        let work = move || {
            for () in wanted {
                let start = Instant::now();
                meter::allow(function.memory, exceeded);
                let read = catch_unwind(AssertUnwindSafe(|| match (function.read)(&file) {
                    Ok(what) => Answer::Taken(what),
                    Err(error) => Answer::Refused(format!("{error:#}")),
                }));
                meter::allow_all();
                let answer = read.map_err(|_| Fault::Panic(PANIC.take()));
                if done.send((answer, start.elapsed())).is_err() {
                    return;
                }
            }
        };
        thread::Builder::new().name(READER.to_owned()).spawn(work).expect("a thread");
        Self { inputs, answers, exceeded }
    }
}

/// A panic of a reader is noted, with its place, and printed with the input that brought it about. A backtrace
/// would be made from the memory that the reader may have.
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

/// The folder's name, which is part of every path in it.
fn folder_name(folder: &TempDir) -> String {
    folder.path().file_name().expect("it has one").to_string_lossy().into_owned()
}
