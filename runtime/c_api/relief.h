/* SPDX-License-Identifier: Apache-2.0 */
/* Relief from C and from whatever calls C: colliders on the CPU and on the GPU, particles, pictures of both.
 *
 * librelief.so exports these functions and nothing else; librelief_c.a has the same ones. No exception leaves one.
 *
 * Errors. Whatever is passed on is answered and does not crash, but for memory that is shorter than its count, and text
 * without an end. A call that fails changes nothing; relief_error() names the argument and the cure in one line, and
 * relief_error_count() counts failures. What is returned then: NULL by functions that make something, a
 * negative number by those of type int and int64_t, 0 as a count, "" as a text; what is written: NaN.
 *
 * Handles are numbers that are looked up at each call, in some nanoseconds. NULL, a handle that has been freed, one of
 * another kind and what never was one are errors; no value is given out twice. Freeing NULL does nothing. They are freed by
 * the function of their name, once, in any order: particles and pictures keep the textures that they were made with, until
 * they go themselves.
 * A NULL that a failed call returned brings its error along: relief_textures_create(relief_collider_load(path)) fails as
 * loading did. Where NULL is also a choice, as for the textures of particles, it is that failure until the thread has called
 * relief_error(), or has made one of that kind, and the choice from then on.
 *
 * Functions marked (GL) need an OpenGL context (3.3 or OpenGL ES 3.0 with float render targets) current on the calling
 * thread, the same one for all that belongs together, and leave its state as it was. Where none is current they fail; what is
 * to be freed then stays.
 * Several threads may call at once with handles of their own, and relief_collider_query() and relief_collider_nearest()
 * also with one and the same. Errors are kept for each thread.
 *
 * Lengths are in the mesh's units, times in seconds, vectors of three floats in a row, matrices of sixteen by columns, as
 * OpenGL has them. Every number is finite; where no range stands beside it, no greater than 1e15 either way.
 *
 * Structures only ever grow at their end: set `size` to sizeof(the structure), and leave what you do not need 0. A size that
 * no version of the structure had, 0 for one, is an error. */
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
#define RELIEF_API_MINOR 2
#define RELIEF_API_VERSION (RELIEF_API_MAJOR * 1000 + RELIEF_API_MINOR)
int relief_api_version(void);
const char* relief_version(void); /* of the library: "0.1.0" */

/* Why this thread's last call that failed did so; "" before that. Valid until the next call. */
const char* relief_error(void);
/* How many of this thread's calls have failed so far. Since 1.1. */
uint64_t relief_error_count(void);

/* --- colliders, on the CPU --- */

typedef struct relief_collider relief_collider;

relief_collider* relief_collider_load(const char* path);
/* From memory, which is copied. */
relief_collider* relief_collider_read(const void* bytes, size_t size);
void relief_collider_free(relief_collider* collider);

void relief_collider_bounds(const relief_collider* collider, float min[3], float max[3]);
size_t relief_collider_map_count(const relief_collider* collider);
const char* relief_collider_unit(const relief_collider* collider); /* "m", or ""; as long as the collider */

/* Materials of its surface, whose numbers are from 0; 0: it is all the same. Since 1.2. */
size_t relief_collider_material_count(const relief_collider* collider);
/* "" of surfaces without a name; as long as the collider. Since 1.2. */
const char* relief_collider_material_name(const relief_collider* collider, size_t material);
/* The material at a point on the surface with this normal, of any length; -1: it has none, or an error. Since 1.2. */
int64_t relief_collider_material_at(const relief_collider* collider, const float point[3],
                                    const float normal[3]);

typedef struct relief_sample {
    float
        distance; /* to the plane that decides the side: negative inside; 1e30: outside, and no more is known; NaN: an error */
    float normal[3]; /* outwards; zero where no more than "outside" is known */
    int32_t map;     /* that decides; -1: no map votes */
} relief_sample;

