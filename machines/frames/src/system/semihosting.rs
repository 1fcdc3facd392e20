//! A bare chip under QEMU: it communicates by semihosting, Arm's debugger interface, which RISC-V adopted.

use alloc::string::String;
use alloc::vec;
use core::arch::asm;

/// Where a Cortex-M starts: the word after the top of the stack.
#[cfg(target_arch = "arm")]
#[unsafe(link_section = ".reset")]
#[unsafe(no_mangle)]
static RESET: extern "C" fn() -> ! = start;

#[cfg(target_arch = "riscv32")]
core::arch::global_asm!(".section .reset, \"ax\"", ".globl _start", "_start:", "la sp, stack_top", "tail {start}", start = sym start);

extern "C" fn start() -> ! {
    #[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
    // SAFETY: CPACR of a Cortex-M4: enables coprocessors 10 and 11, the floating-point unit.
    unsafe {
        let cpacr = 0xE000_ED88 as *mut u32;
        cpacr.write_volatile(cpacr.read_volatile() | 0xF << 20);
        asm!("dsb", "isb");
    }
    let mut words = vec![0_u8; 1_000];
    let mut block = [words.as_mut_ptr() as usize, words.len()];
    // SYS_GET_CMDLINE writes the command line and its length; the first word is the program's name.
    semihosting(0x15, block.as_mut_ptr() as usize);
    words.truncate(block[1]);
    let words = String::from_utf8_lossy(&words);
    exit(crate::run(words.split_once(' ').map_or("", |(_, words)| words)))
}

pub(crate) fn print(text: &str) {
    let mut bytes = text.as_bytes().to_vec();
    bytes.push(0);
    // SYS_WRITE0: text that ends with a zero.
    semihosting(0x04, bytes.as_ptr() as usize);
}

pub(crate) fn exit(passed: bool) -> ! {
    loop {
        // SYS_EXIT: ADP_Stopped_ApplicationExit, or ADP_Stopped_RunTimeErrorUnknown.
        semihosting(0x18, if passed { 0x2_0026 } else { 0x2_0023 });
    }
}

fn semihosting(operation: usize, argument: usize) {
    // SAFETY: the debugger reads and writes what the calls above pass to it, and changes only the first register.
    unsafe {
        #[cfg(target_arch = "arm")]
        asm!("bkpt 0xab", inout("r0") operation => _, in("r1") argument);
        #[cfg(target_arch = "riscv32")]
        asm!(
            ".balign 16",
            ".option push",
            ".option norvc",
            "slli zero, zero, 0x1f",
            "ebreak",
            "srai zero, zero, 7",
            ".option pop",
            inout("a0") operation => _, in("a1") argument
        );
    }
}
