//! The message of a program that cannot go on: one line, and exit code 1, as with any other error.

use std::panic::PanicHookInfo;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::output;

/// True if the reason for the end was reported. A crash during the shutdown after it adds nothing.
static SAID: AtomicBool = AtomicBool::new(false);

/// Prints the reason for the end of the process.
pub fn say(line: &str) {
    SAID.store(true, Ordering::Relaxed);
    output::complain(line);
}

/// From now on, a panic ends the process with one line. With `RUST_BACKTRACE` set, a backtrace follows.
pub fn for_panics() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        say(&line(info));
        if is_traced() {
            usual(info);
        }
        std::process::exit(1);
    }));
}

fn is_traced() -> bool {
    std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0")
}

fn line(info: &PanicHookInfo) -> String {
    let said = info.payload_as_str().unwrap_or("no reason given").replace('\n', " ");
    let (file, line) = info.location().map_or(("", 0), |place| (place.file(), place.line()));
    // winit panics when its display server fails.
    if ["winit", "x11"].iter().any(|part| file.contains(part)) {
        format!("error: the window system failed: {said}")
    } else {
        format!("error: this is a mistake of the program, at {file}:{line}: {said}")
    }
}

/// Other systems report crashes themselves.
#[cfg(not(target_os = "linux"))]
pub fn for_crashes() {}

#[cfg(target_os = "linux")]
pub use crashes::for_crashes;

/// Crashes of C and C++ code, from lack of memory or bugs: the driver and the shader compiler.
#[cfg(target_os = "linux")]
mod crashes {
    use std::mem::MaybeUninit;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::time::Duration;

    use libc::{SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, SIGXFSZ, c_int};

    use super::{SAID, is_traced};
    use crate::gpu::is_at_work;

    /// True if the system handles a crash after its line. A signal handler must not read the environment.
    static IS_TRACED: AtomicBool = AtomicBool::new(false);

    /// From now on, a crash of the driver or of the shader compiler ends the process with one line, and so does a
    /// file that exceeds the system's size limit. With `RUST_BACKTRACE` set, the system handles the crash after
    /// that line, and may keep a core dump for a debugger.
    pub fn for_crashes() {
        IS_TRACED.store(is_traced(), Ordering::Relaxed);
        // SAFETY: the handlers below call only what a signal's handler may. To ignore a signal asks for nothing.
        unsafe {
            // Then the write fails, and the half-written file is removed.
            libc::signal(SIGXFSZ, libc::SIG_IGN);
            let mut action = MaybeUninit::<libc::sigaction>::zeroed().assume_init();
            action.sa_sigaction = crashed as *const () as usize;
            // Rust gives its threads a second stack, needed if the first has overflowed.
            action.sa_flags = libc::SA_ONSTACK;
            for signal in [SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT] {
                libc::sigaction(signal, &action, std::ptr::null_mut());
            }
        }
    }

    /// Messages cannot be formatted in a signal handler.
    macro_rules! crash {
        ($signal:literal) => {
            crash!($signal, "", "memory may be short, or --validate may say why")
        };
        ($signal:literal at work) => {
            crash!(
                $signal,
                " while the device worked",
                "most likely a shader read beyond an array behind an address, by a custom index, a material or \
                 a triangle that is too large; or memory is short, or --validate says why"
            )
        };
        ($signal:literal, $when:literal, $why:literal) => {
            concat!(
                "error: the driver or the shader compiler crashed (",
                $signal,
                ")",
                $when,
                ": ",
                $why,
                "\n"
            )
        };
    }

    extern "C" fn crashed(signal: c_int) {
        end(
            signal,
            match signal {
                SIGSEGV if is_at_work() => crash!("SIGSEGV" at work),
                SIGBUS if is_at_work() => crash!("SIGBUS" at work),
                SIGSEGV => crash!("SIGSEGV"),
                SIGBUS => crash!("SIGBUS"),
                SIGILL => crash!("SIGILL"),
                SIGFPE => crash!("SIGFPE"),
                // Rust does so if it gets no memory, and has already reported the size.
                _ => {
                    "error: no memory left, or the driver or the shader compiler gave up (SIGABRT): --validate may say \
                 why\n"
                }
            },
        )
    }

    /// Prints the reason, and ends the process at once: no lock, no allocation, no destructor.
    fn end(signal: c_int, line: &str) {
        let said = SAID.swap(true, Ordering::Relaxed);
        // SAFETY: a signal's handler may call all of these; the line is as long as it says.
        unsafe {
            if said {
                // Another thread may be about to end the process.
                std::thread::sleep(Duration::from_millis(200));
            } else {
                libc::write(2, line.as_ptr().cast(), line.len());
            }
            if IS_TRACED.load(Ordering::Relaxed) {
                // Delivered when this handler returns: the system finds the place of the crash as it was.
                libc::signal(signal, libc::SIG_DFL);
                libc::raise(signal);
                return;
            }
            libc::_exit(1)
        }
    }
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    /// The end of a child of [`a_panic_ends_in_a_line`].
    #[test]
    #[ignore = "run by a_panic_ends_in_a_line"]
    fn a_panic() {
        let numbers = [1, 2, 3];
        crate::exit::finish(|| {
            Err(anyhow::anyhow!("{}", numbers[std::process::id() as usize + 3]))
        });
    }

    #[test]
    fn a_panic_ends_in_a_line() {
        for traced in ["0", "1"] {
            let mut child = Command::new(std::env::current_exe().unwrap());
            let test = "exit::panic_hook::tests::a_panic";
            child.args([test, "--exact", "--ignored", "--nocapture"]);
            let output = child.env("RUST_BACKTRACE", traced).output().unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            assert_eq!(output.status.code(), Some(1), "{said}");
            let line = said.lines().next().unwrap_or_default();
            assert!(
                line.starts_with("error: this is a mistake of the program, at ")
                    && line.contains("panic_hook.rs:")
                    && line.contains("index out of bounds: the len is 3 but the index is "),
                "{said}"
            );
            assert!(traced == "1" || said.lines().count() == 1, "{said}");
        }
    }
}
