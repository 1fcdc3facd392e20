/* mode13h.h: exact 8-bit triangles into your own frame.
 *
 * A frame is an array of bytes, each the index of one of 256 colours. This library draws flat, shaded, textured, fogged and
 * translucent triangles into it, with a depth buffer if you like. A pixel is drawn if and only if its centre lies inside the
 * triangle, or on a top or left edge: two triangles that share an edge leave no hole and draw no pixel twice. Shades never
 * leave the range of the three corners. So nothing has to be clamped, padded or drawn twice.
 *
 *     static uint8_t pixels[320 * 200];
 *     m13_target frame;
 *     m13_vertex corners[3] = { { 160, 10, 0, 255 }, { 300, 190, 0, 60 }, { 20, 190, 0, 0 } };
 *
 *     m13_target_init(&frame, pixels, sizeof pixels, 320, 200, 320);
 *     m13_clear(&frame, 0);
 *     m13_triangle(&frame, corners, M13_GOURAUD, 0);
 *
 * The library allocates nothing, and keeps state between calls only in memory that you give it. Of the C library it calls
 * only memcpy, memmove, memset and memcmp; the build that chooses the best code for the processor at run time includes
 * Rust's standard library, and links libc. Threads may draw at the same time into different frames (or bands of one frame),
 * each with its own context. On a PC a call needs up to 52 kB of stack, 76 kB with effects; on a 386 20 kB and 64 kB. As
 * WebAssembly it needs 96 kB, more than linkers provide by default: -z stack-size=131072.
 *
 * ERRORS. Functions that return int return M13_OK or a code below 0; m13_message describes it. A call that returns a code
 * has written nothing, with one exception: M13_VERTEX says that some triangles were left out, and the others drawn. A null
 * pointer or a wrong length, pitch, index or number gives a code. Lengths that claim more memory than there is cannot be
 * detected.
 *
 * STRUCTS have their size as their first member, and later versions may append members. m13_target, m13_mesh and
 * m13_material each have a function m13_..._init that sets it and gives all other members harmless values: call it first,
 * then set what you need. m13_stats, which the library fills in, has none: set its `size` yourself. Only m13_vertex and
 * m13_vertex_x have no size: they are four numbers, and will stay that way.
 *
 * COORDINATES. x runs to the right and y down, in pixels. The top left pixel covers 0 to 1, so its centre is at (0.5, 0.5).
 * Coordinates are rounded to the nearest 1/256 pixel.
 *
 * FLOAT OR FIXED. m13_triangle and m13_draw read 32-bit floats. m13_triangle_x and m13_draw_x read 32-bit integers in 16.16
 * (65536 is 1.0), and use no floating point where the processor has no FPU. Both have the same layouts, and draw the same
 * pixels for the same numbers, except that where triangles are clipped, their edges and shades may be rounded differently.
 *
 *     value             float               16.16
 *     x, y              pixels              pixels
 *     w                 any unit            the same
 *     depth             0 to 1              0 to 2^32 - 1, an unsigned integer; 1.0 as a float is 2^30
 *     shade             0 to 255            0 to 255
 *     u, v              texels              texels
 *     fog               0 (none) to 255     the same
 *     slope             0 to 255            the same
 *
 * Greater depths are nearer, and 0 is as far away as possible. If w is the distance along the view axis, depth is near / w,
 * which is linear on the screen, as a depth buffer needs it. Shades, fog and slopes beyond their range are clamped; a depth
 * outside 0 to 1, or a number that is not finite, is rejected where it is used.
 *
 * License: MIT or Apache-2.0. */
#ifndef MODE13H_H
#define MODE13H_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this header: major, minor and patch, eight bits each. */
#define M13_VERSION 0x000100u

/* The version of the library. Its structs are those of this header if the major numbers are equal. */
uint32_t m13_version(void);

/* ---- Errors ---------------------------------------------------------------------------------------------------------- */

#define M13_OK 0
#define M13_NULL (-1)         /* a pointer is null, but must not be */
#define M13_STRUCT_SIZE (-2)  /* the size of a struct is not set: call its m13_..._init */
#define M13_SIDE (-3)         /* each side of a frame must be 1 to 4,096 pixels */
#define M13_PITCH (-4)        /* the pitch is less than the width */
#define M13_BAND (-5)         /* the band has no rows, or reaches beyond the frame */
#define M13_SHORT (-6)        /* there are fewer bytes than the rows need, or more than memory can hold */
#define M13_DEPTH (-7)        /* a depth buffer must have 16 or 32 bits, and a value for each pixel */
#define M13_ALIGNMENT (-8)    /* a depth buffer, a picture or memory is not aligned */
#define M13_OVERLAP (-9)      /* an input overlaps memory that is written */
#define M13_INDEX (-10)       /* an index refers to a vertex that does not exist */
#define M13_COUNT (-11)       /* triangles need a multiple of three vertices or indices */
#define M13_LAYOUT (-12)      /* an attribute is missing, or does not fit into the stride */
#define M13_VALUE (-13)       /* a number is not one of the allowed values */
#define M13_VERTEX (-14)      /* a vertex is not finite or out of range; other triangles were drawn */
#define M13_CONTEXT (-15)     /* this needs a context made by m13_init */
#define M13_NAME (-16)        /* there is no palette of this name */
#define M13_UNSUPPORTED (-17) /* this library was built without effects */

