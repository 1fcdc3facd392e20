# The span loop of 1994 to the letter, on 32-bit x86. Intel syntax, for LLVM's assembler.
#
#   void mode13h_span_i686(uint8_t *row, uint16_t count, uint16_t shade, uint16_t step)
#   {
#       do {
#           *row++ = shade >> 8;
#           shade += step;
#       } while (--count != 0);
#   }
#
# count is 1 to 65,535, as it was: 0 would run 65,536 times. The caller cuts longer rows.
#
# Called by cdecl, four words on the stack whose upper halves (count, shade, step) may hold rubbish:
#
#   edi   row, the caller's edi saved
#   cx    pixels left
#   ax    the running shade; ah, its whole part, is the pixel
#   bx    step, the caller's ebx saved

function mode13h_span_i686
    push    edi
    push    ebx
    mov     edi, [esp + 12]
    mov     cx, [esp + 16]
    mov     ax, [esp + 20]
    mov     bx, [esp + 24]
2:
    mov     [edi], ah           # *row = shade >> 8
    inc     edi                 # row++
    add     ax, bx              # shade += step
    dec     cx                  # while (--count != 0)
    jnz     2b
    pop     ebx
    pop     edi
    ret
endfunction mode13h_span_i686
