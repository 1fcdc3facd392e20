//! An allocator in a fixed block of memory, for a program of one thread: it needs no lock, and so no atomics.

use core::alloc::{GlobalAlloc, Layout};
use core::cell::UnsafeCell;
use core::ptr::{self, NonNull};

use linked_list_allocator::Heap;

/// Size in bytes: a frame with a u32 depth buffer and all tables of the engine needs about 10 MB.
#[cfg(target_os = "none")]
const SIZE: usize = 14 << 20;
#[cfg(not(target_os = "none"))]
const SIZE: usize = 64 << 20;

struct OneThread<T>(UnsafeCell<T>);

// SAFETY: the program has one thread.
unsafe impl<T> Sync for OneThread<T> {}

static MEMORY: OneThread<[u8; SIZE]> = OneThread(UnsafeCell::new([0; SIZE]));

/// `None` before the first call.
#[global_allocator]
static HEAP: OneThread<Option<Heap>> = OneThread(UnsafeCell::new(None));

// SAFETY: the blocks are those of a heap in `MEMORY`, which nothing else uses.
unsafe impl GlobalAlloc for OneThread<Option<Heap>> {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: one thread, and the heap is the only one in `MEMORY`.
        let heap = unsafe { (*self.0.get()).get_or_insert_with(|| Heap::new(MEMORY.0.get().cast(), SIZE)) };
        heap.allocate_first_fit(layout).map_or(ptr::null_mut(), NonNull::as_ptr)
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: one thread, and the block was handed out with this layout.
        unsafe {
            if let (Some(heap), Some(place)) = (&mut *self.0.get(), NonNull::new(place)) {
                heap.deallocate(place, layout);
            }
        }
    }
}
