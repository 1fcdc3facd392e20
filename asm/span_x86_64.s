# The span loop of 1994 on x86-64, and an unrolled version. Intel syntax, for LLVM's assembler.
#
#   void mode13h_span_x86_64(uint8_t *row, uint32_t count, uint16_t shade, uint16_t step)
#   {
#       do {
#           *row++ = shade >> 8;
#           shade += step;
#       } while (--count != 0);
#   }
#
# count is 1 or more: 0 would run 2^32 times, as in the original it ran 65,536 times.
#
# Called by the System V convention on every system, so that there is one register map:
#
#   rdi   row                   in; the upper halves of esi, edx, ecx
#   esi   count                 in  and of their registers may hold rubbish
#   dx    shade                 in
#   cx    step                  in
#   ax    the running shade; ah, its whole part, is the pixel
#   bx    step, the caller's rbx saved
#   ecx   pixels left
#
# What 64-bit code changes in the original: [edi] would cut the pointer in half, so [rdi]. ah cannot
# stand beside a REX register, so neither the pointer nor the shade may move to r8 to r15.

function mode13h_span_x86_64
    push    rbx
    mov     eax, edx
    mov     ebx, ecx
    mov     ecx, esi
2:
    mov     [rdi], ah           # *row = shade >> 8
    inc     rdi                 # row++
    add     ax, bx              # shade += step
    dec     ecx                 # while (--count != 0)
    jnz     2b
    pop     rbx
    ret
endfunction mode13h_span_x86_64

#   void mode13h_span_unrolled_x86_64(the same)
#   {
#       for (n = count % 8; n != 0; n--) { *row++ = shade >> 8; shade += step; }
#       for (n = count / 8; n != 0; n--) eight times { *row++ = shade >> 8; shade += step; }
#   }
#
# The same registers, and esi for the turns of eight that are left. The odd pixels come first, so
# that both loops end by falling through.

function mode13h_span_unrolled_x86_64
    push    rbx
    mov     eax, edx
    mov     ebx, ecx
    mov     ecx, esi
    and     ecx, 7
    jz      3f
2:
    mov     [rdi], ah
    inc     rdi
    add     ax, bx
    dec     ecx
    jnz     2b
3:
    shr     esi, 3
    jz      5f
4:
    mov     [rdi], ah
    add     ax, bx
    mov     [rdi + 1], ah
    add     ax, bx
    mov     [rdi + 2], ah
    add     ax, bx
    mov     [rdi + 3], ah
    add     ax, bx
    mov     [rdi + 4], ah
    add     ax, bx
    mov     [rdi + 5], ah
    add     ax, bx
    mov     [rdi + 6], ah
    add     ax, bx
    mov     [rdi + 7], ah
    add     ax, bx
    add     rdi, 8
    dec     esi
    jnz     4b
5:
    pop     rbx
    ret
endfunction mode13h_span_unrolled_x86_64
