/* SPDX-License-Identifier: Apache-2.0 */
/* Uses relief.h as C99 and as C++: single COLLIDER.relief... prints the field and a collision at 20,000 points of a grid
 * in and around each collider, as bits, so that the output of different compilers and processors can be compared.
 * For each collider, a line of constants, then one for each point: point, distance, normal, then position and velocity
 * after a collision, each as 8 hexadecimal digits. */
#define RELIEF_IMPLEMENTATION
#include "relief.h"

#include <stdio.h>
#include <string.h>

static void print_floats(const float* values, int count) {
    int i;
    for (i = 0; i < count; ++i) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof(bits));
        printf("%08lx ", (unsigned long)bits);
    }
}

static int print_collider(const char* path) {
    relief_collider collider;
    relief_status status = relief_load(&collider, path, NULL);
    const relief_constants* constants = &collider.constants;
    int i, k;
    if (status != RELIEF_OK) {
        printf("%s\n", relief_message(status));
        return 1;
    }
    print_floats(constants->row_x, 16);
    printf("%d %d %d %d %d\n", (int)constants->place[0], (int)constants->place[1], (int)constants->place[2],
           (int)constants->place[3], (int)collider.height);
    for (i = 0; i < 20000; ++i) {
        const int cell[3] = {i % 25, i / 25 % 32, i / 800}; /* 25 x 32 x 25 */
        float p[3], normal[3], v[3], distance;
        for (k = 0; k < 3; ++k) {
            const float low = collider.bounds_min[k], high = collider.bounds_max[k];
            volatile float across = (high - low) * ((float)(cell[k] * 7 - 10) / 160.0F); /* not fused with the sum */
            p[k] = low + across;
            v[k] = (float)(i * (3 + k) % 17 - 8);
        }
        distance = relief_distance(&collider, p, normal);
        print_floats(p, 3);
        print_floats(&distance, 1);
        print_floats(normal, 3);
        relief_collide(&collider, p, v, 0.02F, 0.5F, 0.25F);
        print_floats(p, 3);
        print_floats(v, 3);
        printf("\n");
    }
    relief_close(&collider);
    return 0;
}

int main(int argc, char** argv) {
    int i, failed = argc < 2;
    for (i = 1; i < argc && !failed; ++i) {
        failed = print_collider(argv[i]);
    }
    return failed;
}
