/* relief.h from C99: everything once. c_api POINTS.csv COLLIDER.relief WORLD.json prints x,y,z,f,nx,ny,nz,map of the
 * points. */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <math.h>
#include <relief.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition)                                                                              \
    do {                                                                                              \
        if (!(condition)) {                                                                           \
            fprintf(stderr, "line %d: %s; %s\n", __LINE__, #condition, relief_error());               \
            exit(1);                                                                                  \
        }                                                                                             \
    } while (0)

enum { kPoints = 10000, kBirths = 5000, kSide = 256 };

static void makeContext(void) {
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    CHECK(eglInitialize(display, NULL, NULL) && eglBindAPI(EGL_OPENGL_ES_API));
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    CHECK(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context));
}

static void printSamples(const relief_collider* collider, const char* file) {
    static float points[3 * kPoints];
    static relief_sample samples[kPoints];
    FILE* in = fopen(file, "r");
    size_t count = 0;
    CHECK(in != NULL);
    while (count < kPoints &&
           fscanf(in, "%f,%f,%f\n", &points[3 * count], &points[3 * count + 1], &points[3 * count + 2]) == 3) {
        ++count;
    }
    fclose(in);
    relief_collider_query(collider, points, count, samples);
    for (size_t i = 0; i < count; ++i) {
        const relief_sample* s = &samples[i];
        printf("%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%d\n", points[3 * i], points[3 * i + 1], points[3 * i + 2], s->distance,
               s->normal[0], s->normal[1], s->normal[2], (int)s->map);
    }
}

static void checkMistakes(void) {
    CHECK(relief_collider_load("no such file.relief") == NULL && strstr(relief_error(), "no such file.relief") != NULL);
    CHECK(relief_collider_read("nonsense", 8) == NULL && strlen(relief_error()) > 10);
    CHECK(strchr(relief_error(), '\n') == NULL && relief_error_count() == 2);
}

/* Snow on the collider: none of it may end up inside. */
static void simulate(const relief_collider* collider) {
    float min[3], max[3];
    relief_collider_bounds(collider, min, max);
    const float size = max[1] - min[1];
    relief_textures* textures = relief_textures_create(collider);
    CHECK(textures != NULL && strstr(relief_textures_glsl(textures), "reliefEvaluate") != NULL);

    relief_particles_options options = {.size = sizeof(options)};
    options.capacity = kBirths;
    options.gravity[1] = -size;
    options.drag = 1.0F;
    options.friction = 1.0F;
    options.has_ground = 1;
    options.ground_height = min[1];
    relief_particles* particles = relief_particles_create(textures, &options);
    CHECK(particles != NULL);
    static relief_birth births[kBirths + 1];
    srand(1);
    for (int i = 0; i <= kBirths; ++i) {
        for (int k = 0; k < 3; ++k) {
            births[i].position[k] = min[k] + (max[k] - min[k]) * (float)rand() / (float)RAND_MAX;
        }
        births[i].position[1] = max[1] + 0.1F * size;
        births[i].lifetime = 100.0F;
    }
    CHECK(relief_particles_spawn(particles, births, kBirths + 1) == kBirths);
    for (int i = 0; i < 300; ++i) {
        CHECK(relief_particles_step(particles, 1.0F / 60.0F) == 0);
    }
    CHECK(relief_particles_step(particles, -1.0F) < 0 && strstr(relief_error(), "seconds is -1;") != NULL);
    const relief_counts counts = relief_particles_counts(particles);
    CHECK(counts.born == kBirths && counts.refused == 1 && counts.alive == kBirths);

    static relief_particle states[kBirths];
    CHECK(relief_particles_read(particles, states, kBirths) == kBirths);
    int touched = 0, inside = 0;
    for (int i = 0; i < kBirths; ++i) {
        relief_sample sample;
        relief_collider_query(collider, states[i].position, 1, &sample);
        touched += states[i].collisions > 0;
        inside += sample.map >= 0 && sample.distance < -0.01F * size;
    }
    CHECK(touched > kBirths / 4 && inside == 0);

    /* A picture of it, from the front. */
    GLuint color, depth, framebuffer;
    glGenTextures(1, &color);
    glBindTexture(GL_TEXTURE_2D, color);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, kSide, kSide);
    glGenRenderbuffers(1, &depth);
    glBindRenderbuffer(GL_RENDERBUFFER, depth);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, kSide, kSide);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    relief_picture* picture = relief_picture_create(textures, collider);
    CHECK(picture != NULL);
    relief_view view = {.size = sizeof(view)};
    for (int k = 0; k < 4; ++k) {
        view.view[5 * k] = 1.0F;
    }
    view.view[14] = -4.0F * size;
    view.projection[0] = view.projection[5] = 3.0F;
    view.projection[10] = view.projection[11] = -1.0F;
    view.projection[14] = -0.2F * size;
    view.framebuffer = framebuffer;
    view.width = view.height = kSide;
    view.srgb = 1;
    CHECK(relief_picture_draw(picture, particles, NULL, &view) == 0);
    static unsigned char pixels[kSide * kSide][4];
    glReadPixels(0, 0, kSide, kSide, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    int lit = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        lit += pixels[i][0] > 0;
    }
    CHECK(lit > 1000 && glGetError() == GL_NO_ERROR);

    options.gravity[1] = 0.0F;
    CHECK(relief_particles_set(particles, &options) == 0);
    options.restitution = 2.0F;
    CHECK(relief_particles_set(particles, &options) < 0);
    relief_picture_free(picture);
    relief_particles_free(particles);
    relief_textures_free(textures);
}

