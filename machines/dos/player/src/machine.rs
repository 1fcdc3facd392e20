//! The PC: ports, video memory, and DOS and the BIOS through the stub's service.

use core::alloc::{GlobalAlloc, Layout};
use core::arch::asm;
use core::cell::UnsafeCell;
use core::{ptr, slice};

/// The stub's table, which begins at its `film`.
#[repr(C)]
pub(crate) struct Parameters {
    film: *const u8,
    film_length: usize,
    stack_top: u32,
    heap_kb: usize,
    heap: *mut u8,
    /// Linear address 0.
    low: *mut u8,
    command: *const u8,
    service: extern "C" fn(),
    eax: u32,
    ebx: u32,
    ecx: u32,
    edx: u32,
    ds: u32,
    number: u32,
    flags: u32,
    segment: u32,
    buffer: [u8; 1024],
}

/// Offset of `buffer` in the stub's segment.
const BUFFER: u32 = 4 + 64;

/// The machine that the program runs on.
pub(crate) struct Machine {
    parameters: *mut Parameters,
}

impl Machine {
    /// The video mode of this program.
    pub(crate) const MODE_13H: u8 = 0x13;
    /// The video mode of DOS.
    pub(crate) const TEXT: u8 = 0x03;

    /// The machine, the film and the command-line arguments.
    ///
    /// # Safety
    /// The table is the stub's, and this is called once.
    pub(crate) unsafe fn new<'a>(parameters: *mut Parameters) -> (Self, &'a [u8], &'a [u8]) {
        // SAFETY: the stub's table names memory that nothing else uses.
        unsafe {
            let Parameters { film, film_length, heap, heap_kb, command, .. } = *parameters;
            HEAP.0.get().write((heap as usize, heap as usize + heap_kb * 1024));
            let words = slice::from_raw_parts(command.add(1), usize::from(*command));
            *PARAMETERS.0.get() = parameters;
            (Self { parameters }, slice::from_raw_parts(film, film_length), words)
        }
    }

    /// An interrupt of DOS or the BIOS with AX, BX, CX, DX and DS; returns AX, and whether the carry flag is clear.
    fn interrupt(&mut self, number: u32, [ax, bx, cx, dx]: [u32; 4], ds: Option<u32>) -> (u32, bool, bool) {
        // SAFETY: the table is the stub's; its service accesses only the table, and what the
        // interrupts below access.
        unsafe {
            let p = self.parameters;
            (*p).number = number;
            ((*p).eax, (*p).ebx, (*p).ecx, (*p).edx) = (ax, bx, cx, dx);
            (*p).ds = ds.unwrap_or((*p).segment);
            let service = (*p).service;
            asm!("call {}", in(reg) service, clobber_abi("C"));
            let flags = ptr::read_volatile(&raw const (*p).flags);
            (ptr::read_volatile(&raw const (*p).eax) & 0xFFFF, flags & 1 == 0, flags & 0x40 != 0)
        }
    }

    /// Sets a video mode.
    pub(crate) fn set_mode(&mut self, mode: u8) {
        self.interrupt(0x10, [mode.into(), 0, 0, 0], None);
    }

    /// Prints text to the program's standard output.
    pub(crate) fn print(&mut self, text: &str) {
        for line in text.split_inclusive('\n') {
            let (line, end) = line.strip_suffix('\n').map_or((line, ""), |line| (line, "\r\n"));
            self.write(1, line.as_bytes());
            self.write(1, end.as_bytes());
        }
    }

    /// Writes at most 1,024 bytes to an open file.
    fn write(&mut self, file: u32, bytes: &[u8]) -> bool {
        let bytes = &bytes[..bytes.len().min(1024)];
        // SAFETY: the table is the stub's, and its buffer has this room.
        unsafe { (&mut (*self.parameters).buffer)[..bytes.len()].copy_from_slice(bytes) };
        let (written, is_done, _) = self.interrupt(0x21, [0x4000, file, bytes.len() as u32, BUFFER], None);
        is_done && written as usize == bytes.len()
    }

    /// Returns whether Esc was pressed; other keys are discarded.
    pub(crate) fn is_escaped(&mut self) -> bool {
        loop {
            let (_, _, is_empty) = self.interrupt(0x16, [0x0100, 0, 0, 0], None);
            if is_empty {
                return false;
            }
            let (key, _, _) = self.interrupt(0x16, [0, 0, 0, 0], None);
            if key & 0xFF == 0x1B {
                return true;
            }
        }
    }

    /// Copies a frame to the card.
    pub(crate) fn show(&mut self, pixels: &[u8]) {
        // SAFETY: 64,000 bytes from A0000h on are the card's.
        unsafe { ptr::copy_nonoverlapping(pixels.as_ptr(), self.video(), pixels.len().min(64_000)) };
    }

    fn video(&self) -> *mut u8 {
        // SAFETY: the table is the stub's. Addresses wrap, as the segment's do.
        unsafe { (*self.parameters).low.wrapping_add(0xA0000) }
    }

    /// Waits until the vertical retrace begins.
    pub(crate) fn wait_for_retrace(&mut self) {
        while input(0x3DA) & 8 != 0 {}
        while input(0x3DA) & 8 == 0 {}
    }

    /// Loads the DAC with the colours scaled by `level`/64.
    pub(crate) fn set_dac(&mut self, colors: &[u8], level: u8) {
        output(0x3C8, 0);
        for &part in colors {
            // 63 · 64 / 64 at most.
            output(0x3C9, (u16::from(part) * u16::from(level) / 64) as u8);
        }
    }

    /// Fades from black to the colours, or back, in a second: one step per retrace.
    pub(crate) fn fade(&mut self, colors: &[u8], out: bool) {
        for level in 0..=64 {
            self.wait_for_retrace();
            self.set_dac(colors, if out { 64 - level } else { level });
        }
    }

    /// The seconds of the real-time clock, 0 to 59.
    pub(crate) fn seconds(&mut self) -> u32 {
        loop {
            output(0x70, 0x0A);
            if input(0x71) & 0x80 != 0 {
                continue;
            }
            output(0x70, 0);
            let digits = input(0x71);
            return u32::from(digits >> 4) * 10 + u32::from(digits & 15);
        }
    }

    /// Timer ticks per second.
    pub(crate) const TICKS: u32 = 1_193_182;

    /// Makes the timer count down from 65,536, one per tick.
    pub(crate) fn start_timer(&mut self) {
        output(0x43, 0x34);
        output(0x40, 0);
        output(0x40, 0);
    }

    /// Returns whether the clock has started another second since the last call.
    pub(crate) fn is_second_over(&mut self) -> bool {
        output(0x70, 0x0C);
        input(0x71) & 0x10 != 0
    }

    /// Waits until the clock starts a second; returns the number of timer ticks that took.
    pub(crate) fn rest_of_second(&mut self) -> u32 {
        let count = || {
            output(0x43, 0);
            u16::from_le_bytes([input(0x40), input(0x40)])
        };
        let (mut ticks, mut last) = (0_u32, count());
        while !self.is_second_over() {
            let now = count();
            ticks += u32::from(last.wrapping_sub(now));
            last = now;
        }
        ticks
    }

    /// Writes the card's contents to SCREEN.BIN: the bytes of video memory, then the DAC.
    pub(crate) fn write_screen(&mut self) -> bool {
        const NAME: &[u8] = b"SCREEN.BIN\0";
        // SAFETY: the table is the stub's, and its buffer has room.
        unsafe { (&mut (*self.parameters).buffer)[..NAME.len()].copy_from_slice(NAME) };
        let (file, is_made, _) = self.interrupt(0x21, [0x3C00, 0, 0, BUFFER], None);
        if !is_made {
            return false;
        }
        let (written, is_done, _) = self.interrupt(0x21, [0x4000, file, 64_000, 0], Some(0xA000));
        output(0x3C7, 0);
        let mut dac = [0; 768];
        dac.fill_with(|| input(0x3C9));
        let passed = is_done && written == 64_000 && self.write(file, &dac);
        self.interrupt(0x21, [0x3E00, file, 0, 0], None);
        passed
    }
}

