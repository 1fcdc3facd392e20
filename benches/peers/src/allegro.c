/* Allegro 4: its 8-bit triangles on a memory bitmap. The loop over the triangles is here, so that a call
   from Rust is paid for once a frame. */
#define ALLEGRO_NO_MAGIC_MAIN
#include <allegro.h>
#include <string.h>

static BITMAP *bitmap, *texture;
static ZBUFFER *depths;
static COLOR_MAP table;

int peers_allegro_start(int width, int height, int side) {
    if (install_allegro(SYSTEM_NONE, &errno, NULL) != 0) return -1;
    set_color_depth(8);
    bitmap = create_bitmap_ex(8, width, height);
    texture = create_bitmap_ex(8, side, side);
    if (!bitmap || !texture) return -1;
    depths = create_zbuffer(bitmap);
    if (!depths) return -1;
    set_zbuffer(depths);
    color_map = &table;
    return 0;
}

/* Without clipping Allegro is faster; only for triangles that lie inside. */
void peers_allegro_clip(int on) { set_clip_state(bitmap, on); }

void peers_allegro_clear(int index) { clear_to_color(bitmap, index); }

void peers_allegro_read(unsigned char *bytes) {
    for (int y = 0; y < bitmap->h; y++) memcpy(bytes + y * bitmap->w, bitmap->line[y], bitmap->w);
}

/* The texels, and the byte for a shade or a texel (row) and a texel or the frame's byte (column). */
void peers_allegro_material(const unsigned char *texels, const unsigned char *bytes) {
    for (int y = 0; y < texture->h; y++) memcpy(texture->line[y], texels + y * texture->w, texture->w);
    memcpy(table.data, bytes, sizeof table.data);
}

/* In the order of `Drawing`. */
static const int types[] = {
    POLYTYPE_FLAT,
    POLYTYPE_GCOL,
    POLYTYPE_GCOL | POLYTYPE_ZBUF,
    POLYTYPE_ATEX,
    POLYTYPE_ATEX_LIT,
    POLYTYPE_PTEX,
    POLYTYPE_PTEX_LIT,
    POLYTYPE_PTEX | POLYTYPE_ZBUF,
    POLYTYPE_ATEX_TRANS,
};

static int start(int drawing) {
    if (types[drawing] & POLYTYPE_ZBUF) clear_zbuffer(depths, 0);
    return types[drawing];
}

void peers_allegro_float(int drawing, V3D_f *vertices, int triangles) {
    const int type = start(drawing);
    for (int i = 0; i < triangles; i++, vertices += 3)
        triangle3d_f(bitmap, type, texture, vertices, vertices + 1, vertices + 2);
}

void peers_allegro_fixed(int drawing, V3D *vertices, int triangles) {
    const int type = start(drawing);
    for (int i = 0; i < triangles; i++, vertices += 3)
        triangle3d(bitmap, type, texture, vertices, vertices + 1, vertices + 2);
}
