/* Draws a brushed sphere with OpenGL 3.3 and no window: sphere LIBRARY.glsl PICTURE.ppm
 *
 * The library is text without a #version, so it goes between that line and the shader that calls it:
 * glShaderSource takes them as three strings, and nothing has to be copied or preprocessed.
 */
#define EGL_EGLEXT_PROTOTYPES
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIDE = 256 };

static void stop(const char *what, const char *why) {
    fprintf(stderr, "sphere: %s: %s\n", what, why);
    exit(2);
}

static char *text_of(const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) stop(path, "there is no such file");
    fseek(file, 0, SEEK_END);
    long size = ftell(file);
    rewind(file);
    char *text = calloc(1, (size_t)size + 1);
    if (!text || fread(text, 1, (size_t)size, file) != (size_t)size) stop(path, "it cannot be read");
    fclose(file);
    return text;
}

static void open_context(void) {
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (display == EGL_NO_DISPLAY) display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (!eglInitialize(display, NULL, NULL)) stop("EGL", "there is no display without a window");
    eglBindAPI(EGL_OPENGL_API);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) stop("EGL", "there is no OpenGL 3.3");
}

static void attach(GLuint program, GLenum stage, const char *library, const char *path) {
    const char *parts[] = {"#version 330 core\n", library, text_of(path)};
    GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 3, parts, NULL);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    char log[4096] = "";
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    if (!good) stop(path, log);
    glAttachShader(program, shader);
}

static void open_target(void) {
    GLuint texture, frame, array;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, SIDE, SIDE);
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glViewport(0, 0, SIDE, SIDE);
}

static void write_picture(const char *path) {
    static unsigned char pixels[SIDE][SIDE][3];
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, SIDE, SIDE, GL_RGB, GL_UNSIGNED_BYTE, pixels);
    FILE *file = fopen(path, "wb");
    if (!file) stop(path, "it cannot be written");
    fprintf(file, "P6\n%d %d\n255\n", SIDE, SIDE);
    for (int row = SIDE - 1; row >= 0; --row) fwrite(pixels[row], 1, sizeof pixels[row], file);
    if (fclose(file)) stop(path, "it cannot be written");
}

int main(int count, char **words) {
    if (count != 3) stop("usage", "sphere LIBRARY.glsl PICTURE.ppm");
    open_context();
    GLuint program = glCreateProgram();
    attach(program, GL_VERTEX_SHADER, "", "sphere.vert");
    attach(program, GL_FRAGMENT_SHADER, text_of(words[1]), "sphere.frag");
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) stop("sphere.frag", "it does not link");
    open_target();
    glUseProgram(program);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    write_picture(words[2]);
    printf("wrote %s with %s\n", words[2], glGetString(GL_RENDERER));
    return 0;
}