fn output(port: u16, value: u8) {
    // SAFETY: the ports of the VGA and of the clock touch no memory.
    unsafe { asm!("out dx, al", in("dx") port, in("al") value, options(nomem, nostack, preserves_flags)) };
}

fn input(port: u16) -> u8 {
    let value;
    // SAFETY: the ports of the VGA and of the clock touch no memory.
    unsafe { asm!("in al, dx", in("dx") port, out("al") value, options(nomem, nostack, preserves_flags)) };
    value
}

/// Start and end of the remaining extended memory; nothing is ever freed.
struct Heap(UnsafeCell<(usize, usize)>);
/// The stub's table, for a panic.
struct Table(UnsafeCell<*mut Parameters>);

// SAFETY: the program has one thread.
unsafe impl Sync for Heap {}
// SAFETY: the program has one thread.
unsafe impl Sync for Table {}

static PARAMETERS: Table = Table(UnsafeCell::new(ptr::null_mut()));

#[global_allocator]
static HEAP: Heap = Heap(UnsafeCell::new((0, 0)));

// SAFETY: each block is handed out once, and lies in the block that the stub got from the driver.
unsafe impl GlobalAlloc for Heap {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: one thread.
        let (next, end) = unsafe { &mut *self.0.get() };
        // Distances, because the block may wrap around the end of the segment.
        let start = next.wrapping_add(layout.align() - 1) & !(layout.align() - 1);
        let room = end.wrapping_sub(start);
        if room > isize::MAX as usize || layout.size() > room {
            return ptr::null_mut();
        }
        *next = start.wrapping_add(layout.size());
        start as *mut u8
    }

    unsafe fn dealloc(&self, _: *mut u8, _: Layout) {}
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: the stub's table, set before anything else.
    let mut machine = Machine { parameters: unsafe { *PARAMETERS.0.get() } };
    machine.set_mode(Machine::TEXT);
    machine.print("There is too little memory for this scene, or the program is at fault.\n");
    // DOS ends the program; the block of extended memory stays allocated.
    machine.interrupt(0x21, [0x4C01, 0, 0, 0], None);
    loop {}
}
