/* A textured, lit torus on a 386 with a VGA, by integers alone:
 *     capi/build --target i386
 *     machines/dos/link capi/examples/dos.c target/c/i386/libmode13h.a -I target/c/i386 -o TORUS.EXE
 * It turns until you press a key. TORUS.EXE 20 writes frame 20 to FRAME.BIN, as this file does on a modern machine. */
#include "mode13h.h"
#ifdef DOS
#include "dos.h"
#else
#include <stdio.h>
#include <stdlib.h>
#endif

enum { WIDTH = 320, HEIGHT = 200, AROUND = 32, ACROSS = 16, ONE = 65536, MEMORY = 1 << 20 };

struct vertex {
    int32_t x, y, w, u, v, shade; /* 16.16; x / w and y / w are pixels */
};

static struct world { /* in extended memory */
    uint8_t pixels[WIDTH * HEIGHT], shades[65536], texels[64 * 64], palette[768], dac[768];
    uint16_t depths[WIDTH * HEIGHT], indices[6 * AROUND * ACROSS];
    struct vertex vertices[(AROUND + 1) * (ACROSS + 1)];
    m13_context *context;
} *world;

static int32_t sines[256];
static int32_t sine(int angle) { return sines[angle & 255]; } /* the angle is in 256ths of a circle */
static int32_t cosine(int angle) { return sine(angle + 64); }
static int32_t times(int32_t a, int32_t b) { return (int32_t)((int64_t)a * b >> 16); }

static int make(uint8_t *memory)
{
    static const uint32_t colors[4] = { 0xC8B8A8, 0xFFD850, 0x5080FF, 0xFFA838 }; /* grout, gold, lapis, the gold's edge */
    int64_t last = -26350943, next = 0, after; /* sines by their recurrence, in 2.30 */
    int i, j, k;
    for (i = 0; i < 256; i++, last = next, next = after)
        sines[i] = (int32_t)(next >> 14), after = (2146836866 * next >> 30) - last;
    world = (struct world *)(void *)memory;
    for (i = 0; i < 4; i++) { /* 64 shades of each */
        m13_palette_ramp(world->palette, 64 * (uint32_t)i, 64, 0, colors[i]);
        for (j = 0; j < 256; j++)
            world->shades[256 * j + i] = (uint8_t)(64 * i + j / 4);
    }
    m13_palette_to_dac(world->palette, world->dac);
    for (i = 0; i < 64 * 64; i++) {
        int x = i % 16, y = i / 64 % 16, is_gold = (i ^ i / 64) & 16;
        world->texels[i] = x == 0 || y == 0 ? 0 : !is_gold ? 2 : x < 3 || y < 3 ? 3 : 1;
    }
    for (i = 0; i < AROUND * ACROSS; i++) {
        int a = i / ACROSS * (ACROSS + 1) + i % ACROSS, b = a + ACROSS + 1, quad[6] = { a, b, b + 1, a, b + 1, a + 1 };
        for (k = 0; k < 6; k++)
            world->indices[6 * i + k] = (uint16_t)quad[k];
    }
    return m13_init(memory + MEMORY - (m13_size() + 15) / 16 * 16, m13_size(), &world->context) == M13_OK;
}

static void turn(int32_t p[3], int angle)
{
    int32_t y = times(cosine(angle), p[1]) - times(sine(angle), p[2]), z = times(sine(angle), p[1]) + times(cosine(angle), p[2]);
    int32_t x = p[0], c = cosine(3 * angle / 2), s = sine(3 * angle / 2);
    p[0] = times(c, x) + times(s, z), p[1] = y, p[2] = times(c, z) - times(s, x);
}

static int draw(int frame)
{
    int i;
    m13_target target;
    m13_mesh mesh;
    m13_material material;
    for (i = 0; i < (AROUND + 1) * (ACROSS + 1); i++) {
        struct vertex *to = &world->vertices[i];
        int a = i / (ACROSS + 1), b = i % (ACROSS + 1);
        int32_t c = cosine(a * 256 / AROUND), s = sine(a * 256 / AROUND), across = cosine(b * 256 / ACROSS), light;
        int32_t normal[3] = { times(across, c), times(across, s), sine(b * 256 / ACROSS) };
        int32_t at[3] = { c + normal[0] * 2 / 5, s + normal[1] * 2 / 5, normal[2] * 2 / 5 };
        turn(at, 2 * frame), turn(normal, 2 * frame);
        light = normal[0] / 2 + normal[1] / 2 + normal[2] * 7 / 10;
        to->w = 3 * ONE - at[2];
        to->x = WIDTH / 2 * to->w + 210 * at[0];
        to->y = HEIGHT / 2 * to->w - 175 * at[1]; /* pixels of a VGA are higher than wide: 6 to 5 */
        to->u = a * (256 / AROUND) * ONE, to->v = b * (128 / ACROSS) * ONE;
        to->shade = 40 * ONE + 210 * (light > 0 ? light : 0);
    }
    m13_target_init(&target, world->pixels, sizeof world->pixels, WIDTH, HEIGHT, WIDTH);
    m13_target_depth(&target, world->depths, sizeof world->depths, 16);
    m13_clear(&target, 0), m13_clear_depth(&target);
    m13_mesh_init(&mesh, world->vertices, (AROUND + 1) * (ACROSS + 1), sizeof(struct vertex));
    mesh.homogeneous = 1, mesh.texture = offsetof(struct vertex, u), mesh.shade = offsetof(struct vertex, shade);
    mesh.indices = world->indices, mesh.index_count = 6 * AROUND * ACROSS;
    m13_material_init(&material, M13_GOURAUD), material.cull = M13_CULL_CLOCKWISE, material.mapping = M13_EVERY_16;
    material.texels = world->texels, material.u_bits = material.v_bits = 6, material.shade_table = world->shades;
    return m13_draw_x(&target, &mesh, &material, world->context, NULL) == M13_OK;
}

#ifdef DOS
int dos_main(struct dos *dos)
{
    int frame = dos_argument(dos), is_once = frame >= 0, is_right = make(dos->heap);
    dos_set_mode(dos, 0x13);
    dos_set_dac(world->dac);
    frame = is_once ? frame : 0;
    do {
        is_right = is_right && draw(frame++);
        dos_wait_for_retrace();
        dos_show(dos, world->pixels);
    } while (is_right && !is_once && dos_key(dos) == 0);
    is_right = is_right && (!is_once || dos_save(dos, "FRAME.BIN", dos_screen(dos), WIDTH * HEIGHT));
    dos_set_mode(dos, 3);
    return !is_right;
}
#else
int main(int count, char **words)
{
    uint8_t *memory = malloc(MEMORY);
    FILE *file = fopen("FRAME.BIN", "wb");
    int is_right = memory != NULL && file != NULL && make(memory) && draw(count > 1 ? atoi(words[1]) : 0);
    return !(is_right && fwrite(world->pixels, WIDTH * HEIGHT, 1, file) == 1 && fclose(file) == 0);
}
#endif
