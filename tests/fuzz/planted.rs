//! Faults planted where few inputs lead, one of each kind. Each must be found.

use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use common::model::Model;
use common::model::obj::load;
use fuzz::fault::{Fault, Found};
use fuzz::format::{Format, Function, Reader};
use fuzz::formats::object::{FORMAT, FUNCTION, read, whole};
use fuzz::formats::{nothing, texture};
use fuzz::program::Program;
use fuzz::session::Session;
use fuzz::watch::Watch;
use time_limit::{Limit, Work};

use crate::SEED;

/// The number of inputs within which a fault must be found: fewer than `cargo test` tries for models.
const BUDGET: usize = 4000;

/// Limit if nothing sleeps: processor time.
const AWAKE: Limit = Limit::worked(3);
/// Limit if the planted fault sleeps: time on the clock. A reader delayed by others has the same fault.
const SLEEPY: Limit = Limit::waited(Duration::from_secs(3));

/// The fault found in a reader of inputs of a format.
#[track_caller]
fn found(format: Format, reader: impl Reader) -> Found {
    let mut session = Session::new("planted", format, reader, SEED);
    let found = session.steps(BUDGET).expect_err("the fault is not found");
    println!("input {}: {}", found.number, found.fault);
    found
}

/// The fault found with this function instead of the reader of models.
#[track_caller]
fn found_in(read: fn(&Path) -> Result<String>) -> Fault {
    found_within(AWAKE, read)
}

#[track_caller]
fn found_within(patience: Limit, read: fn(&Path) -> Result<String>) -> Fault {
    let watch = Watch::new(FORMAT, Function { read, ..FUNCTION });
    found(FORMAT, watch.within(patience)).fault
}

/// Returns whether a model is refused for this reason.
fn refused_for(path: &Path, what: &str) -> bool {
    load(path).is_err_and(|error| error.to_string().contains(what))
}

/// Returns whether a model is accepted with this warning.
fn warned_of(path: &Path, what: &str) -> bool {
    load(path).is_ok_and(|model| model.warnings.join(" ").contains(what))
}

#[test]
fn a_panic_is_found() {
    let fault = found_in(|path| {
        if refused_for(path, "too many parts") {
            panic!("planted")
        }
        read(path)
    });
    assert!(matches!(&fault, Fault::Panic(message) if message.contains("planted")), "{fault}");
}

#[test]
fn an_index_that_leads_nowhere_is_found() {
    let fault = found_in(|path| {
        let mut model: Model = load(path)?;
        if model.meshes.len() > 2 {
            model.meshes[2].triangles[0][1] = u32::MAX;
        }
        whole(&model);
        Ok(String::new())
    });
    assert!(matches!(&fault, Fault::Panic(message) if message.contains("no vertex")), "{fault}");
}

/// Keeps a processor busy.
fn work_for(time: Duration) {
    let (start, work) = (Instant::now(), Work::of_this_thread());
    let done = || work.done().unwrap_or(start.elapsed());
    let end = done() + time;
    while done() < end {}
}

#[test]
fn a_wait_without_an_end_is_found() {
    let fault = found_within(SLEEPY, |path| {
        if warned_of(path, "normal index") {
            loop {
                sleep(Duration::from_secs(3600));
            }
        } else {
            read(path)
        }
    });
    assert!(matches!(fault, Fault::Endless(_)), "{fault}");
}

#[test]
fn work_without_an_end_is_found() {
    let fault = found_in(|path| {
        if warned_of(path, "normal index") {
            work_for(AWAKE.processor * 2);
            // The test is over by then, so nobody waits for this thread.
            sleep(Duration::MAX);
            bail!("an end")
        } else {
            read(path)
        }
    });
    assert_eq!(fault, Fault::Endless(AWAKE));
}

#[test]
fn a_long_time_is_found() {
    let fault = found_in(|path| {
        if refused_for(path, "at least 3") {
            work_for(Duration::from_millis(1200));
        }
        read(path)
    });
    assert!(matches!(fault, Fault::Slow(time) if time.as_millis() >= 1200), "{fault}");
}

#[test]
fn memory_without_a_bound_is_found() {
    let fault = found_in(|path| {
        let mut taken = Vec::new();
        while warned_of(path, "is defined at") || refused_for(path, "divided by its w") {
            taken.push(vec![1u8; 1 << 20]);
        }
        read(path)
    });
    assert_eq!(fault, Fault::Memory(FUNCTION.memory as u64));
}

