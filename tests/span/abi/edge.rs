//! A row between two pages that must not be touched.

use std::ffi::{c_int, c_long, c_void};

/// A multiple of the page size of every x86 system.
pub(crate) const SIZE: usize = 65_536;

unsafe extern "C" {
    fn mmap(address: *mut c_void, size: usize, access: c_int, kind: c_int, file: c_int, offset: c_long) -> *mut c_void;
    fn mprotect(address: *mut c_void, size: usize, access: c_int) -> c_int;
    fn munmap(address: *mut c_void, size: usize) -> c_int;
}

/// `SIZE` zero bytes with nothing readable or writable on either side.
pub(crate) struct Edge {
    mapped: *mut c_void,
}

impl Edge {
    pub(crate) fn new() -> Self {
        const NONE: c_int = 0;
        const READ_WRITE: c_int = 3;
        const PRIVATE_ANONYMOUS: c_int = 0x22; // on Linux
        // SAFETY: new pages, of which the middle ones become ours to write.
        let mapped = unsafe { mmap(std::ptr::null_mut(), 3 * SIZE, NONE, PRIVATE_ANONYMOUS, -1, 0) };
        assert_ne!(mapped.addr(), usize::MAX, "mmap failed");
        // SAFETY: within what was mapped.
        assert_eq!(unsafe { mprotect(mapped.byte_add(SIZE), SIZE, READ_WRITE) }, 0, "mprotect failed");
        Self { mapped }
    }

    pub(crate) fn bytes(&mut self) -> &mut [u8] {
        // SAFETY: the middle third is writable, zeroed, and borrowed with `self`.
        unsafe { std::slice::from_raw_parts_mut(self.mapped.byte_add(SIZE).cast(), SIZE) }
    }
}

impl Drop for Edge {
    fn drop(&mut self) {
        // SAFETY: mapped by `new`, and no slice of it is left.
        unsafe { munmap(self.mapped, 3 * SIZE) };
    }
}
