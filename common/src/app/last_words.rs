//! What a program says when it cannot go on: one line, and exit code 1, as with any other error.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::{Write, stderr};
use std::panic::PanicHookInfo;

use super::output;

/// From now on, a panic ends the process in one line. With `RUST_BACKTRACE` set, where it came from follows.
pub fn for_panics() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        output::complain(&line(info));
        if std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0") {
            usual(info);
        }
        std::process::exit(1);
    }));
}

fn line(info: &PanicHookInfo) -> String {
    let said = info.payload_as_str().unwrap_or("no reason given").replace('\n', " ");
    let (file, line) = info.location().map_or(("", 0), |place| (place.file(), place.line()));
    // winit takes its server's answers for granted.
    match ["winit", "x11"].iter().any(|part| file.contains(part)) {
        true => format!("error: the window system failed: {said}"),
        false => format!("error: this is a mistake of the program, at {file}:{line}: {said}"),
    }
}

/// The system's allocator. Where that has nothing left, the process ends in one line.
struct Allocator;

#[global_allocator]
static ALLOCATOR: Allocator = Allocator;

// SAFETY: every call is passed on as it came.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise, here and below.
        given(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, old: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        given(unsafe { System.realloc(old, layout, size) }, size)
    }

    unsafe fn dealloc(&self, old: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(old, layout) }
    }
}

fn given(memory: *mut u8, size: usize) -> *mut u8 {
    if memory.is_null() {
        no_memory(size);
    }
    memory
}

#[cold]
fn no_memory(size: usize) -> ! {
    // Nothing here may allocate: standard error is not buffered, and numbers are written to it as they are made.
    let _ = writeln!(stderr(), "error: no memory left for {size} bytes more");
    std::process::exit(1)
}
