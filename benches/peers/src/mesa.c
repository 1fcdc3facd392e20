/* Mesa's software OpenGL (llvmpipe) off screen: a whole frame of one mesh. */
#include <GL/osmesa.h>
#include <stdlib.h>

static unsigned char *pixels;
static const unsigned *indices;
static int count;

/* One thread, as all the others have. The matrix is column-major; the image is grey, of `side` texels a side. */
int peers_mesa_start(int width, int height, const float *projection, const float *light, int side,
                     const unsigned char *texels) {
    setenv("LP_NUM_THREADS", "0", 1);
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
    OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 0, 0, NULL);
    pixels = malloc((size_t)width * height * 4);
    if (!context || !pixels || !OSMesaMakeCurrent(context, pixels, GL_UNSIGNED_BYTE, width, height)) return -1;
    glViewport(0, 0, width, height);
    glMatrixMode(GL_PROJECTION);
    glLoadMatrixf(projection);
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glDisable(GL_DITHER);
    glEnable(GL_LIGHTING);
    glEnable(GL_LIGHT0);
    glLightfv(GL_LIGHT0, GL_POSITION, light);
    /* The material of a mesh that names none. */
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, (const float[]){1, 1, 1, 1});
    glMaterialfv(GL_FRONT_AND_BACK, GL_AMBIENT, (const float[]){0.15f, 0.15f, 0.15f, 1});
    glMaterialfv(GL_FRONT_AND_BACK, GL_DIFFUSE, (const float[]){0.85f, 0.85f, 0.85f, 1});
    /* The matrix of a model has a size. */
    glEnable(GL_RESCALE_NORMAL);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_LUMINANCE8, side, side, 0, GL_LUMINANCE, GL_UNSIGNED_BYTE, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    glFogi(GL_FOG_MODE, GL_LINEAR);
    return 0;
}

const char *peers_mesa_renderer(void) { return (const char *)glGetString(GL_RENDERER); }

void peers_mesa_mesh(const float *positions, const float *normals, const float *texcoords, const unsigned *of_indices,
                     int of_count) {
    count = of_count;
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_NORMAL_ARRAY);
    glEnableClientState(GL_TEXTURE_COORD_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, positions);
    glNormalPointer(GL_FLOAT, 0, normals);
    glTexCoordPointer(2, GL_FLOAT, 0, texcoords);
    indices = of_indices;
}

/* Whether both sides of faces are drawn, each lit, or those that are turned away are left out; with the image or
   without; with fog from `start` to `end` into a grey, or, where `end` is 0, without. */
void peers_mesa_stages(int both, int textured, float start, float end, float grey) {
    const float color[4] = {grey, grey, grey, 1};
    if (both) glDisable(GL_CULL_FACE); else glEnable(GL_CULL_FACE);
    glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, both);
    if (textured) glEnable(GL_TEXTURE_2D); else glDisable(GL_TEXTURE_2D);
    if (end > 0) glEnable(GL_FOG); else glDisable(GL_FOG);
    glFogf(GL_FOG_START, start);
    glFogf(GL_FOG_END, end);
    glFogfv(GL_FOG_COLOR, color);
}

/* Clear, then for each object, given its matrix: transform, light, cull, draw. The pixels are there when it returns. */
void peers_mesa_frame(const float *modelviews, int objects) {
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (int i = 0; i < objects; i++) {
        glLoadMatrixf(modelviews + 16 * i);
        glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, indices);
    }
    glFinish();
}

/* The red of every pixel, the lowest row first: pictures are grey. */
void peers_mesa_read(int of_pixels, unsigned char *bytes) {
    for (int i = 0; i < of_pixels; i++) bytes[i] = pixels[4 * i];
}
