//! Pool of renderers, as many as work at a time. Each keeps what it has made, tables and memory, for the next frame.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Artists, and how another is made when all are at work.
pub(crate) struct RendererPool<Artist, Make> {
    make: Make,
    idle: Mutex<Vec<Artist>>,
}

impl<Artist, Make: Fn() -> Artist> RendererPool<Artist, Make> {
    pub(crate) fn new(make: Make) -> Self {
        Self { make, idle: Mutex::default() }
    }

    /// Lets one that is idle work.
    pub(crate) fn work<Done>(&self, work: impl FnOnce(&mut Artist) -> Done) -> Done {
        let idle = self.idle().pop();
        let mut artist = idle.unwrap_or_else(&self.make);
        let done = work(&mut artist);
        self.idle().push(artist);
        done
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Artist>> {
        // Of artists none is half there: the list is sound even after a panic.
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