/* What the particles collide with, at `count` points. A point that is not finite is an error; the others are answered. */
void relief_collider_query(const relief_collider* collider, const float* points, size_t count,
                           relief_sample* samples);
/* To the nearest surface, which is searched for: some thirteen times the work. */
void relief_collider_nearest(const relief_collider* collider, const float* points, size_t count,
                             relief_sample* samples);

/* --- worlds, on the CPU. Since 1.2 --- */

typedef struct relief_world relief_world;

/* Without bodies: for relief_world_add(). */
relief_world* relief_world_create(void);
/* A world.json of `relief bake LEVEL --world`, with the colliders that it names: up to 65536 bodies of 4096 colliders. Lengths
 * are world units. A body is a number, from 0, in the file's order. */
relief_world* relief_world_load(const char* world_path);
void relief_world_free(relief_world* world);

size_t relief_world_body_count(const relief_world* world);
/* The bodies of the node of this name, in their order: several in one place where its mesh was cut into tiles, which move as one.
 * Writes the first `count` of them, and returns how many there are; that there is none is an error, and 0. */
size_t relief_world_find(const relief_world* world, const char* node, uint32_t* bodies, size_t count);
const char* relief_world_node(const relief_world* world, size_t body); /* as long as the world */
/* The box that holds all bodies, those of clips at any time of them. */
void relief_world_bounds(const relief_world* world, float min[3], float max[3]);

typedef struct relief_pose {
    float position[3]; /* of the collider's origin */
    float rotation[4]; /* a unit quaternion x, y, z, w; of length 1 to a thousandth */
} relief_pose;

/* Where the file places a body. */
int relief_world_pose(const relief_world* world, size_t body, relief_pose* pose);

/* As relief_collider_query(), of all bodies where the file places them; `map` is the body that decides, -1: none votes. Takes
 * time by the number of bodies. */
void relief_world_query(const relief_world* world, const float* points, size_t count, relief_sample* samples);

/* --- colliders that move by clips: characters, machines. Since 1.2 --- */

typedef struct relief_animation relief_animation;

/* The animated mesh of a container of `relief bake --animated`. The collider may be freed at once. */
relief_animation* relief_animation_create(const relief_collider* collider);
void relief_animation_free(relief_animation* animation);

size_t relief_animation_clip_count(const relief_animation* animation);
const char* relief_animation_clip_name(const relief_animation* animation,
                                       size_t clip); /* as long as the animation */
float relief_animation_clip_seconds(const relief_animation* animation, size_t clip);
/* Joints as glTF's skins have them; that of a mesh without a skin is its node. */
size_t relief_animation_joint_count(const relief_animation* animation);
const char* relief_animation_joint_name(const relief_animation* animation,
                                        size_t joint);                   /* as long as the animation */
size_t relief_animation_weight_count(const relief_animation* animation); /* of morph targets */

/* Adds a body that moves by clips, behind the others, and returns its number; relief_world_query() leaves it out. The animation may be
 * freed at once. `pose` is that of the mesh's origin; `resolution` texels of its three maps along its longest side, 16 to 4096, or 0: 512; `room`
 * the sides of a box that holds it in every pose, or NULL: those that its clips need. */
int64_t relief_world_add(relief_world* world, const relief_animation* animation, const relief_pose* pose,
                         uint32_t resolution, const float room[3]);

/* --- colliders, on the GPU (GL) --- */

typedef struct relief_textures relief_textures;

relief_textures* relief_textures_create(const relief_collider* collider);
/* Of all bodies of a world, which may be freed at once. Since 1.2. */
relief_textures* relief_textures_create_world(const relief_world* world);
void relief_textures_free(relief_textures* textures);
/* Moves bodies of a world: poses[i] is that of bodies[i] at the end of the next step, and the others stay; where a body was after
 * the call before is its place at the step's beginning. Call it before each step while anything moves, and once more, with a
 * count of 0 perhaps, when all has stopped. Scales stay. A body that is named twice has its last pose. Since 1.2. */
