/* What runs before dos_main, and what compilers call without being asked. */
#include <stddef.h>

#include "dos.h"

extern uint8_t bss_start[], bss_end[];

/* The first byte of the image, which the stub calls. */
__attribute__((section(".entry"), used)) int entry(struct dos *dos);
int entry(struct dos *dos)
{
    uint8_t *to = bss_start;
    while (to < bss_end)
        *to++ = 0;
    return dos_main(dos);
}

void *memset(void *to, int byte, size_t bytes);
void *memset(void *to, int byte, size_t bytes)
{
    void *next = to;
    __asm__ volatile("rep stosb" : "+D"(next), "+c"(bytes) : "a"(byte) : "memory");
    return to;
}

void *memcpy(void *to, const void *from, size_t bytes);
void *memcpy(void *to, const void *from, size_t bytes)
{
    void *next = to;
    size_t words = bytes / 4, rest = bytes % 4;
    __asm__ volatile("rep movsl" : "+D"(next), "+S"(from), "+c"(words) : : "memory");
    __asm__ volatile("rep movsb" : "+D"(next), "+S"(from), "+c"(rest) : : "memory");
    return to;
}

void *memmove(void *to, const void *from, size_t bytes);
void *memmove(void *to, const void *from, size_t bytes)
{
    uint8_t *next = to;
    const uint8_t *byte = from;
    if (next - byte < 0 || (size_t)(next - byte) >= bytes)
        return memcpy(to, from, bytes);
    while (bytes-- > 0)
        next[bytes] = byte[bytes];
    return to;
}

int memcmp(const void *a, const void *b, size_t bytes);
int memcmp(const void *a, const void *b, size_t bytes)
{
    const uint8_t *one = a, *other = b;
    for (; bytes > 0; bytes--, one++, other++)
        if (*one != *other)
            return *one < *other ? -1 : 1;
    return 0;
}