/* The level of tests/cli/level.py: a box, of which the second node is twice as large, is lifted out of the way. */
static void simulateWorld(const char* file) {
    CHECK(relief_world_load("no such world.json") == NULL && strstr(relief_error(), "no such world.json") != NULL);
    relief_world* world = relief_world_load(file);
    CHECK(world != NULL && relief_world_body_count(world) == 5);
    uint32_t second = 0;
    CHECK(relief_world_find(world, "second", &second, 1) == 1 && second == 2);
    CHECK(strcmp(relief_world_node(world, 2), "second") == 0 && relief_world_find(world, "none", NULL, 0) == 0);
    float min[3], max[3];
    relief_world_bounds(world, min, max);
    CHECK(min[0] < -19.0F && max[1] > 1.9F);
    relief_pose pose;
    CHECK(relief_world_pose(world, second, &pose) == 0 && pose.position[0] == 5.0F);
    const float above[3] = {5.0F, 1.9F, 5.0F};
    relief_sample sample;
    relief_world_query(world, above, 1, &sample);
    CHECK(sample.map == (int)second && sample.distance < 0.0F && sample.distance > -0.2F);

    relief_textures* textures = relief_textures_create_world(world);
    CHECK(textures != NULL);
    relief_particles_options options = {.size = sizeof(options), .capacity = 8, .gravity = {0.0F, -10.0F, 0.0F}};
    for (int lifted = 0; lifted < 2; ++lifted) {
        pose.position[1] = lifted ? 10.0F : 0.0F;
        CHECK(relief_textures_set_poses(textures, &second, &pose, 1) == 0);
        CHECK(relief_textures_set_poses(textures, NULL, NULL, 0) == 0);
        relief_particles* particles = relief_particles_create(textures, &options);
        const relief_birth birth = {.position = {5.0F, 3.0F, 5.0F}, .lifetime = 100.0F};
        CHECK(relief_particles_spawn(particles, &birth, 1) == 1);
        for (int step = 0; step < 240; ++step) {
            CHECK(relief_particles_step(particles, 1.0F / 60.0F) == 0);
        }
        relief_particle at;
        CHECK(relief_particles_read(particles, &at, 1) == 1 && fabsf(at.position[1] - (lifted ? 0.0F : 2.0F)) < 0.1F);
        relief_particles_free(particles);
    }
    relief_textures_free(textures);
    relief_world_free(world);
}

int main(int argc, char** argv) {
    CHECK(argc == 4 && relief_api_version() >= RELIEF_API_VERSION && relief_version()[0] != 0);
    checkMistakes();
    relief_collider* collider = relief_collider_load(argv[2]);
    CHECK(collider != NULL && relief_collider_map_count(collider) > 0 && relief_collider_unit(collider) != NULL);
    CHECK(relief_textures_create(collider) == NULL && strstr(relief_error(), "no OpenGL context") != NULL);
    printSamples(collider, argv[1]);
    makeContext();
    simulate(collider);
    simulateWorld(argv[3]);
    relief_collider_free(collider);
    return 0;
}
