/* A program without a C library, with 16.16 alone: `list` uses m13_draw_x, otherwise m13_triangle_x. Its exit status is
 * 0 if a pixel has the expected shade. */
#include "mode13h.h"

static uint8_t pixels[64 * 40];
static uint32_t depths[64 * 40];

void start(void);
void start(void)
{
    static const m13_vertex_x corners[3] = { { 0, 0, 1, 40 << 16 }, { 8 << 16, 0, 1, 200 << 16 }, { 0, 4 << 16, 1, 40 << 16 } };
    m13_target frame;
    int status = 1;
    m13_target_init(&frame, pixels, sizeof pixels, 64, 40, 64);
    m13_target_depth(&frame, depths, sizeof depths, 32);
    m13_clear(&frame, 7);
    m13_clear_depth(&frame);
#ifdef list
    {
        m13_mesh mesh;
        m13_material material;
        m13_mesh_init(&mesh, corners, 3, sizeof corners[0]);
        mesh.depth = offsetof(m13_vertex_x, depth);
        mesh.shade = offsetof(m13_vertex_x, shade);
        m13_material_init(&material, M13_GOURAUD);
        status = m13_draw_x(&frame, &mesh, &material, NULL, NULL);
    }
#else
    status = m13_triangle_x(&frame, corners, M13_GOURAUD, 0);
#endif
    status = status == M13_OK && pixels[0] == 50 && pixels[6] == 170 && pixels[7] == 7 ? 0 : 1;
    __asm__ volatile("int $0x80" : : "a"(1), "b"(status)); /* Linux: exit */
    for (;;)
        ;
}