/* The message of a code, in English. Never null. */
const char *m13_message(int code);

/* The name of the kernel that fills spans on this processor, such as "avx2". All kernels draw the same bytes. */
const char *m13_kernel(void);

/* ---- Frames ---------------------------------------------------------------------------------------------------------- */

/* The frame to draw into. It is checked at each call, and may be copied and changed as you like. */
typedef struct m13_target {
    uint32_t size;
    uint32_t width, height;                      /* of the whole frame, 1 to 4,096 */
    uint32_t first_row, rows;                    /* the rows that `pixels` holds */
    uint32_t clip_x0, clip_y0, clip_x1, clip_y1; /* x0 <= x < x1, y0 <= y < y1; anything outside the frame is ignored */
    uint32_t depth_bits;                         /* 0 (no depth buffer), 16 or 32 */
    uint8_t *pixels;                             /* the first pixel of `first_row` */
    size_t pixel_bytes;                          /* at least pitch * (rows - 1) + width */
    size_t pitch;                                /* bytes from a row to the next, at least `width` */
    void *depth;                                 /* width * rows values of uint16_t or uint32_t, without a pitch */
    size_t depth_bytes;
} m13_target;

/* A whole frame without a depth buffer. If your rows run upwards, count y from the bottom row. */
int m13_target_init(m13_target *target, void *pixels, size_t bytes, uint32_t width, uint32_t height, size_t pitch);

/* A frame of which memory holds only a band: `rows` rows from `first_row` on. m13_target_band moves it. */
int m13_target_init_band(m13_target *target, void *pixels, size_t bytes, uint32_t width, uint32_t height, size_t pitch,
                         uint32_t first_row, uint32_t rows);

/* Gives a target a depth buffer of 16 or 32 bits, aligned to its values; 0 bits removes it. Sixteen bits hold the upper 16
 * of the 30 bits of a float's depth, rounded up. The buffer is not cleared. */
int m13_target_depth(m13_target *target, void *depth, size_t bytes, uint32_t bits);

/* Draws only where x0 <= x < x1 and y0 <= y < y1. Bytes inside are the same as without clipping. */
int m13_target_clip(m13_target *target, int32_t x0, int32_t y0, int32_t x1, int32_t y1);

/* Says that `pixels` (and the depth buffer) hold `rows` rows from `first_row` on and no others. Coordinates remain those of
 * the whole frame, so a frame can be drawn band by band with little memory (begin with m13_target_init_band), or by several
 * threads; its bytes are the same. Bytes between `width` and the pitch may be rewritten unchanged, so no two threads may
 * draw frames that lie side by side in the same rows of memory. */
int m13_target_band(m13_target *target, uint32_t first_row, uint32_t rows);

/* Checks the whole target, as each drawing call does. */
int m13_target_check(const m13_target *target);

/* Sets every pixel inside the clip rectangle to `index`, or every depth there to 0. */
int m13_clear(const m13_target *target, uint8_t index);
int m13_clear_depth(const m13_target *target);

/* ---- Spans ----------------------------------------------------------------------------------------------------------- */

/* The loop of 1994: pixels[k] = ((shade + k * step) mod 65536) >> 8, in 8.8. A falling shade has a step in two's
 * complement. Add 128 to the shade to round to the nearest. */
int m13_span(uint8_t *pixels, size_t count, uint16_t shade, uint16_t step);

/* A row of texels: pixels[k] is the texel at (u + k * du, v + k * dv), in 16.16; coordinates wrap. The picture is 2^u_bits
 * wide and 2^v_bits high, row by row; at most 8 bits each. */
int m13_span_texture(uint8_t *pixels, size_t count, const uint8_t *texels, uint32_t u_bits, uint32_t v_bits, uint32_t u,
                     uint32_t v, uint32_t du, uint32_t dv);

/* ---- One triangle ---------------------------------------------------------------------------------------------------- */

/* How shades vary between the corners. */
#define M13_FLAT 0                /* one index for the whole triangle; corners need no shade */
#define M13_GOURAUD 1             /* linear on the screen, less than 3/4 shade from exact */
#define M13_GOURAUD_8_8 2         /* the same with one span per row, as in 1994: off by less than 1/2 + width/256 */
#define M13_GOURAUD_16_16 3       /* the same in 16.16: off by less than 1/2 + width/65536 */
#define M13_GOURAUD_PERSPECTIVE 4 /* linear on the face in space; uses depth as 1/w */