#[test]
fn memory_for_what_a_header_promises_is_found() {
    // As many texels as the file declares, whatever it contains; they are never touched.
    let read = |path: &Path| {
        let bytes = std::fs::read(path)?;
        let side = |at: usize| {
            bytes.get(at..at + 4).map_or(0, |four| u32::from_be_bytes(four.try_into().unwrap()))
        };
        let texels =
            vec![0u8; 4 * (side(16) as usize).min(1 << 20) * (side(20) as usize).min(1 << 20)];
        Ok(format!("{}", texels.len()))
    };
    let function = Function { beside: nothing, read, memory: texture::FUNCTION.memory };
    let fault = found(texture::FORMAT, Watch::new(texture::FORMAT, function)).fault;
    assert!(matches!(fault, Fault::Memory(_)), "{fault}");
}

#[test]
fn a_message_of_two_lines_is_found() {
    let fault = found_in(|path| {
        if refused_for(path, "not a finite 32-bit number") {
            bail!("{}: first\nsecond", path.display())
        } else {
            read(path)
        }
    });
    assert!(matches!(fault, Fault::Line(_)), "{fault}");
}

#[test]
fn a_message_that_names_no_file_is_found() {
    let fault = found_in(|path| {
        if refused_for(path, "is out of range") {
            bail!("an index is out of range")
        } else {
            read(path)
        }
    });
    assert!(matches!(fault, Fault::Line(_)), "{fault}");
}

#[test]
fn what_is_found_is_kept_and_is_the_same_in_the_next_run() {
    let planted: fn(&Path) -> Result<String> =
        |path| if refused_for(path, "too many parts") { panic!("planted") } else { read(path) };
    let function = Function { read: planted, ..FUNCTION };
    let [first, second] = [(); 2].map(|()| found(FORMAT, Watch::new(FORMAT, function)));
    assert_eq!((first.number, &first.input), (second.number, &second.input));
    let told = first.keep();
    assert!(told.contains("seed 18") && told.contains("again: FUZZ_READER="), "{told}");
    let file = told.split("FUZZ_INPUT=").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    let kept = std::fs::read(run::root().join(file)).unwrap();
    assert_eq!(kept, first.input);
    let again = Watch::new(FORMAT, function).ask(&kept);
    assert_eq!(again.unwrap_err(), first.fault);
}

/// The fault found in a program that does this to a model with a negative index, and refuses all others
/// correctly.
#[cfg(unix)]
#[track_caller]
fn found_in_program(patience: Limit, command: fn(&Path, &[u8]) -> Command) -> Fault {
    let program = Program::new(FORMAT, nothing, command, &["o.png"]);
    found(FORMAT, program.within(patience)).fault
}

#[cfg(unix)]
macro_rules! planted {
    ($patience:ident: $($name:ident, $script:literal: $fault:pat,)*) => {$(
        #[test]
        fn $name() {
            let fault = found_in_program($patience, |_, _| {
                let mut command = Command::new("sh");
                command.args(["-c", concat!(
                    "if grep -q '^f.* -' m.obj; then ", $script, "; fi; echo 'error: m.obj: no' >&2; exit 1"
                )]);
                command
            });
            assert!(matches!(&fault, $fault), "{fault}");
        }
    )*};
}

#[cfg(unix)]
planted! {
    AWAKE:
    a_crash_is_found, "kill -SEGV $$": Fault::Exit(_),
    an_exit_code_of_no_meaning_is_found, "exit 101": Fault::Exit(_),
    a_panic_that_became_a_line_is_found,
        "echo 'error: this is a mistake of the program, at a.rs:1: no' >&2; exit 1": Fault::Panic(_),
    two_lines_of_error_are_found, "echo 'error: m.obj: first' >&2; echo 'second' >&2; exit 1": Fault::Line(_),
    a_failure_without_a_word_is_found, "exit 1": Fault::Line(_),
    a_word_of_a_run_that_succeeds_is_found, "echo 'by the way' >&2; exit 0": Fault::Line(_),
    a_command_for_the_terminal_is_found, "printf 'error: \\033[31m\\n' >&2; exit 1": Fault::Line(_),
    a_file_that_is_left_behind_is_found, ": > .tmpAbCdEf": Fault::Left(_),
    a_file_that_is_left_elsewhere_is_found, ": > $TMPDIR/a": Fault::Left(_),
    a_file_that_is_gone_is_found, "rm m.obj": Fault::Left(_),
    a_program_that_works_for_ever_is_found, "while :; do :; done": Fault::Endless(_),
}

#[cfg(unix)]
planted! {
    SLEEPY:
    a_program_that_sleeps_for_ever_is_found, "exec sleep 1000": Fault::Endless(_),
}

#[cfg(target_os = "linux")]
#[test]
fn a_program_that_takes_all_memory_is_found() {
    // Its input has no line break, so it buffers all of it.
    let command: fn(&Path, &[u8]) -> Command = |_, _| {
        let mut command = Command::new("tail");
        command.arg("/dev/zero");
        command
    };
    let program = Program::new(FORMAT, nothing, command, &[]);
    assert!(matches!(found(FORMAT, program).fault, Fault::Memory(_)));
}
