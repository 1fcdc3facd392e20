; Runs a program in virtual 8086 mode, where EMM386 and Windows keep the programs of DOS: `nasm -f bin`, a .COM.
;     V86 PROGRAM [WORD...]    ends with the program's status
;
; It needs a 386 in real mode. DOS and the BIOS run in virtual 8086 mode, too: a monitor in ring 0 hands every interrupt on
; to the handler in real mode's table. The monitor emulates nothing: what only ring 0 may do ends the program.

CODE    equ 8
DATA    equ 16
FLAT    equ 24
TASK    equ 32

END_V86 equ 0F1h                        ; the interrupt that asks the monitor for real mode

; Statuses: there is no such program, and it did what only ring 0 may do.
NOT_STARTED equ 254
NOT_ALLOWED equ 255

; The stack of ring 0 after an interrupt. Some exceptions have an error code, which is between `vector` and `eip`.
struc frame
.registers      resd 8
.vector         resw 1                  ; where the call in `vectors` would return to
.eip            resd 1
.cs             resd 1
.eflags         resd 1
.esp            resd 1
.ss             resd 1
.es_to_gs       resd 4
endstruc
ERROR_CODE      equ 4                   ; its bytes

; The segment of the task's state, and behind it a bit for each port. A bit that is 0 allows the port, which IOPL does not
; in virtual 8086 mode.
TASK_ESP0       equ 4
TASK_SS0        equ 8
TASK_PORTS      equ 102                 ; where the offset of the bits is
TASK_LENGTH     equ 104
PORTS           equ 65536 / 8

        org 100h
        bits 16
        cpu 386
start:  cld
        mov sp, stack
        mov bx, end + 15                ; the rest of the memory is the program's
        shr bx, 4
        mov ah, 4Ah
        int 21h

        mov si, 81h                     ; the command line, which ends with a 13
        mov di, program
.space: lodsb
        cmp al, ' '
        je .space
.name:  cmp al, ' '
        jbe .named
        stosb
        lodsb
        jmp .name
.named: mov byte [di], 0
        sub si, 2                       ; the byte in front of the words that are left is for their length
        mov [words], si
        mov ax, 80h
        add al, [80h]
        sub ax, si
        mov [si], al

        xor ebx, ebx                    ; this segment, until virtual 8086 mode
        mov bx, cs
        mov [words + 2], bx
        mov [fcb1 + 2], bx
        mov [fcb2 + 2], bx
        mov [real_segment], bx
        mov eax, ebx
        shl eax, 4
        add [gdt + CODE + 2], eax       ; three bytes of a base: there is no carry into the fourth
        add [gdt + DATA + 2], eax
        add [gdt + TASK + 2], eax
        add [gdtr + 2], eax
        add [idtr + 2], eax

        mov di, idt
        mov ax, vectors
        mov cx, 256
.gate:  mov [di], ax
        mov word [di + 2], CODE
        mov dword [di + 4], 0EE00h      ; an interrupt gate, 32 bits, for every ring
        add ax, 4
        add di, 8
        loop .gate

        xor ax, ax
        mov di, task
        mov cx, TASK_LENGTH + PORTS
        rep stosb
        mov byte [di], 0FFh             ; the end of the bits
        mov word [task + TASK_ESP0], ring0_stack
        mov word [task + TASK_SS0], DATA
        mov word [task + TASK_PORTS], TASK_LENGTH

        cli
        lgdt [gdtr]
        lidt [idtr]
        mov eax, cr0
        or al, 1
        mov cr0, eax
        jmp CODE:ring0

; To virtual 8086 mode, by a return from an interrupt that never was.
ring0:  mov ax, DATA
        mov ss, ax
        mov esp, ring0_stack
        mov ax, TASK
        ltr ax
        push dword 2                    ; no flag, so that NT does not make it a return to another task
        popfd
        times 4 push ebx                ; GS, FS, DS, ES
        push ebx                        ; SS:ESP
        push dword stack
        push dword 23202h               ; VM, IOPL 3, IF
        push ebx                        ; CS:EIP
        push dword virtual
        iretd

