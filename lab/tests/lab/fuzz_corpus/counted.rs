//! An allocator that counts, thread by thread, how much memory a piece of work holds at once.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    /// Bytes that this thread has allocated and not freed, and the maximum of that. Signed, since a thread may free
    /// what another allocated.
    static COUNTS: Cell<(isize, isize)> = const { Cell::new((0, 0)) };
}

struct Counted;

#[global_allocator]
static COUNTED: Counted = Counted;

fn count(bytes: isize) {
    // When a thread ends, its counts may already be gone.
    let _ = COUNTS.try_with(|counts| {
        let (now, peak) = counts.get();
        counts.set((now + bytes, peak.max(now + bytes)));
    });
}

// SAFETY: everything is delegated to the system's allocator; counting allocates nothing, as the counts need no
// destructor.
unsafe impl GlobalAlloc for Counted {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: the caller's obligations are those of the system's allocator.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // The old and the new block may exist at once.
        count(size as isize);
        count(-(layout.size() as isize));
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

/// The most bytes that `work` holds in memory at once, beyond what was there before.
pub(crate) fn peak(work: impl FnOnce()) -> usize {
    let before = COUNTS.with(|counts| {
        let (now, _) = counts.get();
        counts.set((now, now));
        now
    });
    work();
    COUNTS.with(|counts| counts.get().1 - before).unsigned_abs()
}
