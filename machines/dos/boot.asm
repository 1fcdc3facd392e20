; The first sector of a 1.44 MB floppy: reads what follows to 1000h:0, one sector at a time, and starts the stub there.
        org 7C00h
        bits 16
start:  jmp short begin
        align 4, db 0
sectors dw 0                            ; `mode13h dos` writes their number here
drive   db 0

begin:  cli
        xor ax, ax
        mov ss, ax
        mov sp, 7C00h
        sti
        mov ds, ax
        cld
        mov [drive], dl
        mov ax, 1000h
        mov es, ax
        mov si, 1
.next:  mov ax, si
        xor dx, dx
        mov bx, 18                      ; sectors of a track
        div bx
        mov cl, dl
        inc cl
        mov dh, al
        and dh, 1
        shr ax, 1
        mov ch, al
        mov dl, [drive]
        xor bx, bx
        mov di, 5
.retry: mov ax, 0201h
        int 13h
        jnc .read
        xor ah, ah
        int 13h
        dec di
        jnz .retry
        mov si, broken
.say:   lodsb
        or al, al
        jz $
        mov ah, 0Eh
        int 10h
        jmp .say
.read:  mov ax, es
        add ax, 32
        mov es, ax
        inc si
        dec word [sectors]
        jnz .next
        jmp 1000h:0FF0h                 ; `boot` of the stub

broken  db 'The disk cannot be read.', 0
        times 510 - ($ - $$) db 0
        dw 0AA55h