; In virtual 8086 mode.
virtual:
        mov ax, 4B00h
        mov bx, environment
        mov dx, program
        int 21h
        mov bx, cs                      ; DOS keeps CS alone
        mov ds, bx
        mov ss, bx
        mov sp, stack
        jc .not_started
        mov ah, 4Dh
        int 21h
        mov [status], al
        int END_V86
.not_started:
        mov dx, not_started
        mov ah, 9
        int 21h
        int END_V86

; In virtual 8086 mode, in place of the program.
not_allowed:
        push cs
        pop ds
        mov dx, only_ring0
        mov ah, 9
        int 21h
        mov ax, 4C00h + NOT_ALLOWED
        int 21h

; An entry for each interrupt. Its four bytes are those of the interrupt's address in real mode's table.
vectors:
%rep 256
        call near monitor
        nop
%endrep

; Every interrupt in virtual 8086 mode comes here, with interrupts off.
monitor:
        pushad
        mov bp, sp
        mov ax, FLAT
        mov ds, ax
        cmp sp, ring0_stack - frame_size
        jne .error                      ; there is an error code
        movzx ebx, word [bp + frame.vector]
        sub bx, vectors + 3
        cmp bx, END_V86 * 4
        je to_real

        ; What an interrupt does in real mode: flags, CS and IP to the stack, IF and TF off, and to the handler.
        sub word [bp + frame.esp], 6
        movzx eax, word [bp + frame.ss]
        shl eax, 4
        movzx edx, word [bp + frame.esp]
        add eax, edx
        mov dx, [bp + frame.eip]
        mov [eax], dx
        mov dx, [bp + frame.cs]
        mov [eax + 2], dx
        mov dx, [bp + frame.eflags]
        mov [eax + 4], dx
        and word [bp + frame.eflags], ~300h
        mov dx, [ebx]
        mov [bp + frame.eip], dx
        mov dx, [ebx + 2]
        mov [bp + frame.cs], dx
        popad
        add sp, 2                       ; `vector`
        iretd
.error: mov dword [bp + ERROR_CODE + frame.eip], not_allowed
        mov ax, [cs:real_segment]
        mov [bp + ERROR_CODE + frame.cs], ax
        lea sp, [bp + ERROR_CODE + frame.eip]
        iretd

to_real:
        mov ax, DATA                    ; limits of 64 KB
        mov ds, ax
        mov es, ax
        mov fs, ax
        mov gs, ax
        mov eax, cr0
        and al, 0FEh
        mov cr0, eax
        db 0EAh                         ; jmp far
        dw real_mode
real_segment dw 0
real_mode:
        mov ax, cs
        mov ds, ax
        mov ss, ax
        mov sp, stack
        lidt [real_idtr]
        sti
        mov al, [status]
        mov ah, 4Ch
        int 21h

not_started db 'V86: the program cannot be started.', 13, 10, '$'
only_ring0  db 'V86: the program did what only ring 0 may do.', 13, 10, '$'
status      db NOT_STARTED

; What DOS is told of the program.
environment dw 0                        ; this program's
words       dw 0, 0
fcb1        dw 5Ch, 0
fcb2        dw 6Ch, 0

        align 8, db 0
gdt     dq 0
        dw 0FFFFh, 0, 9A00h, 0000h      ; code, 16 bits, 64 KB
        dw 0FFFFh, 0, 9200h, 0000h      ; data, 64 KB
        dw 0FFFFh, 0, 9200h, 008Fh      ; data, 4 GB from linear address 0
        dw TASK_LENGTH + PORTS, task, 8900h, 0000h
gdt_end:
gdtr    dw gdt_end - gdt - 1
        dd gdt
idtr    dw 256 * 8 - 1
        dd idt
real_idtr dw 256 * 4 - 1
        dd 0

        section .bss
program         resb 128                ; its name, which ends with a 0
idt             resb 256 * 8
task            resb TASK_LENGTH + PORTS + 1
                alignb 4
                resb 512
ring0_stack:    resb 512
stack:
end:
