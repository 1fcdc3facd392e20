//! An allocator in a fixed block of memory: a list of free blocks in address order, first fit.

use core::alloc::{GlobalAlloc, Layout};
use core::cell::UnsafeCell;
use core::ptr;

/// Size in bytes: a frame with a u32 depth buffer and all tables of the engine needs about 10 MB.
#[cfg(target_os = "none")]
const SIZE: usize = 14 << 20;
#[cfg(not(target_os = "none"))]
const SIZE: usize = 64 << 20;
/// Every block starts and ends at a multiple of this, which leaves room for the header of a free one.
const GRAIN: usize = 16;

#[repr(align(16))]
struct Memory(UnsafeCell<[u8; SIZE]>);

// SAFETY: the program has one thread.
unsafe impl Sync for Memory {}

static MEMORY: Memory = Memory(UnsafeCell::new([0; SIZE]));

/// Header of a free block, stored in the block.
struct Free {
    size: usize,
    next: *mut Free,
}

/// The first free block; `None` before the first call.
struct Heap(UnsafeCell<Option<*mut Free>>);

// SAFETY: the program has one thread.
unsafe impl Sync for Heap {}

#[global_allocator]
static HEAP: Heap = Heap(UnsafeCell::new(None));

fn grains(layout: Layout) -> usize {
    layout.size().max(1).next_multiple_of(GRAIN)
}

// SAFETY: a block handed out is removed from the list, and lies in `MEMORY`, which nothing else uses.
unsafe impl GlobalAlloc for Heap {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let size = grains(layout);
        // SAFETY: one thread; the list's headers lie in free blocks of `MEMORY`, each of its `size`.
        unsafe {
            let first = (*self.0.get()).get_or_insert_with(|| {
                let first = MEMORY.0.get().cast::<Free>();
                first.write(Free { size: SIZE, next: ptr::null_mut() });
                first
            });
            let mut link: *mut *mut Free = first;
            while !(*link).is_null() {
                let piece = *link;
                let Free { size: room, next } = piece.read();
                let before = piece.cast::<u8>().align_offset(layout.align().max(GRAIN));
                if before.checked_add(size).is_none_or(|end| end > room) {
                    link = &raw mut (*piece).next;
                    continue;
                }
                let place = piece.cast::<u8>().add(before);
                let mut rest = next;
                if before + size < room {
                    rest = place.add(size).cast();
                    rest.write(Free { size: room - before - size, next });
                }
                if before > 0 {
                    piece.write(Free { size: before, next: rest });
                } else {
                    *link = rest;
                }
                return place;
            }
        }
        ptr::null_mut()
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        let size = grains(layout);
        let piece: *mut Free = place.cast();
        // SAFETY: one thread; the block was handed out with this layout, so it is on no list.
        unsafe {
            let Some(first) = &mut *self.0.get() else { return };
            let (mut before, mut after) = (ptr::null_mut::<Free>(), *first);
            while !after.is_null() && after < piece {
                (before, after) = (after, (*after).next);
            }
            piece.write(Free { size, next: after });
            join(piece);
            if before.is_null() {
                *first = piece;
            } else {
                (*before).next = piece;
                join(before);
            }
        }
    }
}

/// Merges a free block with the next, if they touch.
unsafe fn join(piece: *mut Free) {
    // SAFETY: the caller has a free block, whose `next` is one or null.
    unsafe {
        let next = (*piece).next;
        if !next.is_null() && piece.cast::<u8>().add((*piece).size) == next.cast() {
            (*piece).size += (*next).size;
            (*piece).next = (*next).next;
        }
    }
}
