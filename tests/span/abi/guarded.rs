//! An allocator that can give every array its own pages, with nothing readable or writable beside them.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::ffi::{c_int, c_long, c_void};
use std::ptr;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

const PAGE: usize = 4096;
/// Addresses, most of which are never backed by memory.
const ARENA: usize = 1 << 36;

unsafe extern "C" {
    fn mmap(address: *mut c_void, size: usize, access: c_int, kind: c_int, file: c_int, offset: c_long) -> *mut c_void;
    fn mprotect(address: *mut c_void, size: usize, access: c_int) -> c_int;
    fn madvise(address: *mut c_void, size: usize, advice: c_int) -> c_int;
}

const NONE: c_int = 0;
const READ_WRITE: c_int = 3;
// On Linux: private, anonymous, no memory reserved.
const KIND: c_int = 0x4022;
const DONT_NEED: c_int = 4;

/// Which end of an array lies at the end of its pages.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Side {
    /// A page that must not be touched follows the last byte, as closely as the alignment allows.
    Behind,
    /// One precedes the first byte.
    Before,
}

thread_local! {
    static GUARDED: Cell<Option<Side>> = const { Cell::new(None) };
}

/// Runs `action` with every array that it allocates guarded on this side.
pub(crate) fn guarded<T>(side: Side, action: impl FnOnce() -> T) -> T {
    GUARDED.set(Some(side));
    let result = action();
    GUARDED.set(None);
    result
}

/// How many arrays have been guarded.
pub(crate) fn arrays() -> usize {
    ARRAYS.load(Ordering::Relaxed)
}

static ARRAYS: AtomicUsize = AtomicUsize::new(0);
/// Bytes of the arena already used. None is reused, so freed memory stays out of bounds.
static USED: AtomicUsize = AtomicUsize::new(PAGE);
static START: OnceLock<usize> = OnceLock::new();

fn arena() -> usize {
    *START.get_or_init(|| {
        // SAFETY: new pages, none of them readable or writable.
        let mapped = unsafe { mmap(ptr::null_mut(), ARENA, NONE, KIND, -1, 0) };
        assert_ne!(mapped.addr(), usize::MAX, "mmap failed");
        mapped.expose_provenance()
    })
}

fn pages(size: usize) -> usize {
    size.next_multiple_of(PAGE)
}

struct Guarding;

#[global_allocator]
static ALLOCATOR: Guarding = Guarding;

// SAFETY: blocks handed out lie in pages that are handed out once, are writable, and stay so until freed; everything
// else is the system's.
unsafe impl GlobalAlloc for Guarding {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let side = GUARDED.try_with(Cell::get).ok().flatten();
        let Some(side) = side.filter(|_| layout.align() <= PAGE && layout.size() > 0) else {
            // SAFETY: the caller's promise.
            return unsafe { System.alloc(layout) };
        };
        let size = pages(layout.size());
        // An unused page after each.
        let offset = USED.fetch_add(size + PAGE, Ordering::Relaxed);
        if offset + size + PAGE > ARENA {
            return ptr::null_mut();
        }
        let start: *mut u8 = ptr::with_exposed_provenance_mut(arena() + offset);
        // SAFETY: pages of the arena that are not in use.
        if unsafe { mprotect(start.cast(), size, READ_WRITE) } != 0 {
            return ptr::null_mut();
        }
        ARRAYS.fetch_add(1, Ordering::Relaxed);
        let before = match side {
            Side::Before => 0,
            Side::Behind => (size - layout.size()) / layout.align() * layout.align(),
        };
        // SAFETY: at most `size − layout.size()` bytes on.
        unsafe { start.add(before) }
    }

    unsafe fn dealloc(&self, array: *mut u8, layout: Layout) {
        let Some(offset) = START.get().and_then(|start| array.addr().checked_sub(*start)).filter(|at| *at < ARENA)
        else {
            // SAFETY: the caller's promise; it does not lie in the arena.
            return unsafe { System.dealloc(array, layout) };
        };
        let (size, before) = (pages(layout.size()), offset % PAGE);
        // SAFETY: the pages that `alloc` gave it, as it begins in the first of them.
        unsafe {
            let start: *mut c_void = array.sub(before).cast();
            madvise(start, size, DONT_NEED);
            mprotect(start, size, NONE);
        }
    }
}
