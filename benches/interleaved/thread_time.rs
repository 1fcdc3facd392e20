//! The CPU time of a thread, where the system counts it: other programs do not add to it.

use std::time::Duration;

/// Seconds that `work` takes.
pub(crate) fn seconds(work: impl FnOnce()) -> f64 {
    let started = now();
    work();
    (now() - started).as_secs_f64()
}

fn now() -> Duration {
    #[cfg(unix)]
    if let Ok(time) = nix::time::clock_gettime(nix::time::ClockId::CLOCK_THREAD_CPUTIME_ID) {
        return time.into();
    }
    std::time::UNIX_EPOCH.elapsed().unwrap_or_default()
}
