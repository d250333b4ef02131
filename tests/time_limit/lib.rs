//! The work of a process or thread, and its limit.
//!
//! On a busy machine, a clock says little about a program, because others may have had the processors. So
//! limits are in processor time. A clock only ends programs that sleep.

use std::fmt::{Display, Formatter};
use std::process::Child;
use std::thread;
use std::time::{Duration, Instant};

/// The interval at which the work is checked.
pub const GLANCE: Duration = Duration::from_millis(10);

/// The time on the clock after which a sleeping program is ended: far longer than anything takes, whatever
/// else the machine does.
pub const ASLEEP: Duration = Duration::from_secs(1800);

/// A limit of a process or thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limit {
    /// The limit of processor time.
    pub processor: Duration,
    /// The limit on the clock.
    pub clock: Duration,
}

impl Limit {
    /// No limit.
    pub const NONE: Self = Self { processor: Duration::MAX, clock: Duration::MAX };

    /// A limit in seconds of processor time, whatever else the machine does.
    pub const fn worked(seconds: u64) -> Self {
        Self { processor: Duration::from_secs(seconds), clock: ASLEEP }
    }

    /// A limit on the clock, for a program that also waits.
    pub const fn waited(clock: Duration) -> Self {
        Self { processor: Duration::MAX, clock }
    }

    /// Returns whether work that began at `start` exceeds the limit. If the system does not report the work,
    /// the clock decides.
    pub fn is_over(self, work: Work, start: Instant) -> bool {
        let waited = start.elapsed();
        waited > self.clock || work.done().unwrap_or(waited) > self.processor
    }
}

impl Display for Limit {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self.processor {
            Duration::MAX => write!(f, "{} s", self.clock.as_secs()),
            time => write!(f, "{} s of processors", time.as_secs()),
        }
    }
}

/// The work of a process or of a thread: its processor time.
#[derive(Clone, Copy, Debug)]
pub struct Work(#[cfg(target_os = "linux")] Option<libc::clockid_t>);

#[cfg(target_os = "linux")]
impl Work {
    /// The work of a process, by its number, with all its threads.
    pub fn of_process(id: u32) -> Self {
        let mut clock = 0;
        // SAFETY: the call writes to the given place, and fails for a process that does not exist.
        let told = unsafe { libc::clock_getcpuclockid(id as i32, &mut clock) } == 0;
        Self(told.then_some(clock))
    }

    /// The work of the calling thread.
    pub fn of_this_thread() -> Self {
        let mut clock = 0;
        // SAFETY: the thread exists, and the call writes to the given place.
        let told = unsafe { libc::pthread_getcpuclockid(libc::pthread_self(), &mut clock) } == 0;
        Self(told.then_some(clock))
    }

    /// The processor time; `None` if it is not reported, as for a process that has ended.
    pub fn done(self) -> Option<Duration> {
        let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
        // SAFETY: the call writes to the given place, and fails for a clock that does not exist.
        let told = unsafe { libc::clock_gettime(self.0?, &mut time) } == 0;
        told.then(|| Duration::new(time.tv_sec as u64, time.tv_nsec as u32))
    }
}

impl From<&Child> for Work {
    fn from(child: &Child) -> Self {
        Self::of_process(child.id())
    }
}

#[cfg(not(target_os = "linux"))]
impl Work {
    /// The work of a process, by its number, with all its threads.
    pub fn of_process(_: u32) -> Self {
        Self()
    }

    /// The work of the calling thread.
    pub fn of_this_thread() -> Self {
        Self()
    }

    /// Not reported.
    pub fn done(self) -> Option<Duration> {
        None
    }
}

/// Waits until a child has worked this long, by the clock if work is not reported, or has ended.
///
/// # Panics
/// If the system does not report whether the child runs.
pub fn wait_until_worked(child: &mut Child, time: Duration) {
    let start = Instant::now();
    while child.try_wait().expect("a child can be asked for").is_none()
        && Work::from(&*child).done().unwrap_or(start.elapsed()) < time
    {
        thread::sleep(GLANCE);
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::process::Command;

    use super::*;

    /// The time until a script was found to exceed the limit, and its work.
    fn over(limit: Limit, script: &str) -> (Duration, Duration) {
        let mut child = Command::new("sh").args(["-c", script]).spawn().expect("a shell");
        let (start, work) = (Instant::now(), Work::from(&child));
        while !limit.is_over(work, start) {
            thread::sleep(GLANCE);
        }
        let found = (start.elapsed(), work.done().expect("it runs"));
        child.kill().expect("it runs");
        child.wait().expect("it ends");
        found
    }

    #[test]
    fn who_works_is_ended_by_work_and_who_sleeps_by_the_clock() {
        let limit = Limit { processor: Duration::from_millis(200), clock: ASLEEP };
        let (_, worked) = over(limit, "while :; do :; done");
        assert!(worked > limit.processor, "{worked:?}");
        let short = Duration::from_millis(50);
        let (waited, worked) = over(Limit::waited(short), "exec sleep 600");
        assert!(waited > short && worked < short, "{waited:?}, {worked:?}");
        assert_eq!(Limit::worked(5).to_string(), "5 s of processors");
        assert_eq!(Limit::waited(Duration::from_secs(7)).to_string(), "7 s");
    }

    #[test]
    fn a_thread_s_work_is_its_own_and_ends_with_it() {
        let (before, start) = (Work::of_this_thread().done().unwrap(), Instant::now());
        let other = thread::spawn(|| {
            let work = Work::of_this_thread();
            while work.done().unwrap() < Duration::from_millis(100) {}
            work
        });
        let other = other.join().unwrap();
        // The system wakes a joining thread a moment before it removes the joined one.
        while other.done().is_some() {
            assert!(start.elapsed() < ASLEEP);
            thread::yield_now();
        }
        assert!(start.elapsed() >= Duration::from_millis(100));
        let own = Work::of_this_thread().done().unwrap() - before;
        assert!(own < Duration::from_millis(100), "{own:?}");
    }
}
