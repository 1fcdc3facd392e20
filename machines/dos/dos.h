/* The services of the stub for a 32-bit program, which machines/dos/link turns into a program for DOS. The program begins
 * in dos_main, and ends when that returns its exit status.
 *
 * Addresses are flat, and 0 is where the program was loaded. Interrupts are off, except while one is called: key
 * presses wait until then. */
#ifndef DOS_H
#define DOS_H

#include <stdint.h>

/* The stub's table. */
struct dos {
    const uint8_t *unused;
    uint32_t unused_bytes;
    uint8_t *stack_top;
    uint32_t heap_kb;       /* of extended memory, as set by `--heap` */
    uint8_t *heap;          /* where it begins, aligned to 16 */
    uint8_t *low;           /* linear address 0 */
    const uint8_t *command; /* the command line: a byte with its length, then its characters */
    void (*service)(void);  /* calls interrupt `number` of DOS or the BIOS in real mode, with these registers */
    uint32_t eax, ebx, ecx, edx, ds, number;
    uint32_t flags;       /* as the interrupt left them */
    uint32_t segment;     /* the program's, for what DS points to */
    uint8_t buffer[1024]; /* at DOS_BUFFER in that segment: what an interrupt reads or writes */
};
enum { DOS_BUFFER = 4 + 64 };

int dos_main(struct dos *dos);

/* Calls an interrupt with DS at the program's segment. Returns AX, or -1 if the carry flag is set. */
static inline int dos_interrupt(struct dos *dos, uint8_t number, uint16_t ax, uint16_t bx, uint16_t cx, uint16_t dx)
{
    dos->number = number;
    dos->eax = ax, dos->ebx = bx, dos->ecx = cx, dos->edx = dx, dos->ds = dos->segment;
    dos->service();
    return dos->flags & 1 ? -1 : (int)(dos->eax & 0xFFFF);
}

/* Sets a mode of the BIOS: 0x13 is 320 x 200 bytes, 3 is text. */
static inline void dos_set_mode(struct dos *dos, uint8_t mode) { dos_interrupt(dos, 0x10, mode, 0, 0, 0); }

/* The bytes of mode 13h, and a frame copied there. */
static inline uint8_t *dos_screen(struct dos *dos) { return dos->low + 0xA0000; }
static inline void dos_show(struct dos *dos, const uint8_t pixels[64000])
{
    uint8_t *to = dos_screen(dos);
    uint32_t count = 16000;
    __asm__ volatile("rep movsl" : "+D"(to), "+S"(pixels), "+c"(count) : : "memory");
}

static inline void dos_out(uint16_t port, uint8_t value) { __asm__ volatile("outb %0, %1" : : "a"(value), "Nd"(port)); }
static inline uint8_t dos_in(uint16_t port)
{
    uint8_t value;
    __asm__ volatile("inb %1, %0" : "=a"(value) : "Nd"(port));
    return value;
}

/* Loads the 256 colours of the DAC, 6 bits a part. */
static inline void dos_set_dac(const uint8_t dac[768])
{
    int i;
    dos_out(0x3C8, 0);
    for (i = 0; i < 768; i++)
        dos_out(0x3C9, dac[i]);
}

/* Waits until the vertical retrace begins. */
static inline void dos_wait_for_retrace(void)
{
    while (dos_in(0x3DA) & 8)
        ;
    while (!(dos_in(0x3DA) & 8))
        ;
}

/* The next key, its character below its scan code; 0 if there is none. */
static inline int dos_key(struct dos *dos)
{
    dos_interrupt(dos, 0x16, 0x0100, 0, 0, 0);
    return dos->flags & 0x40 ? 0 : dos_interrupt(dos, 0x16, 0, 0, 0, 0) & 0xFFFF;
}

/* Writes bytes to an open file; 1 is the program's output. Returns whether all were written. */
static inline int dos_write(struct dos *dos, int file, const uint8_t *bytes, uint32_t count)
{
    while (count > 0) {
        uint32_t part = count < sizeof dos->buffer ? count : sizeof dos->buffer, i;
        for (i = 0; i < part; i++)
            dos->buffer[i] = bytes[i];
        if (dos_interrupt(dos, 0x21, 0x4000, (uint16_t)file, (uint16_t)part, DOS_BUFFER) != (int)part)
            return 0;
        bytes += part, count -= part;
    }
    return 1;
}

/* Writes a file, which is overwritten. Returns whether all of it was written. */
static inline int dos_save(struct dos *dos, const char *name, const uint8_t *bytes, uint32_t count)
{
    int file, i, is_written;
    for (i = 0; i < 127 && name[i] != 0; i++)
        dos->buffer[i] = (uint8_t)name[i];
    dos->buffer[i] = 0;
    file = dos_interrupt(dos, 0x21, 0x3C00, 0, 0, DOS_BUFFER);
    if (file < 0)
        return 0;
    is_written = dos_write(dos, file, bytes, count);
    return dos_interrupt(dos, 0x21, 0x3E00, (uint16_t)file, 0, 0) >= 0 && is_written;
}

/* The first number of the command line; -1 if there is none. */
static inline int dos_argument(const struct dos *dos)
{
    int number = -1, i;
    for (i = 1; i <= dos->command[0]; i++) {
        int digit = dos->command[i] - '0';
        if (digit >= 0 && digit <= 9)
            number = (number < 0 ? 0 : number % 100000 * 10) + digit;
        else if (number >= 0)
            break;
    }
    return number;
}

#endif
