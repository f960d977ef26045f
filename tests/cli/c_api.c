/* SPDX-License-Identifier: Apache-2.0 */
/* Uses relief_runtime.h from C99; tests/runtime/c_api calls every function. c_api POINTS.csv COLLIDER.relief prints
 * x,y,z,f,nx,ny,nz,map for each point. */
#include <relief_runtime.h>
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

enum { kPoints = 10000 };

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

int main(int argc, char** argv) {
    CHECK(argc == 3 && relief_api_version() >= RELIEF_API_VERSION && relief_version()[0] != 0);
    CHECK(relief_collider_load("no such file.relief") == NULL &&
          strstr(relief_error(), "no such file.relief") != NULL);
    relief_collider* collider = relief_collider_load(argv[2]);
    CHECK(collider != NULL && relief_collider_map_count(collider) > 0 &&
          relief_collider_unit(collider) != NULL);
    CHECK(relief_textures_create(collider) == NULL && strstr(relief_error(), "no OpenGL context") != NULL);
    CHECK(relief_particles_create(NULL, NULL) == NULL && relief_world_load("no such world.json") == NULL);
    printSamples(collider, argv[1]);
    relief_collider_free(collider);
    return 0;
}