/* A shade is an index of the palette, so put your colours in ramps, such as indices first + 0 to first + 63 from dark to
 * light. A triangle whose corners lie in a ramp does not leave it. */
typedef struct m13_vertex {
    float x, y, depth, shade;
} m13_vertex;

typedef struct m13_vertex_x {
    int32_t x, y;
    uint32_t depth;
    int32_t shade;
} m13_vertex_x;

/* Draws one triangle. The order of the corners makes no difference. `color` is the index for M13_FLAT, 0 to 255. m13_draw
 * is faster for many triangles. */
int m13_triangle(const m13_target *target, const m13_vertex corners[3], uint32_t shading, uint32_t color);
int m13_triangle_x(const m13_target *target, const m13_vertex_x corners[3], uint32_t shading, uint32_t color);

/* ---- Lists of triangles ---------------------------------------------------------------------------------------------- */

/* The offset of an attribute that vertices lack. */
#define M13_ABSENT 0xFFFFFFFFu

/* Your own vertices, one every `stride` bytes, and the offsets of their attributes in bytes, as from offsetof. All numbers
 * have 32 bits, and need not be aligned. */
typedef struct m13_mesh {
    uint32_t size;
    uint32_t vertex_count;
    uint32_t stride;
    uint32_t position;    /* x, y; with `homogeneous` x, y, w. Required. */
    uint32_t depth;       /* for a depth buffer or perspective; not read with `homogeneous`, where it is near / w */
    uint32_t shade;       /* required unless flat, or lit by a slope table */
    uint32_t texture;     /* u, v; required with texels */
    uint32_t fog;         /* required with a fog table */
    uint32_t slope;       /* column, row of the slope table; required with one */
    uint32_t homogeneous; /* 0: x and y are pixels. 1: x / w and y / w are, and triangles are clipped where w < near. */
    uint32_t index_bits;  /* 8, 16 (the default) or 32 */
    uint32_t index_count; /* three per triangle */
    float near_w;         /* the near plane of m13_draw, above 0; by default 1.0 */
    int32_t near_w_x;     /* the near plane of m13_draw_x, in 16.16, above 0; by default 1 << 16 */
    const void *vertices;
    const void *indices; /* null: every three consecutive vertices are a triangle */
} m13_mesh;

/* Vertices that have only a position, at offset 0, and no indices. The other members get the defaults named above, or 0. */
int m13_mesh_init(m13_mesh *mesh, const void *vertices, uint32_t count, uint32_t stride);

/* Which triangles are culled, by the winding of their corners as seen on the screen. */
#define M13_CULL_NONE 0
#define M13_CULL_COUNTER_CLOCKWISE 1
#define M13_CULL_CLOCKWISE 2

/* How texture coordinates are interpolated. The last two need depths, or w. */
#define M13_AFFINE 0      /* linear on the screen */
#define M13_EVERY_16 1    /* exact at every sixteenth pixel, linear between */
#define M13_PERSPECTIVE 2 /* exact at every pixel */

/* The pattern that replaces the half added when a shade is rounded. */
#define M13_DITHER_NONE 0
#define M13_DITHER_BAYER 1
#define M13_DITHER_BLUE_NOISE 2
#define M13_DITHER_PS1 3

/* How the triangles of a list are drawn. Each pixel passes these stages, if their pointers are not null:
 *
 *     shade    flat, from the corners, or slope_table[row * 256 + column]
 *     texture  shade_table[shade * 256 + texel]; without that table, the texel itself, whatever the shading
 *     fog      fog_table[fog * 256 + index]
 *     blend    blend_table[index * 256 + the frame's index]
 *
 * Tables have 65,536 bytes; see m13_table_... below. Everything except shading, color and cull needs a context. */
typedef struct m13_material {
    uint32_t size;
    uint32_t shading;    /* M13_FLAT, ... */
    uint32_t color;      /* for M13_FLAT: the index, or with a shade table the shade */
    uint32_t cull;       /* M13_CULL_... */
    uint32_t mapping;    /* M13_AFFINE, ... */
    uint32_t dither;     /* M13_DITHER_... */
    uint32_t keep_depth; /* by default 1; 0 tests depths but does not store them, for translucent faces (needs a context) */
    uint32_t u_bits;     /* the picture is 2^u_bits wide, at most 256, and 2^v_bits high; it wraps */
    uint32_t v_bits;
    uint32_t reserved;
    const uint8_t *texels;
    const uint8_t *shade_table;
    const uint8_t *slope_table;
    const uint8_t *fog_table;
    const uint8_t *blend_table;
} m13_material;

