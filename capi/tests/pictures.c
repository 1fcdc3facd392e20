/* Draws with every part of the library, and prints hashes: the same lines on every machine and with every kernel. Without
 * an operating system it runs on a bare Cortex-M or RISC-V under QEMU, where it talks by semihosting, and in WebAssembly. */
#include "mode13h.h"

enum { WIDTH = 160, HEIGHT = 100, PITCH = 163, VERTICES = 96, INDICES = 180 };

/* A vertex: x, y, w, depth, shade, u, v, fog, and column and row of the slope table. */
enum { W = 2, DEPTH, SHADE, U, V, FOG, COLUMN, ROW, NUMBERS };

static uint8_t pixels[PITCH * HEIGHT], palette[768], texels[64 * 32], tables[5][65536], memory[0x40000];
static uint32_t depths[WIDTH * HEIGHT], vertices[VERTICES][NUMBERS], indices[INDICES], shown[WIDTH * HEIGHT];
static uint32_t state;
static uint64_t hash;

static void say(const char *line);

/* FNV-1a. */
static void add(const void *from, size_t bytes)
{
    const uint8_t *byte = from;
    while (bytes-- > 0)
        hash = (hash ^ *byte++) * 0x100000001B3u;
}

static void add_number(int number)
{
    uint8_t bytes[2];
    bytes[0] = (uint8_t)number;
    bytes[1] = (uint8_t)(number >> 8);
    add(bytes, 2);
}

static void report(const char *name)
{
    static char line[40];
    int i = 0, k;
    while (name[i] != 0)
        line[i] = name[i], i++;
    line[i++] = ' ';
    for (k = 60; k >= 0; k -= 4)
        line[i++] = "0123456789abcdef"[hash >> k & 15];
    line[i] = 0;
    say(line);
    hash = 0xCBF29CE484222325u;
}

/* Below 2^20. */
static uint32_t below(uint32_t end)
{
    state = state * 1664525u + 1013904223u;
    return (state >> 8) % end;
}

static uint32_t bits_of(float number)
{
    union {
        float number;
        uint32_t bits;
    } real;
    real.number = number;
    return real.bits;
}

/* A number of 256ths, exact through either interface. */
static void put(uint32_t *to, int32_t number, int is_fixed)
{
    *to = is_fixed ? (uint32_t)number << 8 : bits_of((float)number / 256.0f);
}

static void make_vertices(int is_homogeneous, int is_fixed)
{
    int i, k;
    for (i = 0; i < VERTICES; i++) {
        /* Some are behind the eye, and some far beyond the guard band. */
        int32_t w = is_homogeneous ? (int32_t)below(1024) - 128 : 256;
        int32_t x = (int32_t)below((WIDTH + 128) * 256) - 64 * 256, y = (int32_t)below((HEIGHT + 64) * 256) - 32 * 256;
        uint32_t *to = vertices[i], depth = below(0x100000);
        if (!is_homogeneous && below(16) == 0)
            x *= 20, y *= 20;
        put(&to[0], is_homogeneous ? x / 256 * w + (x & 255) : x, is_fixed);
        put(&to[1], is_homogeneous ? y / 256 * w + (y & 255) : y, is_fixed);
        put(&to[W], w, is_fixed);
        to[DEPTH] = is_fixed ? depth << 10 : bits_of((float)(int32_t)depth / 1048576.0f);
        for (k = SHADE; k < NUMBERS; k++)
            put(&to[k], k == U || k == V ? (int32_t)below(0x10000) - 0x8000 : (int32_t)below(0xFF01), is_fixed);
    }
}

/* Triangles of the list have all sizes. */
static void make_indices(uint32_t bits)
{
    int i;
    for (i = 0; i < INDICES; i++) {
        uint32_t index = below(VERTICES);
        if (bits == 8)
            ((uint8_t *)indices)[i] = (uint8_t)index;
        else if (bits == 16)
            ((uint16_t *)(void *)indices)[i] = (uint16_t)index;
        else
            indices[i] = index;
    }
}

