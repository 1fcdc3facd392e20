/* A textured, lit torus in an 8-bit surface of SDL2: cc sdl2.c -lmode13h -lm `sdl2-config --cflags --libs`
 * Without a display (SDL_VIDEODRIVER=dummy) it draws a few frames, and saves the last as sdl2.bmp. */
#include <SDL.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "mode13h.h"

enum { WIDTH = 320, HEIGHT = 240, AROUND = 48, ACROSS = 24 };

struct vertex {
    float x, y, w, u, v, shade;
};

static struct vertex vertices[(AROUND + 1) * (ACROSS + 1)];
static uint16_t indices[6 * AROUND * ACROSS];
static uint8_t palette[768], shades[65536], texels[64 * 64];
static uint32_t depths[WIDTH * HEIGHT];

static void place(float turn)
{
    int i, j;
    float c = cosf(turn), s = sinf(turn);
    for (i = 0; i <= AROUND; i++)
        for (j = 0; j <= ACROSS; j++) {
            struct vertex *to = &vertices[i * (ACROSS + 1) + j];
            float a = (float)i * 6.2831853f / AROUND, b = (float)j * 6.2831853f / ACROSS;
            float normal[3] = { cosf(b) * cosf(a), cosf(b) * sinf(a), sinf(b) };
            float at[3] = { cosf(a) + 0.4f * normal[0], sinf(a) + 0.4f * normal[1], 0.4f * normal[2] };
            float y = c * at[1] - s * at[2], z = s * at[1] + c * at[2];
            float light = 0.5f * normal[0] + 0.5f * (c * normal[1] - s * normal[2]) + 0.7f * (s * normal[1] + c * normal[2]);
            to->w = 3.2f - z;
            to->x = WIDTH / 2 * to->w + 300.0f * at[0];
            to->y = HEIGHT / 2 * to->w - 300.0f * y;
            to->u = (float)i * 256.0f / AROUND;
            to->v = (float)j * 128.0f / ACROSS;
            to->shade = 40.0f + 215.0f * (light > 0 ? light : 0);
        }
}

int main(int count, char **words)
{
    SDL_Window *window;
    SDL_Surface *surface, *screen;
    SDL_Color colors[256];
    SDL_Event event;
    m13_context *context;
    m13_target target;
    m13_mesh mesh;
    m13_material material;
    int i, j, frame, is_running = 1, is_dummy;
    void *memory = malloc(m13_size() + 15);
    (void)count, (void)words;
    if (memory == NULL || SDL_Init(SDL_INIT_VIDEO) != 0)
        return 1;
    is_dummy = strcmp(SDL_GetCurrentVideoDriver(), "dummy") == 0;
    window = SDL_CreateWindow("mode13h", SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, WIDTH, HEIGHT, 0);
    surface = SDL_CreateRGBSurfaceWithFormat(0, WIDTH, HEIGHT, 8, SDL_PIXELFORMAT_INDEX8);
    if (window == NULL || surface == NULL)
        return 1;

    m13_palette_named("materials-8x32", palette);
    for (i = 0; i < 256; i++) {
        SDL_Color color = { palette[3 * i], palette[3 * i + 1], palette[3 * i + 2], 255 };
        colors[i] = color;
    }
    SDL_SetPaletteColors(surface->format->palette, colors, 0, 256);
    m13_table_shades(palette, NULL, shades);
    for (i = 0; i < 64 * 64; i++) /* tiles of gold and lapis */
        texels[i] = (uint8_t)(((i ^ i / 64) & 16 ? 32 + 20 : 160 + 20) + (i % 16 == 0 || i / 64 % 16 == 0 ? -10 : i % 3));
    for (i = 0; i < AROUND; i++)
        for (j = 0; j < ACROSS; j++) {
            int a = i * (ACROSS + 1) + j, b = a + ACROSS + 1, k;
            int quad[6] = { a, b, b + 1, a, b + 1, a + 1 };
            for (k = 0; k < 6; k++)
                indices[6 * (i * ACROSS + j) + k] = (uint16_t)quad[k];
        }
    m13_init((void *)(((uintptr_t)memory + 15) & ~(uintptr_t)15), m13_size(), &context);
    m13_mesh_init(&mesh, vertices, sizeof vertices / sizeof vertices[0], sizeof vertices[0]);
    mesh.homogeneous = 1;
    mesh.texture = offsetof(struct vertex, u);
    mesh.shade = offsetof(struct vertex, shade);
    mesh.indices = indices;
    mesh.index_count = sizeof indices / sizeof indices[0];
    m13_material_init(&material, M13_GOURAUD);
    material.cull = M13_CULL_CLOCKWISE;
    material.mapping = M13_PERSPECTIVE;
    material.texels = texels;
    material.u_bits = material.v_bits = 6;
    material.shade_table = shades;

    for (frame = 0; is_running && !(is_dummy && frame == 30); frame++) {
        int code;
        while (SDL_PollEvent(&event))
            is_running = is_running && event.type != SDL_QUIT && event.type != SDL_KEYDOWN;
        place((float)frame * 0.03f);
        SDL_LockSurface(surface);
        m13_target_init(&target, surface->pixels, (size_t)(surface->pitch * HEIGHT), WIDTH, HEIGHT, (size_t)surface->pitch);
        m13_target_depth(&target, depths, sizeof depths, 32);
        m13_clear(&target, 0);
        m13_clear_depth(&target);
        code = m13_draw(&target, &mesh, &material, context, NULL);
        SDL_UnlockSurface(surface);
        if (code != M13_OK)
            return SDL_Log("%s", m13_message(code)), 1;
        screen = SDL_GetWindowSurface(window);
        SDL_BlitSurface(surface, NULL, screen, NULL);
        SDL_UpdateWindowSurface(window);
        SDL_Delay(is_dummy ? 0 : 15);
    }
    return is_dummy ? SDL_SaveBMP(surface, "sdl2.bmp") : 0;
}