/* A material with a shading and nothing else: `keep_depth` is 1, all other members are 0. */
int m13_material_init(m13_material *material, uint32_t shading);

/* Counts of a call. Set `size` to sizeof(m13_stats) before the call; the rest is overwritten. */
typedef struct m13_stats {
    uint32_t size;
    uint32_t triangles; /* drawn; each part of a clipped one counts */
    uint32_t refused;   /* left out because of M13_VERTEX */
    uint32_t spans;
    uint32_t covered; /* pixels inside triangles and the clip rectangle */
    uint32_t pixels;  /* the pixels written */
} m13_stats;

/* Working memory for textures and other effects. */
typedef struct m13_context m13_context;

/* The size of a context in bytes; 0 in a library without effects. */
size_t m13_size(void);

/* Makes a context in `bytes` bytes of `memory`, aligned to 16 (as malloc's is on 64-bit machines), and stores its address.
 * It uses no other memory, and need not be closed: reuse the memory when you no longer need the context. Only one call at a
 * time may use it. */
int m13_init(void *memory, size_t bytes, m13_context **context);

/* Draws the triangles of a mesh, in their order. `context` may be null if the material does not need it; `stats` may be
 * null. Indices are checked before anything is drawn. Triangles that extend beyond the near plane are clipped, with no
 * crack between neighbours; positions may be any finite numbers. */
int m13_draw(const m13_target *target, const m13_mesh *mesh, const m13_material *material, m13_context *context,
             m13_stats *stats);
int m13_draw_x(const m13_target *target, const m13_mesh *mesh, const m13_material *material, m13_context *context,
               m13_stats *stats);

/* ---- Palettes -------------------------------------------------------------------------------------------------------- */

/* A palette is 768 bytes: red, green and blue of 256 colours, 0 to 255 each. A single colour is 0xRRGGBB. */

/* The names of the built-in palettes, from index 0 on; null after the last. The second function copies one of them. */
const char *m13_palette_name(uint32_t index);
int m13_palette_named(const char *name, uint8_t palette[768]);

/* Fills `entries` entries from `first` on, evenly from one colour to another. */
int m13_palette_ramp(uint8_t palette[768], uint32_t first, uint32_t entries, uint32_t from_rgb, uint32_t to_rgb);

/* The index of the nearest colour, the first of equally near ones; or a code below 0. */
int m13_palette_nearest(const uint8_t palette[768], uint32_t rgb);

/* The palette `part` 256ths of the way to another; more than 256 counts as 256. `out` may be either of them. */
int m13_palette_fade(const uint8_t palette[768], const uint8_t other[768], uint32_t part, uint8_t out[768]);

/* Rotates `entries` entries from `first` on by `steps`, upwards if positive. */
int m13_palette_cycle(uint8_t palette[768], uint32_t first, uint32_t entries, int32_t steps);

/* To the 6 bits of the VGA's DAC, rounded down, and back. On a VGA: outp(0x3C8, 0), then 768 times outp(0x3C9, out[i]).
 * `out` may be the palette itself. */
int m13_palette_to_dac(const uint8_t palette[768], uint8_t out[768]);
int m13_palette_from_dac(const uint8_t dac[768], uint8_t out[768]);

/* ---- Tables ---------------------------------------------------------------------------------------------------------- */

/* Tables of 65,536 bytes for materials. Each entry is the nearest colour to an exact mixture, as the DAC shows both. One
 * takes some milliseconds to make; on a 386, where it takes half a minute, load it from a file. */

/* table[shade * 256 + texel]: the texel's colour in a light of shade / 255. `texel_colors` is the palette of the texels, null
 * if it is the same. */
int m13_table_shades(const uint8_t palette[768], const uint8_t *texel_colors, uint8_t table[65536]);

/* table[fog * 256 + index]: the index's colour in fog of this density, 0 to 255. */
int m13_table_fog(const uint8_t palette[768], uint32_t fog_rgb, uint8_t table[65536]);

/* table[new * 256 + old]: glass. `opacity` is 0 (invisible) to 255. */
int m13_table_blend(const uint8_t palette[768], uint8_t opacity, uint8_t table[65536]);

/* table[new * 256 + old]: the sum of both, for things that glow. */
int m13_table_add(const uint8_t palette[768], uint8_t table[65536]);

/* ---- For modern screens ---------------------------------------------------------------------------------------------- */

/* Writes the rows of a frame as 0x00RRGGBB or as 5, 6 and 5 bits, in the colours that a VGA shows. `pitch` is in bytes. */
int m13_show_32(const m13_target *target, const uint8_t palette[768], uint32_t *out, size_t bytes, size_t pitch);
int m13_show_16(const m13_target *target, const uint8_t palette[768], uint16_t *out, size_t bytes, size_t pitch);

#ifdef __cplusplus
}
#endif

#endif
