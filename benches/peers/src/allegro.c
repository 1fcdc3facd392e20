/* Allegro 4: its 8-bit triangles on a memory bitmap. The loop over the triangles is here, so that a call
   from Rust is paid for once a frame. */
#define ALLEGRO_NO_MAGIC_MAIN
#include <allegro.h>
#include <string.h>

static BITMAP *bitmap;

int peers_allegro_start(int width, int height) {
    if (install_allegro(SYSTEM_NONE, &errno, NULL) != 0) return -1;
    set_color_depth(8);
    bitmap = create_bitmap_ex(8, width, height);
    return bitmap ? 0 : -1;
}

/* Without clipping Allegro is faster; only for triangles that lie inside. */
void peers_allegro_clip(int on) { set_clip_state(bitmap, on); }

void peers_allegro_clear(int index) { clear_to_color(bitmap, index); }

void peers_allegro_read(unsigned char *bytes) {
    for (int y = 0; y < bitmap->h; y++) memcpy(bytes + y * bitmap->w, bitmap->line[y], bitmap->w);
}

void peers_allegro_float(int type, V3D_f *vertices, int triangles) {
    for (int i = 0; i < triangles; i++, vertices += 3)
        triangle3d_f(bitmap, type, NULL, vertices, vertices + 1, vertices + 2);
}

void peers_allegro_fixed(int type, V3D *vertices, int triangles) {
    for (int i = 0; i < triangles; i++, vertices += 3)
        triangle3d(bitmap, type, NULL, vertices, vertices + 1, vertices + 2);
}
