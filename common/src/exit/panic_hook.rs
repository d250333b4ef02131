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
    use std::sync::atomic::Ordering;
    use std::time::Duration;

    use libc::{SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, SIGXFSZ, c_int};

    use super::{SAID, is_traced};

    /// From now on, a crash of the driver or of the shader compiler ends the process with one line, and so does a
    /// file that exceeds the system's size limit. With `RUST_BACKTRACE` set, crashes are left to the system, which
    /// may keep a core dump for a debugger.
    pub fn for_crashes() {
        // SAFETY: the handlers below call only what a signal's handler may, and none of them returns. To ignore
        // a signal asks for nothing.
        unsafe {
            // Then the write fails, and the half-written file is removed.
            libc::signal(SIGXFSZ, libc::SIG_IGN);
            if is_traced() {
                return;
            }
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
        ($what:literal, $signal:literal) => {
            concat!(
                "error: the driver or the shader compiler ",
                $what,
                " (",
                $signal,
                "): memory may be short, or --validate may say why\n"
            )
        };
    }

    extern "C" fn crashed(signal: c_int) {
        end(match signal {
            SIGSEGV => crash!("crashed", "SIGSEGV"),
            SIGBUS => crash!("crashed", "SIGBUS"),
            SIGILL => crash!("crashed", "SIGILL"),
            SIGFPE => crash!("crashed", "SIGFPE"),
            // Rust does so if it gets no memory, and has already reported the size.
            _ => {
                "error: no memory left, or the driver or the shader compiler gave up (SIGABRT): --validate may say \
                 why\n"
            }
        })
    }

    /// Prints the reason, and ends the process at once: no lock, no allocation, no destructor.
    fn end(line: &str) -> ! {
        let said = SAID.swap(true, Ordering::Relaxed);
        // SAFETY: a signal's handler may call these three; the line is as long as it says.
        unsafe {
            if said {
                // Another thread may be about to end the process.
                std::thread::sleep(Duration::from_millis(200));
            } else {
                libc::write(2, line.as_ptr().cast(), line.len());
            }
            libc::_exit(1)
        }
    }
}
