/* Allegro 4's polygon3d and a function that takes its place: their pictures side by side, and their times.
 *     cc allegro4.c -lmode13h `allegro-config --libs` */
#include <allegro.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <time.h>

#include "mode13h.h"
enum { WIDTH = 320, HEIGHT = 200, AROUND = 48, ACROSS = 24, ROUNDS = 300 };

static uint8_t texels[64 * 64], shades[65536], palette[768];
static uint32_t context_memory[64 * 1024];
static m13_context *context;
static struct { fixed x, y, u, v, shade; } list[4096];
static uint32_t listed;
static struct { BITMAP *bitmap, *texture; int type; } of;

/* Draws the collected triangles. A program calls it before it shows or reads the bitmap. */
static void flush(void)
{
    m13_target target;
    m13_mesh mesh;
    m13_material material;
    BITMAP *to = of.bitmap;
    size_t pitch;
    if (listed == 0) return;
    pitch = to->h > 1 ? (size_t)(to->line[1] - to->line[0]) : (size_t)to->w; /* a part of a bitmap has its parent's */
    m13_target_init(&target, to->line[0], pitch * (size_t)(to->h - 1) + (size_t)to->w, (uint32_t)to->w, (uint32_t)to->h, pitch);
    m13_target_clip(&target, to->cl, to->ct, to->cr, to->cb);
    m13_mesh_init(&mesh, list, listed, sizeof list[0]);
    mesh.texture = 8, mesh.shade = 16;
    m13_material_init(&material, M13_GOURAUD_8_8);
    if (of.type == POLYTYPE_ATEX || of.type == POLYTYPE_ATEX_LIT) {
        material.texels = of.texture->dat;
        material.u_bits = material.v_bits = 6;
        material.shade_table = of.type == POLYTYPE_ATEX_LIT ? shades : NULL;
    }
    m13_draw_x(&target, &mesh, &material, context, NULL);
    listed = 0;
}

/* Replaces polygon3d: Allegro's types, corners and bitmaps. u, v are 16.16, c is a shade of 0 to 255. */
static void m13_polygon3d(BITMAP *bitmap, int type, BITMAP *texture, int count, V3D *corners[])
{
    int i, k;
    if (bitmap != of.bitmap || type != of.type || texture != of.texture)
        flush();
    of.bitmap = bitmap, of.type = type, of.texture = texture;
    for (i = 2; i < count; i++) {
        if (listed + 3 > sizeof list / sizeof list[0])
            flush();
        for (k = 0; k < 3; k++, listed++) {
            V3D *v = corners[k == 0 ? 0 : i - 2 + k];
            list[listed].x = v->x, list[listed].y = v->y, list[listed].u = v->u, list[listed].v = v->v;
            list[listed].shade = (type == POLYTYPE_FLAT ? corners[0]->c : v->c) << 16; /* equal shades are flat */
        }
    }
}

static void corner(V3D *to, int i, int j)
{
    double a = i * 6.2831853 / AROUND, b = j * 6.2831853 / ACROSS, r = 1.0 + 0.4 * cos(b);
    double x = r * cos(a), y = r * sin(a) * 0.8 + 0.24 * sin(b), z = 2.6 - r * sin(a) * 0.6 + 0.32 * sin(b);
    to->x = ftofix(WIDTH / 4 + 135 * x / z), to->y = ftofix(HEIGHT / 2 + 113 * y / z), to->z = ftofix(z);
    to->u = itofix(i * 8), to->v = itofix(j * 8);
    to->c = (int)(125 + 125 * (0.5 * cos(b) * cos(a) - 0.6 * sin(b) - 0.5 * sin(a) * cos(b)));
}

typedef void painter(BITMAP *, int, BITMAP *, int, V3D **);
static double draw(BITMAP *bitmap, BITMAP *texture, int type, painter *paint)
{
    static V3D grid[AROUND + 1][ACROSS + 1];
    clock_t then;
    int i, j, round;
    for (i = 0; i <= AROUND; i++)
        for (j = 0; j <= ACROSS; j++)
            corner(&grid[i][j], i, j);
    for (then = clock(), round = 0; round < ROUNDS; round++)
        for (i = 0; i < AROUND; i++)
            for (j = 0; j < ACROSS; j++) {
                V3D *quad[4] = { &grid[i][j], &grid[i + 1][j], &grid[i + 1][j + 1], &grid[i][j + 1] };
                fixed area = fixmul(quad[1]->x - quad[0]->x, quad[2]->y - quad[0]->y) -
                             fixmul(quad[2]->x - quad[0]->x, quad[1]->y - quad[0]->y);
                if (area < 0) paint(bitmap, type, texture, 4, quad);
            }
    flush();
    return (double)(clock() - then) / CLOCKS_PER_SEC * 1e9 / ROUNDS / (AROUND * ACROSS / 2);
}

int main(void)
{
    BITMAP *screen_of_both, *left, *right, *texture;
    COLOR_MAP light;
    PALETTE colors;
    uint8_t *aligned = (uint8_t *)context_memory + (16 - (uintptr_t)context_memory % 16) % 16;
    static const char *names[] = { "flat", "shaded", "textured", "textured, lit" };
    static const int types[] = { POLYTYPE_FLAT, POLYTYPE_GCOL, POLYTYPE_ATEX, POLYTYPE_ATEX_LIT };
    int i;
    if (install_allegro(SYSTEM_NONE, &errno, NULL) != 0 || m13_init(aligned, m13_size(), &context) != M13_OK) return 1;
    set_color_depth(8);
    screen_of_both = create_bitmap(WIDTH, 4 * HEIGHT), left = create_bitmap(WIDTH / 2, HEIGHT);
    right = create_bitmap(WIDTH / 2, HEIGHT), texture = create_bitmap(64, 64);
    clear(screen_of_both);
    m13_palette_ramp(palette, 0, 256, 0x000008, 0xFFE8C0);
    m13_palette_to_dac(palette, texels);
    for (i = 0; i < 256; i++)
        colors[i].r = texels[3 * i], colors[i].g = texels[3 * i + 1], colors[i].b = texels[3 * i + 2];
    m13_table_shades(palette, NULL, shades);
    for (i = 0; i < 65536; i++)
        light.data[i >> 8][i & 255] = shades[i];
    color_map = &light;
    for (i = 0; i < 64 * 64; i++)
        texture->line[i / 64][i % 64] = (uint8_t)(((i ^ i / 64) & 8 ? 250 : 130) - (i % 8) * 6);
    for (i = 0; i < 4; i++) {
        double theirs = (clear(left), draw(left, texture, types[i], polygon3d));
        double ours = (clear(right), draw(right, texture, types[i], m13_polygon3d));
        printf("%-14s Allegro %5.0f ns a quad, mode13h %5.0f\n", names[i], theirs, ours);
        blit(left, screen_of_both, 0, 0, 0, i * HEIGHT, WIDTH / 2, HEIGHT);
        blit(right, screen_of_both, 0, 0, WIDTH / 2, i * HEIGHT, WIDTH / 2, HEIGHT);
    }
    return save_pcx("allegro4.pcx", screen_of_both, colors) != 0;
}
END_OF_MAIN()
