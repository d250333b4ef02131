//! The C library's allocator, counted: Rust's own is the book's, and C and C++ have none of Rust's.
//!
//! An executable's functions come before those of the libraries that it loads.

use std::ffi::{c_int, c_void};

use fuzz::meter::count;

unsafe extern "C" {
    fn __libc_malloc(size: usize) -> *mut c_void;
    fn __libc_calloc(count: usize, size: usize) -> *mut c_void;
    fn __libc_realloc(old: *mut c_void, size: usize) -> *mut c_void;
    fn __libc_memalign(alignment: usize, size: usize) -> *mut c_void;
    fn __libc_free(memory: *mut c_void);
    fn malloc_usable_size(memory: *mut c_void) -> usize;
}

// SAFETY, of all: arguments and results are passed on as they are; counting allocates nothing, does not unwind,
// and comes before the memory is taken, so that who may have no more takes none.

#[unsafe(no_mangle)]
unsafe extern "C" fn malloc(size: usize) -> *mut c_void {
    count(size as isize);
    // SAFETY: as above.
    unsafe { counted(size, __libc_malloc(size)) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn calloc(number: usize, size: usize) -> *mut c_void {
    let bytes = number.saturating_mul(size);
    count(bytes as isize);
    // SAFETY: as above.
    unsafe { counted(bytes, __libc_calloc(number, size)) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn realloc(old: *mut c_void, size: usize) -> *mut c_void {
    // SAFETY: as above.
    let before = if old.is_null() { 0 } else { unsafe { malloc_usable_size(old) } };
    count(size as isize - before as isize);
    // SAFETY: as above.
    unsafe { counted(size, __libc_realloc(old, size)) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn posix_memalign(to: *mut *mut c_void, alignment: usize, size: usize) -> c_int {
    const ENOMEM: c_int = 12;
    count(size as isize);
    // SAFETY: as above; `to` is where the caller wants it.
    unsafe {
        *to = counted(size, __libc_memalign(alignment, size));
        if (*to).is_null() { ENOMEM } else { 0 }
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn free(memory: *mut c_void) {
    if !memory.is_null() {
        // SAFETY: as above.
        count(-(unsafe { malloc_usable_size(memory) } as isize));
    }
    // SAFETY: as above.
    unsafe { __libc_free(memory) }
}

/// Puts the count of `asked` bytes right, by what was given.
unsafe fn counted(asked: usize, memory: *mut c_void) -> *mut c_void {
    // SAFETY: it is what the allocator gave.
    let given = if memory.is_null() { 0 } else { unsafe { malloc_usable_size(memory) } };
    count(given as isize - asked as isize);
    memory
}
