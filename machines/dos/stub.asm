; The 16-bit half of the program for DOS: `nasm -f bin`, 4,096 bytes, placed before the flat image of player/.
;
; From a floppy (boot.asm) it is started at `boot`, without DOS: it then serves the few DOS calls itself.
;
; It checks for a 386 in real mode with enough extended memory (XMS), enters protected mode with segments based at the
; program itself, so that address 0 is the first byte of this file, and calls the image. The image may request one
; service: an interrupt of DOS or the BIOS, in real mode. Interrupts are off in protected mode: keyboard input waits
; until the next service.

IMAGE   equ 1000h                       ; where the image is, and begins

CODE32  equ 8
DATA32  equ 16
CODE16  equ 24
DATA16  equ 32

        org 0
        bits 16
start:  jmp begin
        align 4, db 0

; What `mode13h dos` writes here.
film            dd 0                    ; offset and length of the film
film_length     dd 0
stack_top       dd 0                    ; of protected mode
heap_kb         dd 0                    ; extended memory that is needed

; What the image receives besides the four above: the address of `film` is its argument.
heap            dd 0                    ; offset of the extended memory
low             dd 0                    ; offset of linear address 0
command         dd 0                    ; offset of the command line: a byte with its length, then the words
entry           dd service
; The registers of an interrupt, in and out.
r_eax           dd 0
r_ebx           dd 0
r_ecx           dd 0
r_edx           dd 0
r_ds            dd 0
number          dd 0                    ; of the interrupt
r_flags         dd 0                    ; out
stub_segment    dd 0                    ; this segment, for what DS points to
buffer          times 1024 db 0         ; for text and bytes that an interrupt reads or writes

xms             dd 0
handle          dw 0
psp             dw 0
real_sp         dw 0
real_ss         dw 0
saved_esp       dd 0
status          db 0
is_booted       db 0
no_words        db 0                    ; a command line of no words

        align 8, db 0
gdt     dq 0
        dw 0FFFFh, 0, 9A00h, 00CFh      ; code, 32 bits, 4 GB
        dw 0FFFFh, 0, 9200h, 00CFh      ; data, 4 GB
        dw 0FFFFh, 0, 9A00h, 0000h      ; code, 16 bits, 64 KB
        dw 0FFFFh, 0, 9200h, 0000h      ; data, 64 KB
gdt_end:
gdtr    dw gdt_end - gdt - 1
        dd 0

no_386  db 'This program needs a 386.', 13, 10, '$'
in_v86  db 'The processor is not in real mode: EMM386 or Windows is running. Start DOS without it.', 13, 10, '$'
no_xms  db 'There is no extended memory: load HIMEM.SYS in CONFIG.SYS.', 13, 10, '$'
no_room db 'There is too little extended memory: 4 MB are enough for most scenes.', 13, 10, '$'
no_a20  db 'The memory above 1 MB cannot be reached: line A20 stays off.', 13, 10, '$'

; Prints the line at DX, and ends with status 1.
say_and_end:
        push cs
        pop ds
        mov ah, 9
        int 21h
        mov ax, 4C01h
        int 21h

; Clears the carry flag on a 386. Bits 12 to 15 of the flags: all set on an 8086, all clear on a 286, what was written
; on a 386.
is_386: pushf
        pop ax
        and ah, 0Fh
        push ax
        popf
        pushf
        pop ax
        and ah, 0F0h
        cmp ah, 0F0h
        je .older
        mov ah, 70h
        push ax
        popf
        pushf
        pop ax
        and ah, 70h
        jz .older
        clc
        ret
.older: stc
        ret

begin:  cld
        mov [cs:psp], es
        push cs
        pop ds
        call is_386
        jc no_processor
        smsw ax
        test al, 1
        mov dx, in_v86
        jnz say_and_end

        mov ax, 4300h
        int 2Fh
        cmp al, 80h
        mov dx, no_xms
        jne say_and_end
        mov ax, 4310h
        int 2Fh
        mov [cs:xms], bx
        mov [cs:xms + 2], es
        push cs
        pop ds
        mov ah, 8                       ; the largest free block
        call far [xms]
        cmp ax, [heap_kb]
        jb no_processor.no_room
        mov dx, [heap_kb]
        mov ah, 9                       ; allocate
        call far [xms]
        dec ax
        jnz no_processor.no_room
        mov [handle], dx
        mov ah, 0Ch                     ; lock: DX:BX is its address
        call far [xms]
        dec ax
        jnz no_processor.free
        mov [heap], bx
        mov [heap + 2], dx
        mov ah, 5                       ; A20 on
        call far [xms]
        dec ax
        mov dx, no_a20
        jnz no_processor.unlock

        ; All segments are based at the start of the program.
based:
        xor eax, eax
        mov ax, cs
        mov [stub_segment], eax
        mov [realseg], ax
        shl eax, 4
        sub [heap], eax
        xor ebx, ebx
        sub ebx, eax
        mov [low], ebx
        movzx ecx, word [psp]
        shl ecx, 4
        sub ecx, eax
        add ecx, 80h
        mov [command], ecx
        cmp byte [is_booted], 0
        je .with_words
        mov dword [command], no_words
