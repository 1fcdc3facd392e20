/* A triangle loop of 1997 beside m13_draw: holes, pixels drawn twice, and time. cc replace.c -lmode13h -lm
 * The loop sums float slopes, includes both ends of each row, and clamps each shade. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "mode13h.h"
enum { WIDTH = 320, HEIGHT = 200, ROUND = 64, SIDE = 32, ROUNDS = 400 };
struct vertex { float x, y, shade; };
static uint8_t pixels[WIDTH * HEIGHT], hits[WIDTH * HEIGHT];
static struct vertex vertices[ROUND * SIDE];
static uint16_t indices[6 * ROUND * SIDE];
static int is_counting; /* counts each pixel instead of drawing it */

static void edge_of_1997(const struct vertex *a, const struct vertex *b, float left[2][HEIGHT], float right[2][HEIGHT])
{
    int y, first = (int)ceilf(a->y), last = (int)b->y;
    float slope, x, shade_slope, shade;
    slope = a->y == b->y ? 0 : (b->x - a->x) / (b->y - a->y);
    shade_slope = a->y == b->y ? 0 : (b->shade - a->shade) / (b->y - a->y);
    x = a->x + slope * ((float)first - a->y);
    shade = a->shade + shade_slope * ((float)first - a->y);
    for (y = first; y <= last; y++, x += slope, shade += shade_slope) {
        if (y < 0 || y >= HEIGHT) continue;
        if (x < left[0][y]) left[0][y] = x, left[1][y] = shade;
        if (x > right[0][y]) right[0][y] = x, right[1][y] = shade;
    }
}

static void triangle_of_1997(const struct vertex *corners[3])
{
    static float left[2][HEIGHT], right[2][HEIGHT];
    int i, x, y, first = HEIGHT, last = -1;
    for (i = 0; i < 3; i++) {
        first = corners[i]->y < (float)first ? (int)corners[i]->y : first;
        last = corners[i]->y > (float)last ? (int)corners[i]->y : last;
    }
    for (y = first < 0 ? first = 0 : first, last = last < HEIGHT ? last : HEIGHT - 1; y <= last; y++)
        left[0][y] = 1e9f, right[0][y] = -1e9f;
    for (i = 0; i < 3; i++) {
        const struct vertex *a = corners[i], *b = corners[(i + 1) % 3];
        edge_of_1997(a->y > b->y ? b : a, a->y > b->y ? a : b, left, right);
    }
    for (y = first; y <= last; y++) {
        int x0 = (int)left[0][y], x1 = (int)right[0][y];
        float step = x1 > x0 ? (right[1][y] - left[1][y]) / (float)(x1 - x0) : 0, shade = left[1][y];
        if (right[0][y] < left[0][y]) continue;
        for (x = x0; x <= x1; x++, shade += step) {
            float clamped = shade < 0 ? 0 : shade > 255 ? 255 : shade;
            if (x >= 0 && x < WIDTH && is_counting)
                hits[y * WIDTH + x]++;
            else if (x >= 0 && x < WIDTH)
                pixels[y * WIDTH + x] = (uint8_t)clamped;
        }
    }
}
static void report(const char *who, double seconds)
{
    int i, holes = 0, doubles = 0, outside = 0;
    for (i = 0; i < WIDTH * HEIGHT; i++) {
        float x = (float)(i % WIDTH) + 0.5f - WIDTH / 2, y = (float)(i / WIDTH) + 0.5f - HEIGHT / 2;
        holes += x * x + y * y < 89.5f * 89.5f && hits[i] == 0;
        doubles += hits[i] > 1;
        outside += x * x + y * y > 90.0f * 90.0f && hits[i] > 0;
    }
    printf("%-7s %6.0f ns a triangle, %4d holes, %5d pixels drawn twice, %3d outside\n", who,
           seconds * 1e9 / ROUNDS / (2 * ROUND * (SIDE - 1)), holes, doubles, outside);
}

int main(void)
{
    static uint8_t one_more[65536], memory[300000];
    m13_context *context;
    m13_target frame;
    m13_mesh mesh;
    m13_material material;
    int i, j, k, count = 0;
    clock_t then;
    for (j = 0; j < SIDE; j++) /* a disc of rings */
        for (i = 0; i < ROUND; i++) {
            float r = 90.0f * (float)j / (SIDE - 1), angle = (float)(i + j % 2 * 0.5) * 6.2831853f / ROUND;
            vertices[j * ROUND + i] =
                (struct vertex){ WIDTH / 2 + r * cosf(angle), HEIGHT / 2 + r * sinf(angle), 130 + 125 * sinf(3 * angle) };
        }
    for (j = 0; j + 1 < SIDE; j++)
        for (i = 0; i < ROUND; i++) {
            int next = (i + 1) % ROUND, own = i + (j % 2), a = j * ROUND, b = a + ROUND; /* rings are half a step apart */
            int quad[6] = { a + i, a + next, b + own % ROUND, a + i, b + own % ROUND, b + (own + ROUND - 1) % ROUND };
            for (k = 0; k < 6; k++)
                indices[count++] = (uint16_t)quad[k];
        }
    for (is_counting = 1; is_counting >= 0; is_counting--)
        for (then = clock(), k = 0; k < (is_counting ? 1 : ROUNDS); k++)
            for (i = 0; i < count; i += 3) {
                const struct vertex *t[] = { vertices + indices[i], vertices + indices[i + 1], vertices + indices[i + 2] };
                triangle_of_1997(t);
            }
    report("1997", (double)(clock() - then) / CLOCKS_PER_SEC);

    m13_target_init(&frame, pixels, sizeof pixels, WIDTH, HEIGHT, WIDTH);
    m13_mesh_init(&mesh, vertices, ROUND * SIDE, sizeof vertices[0]);
    mesh.shade = offsetof(struct vertex, shade);
    mesh.indices = indices, mesh.index_count = (uint32_t)count;
    m13_material_init(&material, M13_GOURAUD);
    for (then = clock(), k = 0; k < ROUNDS; k++)
        m13_draw(&frame, &mesh, &material, NULL, NULL);
    then = clock() - then;
    for (i = 0; i < 65536; i++) /* counted by a blend: the frame's index plus one */
        one_more[i] = (uint8_t)((i & 255) + 1);
    frame.pixels = memset(hits, 0, sizeof hits);
    material.blend_table = one_more;
    m13_init(memory + (16 - (uintptr_t)memory % 16) % 16, sizeof memory - 16, &context);
    k = m13_draw(&frame, &mesh, &material, context, NULL);
    report("mode13h", (double)then / CLOCKS_PER_SEC);
    return k != M13_OK;
}
