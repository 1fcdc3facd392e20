//! An allocator in the caller's memory and a panic handler, which a C library needs and an `rlib` does not.

#[cfg(feature = "effects")]
pub(crate) use arena::within;

#[cfg(feature = "effects")]
mod arena {
    use core::alloc::{GlobalAlloc, Layout};
    use core::sync::atomic::{AtomicUsize, Ordering};

    /// Hands out the memory of the context that is being made, and takes nothing back. At any other time it has no
    /// memory to give, as the stages already have all they need.
    struct Arena {
        /// The first free address and the end; 0 while no context is made.
        next: AtomicUsize,
        end: AtomicUsize,
    }

    #[global_allocator]
    static ARENA: Arena = Arena { next: AtomicUsize::new(0), end: AtomicUsize::new(0) };

    /// Only one thread at a time makes a context. A processor without an atomic exchange has no threads.
    #[cfg(target_has_atomic = "8")]
    static IS_TAKEN: core::sync::atomic::AtomicBool = core::sync::atomic::AtomicBool::new(false);

    /// Runs `make` with this memory to allocate from.
    pub(crate) fn within(memory: *mut u8, bytes: usize, make: impl FnOnce()) {
        #[cfg(target_has_atomic = "8")]
        while IS_TAKEN.swap(true, Ordering::Acquire) {
            core::hint::spin_loop();
        }
        let start = memory.expose_provenance();
        ARENA.next.store(start, Ordering::Relaxed);
        ARENA.end.store(start + bytes, Ordering::Relaxed);
        make();
        ARENA.next.store(0, Ordering::Relaxed);
        ARENA.end.store(0, Ordering::Relaxed);
        #[cfg(target_has_atomic = "8")]
        IS_TAKEN.store(false, Ordering::Release);
    }

    // SAFETY: each block is inside the memory, aligned, and handed out once.
    unsafe impl GlobalAlloc for Arena {
        unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
            let next = self.next.load(Ordering::Relaxed);
            let first = next.checked_next_multiple_of(layout.align());
            if next > 0
                && let Some(first) = first
                && let Some(end) = first.checked_add(layout.size())
                && end <= self.end.load(Ordering::Relaxed)
            {
                self.next.store(end, Ordering::Relaxed);
                return core::ptr::with_exposed_provenance_mut(first);
            }
            #[cfg(feature = "std")]
            // SAFETY: by the caller.
            return unsafe { std::alloc::System.alloc(layout) };
            #[cfg(not(feature = "std"))]
            core::ptr::null_mut()
        }

        /// Does nothing, as the stages free nothing.
        unsafe fn dealloc(&self, _: *mut u8, _: Layout) {}
    }
}

/// Nothing panics, because all arguments are checked. If something did, the program would end here.
#[cfg(not(feature = "std"))]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    // SAFETY: an invalid instruction, which ends the program.
    unsafe {
        core::arch::asm!("ud2", options(noreturn, nomem, nostack));
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    loop {
        core::hint::spin_loop();
    }
}