static void picture(uint32_t number, int is_fixed, m13_context *context)
{
    m13_target target;
    m13_mesh mesh;
    m13_material material;
    m13_stats stats = { sizeof stats, 0, 0, 0, 0, 0 };
    int is_homogeneous = number / 5 % 2 == 1;
    m13_target_init(&target, pixels, sizeof pixels, WIDTH, HEIGHT, PITCH);
    if (number % 3 > 0)
        m13_target_depth(&target, depths, sizeof depths, 16u * (number % 3));
    if (number % 7 == 0)
        m13_target_clip(&target, 11, 7, 149, 90);
    if (number % 11 == 0)
        m13_target_band(&target, 17, 60);
    if (below(2))
        m13_clear(&target, (uint8_t)below(256));
    if (below(3))
        m13_clear_depth(&target);
    make_vertices(is_homogeneous, is_fixed);
    m13_mesh_init(&mesh, vertices, VERTICES, sizeof vertices[0]);
    mesh.depth = 4 * DEPTH, mesh.shade = 4 * SHADE, mesh.texture = 4 * U, mesh.fog = 4 * FOG, mesh.slope = 4 * COLUMN;
    mesh.homogeneous = (uint32_t)is_homogeneous;
    mesh.near_w = 0.5f, mesh.near_w_x = 0x8000;
    if (number % 4 > 0) {
        mesh.index_bits = 4u << number % 4;
        mesh.indices = indices;
        mesh.index_count = number % 13 == 0 ? 9 : INDICES;
        make_indices(mesh.index_bits);
    }
    m13_material_init(&material, number % 5);
    material.color = below(256);
    material.cull = below(4) % 3;
    if (context != NULL) {
        material.texels = below(4) ? texels : NULL;
        material.u_bits = 6, material.v_bits = 5;
        material.mapping = below(3);
        material.dither = below(3);
        material.keep_depth = below(2);
        material.shade_table = below(3) ? tables[0] : NULL;
        material.fog_table = below(3) ? NULL : tables[1];
        material.blend_table = below(3) ? NULL : tables[2 + below(2)];
        material.slope_table = below(4) ? NULL : tables[4];
    }
    add_number((is_fixed ? m13_draw_x : m13_draw)(&target, &mesh, &material, context, &stats));
    add(&stats, sizeof stats);
    add(pixels, sizeof pixels);
    add(depths, sizeof depths);
}

static void triangles(void)
{
    int i, k;
    m13_target target;
    m13_target_init(&target, pixels, sizeof pixels, WIDTH, HEIGHT, PITCH);
    m13_target_depth(&target, depths, sizeof depths, 32);
    for (i = 0; i < 100; i++) {
        m13_vertex corners[3];
        m13_vertex_x corners_x[3];
        for (k = 0; k < 3; k++) {
            int32_t x = (int32_t)below(0x10000) - 0x2000, y = (int32_t)below(0x8000) - 0x1000;
            uint32_t depth = below(0x10000), shade = below(256);
            m13_vertex corner = { 0, 0, 0, 0 };
            m13_vertex_x corner_x = { 0, 0, 0, 0 };
            corner.x = (float)x / 256.0f, corner.y = (float)y / 256.0f;
            corner.depth = (float)(int32_t)depth / 65536.0f, corner.shade = (float)(int32_t)shade;
            corner_x.x = x * 256, corner_x.y = y * 256, corner_x.depth = depth << 14, corner_x.shade = (int32_t)shade * 65536;
            corners[k] = corner, corners_x[k] = corner_x;
        }
        add_number(i % 2 ? m13_triangle(&target, corners, (uint32_t)i % 5, (uint32_t)i)
                         : m13_triangle_x(&target, corners_x, (uint32_t)i % 5, (uint32_t)i));
    }
    add(pixels, sizeof pixels);
    add(depths, sizeof depths);
}

static void colors(void)
{
    uint32_t i;
    m13_target target;
    for (i = 0; m13_palette_name(i) != NULL; i++) {
        add_number(m13_palette_named(m13_palette_name(i), palette));
        add(palette, sizeof palette);
    }
    m13_palette_ramp(palette, 96, 64, 0x100804, 0xFFE0A0);
    m13_palette_cycle(palette, 10, 50, 7);
    m13_palette_fade(palette, palette, 100, palette);
    m13_palette_to_dac(palette, palette);
    m13_palette_from_dac(palette, palette);
    add(palette, sizeof palette);
    for (i = 0; i < 20; i++)
        add_number(m13_palette_nearest(palette, below(0x100000)));
    m13_table_shades(palette, NULL, tables[0]);
    m13_table_fog(palette, 0x8090A0, tables[1]);
    m13_table_blend(palette, 150, tables[2]);
    m13_table_add(palette, tables[3]);
    for (i = 0; i < 65536; i++)
        tables[4][i] = (uint8_t)((i & 255) * (i >> 8) >> 8);
    add(tables, sizeof tables);
    m13_target_init(&target, pixels, sizeof pixels, WIDTH, HEIGHT, PITCH);
    m13_show_16(&target, palette, (uint16_t *)(void *)shown, sizeof shown, 2 * WIDTH);
    add(shown, 2 * WIDTH * HEIGHT);
    m13_show_32(&target, palette, shown, sizeof shown, 4 * WIDTH);
    add(shown, sizeof shown);
}

