; A program for DOS of a flat image, as `link` puts it together: STUB and IMAGE are files, BSS bytes follow the image, then
; REAL and STACK bytes of stack, and HEAP is the extended memory in KB.
        org 0

HEADER  equ 32

header: db 'MZ'
        dw (end - header) % 512, (end - header + 511) / 512
        dw 0                            ; relocations
        dw HEADER / 16
        dw (BSS + REAL + STACK) / 16    ; memory behind the program, at least and at most
        dw (BSS + REAL + STACK) / 16
        dw (end - header - HEADER + BSS) / 16, REAL ; SS:SP
        dw 0                            ; sum
        dw 0, 0                         ; IP, CS
        dw HEADER - 4, 0                ; the table of relocations
        dw 0, 0
        incbin STUB, 0, 4
        dd 0, 0, end - header - HEADER + BSS + REAL + STACK, HEAP
        incbin STUB, 20
        incbin IMAGE
end:
