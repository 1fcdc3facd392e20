; A 64 kB ROM in place of a PC's BIOS: switches the processor to 64 bits with AVX-512, reads the program from the hard disk,
; and starts it. It serves two Linux calls: write prints its text to port E9h, exit ends Bochs. Exceptions are not handled: the
; processor shuts down, and Bochs ends.
;     nasm -D SECTORS=N -D WORDS="'FILE'"       the program's sectors of 512 bytes
place   equ 1000000h                    ; the program's first instruction (image.ld)
stack   equ 0F00000h                    ; as Linux leaves it: the number of words, their addresses
memory  equ 8000000h                    ; bytes
tables  equ 10000h                      ; pages
        org 0FFFF0000h
rom     equ $
        bits 16
start:  cli
        o32 lgdt [cs:gdtr - rom]
        mov eax, cr0
        or al, 1
        mov cr0, eax
        jmp dword 8:protected
        bits 32
protected:
        mov ax, 16
        mov ds, ax
        mov ss, ax
        mov es, ax
        cld
        xor ebx, ebx                    ; the sector
        mov edi, place
.read:  mov dx, 1F2h
        mov al, 1                       ; one
        out dx, al
        mov eax, ebx
        or eax, 0E0000000h              ; the first disk, by the sector's number
        mov ecx, 4
.number:
        inc edx
        out dx, al
        shr eax, 8
        loop .number
        inc edx
        mov al, 20h                     ; read
        out dx, al
.wait:  in al, dx
        test al, 8
        jz .wait
        mov dx, 1F0h
        mov ecx, 256
        rep insw
        inc ebx
        cmp ebx, SECTORS
        jne .read
        ; Bochs's memory is not zeroed.
        xor eax, eax
        mov ecx, place + memory
        sub ecx, edi
        rep stosb
        mov edi, tables
        mov ecx, 2000h
        rep stosb
        mov esi, words
        mov edi, stack
        mov ecx, words_size
        rep movsb
        ; Identity-map the first 4 GB: four pages of 1 GB.
        mov dword [tables], tables + 1000h + 3
        mov edi, tables + 1000h
.page:  lea edx, [eax + 83h]
        mov [edi], edx
        add edi, 8
        add eax, 40000000h
        jnz .page
        mov eax, tables
        mov cr3, eax
        mov eax, 1 << 5 | 1 << 9 | 1 << 10 | 1 << 18    ; PAE, FXSR, SIMD exceptions, XSAVE
        mov cr4, eax
        mov ecx, 0C0000080h             ; EFER: long mode, SYSCALL
        mov eax, 101h
        xor edx, edx
        wrmsr
        mov eax, 80000033h              ; paging, numeric errors, monitored coprocessor, protected mode
        mov cr0, eax
        jmp 24:wide
        bits 64
wide:   xor ecx, ecx                    ; XCR0: x87, SSE, AVX, and the three parts of AVX-512
        mov eax, 0E7h
        xor edx, edx
        xsetbv
        mov ecx, 0C0000081h             ; STAR: the selectors of a call
        xor eax, eax
        mov edx, 24
        wrmsr
        inc ecx                         ; LSTAR: where a call goes
        mov eax, serve
        xor edx, edx
        wrmsr
        mov ecx, 0C0000084h             ; FMASK: no flag is changed
        xor eax, eax
        wrmsr
        mov esp, stack
        mov eax, place
        jmp rax

; RAX is the call, RSI and RDX the text; RCX holds the return address, R11 may be changed.
serve:  cmp eax, 1
        jne exit
        push rcx
        push rsi
        mov ecx, edx
        mov r11, rdx
        mov dx, 0E9h
        rep outsb
        mov eax, r11d
        mov edx, r11d
        pop rsi
        pop rcx
        jmp rcx
; Prints the status, then the word that ends Bochs.
exit:   lea eax, [rdi + '0']
        mov dx, 0E9h
        mov esi, status
        mov ecx, status_end - status
        rep outsb
        out dx, al
        mov al, 10
        out dx, al
        mov dx, 8900h
        mov esi, down
        mov ecx, down_end - down
        rep outsb
        hlt

status  db 'status '
status_end:
down    db 'Shutdown'
down_end:

        align 8, db 0
gdt     dq 0
        dq 00CF9B000000FFFFh            ; 8: code of 32 bits
        dq 00CF93000000FFFFh            ; 16: data
        dq 00AF9B000000FFFFh            ; 24: code of 64 bits
        dq 00CF93000000FFFFh            ; 32: the stack of a call
gdtr    dw $ - gdt - 1
        dd gdt

words   incbin WORDS
words_size equ $ - words

        times 0FFF0h - ($ - $$) db 0
        bits 16                         ; where the processor begins
        jmp start
        times 10000h - ($ - $$) db 0