int relief_textures_set_poses(relief_textures* world_textures, const uint32_t* bodies,
                              const relief_pose* poses, size_t count);
/* The pose that a clip has at a time; before its first key and behind its last one it rests. The next relief_textures_set_poses()
 * shows it; after a jump, to another clip say, call that twice, or the jump throws what it meets. `body`: that relief_world_add() returned. Since 1.2. */
int relief_textures_play(relief_textures* animated_textures, uint32_t body, const char* clip, double seconds);
/* The same of a pose of your own: for each joint 16 floats, from the space of the mesh's vertices to its own space (glTF's joint
 * matrices: the joint's transform times its inverse bind matrix), and the weight of each morph target. Since 1.2. */
int relief_textures_set_joints(relief_textures* animated_textures, uint32_t body, const float* matrices,
                               size_t joint_count, const float* weights, size_t weight_count);
/* A world with as much of it in full detail as so many bytes of the GPU hold, up to 2^40; 268435456 is a good number. A coarse
 * collider stands in for each that is not there. Files are read by a thread. Since 1.2. */
relief_textures* relief_textures_stream_world(const char* world_path, uint64_t gpu_bytes);

typedef struct relief_ball {
    float center[3]; /* world units, as the radius */
    float radius;    /* > 0 */
} relief_ball;

/* Call it before each step with the places that matter, such as the camera and the emitters: what reaches into these balls is loaded, and
 * what did not for the longest time goes. It copies a little at a time and waits for nothing, unless `waits` is 1 and not 0: then for all that
 * there is room for, so that runs are alike. Of textures that are not streamed it does nothing.
 * Returns how many colliders in the balls are not there in full detail, those that could not be loaded among them; -1: an error. Since 1.2. */
int64_t relief_textures_stream(relief_textures* world_textures, const relief_ball* balls, size_t count,
                               int waits);
/* One line about a collider that could not be loaded, which is told once; "": there is none. Valid until the next call of it. Since 1.2. */
const char* relief_textures_warning(relief_textures* world_textures);

/* What a shader of your own begins with, behind its #version and precision lines: defines and collider.glsl, which has
 * reliefEvaluate(vec3), of a world in its space. Valid as long as the textures. */
const char* relief_textures_glsl(const relief_textures* textures);
/* Sets the samplers of a linked program to units first_unit … first_unit + 2 (+ 3 of a world) and its block to uniform_block; once a program.
 * Leaves the program in use. */
void relief_textures_attach(const relief_textures* textures, uint32_t program, int first_unit,
                            int uniform_block);
/* Binds textures and block there, before a draw; they stay bound. */
void relief_textures_bind(const relief_textures* textures, int first_unit, int uniform_block);

/* --- particles (GL) --- */

typedef struct relief_particles relief_particles;

typedef struct relief_particles_options {
    size_t size;
    uint32_t capacity;  /* particles that may live at once, up to 16777216; 0: 65536 */
    float gravity[3];   /* units a second squared */
    float wind[3];      /* units a second */
    float drag;         /* 1/s; 0 or more */
    float restitution;  /* 0…1: speed kept across a surface */
    float friction;     /* 0…1: speed lost along it, per collision */
    float radius;       /* of collision; 0 or more */
    int32_t has_ground; /* 1: a floor at ground_height; 0: none */
    float ground_height;
} relief_particles_options;

