/* Relief from C and from whatever calls C: colliders on the CPU and on the GPU, particles, pictures of both.
 *
 * librelief.so exports these functions and nothing else; no exception leaves one. A function that makes something returns
 * NULL where it fails, others a negative number, and relief_error() says why, in one line. Handles are freed by the
 * function of their name, once; what depends on another must go first: pictures, then particles, textures, colliders.
 *
 * Functions marked (GL) need an OpenGL context (3.3 or OpenGL ES 3.0 with float render targets) current on the calling
 * thread, the same one for all that belongs together, and leave its state as it was. Handles are for one thread at a time;
 * relief_collider_query() may be called by several at once. Lengths are in the mesh's units, times in seconds, vectors of
 * three floats in a row, matrices of sixteen by columns, as OpenGL has them.
 *
 * Structures only ever grow at their end: set `size` to sizeof(the structure), and leave what you do not need 0. */
#ifndef RELIEF_H
#define RELIEF_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What this header describes. A library has relief_api_version() >= the header's, and the same major number, or must not be
 * used with it. */
#define RELIEF_API_MAJOR 1
#define RELIEF_API_MINOR 0
#define RELIEF_API_VERSION (RELIEF_API_MAJOR * 1000 + RELIEF_API_MINOR)
int relief_api_version(void);
const char* relief_version(void); /* of the library: "0.1.0" */

/* Why this thread's last call that failed did so; "" before that. Valid until the next call. */
const char* relief_error(void);

/* --- colliders, on the CPU --- */

typedef struct relief_collider relief_collider;

relief_collider* relief_collider_load(const char* path);
/* From memory, which is copied. */
relief_collider* relief_collider_read(const void* bytes, size_t size);
void relief_collider_free(relief_collider* collider);

void relief_collider_bounds(const relief_collider* collider, float min[3], float max[3]);
size_t relief_collider_map_count(const relief_collider* collider);
const char* relief_collider_unit(const relief_collider* collider); /* "m", or "" */

typedef struct relief_sample {
    float
        distance; /* to the plane that decides the side: negative inside; 1e30: outside, and no more is known */
    float normal[3]; /* outwards; zero where no more than "outside" is known */
    int32_t map;     /* that decides; -1: no map says anything */
} relief_sample;

/* What the particles collide with, at `count` points. */
void relief_collider_query(const relief_collider* collider, const float* points, size_t count,
                           relief_sample* samples);
/* To the nearest surface, which is searched for: some thirteen times the work. */
void relief_collider_nearest(const relief_collider* collider, const float* points, size_t count,
                             relief_sample* samples);

/* --- colliders, on the GPU (GL) --- */

typedef struct relief_textures relief_textures;

relief_textures* relief_textures_create(const relief_collider* collider);
void relief_textures_free(relief_textures* textures);
/* What a shader of your own begins with, behind its #version and precision lines: defines and collider.glsl, which has
 * reliefEvaluate(vec3). Valid as long as the textures. */
const char* relief_textures_glsl(const relief_textures* textures);
/* Sets the program's samplers to units first_unit … first_unit + 2 and its block to uniform_block; once a program. Leaves
 * the program in use. */
void relief_textures_attach(const relief_textures* textures, uint32_t program, int first_unit,
                            int uniform_block);
/* Binds textures and block there, before a draw; they stay bound. */
void relief_textures_bind(const relief_textures* textures, int first_unit, int uniform_block);

/* --- particles (GL) --- */

typedef struct relief_particles relief_particles;

typedef struct relief_particles_options {
    size_t size;
    uint32_t capacity;  /* particles that may live at once; 0: 65536 */
    float gravity[3];   /* units a second squared */
    float wind[3];      /* units a second */
    float drag;         /* 1/s */
    float restitution;  /* 0…1: speed kept across a surface */
    float friction;     /* 0…1: speed lost along it, per collision */
    float radius;       /* of collision */
    int32_t has_ground; /* 1: a floor at ground_height */
    float ground_height;
} relief_particles_options;

typedef struct relief_birth {
    float position[3];
    float velocity[3];
    float lifetime; /* > 0 */
    uint32_t type;  /* 0 */
} relief_birth;

typedef struct relief_particle {
    uint32_t id;
    float position[3];
    float velocity[3];
    float age;
    float lifetime;
    uint32_t type;
    uint32_t collisions; /* steps in contact so far */
} relief_particle;

typedef struct relief_counts {
    uint64_t born, died, refused;
    uint32_t alive;
} relief_counts;

/* `textures` may be NULL: nothing to collide with. */
relief_particles* relief_particles_create(const relief_textures* textures,
                                          const relief_particles_options* options);
void relief_particles_free(relief_particles* particles);
/* Takes over all but the capacity. */
int relief_particles_set(relief_particles* particles, const relief_particles_options* options);
/* For the next step; returns how many there was room for. */
size_t relief_particles_spawn(relief_particles* particles, const relief_birth* births, size_t count);
int relief_particles_step(relief_particles* particles, float seconds);
relief_counts relief_particles_counts(const relief_particles* particles);
/* Waits for the GPU. Writes at most `room` particles, in the order of their indices; returns how many live, or -1. */
int64_t relief_particles_read(const relief_particles* particles, relief_particle* out, size_t room);

/* --- pictures (GL) --- */

typedef struct relief_picture relief_picture;

typedef struct relief_picture_options {
    size_t size;
    float diameter; /* of a particle; 0: a hundredth of the collider's longest side */
    float color[3]; /* sRGB; all 0: white */
    float opacity;  /* 0…1; 0: 0.95 */
} relief_picture_options;

typedef struct relief_view {
    size_t size;
    float view[16];
    float projection[16];  /* perspective */
    uint32_t framebuffer;  /* with colour and depth; 0: the window's */
    int32_t width, height; /* its pixels (0, 0) … (width - 1, height - 1) */
    int32_t srgb;          /* 1: it takes sRGB values, as a window does; 0: linear light */
} relief_view;

/* `textures` and `collider` light the particles; both NULL: they lie in the open. */
relief_picture* relief_picture_create(const relief_textures* textures, const relief_collider* collider);
void relief_picture_free(relief_picture* picture);
/* Over what is there, hidden where its depth is nearer. */
int relief_picture_draw(relief_picture* picture, const relief_particles* particles,
                        const relief_picture_options* options, const relief_view* view);

#ifdef __cplusplus
}
#endif

#endif
