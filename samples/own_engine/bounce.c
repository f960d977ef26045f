/* SPDX-License-Identifier: Apache-2.0 */
/* Drops 400 balls onto a collider, and prints where they come to rest, one x,y,z per line. Put relief.h beside it:
 *     relief bake bunny.obj -o bunny.relief
 *     cc bounce.c -o bounce -lm
 *     ./bounce bunny.relief */
#define RELIEF_IMPLEMENTATION
#include "relief.h"

#include <stdio.h>

enum { SIDE = 20, STEPS = 2400, STEPS_PER_SECOND = 240 };

int main(int argc, char** argv) {
    relief_collider body;
    relief_status status;
    float height, radius, gravity;
    int i, k, step, resting = 0;
    if (argc != 2) {
        fprintf(stderr, "usage: bounce COLLIDER.relief\n");
        return 2;
    }
    status = relief_load(&body, argv[1], NULL);
    if (status != RELIEF_OK) {
        fprintf(stderr, "bounce: %s: %s\n", argv[1], relief_message(status));
        return 1;
    }
    height = body.bounds_max[1] - body.bounds_min[1];
    radius = 0.01F * height;
    gravity = 5 * height; /* per second squared: about 9.8 m/s^2 for a body two metres high */

    for (i = 0; i < SIDE * SIDE; ++i) {
        const float across[2] = {(i % SIDE + 0.5F) / SIDE, (i / SIDE + 0.5F) / SIDE};
        float velocity[3] = {0, 0, 0}, position[3];
        position[0] = body.bounds_min[0] + across[0] * (body.bounds_max[0] - body.bounds_min[0]);
        position[1] = body.bounds_max[1] + 0.2F * height;
        position[2] = body.bounds_min[2] + across[1] * (body.bounds_max[2] - body.bounds_min[2]);
        for (step = 0; step < STEPS; ++step) {
            velocity[1] -= gravity / STEPS_PER_SECOND;
            for (k = 0; k < 3; ++k) {
                position[k] += velocity[k] / STEPS_PER_SECOND;
            }
            relief_collide(&body, position, velocity, radius, 0.2F, 0.9F);
        }
        if (relief_distance(&body, position, NULL) < 1.5F * radius) { /* the others have rolled off */
            printf("%.9g,%.9g,%.9g\n", position[0], position[1], position[2]);
            ++resting;
        }
    }
    fprintf(stderr, "%d of %d balls rest on it\n", resting, SIDE * SIDE);
    relief_close(&body);
    return 0;
}
