/* SPDX-License-Identifier: Apache-2.0 */
/* relief.h from C99: a query, particles, a world; tests/runtime/c_api calls every function. c_api POINTS.csv COLLIDER.relief WORLD.json prints x,y,z,f,nx,ny,nz,map of the
 * points. */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <relief.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(condition)                                                                \
    do {                                                                                \
        if (!(condition)) {                                                             \
            fprintf(stderr, "line %d: %s; %s\n", __LINE__, #condition, relief_error()); \
            exit(1);                                                                    \
        }                                                                               \
    } while (0)

enum { kPoints = 10000, kBirths = 5000 };

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
    while (count < kPoints && fscanf(in, "%f,%f,%f\n", &points[3 * count], &points[3 * count + 1],
                                     &points[3 * count + 2]) == 3) {
        ++count;
    }
    fclose(in);
    relief_collider_query(collider, points, count, samples);
    for (size_t i = 0; i < count; ++i) {
        const relief_sample* s = &samples[i];
        printf("%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%d\n", points[3 * i], points[3 * i + 1], points[3 * i + 2],
               s->distance, s->normal[0], s->normal[1], s->normal[2], (int)s->map);
    }
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
    relief_particles_free(particles);
    relief_textures_free(textures);
}

/* The level of tests/cli/level.py. */
static void queryWorld(const char* file) {
    relief_world* world = relief_world_load(file);
    CHECK(world != NULL && relief_world_body_count(world) == 5);
    uint32_t second = 0;
    CHECK(relief_world_find(world, "second", &second, 1) == 1 && second == 2);
    const float above[3] = {5.0F, 1.9F, 5.0F};
    relief_sample sample;
    relief_world_query(world, above, 1, &sample);
    CHECK(sample.map == (int)second && sample.distance < 0.0F && sample.distance > -0.2F);
    relief_world_free(world);
}

int main(int argc, char** argv) {
    CHECK(argc == 4 && relief_api_version() >= RELIEF_API_VERSION && relief_version()[0] != 0);
    CHECK(relief_collider_load("no such file.relief") == NULL &&
          strstr(relief_error(), "no such file.relief") != NULL);
    relief_collider* collider = relief_collider_load(argv[2]);
    CHECK(collider != NULL && relief_collider_map_count(collider) > 0 &&
          relief_collider_unit(collider) != NULL);
    CHECK(relief_textures_create(collider) == NULL && strstr(relief_error(), "no OpenGL context") != NULL);
    printSamples(collider, argv[1]);
    makeContext();
    simulate(collider);
    queryWorld(argv[3]);
    relief_collider_free(collider);
    return 0;
}
