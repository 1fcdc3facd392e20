/* A lit cube, drawn with 16-bit depths, and written as cube.pcx: cc cube.c -lmode13h -lm */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "mode13h.h"

enum { WIDTH = 320, HEIGHT = 200 };

/* A corner in this program's own format; `layout` tells m13_draw where to find the numbers it reads. */
struct corner {
    float shade;
    float x, y, w; /* x / w and y / w are pixels */
};

static uint8_t pixels[WIDTH * HEIGHT];
static uint16_t depths[WIDTH * HEIGHT];
static uint8_t palette[768];

static void check(int code)
{
    if (code != M13_OK) {
        fprintf(stderr, "cube: %s\n", m13_message(code));
        exit(1);
    }
}

static void project(struct corner *to, const float at[3], float shade)
{
    float distance = 4.0f - at[2];
    to->x = WIDTH / 2 * distance + at[0] * 190.0f; /* pixels of a VGA are higher than wide: 6 to 5 */
    to->y = HEIGHT / 2 * distance - at[1] * 190.0f * 5 / 6;
    to->w = distance;
    to->shade = shade;
}

static int write_pcx(const char *name)
{
    uint8_t header[128] = { 10, 5, 1, 8, 0, 0, 0, 0, (WIDTH - 1) & 255, (WIDTH - 1) >> 8, HEIGHT - 1, 0 };
    FILE *file = fopen(name, "wb");
    int i, is_written;
    if (file == NULL)
        return 0;
    header[65] = 1;
    header[66] = WIDTH & 255;
    header[67] = WIDTH >> 8;
    header[68] = 1;
    fwrite(header, 1, sizeof header, file);
    for (i = 0; i < WIDTH * HEIGHT; i++) {
        int run = 1;
        while (run < 63 && (i + 1) % WIDTH != 0 && pixels[i + 1] == pixels[i])
            i++, run++;
        if (run > 1 || pixels[i] >= 0xC0)
            putc(0xC0 | run, file);
        putc(pixels[i], file);
    }
    putc(12, file);
    fwrite(palette, 1, sizeof palette, file);
    is_written = !ferror(file);
    return fclose(file) == 0 && is_written;
}

int main(void)
{
    static const uint8_t sides[6][4] = { { 0, 1, 3, 2 }, { 5, 4, 6, 7 }, { 4, 0, 2, 6 },
                                         { 1, 5, 7, 3 }, { 2, 3, 7, 6 }, { 4, 5, 1, 0 } };
    static const float normals[6][3] = { { 0, 0, 1 }, { 0, 0, -1 }, { -1, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 } };
    struct corner corners[24];
    uint16_t indices[36];
    m13_target frame;
    m13_mesh mesh;
    m13_material material;
    m13_stats stats = { sizeof stats, 0, 0, 0, 0, 0 };
    int side, k, axis;
    float c = cosf(0.7f), s = sinf(0.7f), ct = cosf(0.5f), st = sinf(0.5f);

    for (side = 0; side < 6; side++) {
        static const uint8_t fan[6] = { 0, 1, 2, 0, 2, 3 };
        for (k = 0; k < 4; k++) {
            int corner = sides[side][k];
            float at[2][3] = { { corner & 1 ? 1.0f : -1.0f, corner & 2 ? 1.0f : -1.0f, corner & 4 ? -1.0f : 1.0f } };
            float turned[2][3], light;
            for (axis = 0; axis < 3; axis++)
                at[1][axis] = normals[side][axis];
            for (axis = 0; axis < 2; axis++) { /* the position, then the normal */
                float x = c * at[axis][0] + s * at[axis][2], z = c * at[axis][2] - s * at[axis][0];
                turned[axis][0] = x;
                turned[axis][1] = ct * at[axis][1] - st * z;
                turned[axis][2] = st * at[axis][1] + ct * z;
            }
            light = turned[1][0] * 0.4f + turned[1][1] * 0.5f + turned[1][2] * 0.77f;
            /* The ramp's entries are 16 to 255. A little less light from corner to corner. */
            project(&corners[4 * side + k], turned[0], 40.0f + 180.0f * fmaxf(light, 0.0f) + 10.0f * (float)k);
        }
        for (k = 0; k < 6; k++)
            indices[6 * side + k] = (uint16_t)(4 * side + fan[k]);
    }
    check(m13_palette_ramp(palette, 16, 240, 0x100804, 0xFFE0A0));
    check(m13_target_init(&frame, pixels, sizeof pixels, WIDTH, HEIGHT, WIDTH));
    check(m13_target_depth(&frame, depths, sizeof depths, 16));
    check(m13_clear(&frame, 16));
    check(m13_clear_depth(&frame));
    check(m13_mesh_init(&mesh, corners, 24, sizeof corners[0]));
    mesh.position = offsetof(struct corner, x);
    mesh.shade = offsetof(struct corner, shade);
    mesh.homogeneous = 1;
    mesh.indices = indices;
    mesh.index_count = 36;
    check(m13_material_init(&material, M13_GOURAUD));
    material.cull = M13_CULL_CLOCKWISE; /* sides are counter-clockwise from outside */
    check(m13_draw(&frame, &mesh, &material, NULL, &stats));
    printf("%u triangles, %u pixels, by %s\n", (unsigned)stats.triangles, (unsigned)stats.pixels, m13_kernel());
    return write_pcx("cube.pcx") ? 0 : 1;
}