static int draw_all(void)
{
    static const char *const names[2][2] = { { "floats", "16.16" }, { "effects-by-floats", "effects-by-16.16" } };
    m13_context *context = NULL;
    uint32_t i, k, random[6];
    int is_fixed, has_effects;
    hash = 0xCBF29CE484222325u, state = 13;
    for (i = 0; i < 200; i++) {
        for (k = 0; k < 4; k++) /* arguments may be evaluated in any order */
            random[k] = below(0x10000);
        add_number(m13_span(pixels + random[0] % 100, random[1] % 1000, (uint16_t)random[2], (uint16_t)random[3]));
    }
    add(pixels, sizeof pixels);
    report("spans");
    triangles();
    report("triangles");
    colors();
    report("colors");
    for (has_effects = 0; has_effects <= (m13_size() > 0); has_effects++) {
        if (has_effects) {
            uint8_t *start = memory + (16 - (uintptr_t)memory % 16) % 16;
            if (m13_size() > sizeof memory - 16 || m13_init(start, m13_size(), &context) != M13_OK)
                return 1;
            for (i = 0; i < sizeof texels; i++)
                texels[i] = (uint8_t)(i * 7 ^ i / 64 * 5);
            for (i = 0; i < 100; i++) {
                for (k = 0; k < 6; k++)
                    random[k] = below(0x40000);
                m13_span_texture(pixels + random[0] % 100, random[1] % 1000, texels, 6, 5, 4 * random[2], 4 * random[3],
                                 random[4], 0u - random[5]);
            }
            add(pixels, sizeof pixels);
        }
        for (is_fixed = 0; is_fixed < 2; is_fixed++) {
            for (i = 0; i < 120; i++)
                picture(i, is_fixed, context);
            report(names[has_effects][is_fixed]);
        }
    }
    return 0;
}

#if defined __wasm__

__attribute__((import_module("host"), import_name("say"))) void say_line(const char *line);
static void say(const char *line) { say_line(line); }
__attribute__((export_name("draw_all"))) int start(void);
int start(void) { return draw_all(); }

#elif defined __arm__ || defined __riscv

/* Semihosting: a call to the debugger, or to QEMU in its place. */
static void host(unsigned operation, uintptr_t argument)
{
#ifdef __arm__
    register unsigned to __asm__("r0") = operation;
    register uintptr_t with __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(to) : "r"(with) : "memory");
#else
    register unsigned to __asm__("a0") = operation;
    register uintptr_t with __asm__("a1") = argument;
    __asm__ volatile(".balign 16\n.option push\n.option norvc\nslli zero, zero, 0x1f\nebreak\nsrai zero, zero, 7\n.option pop"
                     : "+r"(to) : "r"(with) : "memory");
#endif
}
static void say(const char *line)
{
    host(4, (uintptr_t)line); /* SYS_WRITE0 */
    host(4, (uintptr_t)"\n");
}

void start(void);
void start(void)
{
    int is_wrong = draw_all();
    for (;;)
        host(0x18, is_wrong ? 0x20023 : 0x20026); /* SYS_EXIT: with a run-time error, or as it should */
}
#ifdef __arm__
__attribute__((section(".reset"), used)) static void (*const reset)(void) = start; /* above it is the top of the stack */
#else
__asm__(".section .reset, \"ax\"\n.globl _start\n_start: la sp, stack_top\ntail start\n.text");
#endif

#else

#include <stdio.h>
static void say(const char *line) { puts(line); }
int main(void) { return draw_all(); }

#endif

#if defined __wasm__ || defined __arm__ || defined __riscv

/* Compilers call these in any case. */
void *memset(void *to, int byte, size_t bytes);
void *memset(void *to, int byte, size_t bytes)
{
    uint8_t *next = to;
    while (bytes-- > 0)
        *next++ = (uint8_t)byte;
    return to;
}
void *memcpy(void *to, const void *from, size_t bytes);
void *memcpy(void *to, const void *from, size_t bytes)
{
    uint8_t *next = to;
    const uint8_t *byte = from;
    while (bytes-- > 0)
        *next++ = *byte++;
    return to;
}

#endif