.with_words:
        mov [gdt + CODE32 + 2], ax
        mov [gdt + DATA32 + 2], ax
        mov [gdt + CODE16 + 2], ax
        mov [gdt + DATA16 + 2], ax
        mov ebx, eax
        shr ebx, 16
        mov [gdt + CODE32 + 4], bl
        mov [gdt + DATA32 + 4], bl
        mov [gdt + CODE16 + 4], bl
        mov [gdt + DATA16 + 4], bl
        add eax, gdt
        mov [gdtr + 2], eax
        mov [real_ss], ss
        mov [real_sp], sp
        mov eax, [stack_top]
        mov [saved_esp], eax
        mov ebx, run
        jmp protected

no_processor:
        mov dx, no_386
        jmp say_and_end
.free:  mov dx, [handle]
        mov ah, 0Ah
        call far [xms]
.no_room:
        mov dx, no_room
        jmp say_and_end
.unlock:
        push dx
        mov dx, [handle]
        mov ah, 0Dh
        call far [xms]
        mov dx, [handle]
        mov ah, 0Ah
        call far [xms]
        pop dx
        jmp say_and_end

; To protected mode, continuing at EBX.
protected:
        cli
        o32 lgdt [gdtr]
        mov eax, cr0
        or al, 1
        mov cr0, eax
        jmp dword CODE32:flat

        bits 32
flat:   mov ax, DATA32
        mov ds, ax
        mov es, ax
        mov fs, ax
        mov gs, ax
        mov ss, ax
        mov esp, [saved_esp]
        jmp ebx

run:    cld
        push dword film
        call IMAGE
        mov [status], al
        mov ebx, finish

; To real mode, continuing at BX.
to_real:
        mov [saved_esp], esp
        jmp CODE16:.with_limits

        bits 16
.with_limits:
        mov ax, DATA16
        mov ds, ax
        mov es, ax
        mov fs, ax
        mov gs, ax
        mov ss, ax
        mov eax, cr0
        and al, 0FEh
        mov cr0, eax
        db 0EAh                         ; jmp far
        dw real_mode
realseg dw 0
real_mode: mov ax, cs
        mov ds, ax
        mov es, ax
        mov ss, [real_ss]
        mov sp, [real_sp]
        jmp bx

        bits 32
; The service: interrupt `number` with the registers above.
service:
        pushad
        mov ebx, interrupt
        jmp to_real

        bits 16
interrupt:
        mov al, [number]
        mov [.number], al
        jmp short .written              ; a 486 has already fetched what follows
.written:
        sti
        mov eax, [r_eax]
        mov ebx, [r_ebx]
        mov ecx, [r_ecx]
        mov edx, [r_edx]
        mov ds, [r_ds]
        db 0CDh                         ; int
.number db 0
        cli
        push cs
        pop ds
        mov [r_eax], eax
        mov [r_ebx], ebx
        mov [r_ecx], ecx
        mov [r_edx], edx
        pushf
        pop word [r_flags]
        cld
        mov ebx, .back
        jmp protected

        bits 32
.back:  popad
        ret

        bits 16
finish: sti
        cmp byte [is_booted], 0
        jne .end
        mov ah, 6                       ; A20 off again
        call far [xms]
        mov dx, [handle]
        mov ah, 0Dh
        call far [xms]
        mov dx, [handle]
        mov ah, 0Ah
        call far [xms]
.end:   mov al, [status]
        mov ah, 4Ch
        int 21h

; Without DOS: the BIOS has read the program from a floppy. The stack is below the boot sector.
booted: cld
        push cs
        pop ds
        mov byte [is_booted], 1
        xor ax, ax
        mov es, ax
        mov word [es:21h * 4], dos
        mov [es:21h * 4 + 2], cs
        call is_386
        jc no_processor
        mov ah, 88h                     ; KB above 1 MB
        int 15h
        mov dx, no_room
        jc .end
        cmp ax, [heap_kb]
        jb .end
        mov dword [heap], 100000h
        in al, 92h                      ; A20 on, by the chip set
        or al, 2
        and al, 0FEh
        out 92h, al
        mov ax, 2401h                   ; and by the BIOS
        int 15h
        ; A byte at 500h and the one 1 MB above it are distinct.
        mov ax, 0FFFFh
        mov fs, ax
        mov byte [es:500h], 0
        mov byte [fs:510h], 0FFh
        cmp byte [es:500h], 0
        mov dx, no_a20
        jne .end
        jmp based
.end:   jmp say_and_end

; The DOS calls that are needed: 9 and 40h print, 4Ch ends; others fail.
dos:    cmp ah, 40h
        je .write
        cmp ah, 9
        je .line
        cmp ah, 4Ch
        je .stop
        stc
        retf 2
.stop:  sti
        hlt
        jmp .stop
.write: push si
        push cx
        mov si, dx
        jcxz .written
.byte:  call .put
        loop .byte
.written:
        pop cx
        pop si
        mov ax, cx
        clc
        retf 2
.line:  push si
        mov si, dx
.more:  cmp byte [si], '$'
        je .all
        call .put
        jmp .more
.all:   pop si
        clc
        retf 2
.put:   lodsb
        push bx
        mov ah, 0Eh
        mov bx, 7
        int 10h
        pop bx
        ret

        times IMAGE - 16 - ($ - $$) db 0
boot:   jmp near booted                 ; boot.asm starts here
        times IMAGE - ($ - $$) db 0
