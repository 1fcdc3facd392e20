/* Mesa's software OpenGL (llvmpipe) off screen: a whole frame of one mesh. */
#include <GL/osmesa.h>
#include <stdlib.h>

static unsigned char *pixels;
static const float *positions, *normals;
static const unsigned *indices;
static int count;

/* One thread, as all the others have. The matrix is column-major. */
int peers_mesa_start(int width, int height, const float *projection, const float *light) {
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
    return 0;
}

const char *peers_mesa_renderer(void) { return (const char *)glGetString(GL_RENDERER); }

void peers_mesa_mesh(const float *of_positions, const float *of_normals, const unsigned *of_indices, int of_count) {
    positions = of_positions, normals = of_normals, indices = of_indices, count = of_count;
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_NORMAL_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, positions);
    glNormalPointer(GL_FLOAT, 0, normals);
}

/* Whether both sides of faces are drawn, each lit, or those that are turned away are left out. */
void peers_mesa_sides(int both) {
    if (both) glDisable(GL_CULL_FACE); else glEnable(GL_CULL_FACE);
    glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, both);
}

/* Clear, transform, light, cull, draw; the pixels are there when it returns. */
void peers_mesa_frame(const float *modelview) {
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glLoadMatrixf(modelview);
    glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, indices);
    glFinish();
}

/* Pixels that are not black. */
int peers_mesa_lit(int of_pixels) {
    int lit = 0;
    for (int i = 0; i < of_pixels; i++) lit += (pixels[4 * i] | pixels[4 * i + 1] | pixels[4 * i + 2]) != 0;
    return lit;
}
