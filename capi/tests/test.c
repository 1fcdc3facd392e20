/* Tests every function with valid and with invalid arguments. Canaries surround everything that is written.
 *     test [SEED]    exit status 1, and a line for each failure */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mode13h.h"

static int wrong;
static unsigned long checks;

#define CHECK(what)                                                        \
    do {                                                                   \
        checks++;                                                          \
        if (!(what))                                                       \
            wrong++, printf("test.c:%d: %s\n", __LINE__, #what);           \
    } while (0)
#define IS(code, call)                                                     \
    do {                                                                   \
        int is_ = (call);                                                  \
        checks++;                                                          \
        if (is_ != (code))                                                 \
            wrong++, printf("test.c:%d: %s is %d (%s), not %s\n", __LINE__, #call, is_, m13_message(is_), #code); \
    } while (0)

/* Memory on the heap, so that tools see each byte beyond it, with canaries for the reach of plain runs. */
enum { MARGIN = 64 };
static uint8_t *guarded(size_t bytes)
{
    uint8_t *all = malloc(bytes + 2 * MARGIN);
    if (all == NULL)
        exit(2);
    memset(all, 0xC5, bytes + 2 * MARGIN);
    memset(all + MARGIN, 0, bytes);
    return all + MARGIN;
}
static void release(uint8_t *memory, size_t bytes)
{
    size_t i;
    for (i = 0; i < MARGIN; i++)
        if (memory[bytes + i] != 0xC5 || memory[(ptrdiff_t)i - MARGIN] != 0xC5) {
            wrong++;
            printf("test.c: a canary is dead, %d bytes from the end of %lu\n", (int)i, (unsigned long)bytes);
            break;
        }
    free(memory - MARGIN);
}

static uint64_t state;
static uint32_t random_number(void)
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(state >> 33) * 2u ^ (uint32_t)(state >> 57);
}
static uint32_t below(uint32_t end) { return random_number() % end; }
/* A number that is often at an edge of what is legal. */
static uint32_t odd_number(uint32_t usual)
{
    static const uint32_t odd[] = { 0,     1,     2,          3,          4,          15,         16,         17,        32,         4095,
                                    4096,  4097,  65535,      65536,      0x7FFFFFFF, 0x80000000, 0xFFFFFFFE, 0xFFFFFFFF };
    return below(4) ? below(usual + 1) : odd[below(sizeof odd / sizeof odd[0])];
}
static float odd_float(float usual)
{
    switch (below(16)) {
    case 0: return NAN;
    case 1: return INFINITY;
    case 2: return -INFINITY;
    case 3: return 3e38f;
    case 4: return -3e38f;
    case 5: return 1e-45f;
    case 6: return 0.0f;
    case 7: return usual * 100.0f;
    default: return ((float)below(0x1000000) / 8388608.0f - 0.5f) * usual;
    }
}

static void codes(void)
{
    int code;
    CHECK(m13_version() == M13_VERSION);
    CHECK(strcmp(m13_message(M13_OK), "no error") == 0);
    for (code = -1000; code < 1000; code++)
        CHECK(strlen(m13_message(code)) > 4);
    CHECK(strcmp(m13_message(M13_UNSUPPORTED), m13_message(M13_UNSUPPORTED - 1)) != 0);
    CHECK(strlen(m13_kernel()) > 2);
}

static void targets(void)
{
    uint8_t *pixels = guarded(10 * 7 - 3), *depth = guarded(7 * 7 * 4);
    m13_target t, unset;
    int x, y;
    memset(&unset, 0, sizeof unset);
    IS(M13_OK, m13_target_init(&t, pixels, 10 * 7 - 3, 7, 7, 10));
    IS(M13_NULL, m13_target_init(NULL, pixels, 67, 7, 7, 10));
    IS(M13_NULL, m13_target_init(&t, NULL, 67, 7, 7, 10));
    IS(M13_SIDE, m13_target_init(&t, pixels, 67, 0, 7, 10));
    IS(M13_SIDE, m13_target_init(&t, pixels, 67, 7, 4097, 10));
    IS(M13_PITCH, m13_target_init(&t, pixels, 67, 7, 7, 6));
    IS(M13_SHORT, m13_target_init(&t, pixels, 66, 7, 7, 10));
    IS(M13_SHORT, m13_target_init(&t, pixels, 67, 7, 7, SIZE_MAX));
    IS(M13_SHORT, m13_target_init(&t, pixels, SIZE_MAX, 7, 7, 10));
    IS(M13_SHORT, m13_target_init(&t, pixels, SIZE_MAX / 2 + 2, 7, 7, 10));
    IS(M13_OK, m13_target_init(&t, pixels, 67, 7, 7, 10));
    IS(M13_OK, m13_target_check(&t));
    IS(M13_NULL, m13_target_check(NULL));
    IS(M13_STRUCT_SIZE, m13_target_check(&unset));
    IS(M13_STRUCT_SIZE, m13_clear(&unset, 1));
    IS(M13_STRUCT_SIZE, m13_target_clip(&unset, 0, 0, 1, 1));
    IS(M13_DEPTH, m13_clear_depth(&t));
    IS(M13_DEPTH, m13_target_depth(&t, depth, 7 * 7 * 4, 24));
    IS(M13_DEPTH, m13_target_depth(&t, depth, 7 * 7 * 4 - 1, 32));
    IS(M13_NULL, m13_target_depth(&t, NULL, 7 * 7 * 4, 32));
    IS(M13_ALIGNMENT, m13_target_depth(&t, depth + 2, 7 * 7 * 4 - 2, 32));
    IS(M13_ALIGNMENT, m13_target_depth(&t, depth + 1, 7 * 7 * 4 - 1, 16));
    IS(M13_OK, m13_target_depth(&t, depth + 2, 7 * 7 * 2, 16));
    IS(M13_OK, m13_target_depth(&t, NULL, 0, 0));
    IS(M13_OK, m13_target_depth(&t, depth, 7 * 7 * 4, 32));
    IS(M13_BAND, m13_target_band(&t, 3, 5));
    IS(M13_BAND, m13_target_band(&t, 3, 0));
    IS(M13_BAND, m13_target_band(&t, 3, UINT32_MAX));
    IS(M13_OK, m13_target_check(&t)); /* a refused change changes nothing */
    IS(M13_OK, m13_target_clip(&t, -5, 2, 4, 1000000));
    IS(M13_OK, m13_clear(&t, 9));
    for (y = 0; y < 7; y++)
        for (x = 0; x < (y < 6 ? 10 : 7); x++)
            CHECK(pixels[10 * y + x] == (x < 4 && y >= 2 ? 9 : 0));
    memset(depth, 1, 7 * 7 * 4);
    IS(M13_OK, m13_clear_depth(&t));
    for (x = 0; x < 49; x++)
        CHECK(depth[4 * x] == (x % 7 < 4 && x >= 14 ? 0 : 1));
    IS(M13_OK, m13_target_clip(&t, 4, 4, 2, 2)); /* empty */
    IS(M13_OK, m13_clear(&t, 200));
    IS(M13_OK, m13_clear_depth(&t));
    IS(M13_OK, m13_target_clip(&t, INT32_MIN, INT32_MIN, INT32_MAX, INT32_MAX));
    IS(M13_OK, m13_target_band(&t, 6, 1));
    IS(M13_OK, m13_clear(&t, 8)); /* the row that `pixels` now holds */
    CHECK(pixels[0] == 8 && pixels[6] == 8 && pixels[7] == 0 && pixels[10] == 0);
    t.depth = pixels;
    IS(M13_OVERLAP, (t.depth_bits = 16, m13_target_check(&t)));
    release(pixels, 67);
    release(depth, 7 * 7 * 4);
}

/* A frame drawn in bands, in the memory of one, has the bytes of the whole frame. */
static void bands(void)
{
    static const m13_vertex corners[3] = { { 1, 0, 0, 200 }, { 7, 6, 0, 10 }, { 0, 7, 0, 90 } };
    uint8_t whole[49], *band = guarded(14);
    m13_target t;
    uint32_t row;
    IS(M13_OK, m13_target_init(&t, whole, 49, 7, 7, 7));
    IS(M13_OK, m13_clear(&t, 3));
    IS(M13_OK, m13_triangle(&t, corners, M13_GOURAUD, 0));
    IS(M13_SHORT, m13_target_init_band(&t, band, 13, 7, 7, 7, 0, 2));
    IS(M13_BAND, m13_target_init_band(&t, band, 14, 7, 7, 7, 6, 2));
    IS(M13_BAND, m13_target_init_band(&t, band, 14, 7, 7, 7, 0, 0));
    IS(M13_OK, m13_target_init_band(&t, band, 14, 7, 7, 7, 0, 2));
    IS(M13_SHORT, m13_target_band(&t, 0, 3));
    for (row = 0; row < 7; row += 2) {
        uint32_t rows = row < 6 ? 2 : 1;
        IS(M13_OK, m13_target_band(&t, row, rows));
        IS(M13_OK, m13_clear(&t, 3));
        IS(M13_OK, m13_triangle(&t, corners, M13_GOURAUD, 0));
        CHECK(memcmp(band, whole + 7 * row, 7 * rows) == 0);
    }
    release(band, 14);
}

static void spans(void)
{
    uint8_t *row = guarded(100), *texels = guarded(16);
    int k;
    IS(M13_OK, m13_span(row, 100, 0x1080, 0xFF80));
    for (k = 0; k < 100; k++)
        CHECK(row[k] == (uint8_t)((0x1080 - 0x80 * k) >> 8));
    IS(M13_OK, m13_span(NULL, 0, 1, 1));
    IS(M13_NULL, m13_span(NULL, 1, 1, 1));
    IS(M13_SHORT, m13_span(row, SIZE_MAX, 1, 1));
    for (k = 0; k < 16; k++)
        texels[k] = (uint8_t)(100 + k);
    if (m13_size() > 0) {
        IS(M13_OK, m13_span_texture(row, 100, texels, 3, 1, 0x8000, 0x18000, 0x10000, 0xFFFF8000u));
        for (k = 0; k < 100; k++)
            CHECK(row[k] == 100 + (((3 - k) >> 1 & 1) << 3 | (k & 7)));
        IS(M13_OK, m13_span_texture(NULL, 0, NULL, 0, 0, 0, 0, 0, 0));
        IS(M13_NULL, m13_span_texture(row, 1, NULL, 3, 1, 0, 0, 0, 0));
        IS(M13_NULL, m13_span_texture(NULL, 1, texels, 3, 1, 0, 0, 0, 0));
        IS(M13_VALUE, m13_span_texture(row, 1, texels, 9, 1, 0, 0, 0, 0));
        IS(M13_VALUE, m13_span_texture(row, 1, texels, 3, 0xFFFFFFFFu, 0, 0, 0, 0));
        IS(M13_OVERLAP, m13_span_texture(texels + 3, 4, texels, 3, 1, 0, 0, 0, 0));
    } else {
        IS(M13_UNSUPPORTED, m13_span_texture(row, 1, texels, 3, 1, 0, 0, 0, 0));
    }
    release(row, 100);
    release(texels, 16);
}

static void triangles(m13_context *context)
{
    static const m13_vertex half[3] = { { 0, 0, 0, 40 }, { 8, 0, 0, 200 }, { 0, 4, 0, 40 } };
    static const m13_vertex_x half_x[3] = { { 0, 0, 0, 40 << 16 }, { 8 << 16, 0, 0, 200 << 16 }, { 0, 4 << 16, 0, 40 << 16 } };
    static const uint8_t first_row[8] = { 50, 70, 90, 110, 130, 150, 170, 0 };
    static const uint16_t indices[] = { 0, 1, 2, 2, 1, 0 };
    uint8_t *pixels = guarded(32), *table = guarded(65536);
    m13_vertex bad[3];
    m13_target t;
    m13_mesh mesh;
    m13_material material;
    m13_stats stats = { sizeof stats, 1, 1, 1, 1, 1 };
    uint16_t cells[8 * 4] = { 0 };
    IS(M13_OK, m13_target_init(&t, pixels, 32, 8, 4, 8));
    IS(M13_OK, m13_triangle(&t, half, M13_GOURAUD, 0));
    CHECK(memcmp(pixels, first_row, 8) == 0);
    memset(pixels, 0, 32);
    IS(M13_OK, m13_triangle_x(&t, half_x, M13_GOURAUD_16_16, 0));
    CHECK(memcmp(pixels, first_row, 8) == 0);
    IS(M13_NULL, m13_triangle(NULL, half, M13_FLAT, 1));
    IS(M13_NULL, m13_triangle(&t, NULL, M13_FLAT, 1));
    IS(M13_VALUE, m13_triangle(&t, half, 5, 1));
    IS(M13_VALUE, m13_triangle(&t, half, M13_FLAT, 256));
    memcpy(bad, half, sizeof bad);
    bad[1].y = NAN;
    IS(M13_VERTEX, m13_triangle(&t, bad, M13_FLAT, 1));
    bad[1].y = 0, bad[1].depth = 1.5f;
    IS(M13_VERTEX, m13_triangle(&t, bad, M13_GOURAUD_PERSPECTIVE, 0));
    CHECK(memcmp(pixels, first_row, 8) == 0);

    IS(M13_OK, m13_mesh_init(&mesh, half, 3, sizeof half[0]));
    IS(M13_NULL, m13_mesh_init(&mesh, NULL, 3, 16));
    IS(M13_NULL, m13_mesh_init(NULL, half, 3, 16));
    IS(M13_OK, m13_material_init(&material, M13_GOURAUD));
    IS(M13_NULL, m13_material_init(NULL, M13_GOURAUD));
    IS(M13_LAYOUT, m13_draw(&t, &mesh, &material, NULL, NULL)); /* no shade */
    mesh.shade = offsetof(m13_vertex, shade);
    IS(M13_OK, m13_draw(&t, &mesh, &material, NULL, &stats));
    CHECK(stats.triangles == 1 && stats.refused == 0 && stats.pixels == 16 && stats.covered == 16);
    memcpy(bad, half, sizeof bad);
    bad[1].depth = 1.5f;
    mesh.vertices = bad, mesh.depth = offsetof(m13_vertex, depth);
    IS(M13_OK, m13_draw(&t, &mesh, &material, NULL, &stats)); /* nobody needs the depth */
    CHECK(stats.refused == 0 && stats.pixels == 16);
    mesh.vertices = half, mesh.depth = M13_ABSENT;
    material.shading = M13_GOURAUD_PERSPECTIVE;
    IS(M13_LAYOUT, m13_draw(&t, &mesh, &material, NULL, NULL)); /* no depth */
    material.shading = M13_GOURAUD;
    IS(M13_OK, m13_target_depth(&t, cells, sizeof cells, 16));
    IS(M13_LAYOUT, m13_draw(&t, &mesh, &material, NULL, NULL));
    IS(M13_OK, m13_target_depth(&t, NULL, 0, 0));
    mesh.shade = 13;
    IS(M13_LAYOUT, m13_draw(&t, &mesh, &material, NULL, &stats));
    mesh.shade = M13_ABSENT - 1;
    IS(M13_LAYOUT, m13_draw(&t, &mesh, &material, NULL, &stats));
    mesh.shade = 12, mesh.vertex_count = 2;
    IS(M13_COUNT, m13_draw(&t, &mesh, &material, NULL, &stats));
    mesh.indices = indices, mesh.index_count = 6;
    IS(M13_INDEX, m13_draw(&t, &mesh, &material, NULL, &stats));
    mesh.vertex_count = 3;
    IS(M13_OK, m13_draw(&t, &mesh, &material, NULL, &stats));
    CHECK(stats.triangles == 2);
    material.cull = M13_CULL_CLOCKWISE;
    IS(M13_OK, m13_draw(&t, &mesh, &material, NULL, &stats));
    CHECK(stats.triangles == 1);
    mesh.index_count = 5;
    IS(M13_COUNT, m13_draw(&t, &mesh, &material, NULL, &stats));
    mesh.index_count = 6, mesh.index_bits = 12;
    IS(M13_VALUE, m13_draw(&t, &mesh, &material, NULL, &stats));
    mesh.index_bits = 16;
    stats.size = 0;
    IS(M13_STRUCT_SIZE, m13_draw(&t, &mesh, &material, NULL, &stats));
    mesh.homogeneous = 1, mesh.near_w = NAN;
    IS(M13_VALUE, m13_draw(&t, &mesh, &material, NULL, NULL));
    mesh.homogeneous = 0, mesh.vertices = pixels;
    IS(M13_OVERLAP, m13_draw(&t, &mesh, &material, NULL, NULL));
    mesh.vertices = half, material.fog_table = table;
    IS(m13_size() > 0 ? M13_CONTEXT : M13_UNSUPPORTED, m13_draw(&t, &mesh, &material, NULL, NULL));
    if (context != NULL) {
        IS(M13_LAYOUT, m13_draw(&t, &mesh, &material, context, NULL));
        mesh.fog = 0;
        IS(M13_OK, m13_draw(&t, &mesh, &material, context, NULL));
        CHECK(pixels[0] == 0 && pixels[6] == 0);
        material.fog_table = NULL, material.texels = table, material.u_bits = 9;
        mesh.texture = 0;
        IS(M13_VALUE, m13_draw(&t, &mesh, &material, context, NULL));
        material.u_bits = 8, material.v_bits = 8, material.mapping = M13_PERSPECTIVE;
        IS(M13_LAYOUT, m13_draw(&t, &mesh, &material, context, NULL));
        mesh.depth = 8;
        IS(M13_OK, m13_draw(&t, &mesh, &material, context, NULL));
        IS(M13_CONTEXT, m13_draw(&t, &mesh, &material, (m13_context *)(void *)(table + 16 - (uintptr_t)table % 16), NULL));
        material.texels = NULL, material.blend_table = pixels - MARGIN;
        IS(M13_OVERLAP, m13_draw(&t, &mesh, &material, context, NULL));
        material.blend_table = table, mesh.vertices = context;
        IS(M13_OVERLAP, m13_draw(&t, &mesh, &material, context, NULL));
        material.blend_table = (const uint8_t *)context + 64, mesh.vertices = half;
        IS(M13_OVERLAP, m13_draw(&t, &mesh, &material, context, NULL));
    }
    release(pixels, 32);
    release(table, 65536);
}

static void colors(void)
{
    uint8_t *palette = guarded(768), *other = guarded(768), *table = guarded(65536), *out = guarded(4 * 12 + 3);
    uint8_t pixels[12];
    uint32_t i;
    m13_target t;
    for (i = 0; m13_palette_name(i) != NULL; i++)
        IS(M13_OK, m13_palette_named(m13_palette_name(i), palette));
    CHECK(i == 9);
    IS(M13_NAME, m13_palette_named("mauve", palette));
    IS(M13_NULL, m13_palette_named(NULL, palette));
    IS(M13_NULL, m13_palette_named("grey", NULL));
    IS(M13_OK, m13_palette_ramp(palette, 1, 255, 0, 0xFFFFFF));
    CHECK(palette[767] == 255 && palette[3] == 0 && palette[3 * 128] == 127 + (127 * 255 % 254 * 2 >= 254));
    IS(M13_VALUE, m13_palette_ramp(palette, 1, 256, 0, 1));
    IS(M13_VALUE, m13_palette_ramp(palette, 0, 0, 0, 1));
    IS(M13_VALUE, m13_palette_ramp(palette, 0xFFFFFFFFu, 2, 0, 1));
    IS(M13_NULL, m13_palette_ramp(NULL, 1, 1, 0, 1));
    IS(255, m13_palette_nearest(palette, 0xFFFFFF));
    IS(M13_NULL, m13_palette_nearest(NULL, 1));
    IS(M13_OK, m13_palette_fade(palette, other, 128, other));
    CHECK(other[767] == 127);
    IS(M13_NULL, m13_palette_fade(palette, NULL, 128, other));
    IS(M13_OK, m13_palette_cycle(palette, 254, 2, -1));
    CHECK(palette[767] == 254);
    IS(M13_VALUE, m13_palette_cycle(palette, 254, 3, -1));
    IS(M13_VALUE, m13_palette_cycle(palette, 0xFFFFFFFFu, 0xFFFFFFFFu, INT32_MIN));
    IS(M13_NULL, m13_palette_cycle(NULL, 0, 1, 1));
    IS(M13_OK, m13_palette_to_dac(palette, other));
    CHECK(other[767] == 63);
    IS(M13_OK, m13_palette_from_dac(other, other));
    CHECK(other[767] == 255);
    IS(M13_NULL, m13_palette_to_dac(palette, NULL));
    IS(M13_NULL, m13_palette_from_dac(NULL, palette));
    IS(M13_OK, m13_table_shades(palette, NULL, table));
    CHECK(table[255 * 256 + 7] == 7);
    IS(M13_OK, m13_table_shades(palette, other, table));
    IS(M13_OK, m13_table_fog(palette, 0x808080, table));
    CHECK(table[77] == 77);
    IS(M13_OK, m13_table_blend(palette, 255, table));
    CHECK(table[3 * 256 + 9] == 3);
    IS(M13_OK, m13_table_add(palette, table));
    CHECK(table[255 * 256] == 255);
    IS(M13_NULL, m13_table_shades(NULL, NULL, table));
    IS(M13_NULL, m13_table_fog(palette, 0, NULL));
    IS(M13_NULL, m13_table_blend(NULL, 3, table));
    IS(M13_NULL, m13_table_add(palette, NULL));
    memset(pixels, 255, sizeof pixels);
    IS(M13_OK, m13_target_init(&t, pixels, 12, 4, 3, 4));
    IS(M13_OK, m13_show_32(&t, palette, (uint32_t *)(void *)out, 48, 16));
    CHECK(out[40] == 255); /* 254, as the DAC shows it */
    IS(M13_SHORT, m13_show_32(&t, palette, (uint32_t *)(void *)out, 47, 16));
    IS(M13_PITCH, m13_show_32(&t, palette, (uint32_t *)(void *)out, 48, 15));
    IS(M13_OK, m13_show_16(&t, palette, (uint16_t *)(void *)out, 51, 17)); /* unaligned rows */
    IS(M13_SHORT, m13_show_16(&t, palette, (uint16_t *)(void *)out, 51, SIZE_MAX));
    IS(M13_OVERLAP, m13_show_16(&t, palette, (uint16_t *)(void *)pixels, 51, 8));
    IS(M13_NULL, m13_show_16(&t, NULL, (uint16_t *)(void *)out, 51, 17));
    release(palette, 768);
    release(other, 768);
    release(table, 65536);
    release(out, 4 * 12 + 3);
}

/* Random arguments: nothing is written outside the memory that they name, and nothing crashes. */
static void fuzz(m13_context *context, int rounds)
{
    unsigned long accepted = 0, refused[20] = { 0 };
    uint8_t *table = guarded(65536);
    int i;
    for (i = 0; i < 65536; i++)
        table[i] = (uint8_t)random_number();
    while (rounds-- > 0) {
        size_t bytes = below(3) ? below(6000) : 1 + below(70000);
        size_t depth_bytes = below(20000), vertex_count = below(40), stride = below(8) ? 40 + 4 * below(5) : below(50);
        uint32_t width = below(6) ? 1 + below(70) : odd_number(70), height = below(6) ? 1 + below(70) : odd_number(70), index_count = 3 * below(30), bits = 8u << below(3);
        uint8_t *pixels = guarded(bytes), *depth = guarded(depth_bytes), *vertices = guarded(vertex_count * stride);
        uint8_t *indices = guarded(index_count * bits / 8);
        uint32_t k;
        int code;
        m13_target t;
        m13_mesh mesh;
        m13_material material;
        m13_stats stats = { sizeof stats, 0, 0, 0, 0, 0 };
        m13_target_init(&t, table, 1, 1, 1, 1); /* and by hand, so that nothing is checked yet */
        t.pixels = pixels, t.pixel_bytes = bytes, t.width = width, t.height = t.rows = height;
        t.clip_x1 = width, t.clip_y1 = height;
        t.pitch = below(8) ? (size_t)width + below(5) : odd_number(100);
        if (below(2))
            m13_target_depth(&t, depth + below(2) * 2, depth_bytes < 2 ? 0 : depth_bytes - 2, below(9) ? 16u << below(2) : odd_number(40));
        if (below(2))
            m13_target_clip(&t, (int32_t)odd_number(40), (int32_t)odd_number(40), (int32_t)odd_number(70), (int32_t)odd_number(70));
        if (below(4) == 0)
            m13_target_band(&t, odd_number(40), odd_number(40));
        if (below(16) == 0) { /* by hand, too */
            t.rows = odd_number(80);
            t.first_row = odd_number(80);
            t.pitch = odd_number(80);
        }
        for (k = 0; k + 4 <= vertex_count * stride; k += 4) {
            float number = below(6) ? (float)below(7000) / 100.0f : odd_float(300.0f);
            uint32_t whole = below(6) ? below(70u << 16) : odd_number(0xFFFFFFFEu);
            memcpy(vertices + k, below(2) ? (void *)&number : (void *)&whole, 4);
        }
        for (k = 0; k < index_count * bits / 8; k += bits / 8) { /* little-endian here and there */
            uint32_t index = below(400) ? below((uint32_t)vertex_count + 1) : odd_number(300);
            if (vertex_count > 0 && below(200))
                index %= (uint32_t)vertex_count;
            memcpy(indices + k, &index, bits / 8);
        }
        m13_mesh_init(&mesh, vertices, (uint32_t)vertex_count, (uint32_t)stride);
        if (below(4)) {
            mesh.indices = indices, mesh.index_count = index_count, mesh.index_bits = bits;
        } else if (below(3)) {
            mesh.vertex_count -= mesh.vertex_count % 3;
        }
        mesh.position = below(12) ? 0 : odd_number(20);
        mesh.shade = below(12) ? 4 * below(10) : odd_number(40);
        mesh.texture = below(12) ? 4 * below(10) : odd_number(40);
        mesh.fog = below(12) ? 4 * below(10) : odd_number(40);
        mesh.slope = below(12) ? 4 * below(10) : odd_number(40);
        mesh.depth = below(3) ? 8 : odd_number(40);
        mesh.homogeneous = below(20) ? below(2) : odd_number(3);
        mesh.near_w = below(4) ? 0.5f : odd_float(2.0f);
        mesh.near_w_x = below(4) ? 0x8000 : (int32_t)odd_number(0xFFFFFFFEu);
        m13_material_init(&material, M13_FLAT);
        material.shading = below(20) ? below(5) : odd_number(9);
        material.color = below(20) ? below(256) : odd_number(300);
        material.cull = below(20) ? below(3) : odd_number(3);
        material.mapping = below(20) ? below(3) : odd_number(3);
        material.dither = below(2) ? 0 : below(20) ? below(4) : odd_number(4);
        material.keep_depth = below(3) ? 1 : below(20) ? 0 : odd_number(3);
        material.u_bits = below(20) ? below(9) : odd_number(9);
        material.v_bits = below(20) ? below(9) : odd_number(9);
        if (below(2)) {
            material.texels = below(2) ? table : NULL;
            material.shade_table = below(2) ? table : NULL;
            material.slope_table = below(4) == 0 ? table : NULL;
            material.fog_table = below(3) == 0 ? table : NULL;
            material.blend_table = below(3) == 0 ? table : NULL;
        }
        code = (below(2) ? m13_draw : m13_draw_x)(&t, &mesh, &material, below(40) ? context : NULL, below(3) ? &stats : NULL);
        if (code == M13_OK || code == M13_VERTEX)
            accepted++;
        if (code <= 0 && code > -20)
            refused[-code]++;
        else
            wrong++, printf("test.c: a code of %d\n", code);
        if (below(4) == 0)
            m13_clear(&t, (uint8_t)below(256)), m13_clear_depth(&t);
        release(pixels, bytes);
        release(depth, depth_bytes);
        release(vertices, vertex_count * stride);
        release(indices, index_count * bits / 8);
    }
    release(table, 65536);
    printf("fuzzed: %lu drawn;", accepted);
    for (i = 0; i < 20; i++)
        printf(" %lu", refused[i]);
    puts("");
    CHECK(accepted > 100 && refused[0] > 20);
}

int main(int count, char **words)
{
    size_t size = m13_size();
    uint8_t *memory = guarded(size + 32);
    uint8_t *aligned = memory + (16 - (uintptr_t)memory % 16) % 16;
    m13_context *context = NULL;
    int rounds = count > 2 ? atoi(words[2]) : 3000;
    state = count > 1 ? strtoul(words[1], NULL, 10) : 13;
    if (size > 0) {
        IS(M13_NULL, m13_init(NULL, size, &context));
        IS(M13_NULL, m13_init(aligned, size, NULL));
        IS(M13_SHORT, m13_init(aligned, size - 1, &context));
        IS(M13_ALIGNMENT, m13_init(aligned + 8, size, &context));
        CHECK(context == NULL);
        IS(M13_OK, m13_init(aligned, size, &context));
    } else {
        IS(M13_UNSUPPORTED, m13_init(aligned, 16, &context));
    }
    codes();
    targets();
    bands();
    spans();
    triangles(context);
    colors();
    fuzz(context, rounds);
    {
        size_t i; /* the context has not grown */
        for (i = (size_t)(aligned - memory) + size; i < size + 32; i++)
            CHECK(memory[i] == 0);
    }
    release(memory, size + 32);
    printf("%lu checks, %d wrong, by %s\n", checks, wrong, m13_kernel());
    return wrong > 0;
}