typedef struct relief_birth {
    float position[3];
    float velocity[3];
    float lifetime; /* > 0 */
    uint32_t type;  /* a mark of your own, below 16777216: relief_particle has it again */
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

/* `textures` may be NULL: nothing to collide with. `options` may be NULL: all 0. */
relief_particles* relief_particles_create(const relief_textures* textures,
                                          const relief_particles_options* options);
void relief_particles_free(relief_particles* particles);
/* Takes over all but the capacity. `options` is not NULL. */
int relief_particles_set(relief_particles* particles, const relief_particles_options* options);
/* For the next step; returns how many there was room for. Needs no context. */
size_t relief_particles_spawn(relief_particles* particles, const relief_birth* births, size_t count);
/* `seconds`: above 0, up to 1e9. */
int relief_particles_step(relief_particles* particles, float seconds);
relief_counts relief_particles_counts(const relief_particles* particles);
/* Waits for the GPU. Writes at most `room` particles, in the order of their indices; returns how many live, or -1. */
int64_t relief_particles_read(const relief_particles* particles, relief_particle* out, size_t room);

/* --- births on the surface of characters, machines and colliders. Since 1.2 --- */

typedef struct relief_emitter relief_emitter;

typedef struct relief_emitter_options {
    size_t size;
    float rate;         /* births a second; 0…1e9 */
    uint32_t burst;     /* births of the first call on top of them; up to 16777216 */
    float direction[3]; /* of any length; all 0: the surface's normal, outwards */
    float cone;         /* half angle about it, 0…180 degrees, uniform over its solid angle */
    float speed_min;    /* along the direction, units a second; 0 or more, uniform between the two */
    float speed_max;
    float inherit; /* 0…1000: share of the surface's own velocity at the very place, bending included */
    float lifetime_min; /* > 0; uniform between the two */
    float lifetime_max;
    uint32_t type; /* as relief_birth has it */
    uint64_t seed; /* up to 2^53: the same one gives the same births */
} relief_emitter_options;

/* Births are uniform by the area of the posed mesh. `group`: the name of a joint, whose weights are their density; NULL: all of the mesh.
 * `material`: the name of the material that has them; NULL: any. The animation may be freed at once. */
relief_emitter* relief_emitter_create(const relief_animation* animation, const char* group,
                                      const char* material, const relief_emitter_options* options);
/* The same on the surface of a collider as it lies in its maps, but for parts thinner than a 96th of its longest side. The collider may
 * be freed at once. Takes some tenths of a second. */
relief_emitter* relief_emitter_create_on(const relief_collider* collider, const char* material,
                                         const relief_emitter_options* options);
void relief_emitter_free(relief_emitter* emitter);
/* The births of the last `seconds`, above 0 up to 1e9: of the step that has been taken, in which a body of that animation or collider came
 * to where it is now; of textures of a single collider it is body 0. They go with the next step, each from where the surface was at its
 * own moment, in a straight line between the two poses. Call it before the relief_textures_set_poses() of the next step. Returns
 * how many there was room for; -1: an error. Needs no context. */
int64_t relief_particles_emit(relief_particles* particles, relief_emitter* emitter, relief_textures* textures,
                              uint32_t body, float seconds);

/* --- pictures (GL) --- */

typedef struct relief_picture relief_picture;

typedef struct relief_picture_options {
    size_t size;
    float diameter; /* of a particle; 0: a hundredth of the collider's longest side, or 0.01 in the open */
    float color[3]; /* sRGB, 0…1; all 0: white */
    float opacity;  /* 0…1; 0: 0.95 */
} relief_picture_options;

typedef struct relief_view {
    size_t size;
    float view[16];
    float projection[16];  /* perspective */
    uint32_t framebuffer;  /* with colour and depth; 0: the window's */
    int32_t width, height; /* its pixels (0, 0) … (width - 1, height - 1); up to 65536 */
    int32_t srgb;          /* 1: it takes sRGB values, as a window does; 0: linear light */
} relief_view;

/* `textures` and the `collider` that they are of light the particles; both NULL: they lie in the open. Of a world's textures the
 * collider is NULL, and light is that of the box where the file places its bodies. The collider may be freed at once. */
relief_picture* relief_picture_create(const relief_textures* textures, const relief_collider* collider);
void relief_picture_free(relief_picture* picture);
/* Over what is there, hidden where its depth is nearer. `options` may be NULL: all 0. */
int relief_picture_draw(relief_picture* picture, const relief_particles* particles,
                        const relief_picture_options* options, const relief_view* view);

#ifdef __cplusplus
}
#endif

#endif
