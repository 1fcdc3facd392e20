//! The trampoline for 32-bit x86, cdecl, and deliberately wrong kernels.

use super::{Call, Kernel, Seen, entry};
use std::arch::naked_asm;

pub(crate) const LOOP: entry::Entry = entry::mode13h_span_i686;
/// The loop without its jump.
pub(crate) const FOUR: [&str; 4] = ["mov [edi],ah", "inc edi", "add ax,bx", "dec cx"];
pub(crate) const KEPT: &[&str] = &["ebx", "ebp", "esi", "edi"];

/// Saves what it needs to return in a block at a multiple of 256, found again from whatever the stack pointer is when
/// the kernel returns; 64 bytes below it are guarded, then come the arguments.
#[unsafe(naked)]
pub(crate) unsafe extern "cdecl" fn trampoline(call: &Call, seen: &mut Seen) {
    naked_asm!(
        "push ebx",
        "push ebp",
        "push esi",
        "push edi",
        "mov edx, [esp + 20]", // call
        "mov ecx, [esp + 24]", // seen
        "mov eax, esp",
        "sub esp, 1024",
        "and esp, -256",      // the block
        "mov [esp], eax",     // 0: our stack
        "mov [esp + 4], ecx", // 4: seen
        "stmxcsr [ecx + 36]",
        "mov eax, 0x5A5A5A5A",
        ".rept 16",
        "push eax",
        ".endr",
        "push [edx + 16]",
        "push [edx + 12]",
        "push [edx + 8]",
        "push [edx + 4]",
        "push [edx]", // the kernel, below where its return address will lie
        "mov ebx, [edx + 20]",
        "mov ebp, [edx + 24]",
        "mov esi, [edx + 28]",
        "mov edi, [edx + 32]",
        "mov eax, [edx + 44]",
        "mov ecx, eax",
        "mov edx, eax",
        "cld",
        "add esp, 4",
        "call [esp - 4]",
        "mov ecx, esp",
        "lea eax, [esp + 255]",
        "and eax, -256", // the block
        "lea esp, [eax - 160]",
        "mov edx, [eax + 4]",
        "mov [edx], ebx",
        "mov [edx + 4], ebp",
        "mov [edx + 8], esi",
        "mov [edx + 12], edi",
        "pushfd",
        "pop ebx",
        "cld",
        "mov [edx + 24], ebx",
        "lea ebx, [eax - 80]",
        "sub ecx, ebx",
        "mov [edx + 28], ecx",
        "stmxcsr [edx + 40]",
        "xor ebx, ebx",
        "mov ecx, -64",
        "2:",
        "mov esi, [eax + ecx]",
        "xor esi, 0x5A5A5A5A",
        "or ebx, esi",
        "add ecx, 4",
        "jnz 2b",
        "mov [edx + 32], ebx",
        "mov esp, [eax]",
        "pop edi",
        "pop esi",
        "pop ebp",
        "pop ebx",
        "ret",
    )
}

/// A sound loop: edi is kept, eax is the row, dx the shade, and the step is read from the stack.
macro_rules! sound_loop {
    ($($before:literal,)* ; $($after:literal),*) => {
        naked_asm!(
            "mov eax, [esp + 4]", "movzx ecx, word ptr [esp + 8]", "mov edx, [esp + 12]",
            $($before,)*
            "2:",
            "mov [eax], dh",
            "inc eax", "add dx, [esp + 16]", "dec ecx", "jnz 2b",
            $($after,)*
            "ret",
        )
    };
}

kernels! {
    "cdecl", u16;
    clobbers_ebx => "ebx is": ; "mov ebx, 1"
    clobbers_ebp => "ebp is": ; "inc ebp"
    clobbers_esi => "esi is": ; "inc esi"
    clobbers_edi => "edi is": ; "inc edi"
    sets_direction => "the direction flag": ; "std"
    leaves_the_stack_higher => "the stack pointer is off by": ; "ret 8"
    writes_on_the_callers_stack => "the caller's stack": ; "mov dword ptr [esp + 20], 0"
    changes_rounding => "MXCSR": ; "mov dword ptr [esp + 4], 0x7F80", "ldmxcsr [esp + 4]"
    writes_one_wrong => "pixel 19 is": ; "inc byte ptr [eax - 1]"
    writes_one_short => "pixel 19 is": "dec ecx" ; "nop"
    writes_one_beyond => "a byte beside": "inc ecx" ; "nop"
    writes_one_before => "a byte beside": "mov byte ptr [eax - 1], 0" ; "nop"
    reads_the_upper_count => "a byte beside": "mov ecx, [esp + 8]", "shr ecx, 16", "sub cx, [esp + 8]", "neg cx" ; "nop"
    reads_the_upper_shade => "pixel 0 is": "mov edx, [esp + 12]", "shr edx, 8" ; "nop"
}
