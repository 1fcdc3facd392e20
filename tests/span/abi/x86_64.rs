//! The trampoline for x86-64, System V convention, and deliberately wrong kernels.

use super::{Call, Kernel, Seen, entry};
use std::arch::naked_asm;

pub(crate) const LOOP: entry::Entry = entry::mode13h_span_x86_64;
/// The loop without its jump.
pub(crate) const FOUR: [&str; 4] = ["mov [rdi],ah", "inc rdi", "add ax,bx", "dec ecx"];
pub(crate) const KEPT: &[&str] = &["rbx", "rbp", "r12", "r13", "r14", "r15"];

/// Saves what it needs to return in a block at a multiple of 256, found again from whatever the stack pointer is when
/// the kernel returns; 64 bytes below it are guarded.
#[unsafe(naked)]
pub(crate) unsafe extern "sysv64" fn trampoline(call: &Call, seen: &mut Seen) {
    naked_asm!(
        "push rbx",
        "push rbp",
        "push r12",
        "push r13",
        "push r14",
        "push r15",
        "mov rax, rsp",
        "sub rsp, 1024",
        "and rsp, -256",      // the block
        "mov [rsp], rax",     // 0: our stack
        "mov [rsp + 8], rsi", // 8: seen
        "stmxcsr [rsi + 72]",
        "mov rax, 0x5A5A5A5A5A5A5A5A",
        ".rept 8",
        "push rax",
        ".endr",
        "mov r11, rdi",
        "mov rdi, [r11 + 8]",
        "mov rsi, [r11 + 16]",
        "mov rdx, [r11 + 24]",
        "mov rcx, [r11 + 32]",
        "mov rbx, [r11 + 40]",
        "mov rbp, [r11 + 48]",
        "mov r12, [r11 + 56]",
        "mov r13, [r11 + 64]",
        "mov r14, [r11 + 72]",
        "mov r15, [r11 + 80]",
        "mov rax, [r11 + 88]",
        "mov r8, rax",
        "mov r9, rax",
        "mov r10, rax",
        "cld",
        "call [r11]",
        "mov r11, rsp",
        "lea r10, [rsp + 255]",
        "and r10, -256", // the block
        "lea rsp, [r10 - 128]",
        "mov rdx, [r10 + 8]",
        "mov [rdx], rbx",
        "mov [rdx + 8], rbp",
        "mov [rdx + 16], r12",
        "mov [rdx + 24], r13",
        "mov [rdx + 32], r14",
        "mov [rdx + 40], r15",
        "pushfq",
        "pop rax",
        "cld",
        "mov [rdx + 48], rax",
        "lea rax, [r10 - 64]",
        "sub r11, rax",
        "mov [rdx + 56], r11",
        "stmxcsr [rdx + 76]",
        "mov rcx, 0x5A5A5A5A5A5A5A5A",
        "xor eax, eax",
        "mov r8, -64",
        "2:",
        "mov r9, [r10 + r8]",
        "xor r9, rcx",
        "or rax, r9",
        "add r8, 8",
        "jnz 2b",
        "mov [rdx + 64], rax",
        "mov rsp, [r10]",
        "pop r15",
        "pop r14",
        "pop r13",
        "pop r12",
        "pop rbp",
        "pop rbx",
        "ret",
    )
}

/// Runs any code: `row` is the address of a `&mut dyn FnMut()`, which it calls.
pub(crate) unsafe extern "sysv64" fn run(row: *mut u8, _count: u32, _shade: u16, _step: u16) {
    // SAFETY: the caller's promise, and nobody else uses it meanwhile.
    let action = unsafe { &mut *row.cast::<&mut dyn FnMut()>() };
    action();
}

/// A loop with the step in r8d, so that it touches no callee-saved register.
macro_rules! sound_loop {
    ($($before:literal,)* ; $($after:literal),*) => {
        naked_asm!(
            $($before,)*
            "mov r8d, ecx", "mov eax, edx",
            "2:",
            "mov edx, eax", "shr edx, 8", "mov [rdi], dl",
            "inc rdi", "add eax, r8d", "dec esi", "jnz 2b",
            $($after,)*
            "ret",
        )
    };
}

kernels! {
    "sysv64", u32;
    clobbers_rbx => "rbx is": ; "mov ebx, 1"
    clobbers_rbp => "rbp is": ; "inc rbp"
    clobbers_r12 => "r12 is": ; "xor r12d, r12d"
    clobbers_r13 => "r13 is": ; "inc r13"
    clobbers_r14 => "r14 is": ; "inc r14"
    clobbers_r15 => "r15 is": ; "not r15"
    sets_direction => "the direction flag": ; "std"
    leaves_the_stack_higher => "the stack pointer is off by": ; "ret 8"
    writes_on_the_callers_stack => "the caller's stack": ; "mov dword ptr [rsp + 8], 0"
    changes_rounding => "MXCSR": ; "mov dword ptr [rsp - 8], 0x7F80", "ldmxcsr [rsp - 8]"
    writes_one_wrong => "pixel 19 is": ; "inc byte ptr [rdi - 1]"
    writes_one_short => "pixel 19 is": "dec esi" ; "nop"
    writes_one_beyond => "a byte beside": "inc esi" ; "nop"
    writes_one_before => "a byte beside": "mov byte ptr [rdi - 1], 0" ; "nop"
    reads_the_upper_count => "a byte beside": "mov rax, rsi", "shr rax, 32", "sub esi, eax", "and esi, 31" ; "nop"
    reads_the_upper_shade => "pixel 0 is": "mov eax, edx", "shr eax, 8", "and eax, 0xFF00", "sub edx, eax" ; "nop"
    reads_the_upper_step => "pixel 1 is": "mov eax, ecx", "shr eax, 8", "and eax, 0xFF00", "sub ecx, eax" ; "nop"
}
