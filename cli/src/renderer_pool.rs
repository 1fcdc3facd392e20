//! A pool of renderers, one for each thread at work. Each keeps its tables and memory for the next frame.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// Idle artists, and how another is made when all are busy.
pub(crate) struct RendererPool<Artist, Make> {
    make: Make,
    idle: Mutex<Vec<Artist>>,
}

impl<Artist, Make: Fn() -> Artist> RendererPool<Artist, Make> {
    pub(crate) fn new(make: Make) -> Self {
        Self { make, idle: Mutex::default() }
    }

    /// Has an idle artist do the work, or a new one if all are busy.
    pub(crate) fn work<Done>(&self, work: impl FnOnce(&mut Artist) -> Done) -> Done {
        let idle = self.idle().pop();
        let mut artist = idle.unwrap_or_else(&self.make);
        let done = work(&mut artist);
        self.idle().push(artist);
        done
    }

    fn idle(&self) -> MutexGuard<'_, Vec<Artist>> {
        // No artist is ever half in the list, so it is intact even after a panic.
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
