//! The limit on open files of a process. If it is too low, driver, window and files each fail with an error of
//! their own, and none names the reason.

use anyhow::Result;

/// Enough for everything a program opens.
#[cfg(unix)]
const ENOUGH: libc::rlim_t = 64;

/// Checks that the system allows enough.
///
/// # Errors
/// If it does not.
#[cfg(unix)]
pub fn check() -> Result<()> {
    let mut limit = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
    // SAFETY: the structure is there to be written.
    let is_known = unsafe { libc::getrlimit(libc::RLIMIT_NOFILE, &raw mut limit) } == 0;
    let files = limit.rlim_cur;
    anyhow::ensure!(
        !is_known || files >= ENOUGH,
        "the system lets this process have {files} files open at once; {ENOUGH} are enough: ulimit -n {ENOUGH}"
    );
    Ok(())
}

/// Other systems have no such limit.
#[cfg(not(unix))]
pub fn check() -> Result<()> {
    Ok(())
}
