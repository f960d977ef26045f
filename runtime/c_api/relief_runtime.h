/* SPDX-License-Identifier: Apache-2.0 */
/* The C API of Relief: colliders on the CPU and the GPU, particles and their renderers.
 *
 * librelief.so exports only these functions; librelief_c.a contains the same ones. No C++ exception leaves them.
 *
 * Errors. Arguments are validated. No call crashes on invalid arguments; the exceptions are arrays shorter than their
 * count and strings without a terminating zero. A failed call changes nothing. relief_error() returns one line that
 * names the argument and the fix; relief_error_count() counts failures. On failure, functions that create an object
 * return NULL, functions of type int and int64_t return a negative number, counts are 0, and strings are "". Output
 * values are NaN.
 *
 * Handles. A handle is looked up at each call, in a few nanoseconds; values are never reused. NULL, a freed handle, a
 * handle of another type and an arbitrary value are errors. Free each handle once, with the free function of its type,
 * in any order: particles and renderers keep their textures alive. Freeing NULL does nothing. A NULL returned by a
 * failed call carries its error: relief_textures_create(relief_collider_load(path)) fails with the error of the load.
 * Some arguments may be NULL, such as the textures of particles. If creating an object of the argument's type failed,
 * NULL is rejected with that error until the thread calls relief_error() or creates an object of that type.
 *
 * OpenGL. Functions in sections marked (GL) need a current OpenGL context on the calling thread: OpenGL 3.3, or OpenGL
 * ES 3.0 with renderable float textures. Exceptions: relief_textures_glsl(), relief_textures_warning(),
 * relief_particles_spawn() and relief_particles_counts(). Use the same context for all objects that work together. The
 * functions restore the GL state that they change, unless stated otherwise. Functions that need a context fail if none
 * is current; a handle to be freed then stays valid.
 *
 * Threads. Several threads may call at once with different handles. relief_collider_query() and
 * relief_collider_nearest() may also share a handle. Errors are stored per thread.
 *
 * Units. Lengths are in the units of the mesh, times in seconds. A vector is three consecutive floats; a matrix is
 * sixteen floats in column-major order. All numbers must be finite. If no range is given, it is -1e15 to 1e15.
 *
 * Structures only grow at their end. Set `size` to sizeof(the structure), and unused members to 0. A `size` that
 * matches no version of the structure, such as 0, is an error. */
#ifndef RELIEF_RUNTIME_H
#define RELIEF_RUNTIME_H

#ifdef RELIEF_H
#error "relief_runtime.h and relief.h both define relief_collider; include them in different source files"
#endif

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this header. A library is compatible if its major number is the same and relief_api_version() is not
 * lower than RELIEF_API_VERSION. */
#define RELIEF_API_MAJOR 1
#define RELIEF_API_MINOR 2
#define RELIEF_API_VERSION (RELIEF_API_MAJOR * 1000 + RELIEF_API_MINOR)
int relief_api_version(void);
const char* relief_version(void); /* version of the library, such as "0.1.0" */

/* Returns the message of the last failed call of this thread, or "" if none has failed. Valid until the next call. */
const char* relief_error(void);
/* Returns the number of failed calls of this thread. Since 1.1. */
uint64_t relief_error_count(void);

/* --- colliders, on the CPU --- */

typedef struct relief_collider relief_collider;

/* Reads a .relief file. */
relief_collider* relief_collider_load(const char* path);
/* Reads a collider from memory, which is copied. */
relief_collider* relief_collider_read(const void* bytes, size_t size);
void relief_collider_free(relief_collider* collider);

/* Writes the bounds of the collider in object space. */
void relief_collider_bounds(const relief_collider* collider, float min[3], float max[3]);
size_t relief_collider_map_count(const relief_collider* collider);
/* Returns the unit of length, such as "m", or "" if unknown. Valid until the collider is freed. */
const char* relief_collider_unit(const relief_collider* collider);

/* Returns the number of surface materials; 0 if the collider has none. Since 1.2. */
size_t relief_collider_material_count(const relief_collider* collider);
/* Returns the name of a material, numbered from 0; it may be "". Valid until the collider is freed. Since 1.2. */
const char* relief_collider_material_name(const relief_collider* collider, size_t material);
/* Returns the material at a point on the surface, or -1 if the collider has no materials or on error. `normal`: the
 * surface normal at the point, of any length. Since 1.2. */
int64_t relief_collider_material_at(const relief_collider* collider, const float point[3],
                                    const float normal[3]);

typedef struct relief_sample {
    float
        distance; /* to the deciding plane or surface; < 0 inside; 1e30 far outside or no vote; NaN: error */
    float normal[3]; /* outwards; zero if distance is 1e30 or NaN */
    int32_t map;     /* the map that decides; -1: no map votes */
} relief_sample;

/* Evaluates, at `count` points, the field that particles collide with. `points` holds 3 * count floats. A non-finite
 * point is an error; the other points are still evaluated. */
void relief_collider_query(const relief_collider* collider, const float* points, size_t count,
                           relief_sample* samples);
/* Like relief_collider_query(), but searches for the nearest surface and returns the distance to it. Takes about
 * thirteen times as long. */
void relief_collider_nearest(const relief_collider* collider, const float* points, size_t count,
                             relief_sample* samples);

/* --- worlds, on the CPU. Since 1.2 --- */

typedef struct relief_world relief_world;

/* Creates a world without bodies; add them with relief_world_add(). */
relief_world* relief_world_create(void);
/* Reads a world.json written by `relief bake LEVEL --world`, and the colliders that it names: at most 65536 bodies and
 * 4096 colliders. Lengths are in world units. Bodies are numbered from 0, in the order of the file. */
relief_world* relief_world_load(const char* world_path);
void relief_world_free(relief_world* world);

size_t relief_world_body_count(const relief_world* world);
/* Finds the bodies of the node with this name. A node has several bodies if its mesh was cut into tiles; move them
 * together. Writes the first `count` body numbers, in ascending order, and returns the number of bodies found. If there
 * is none, it fails and returns 0. */
size_t relief_world_find(const relief_world* world, const char* node, uint32_t* bodies, size_t count);
/* Returns the name of a body's node. Valid until the world is freed. */
const char* relief_world_node(const relief_world* world, size_t body);
/* Writes the bounds of all bodies; the bounds of an animated body cover its clips at all times. */
void relief_world_bounds(const relief_world* world, float min[3], float max[3]);

typedef struct relief_pose {
    float position[3]; /* position of the collider's origin */
    float rotation[4]; /* unit quaternion x, y, z, w; length 1 ± 0.001 */
} relief_pose;

/* Writes the initial pose of a body: as in the file, or as passed to relief_world_add(). */
int relief_world_pose(const relief_world* world, size_t body, relief_pose* pose);

/* Like relief_collider_query(), for all bodies in the poses of the file. `map` is the body that decides, or -1 if no
 * body votes. The cost is proportional to the number of bodies. */
void relief_world_query(const relief_world* world, const float* points, size_t count, relief_sample* samples);

/* --- animated colliders: characters, machines. Since 1.2 --- */

typedef struct relief_animation relief_animation;

/* Reads the animated mesh of a collider baked with `relief bake --animated`. The collider may be freed afterwards. */
relief_animation* relief_animation_create(const relief_collider* collider);
void relief_animation_free(relief_animation* animation);

size_t relief_animation_clip_count(const relief_animation* animation);
/* Names of clips and joints are valid until the animation is freed. */
const char* relief_animation_clip_name(const relief_animation* animation, size_t clip);
float relief_animation_clip_duration(const relief_animation* animation, size_t clip);
/* Joints as in a glTF skin; the only joint of a mesh without a skin is its node. */
size_t relief_animation_joint_count(const relief_animation* animation);
const char* relief_animation_joint_name(const relief_animation* animation, size_t joint);
/* Returns the number of morph targets. */
size_t relief_animation_weight_count(const relief_animation* animation);

/* Appends an animated body to the world and returns its number. relief_world_query() ignores animated bodies. The
 * animation may be freed afterwards. `pose`: pose of the mesh's origin. `resolution`: texels of its three maps along
 * the longest side, 16 to 4096; 0: 512. `box_size`: the sides of a box that contains the body in every pose; NULL: the
 * extent of its clips. */
int64_t relief_world_add(relief_world* world, const relief_animation* animation, const relief_pose* pose,
                         uint32_t resolution, const float box_size[3]);

/* --- colliders, on the GPU (GL) --- */

typedef struct relief_textures relief_textures;

/* Uploads a collider. The collider may be freed afterwards. */
relief_textures* relief_textures_create(const relief_collider* collider);
/* Uploads all bodies of a world. The world may be freed afterwards. Since 1.2. */
relief_textures* relief_textures_create_world(const relief_world* world);
void relief_textures_free(relief_textures* textures);
/* Moves bodies of a world: poses[i] is the pose of bodies[i] at the end of the next step. The poses of the previous
 * call apply at the beginning of the step; bodies that are not listed stay. Call it before each step while any body
 * moves, and once more after the last one stops (count may be 0). Scales do not change. If a body is listed twice, the
 * last pose applies. Since 1.2. */
int relief_textures_set_poses(relief_textures* world_textures, const uint32_t* bodies,
                              const relief_pose* poses, size_t count);
/* Sets an animated body to the pose of a clip at `seconds`, clamped to its first and last key. The next call of
 * relief_textures_set_poses() applies it. After a jump, such as a change of clip, call relief_textures_set_poses()
 * twice; otherwise the jump counts as motion and pushes particles. `body`: a number returned by relief_world_add().
 * Since 1.2. */
int relief_textures_set_clip(relief_textures* animated_textures, uint32_t body, const char* clip,
                             double seconds);
/* Like relief_textures_set_clip(), with your own pose. `matrices`: 16 floats per joint, the glTF joint matrix (the
 * joint's transform times its inverse bind matrix). `weights`: one weight per morph target. The counts must match those
 * of the animation. Since 1.2. */
int relief_textures_set_joints(relief_textures* animated_textures, uint32_t body, const float* matrices,
                               size_t joint_count, const float* weights, size_t weight_count);
/* Streams a world: keeps full-detail colliders within a budget of `gpu_bytes`, 1 to 2^40; 268435456 is a good value.
 * Coarse versions replace colliders that are not loaded. A background thread reads the files. Since 1.2. */
relief_textures* relief_textures_stream_world(const char* world_path, uint64_t gpu_bytes);

typedef struct relief_sphere {
    float center[3]; /* world units */
    float radius;    /* world units; > 0 */
} relief_sphere;

/* Updates a streamed world. Call it before each step with the places that need full detail, such as the camera and the
 * emitters. Colliders that intersect the spheres are loaded; the least recently needed ones are evicted. `wait` 0:
 * uploads a little per call and never blocks. `wait` 1: blocks until everything that fits is loaded, for reproducible
 * runs. Does nothing for textures that are not streamed. Returns the number of colliders in the spheres without full
 * detail, including those that failed to load; -1 on error. Since 1.2. */
int64_t relief_textures_stream(relief_textures* world_textures, const relief_sphere* spheres, size_t count,
                               int wait);
/* Returns one line about a collider that failed to load, once per collider; "" if there is none. Valid until the next
 * call of this function. Since 1.2. */
const char* relief_textures_warning(relief_textures* world_textures);

/* Returns GLSL to insert into your own shader after its #version and precision lines: defines and collider.glsl, with
 * reliefEvaluate(vec3). The point is in object space, or in world space for a world. Valid until the textures are
 * freed. */
const char* relief_textures_glsl(const relief_textures* textures);
/* Sets the samplers of a linked program to the texture units from first_unit on (three units; four for a world), and
 * its uniform block to binding uniform_block. Call it once per program. Leaves the program in use. */
void relief_textures_attach(const relief_textures* textures, uint32_t program, int first_unit,
                            int uniform_block);
/* Binds the textures and the uniform block before a draw; they stay bound. */
void relief_textures_bind(const relief_textures* textures, int first_unit, int uniform_block);

/* --- particles (GL) --- */

typedef struct relief_particles relief_particles;

typedef struct relief_particles_options {
    size_t size;
    uint32_t capacity;  /* maximum number of live particles, up to 16777216; 0: 65536 */
    float gravity[3];   /* units/s^2 */
    float wind[3];      /* units/s */
    float drag;         /* 1/s; 0 or more */
    float restitution;  /* 0…1: fraction of the normal speed kept at a collision */
    float friction;     /* 0…1: fraction of the tangential speed lost at a collision */
    float radius;       /* collision radius; 0 or more */
    int32_t has_ground; /* 1: a floor at ground_height; 0: none */
    float ground_height;
} relief_particles_options;

typedef struct relief_birth {
    float position[3];
    float velocity[3];
    float lifetime; /* > 0 */
    uint32_t type;  /* user data, below 16777216; copied to relief_particle */
} relief_birth;

typedef struct relief_particle {
    uint32_t id;
    float position[3];
    float velocity[3];
    float age;
    float lifetime;
    uint32_t type;
    uint32_t collisions; /* number of steps in contact */
} relief_particle;

typedef struct relief_counts {
    uint64_t born, died, rejected; /* rejected: births without room */
    uint32_t alive;
} relief_counts;

/* Creates a particle system. `textures`: NULL for no collider. `options`: NULL for all 0. */
relief_particles* relief_particles_create(const relief_textures* textures,
                                          const relief_particles_options* options);
void relief_particles_free(relief_particles* particles);
/* Sets all options except the capacity. `options` must not be NULL. */
int relief_particles_set(relief_particles* particles, const relief_particles_options* options);
/* Queues births for the next step and returns the number accepted. Needs no context. */
size_t relief_particles_spawn(relief_particles* particles, const relief_birth* births, size_t count);
/* Advances the particles. `seconds`: above 0, up to 1e9. Recompiles the program if colliders or options require it. */
int relief_particles_step(relief_particles* particles, float seconds);
relief_counts relief_particles_counts(const relief_particles* particles);
/* Reads the particles back, which waits for the GPU. Writes at most `capacity` particles, in index order. Returns the
 * number of live particles, or -1 on error. */
int64_t relief_particles_read(const relief_particles* particles, relief_particle* out, size_t capacity);

/* --- births on the surface of characters, machines and colliders. Since 1.2 --- */

typedef struct relief_emitter relief_emitter;

typedef struct relief_emitter_options {
    size_t size;
    float rate;         /* births/s; 0…1e9 */
    uint32_t burst;     /* additional births in the first call; up to 16777216 */
    float direction[3]; /* of any length; all 0: the outward surface normal */
    float cone;         /* half angle around the direction, 0…180 degrees; uniform over the solid angle */
    float speed_min;    /* units/s; 0 or more; uniform between minimum and maximum */
    float speed_max;
    float inherit; /* 0…1000: factor of the surface velocity at the point of birth, deformation included */
    float lifetime_min; /* seconds, > 0; uniform between minimum and maximum */
    float lifetime_max;
    uint32_t type; /* as in relief_birth */
    uint64_t seed; /* up to 2^53; equal seeds give equal births */
} relief_emitter_options;

/* Creates an emitter on the surface of an animated mesh. Births are uniform by area of the posed mesh. `group`: the
 * joint whose weights are the density; NULL: the whole mesh. `material`: the name of the emitting material; NULL: all.
 * The animation may be freed afterwards. */
relief_emitter* relief_emitter_create(const relief_animation* animation, const char* group,
                                      const char* material, const relief_emitter_options* options);
/* Creates an emitter on the surface that the maps of a collider represent. Parts thinner than 1/96 of its longest side
 * may be missing. The collider may be freed afterwards. Takes a few tenths of a second. */
relief_emitter* relief_emitter_create_on(const relief_collider* collider, const char* material,
                                         const relief_emitter_options* options);
void relief_emitter_free(relief_emitter* emitter);
/* Queues the births of the last step for the next step. `seconds`: the length of the last step, above 0, up to 1e9.
 * `body`: a body with the emitter's animation or collider; 0 for textures of a single collider. Each birth starts where
 * the surface was at its time of birth, interpolated linearly between the last two poses. Call it before the
 * relief_textures_set_poses() of the next step. Returns the number of births accepted, or -1 on error. Needs no
 * context. */
int64_t relief_particles_emit(relief_particles* particles, relief_emitter* emitter, relief_textures* textures,
                              uint32_t body, float seconds);

/* --- renderers (GL) --- */

typedef struct relief_renderer relief_renderer;

typedef struct relief_renderer_options {
    size_t size;
    float diameter; /* of a particle; 0: 1/100 of the collider's longest side, or 0.01 without a collider */
    float color[3]; /* sRGB, 0…1; all 0: white */
    float opacity;  /* 0…1; 0: 0.95 */
} relief_renderer_options;

typedef struct relief_view {
    size_t size;
    float view[16];
    float projection[16];  /* perspective */
    uint32_t framebuffer;  /* with colour and depth; 0: the default framebuffer */
    int32_t width, height; /* in pixels; up to 65536 */
    int32_t srgb;          /* 1: the framebuffer stores sRGB values, as a window does; 0: linear */
} relief_view;

/* Creates a renderer of particles on which the collider casts shadows. `textures` and `collider`: of the same collider,
 * or both NULL for no shadows. For textures of a world, `collider` must be NULL; the shadows then cover the initial
 * bounds of the bodies. The collider may be freed afterwards. */
relief_renderer* relief_renderer_create(const relief_textures* textures, const relief_collider* collider);
void relief_renderer_free(relief_renderer* renderer);
/* Draws the particles over the framebuffer's contents, tested against its depth buffer. `options`: NULL for all 0. */
int relief_renderer_draw(relief_renderer* renderer, const relief_particles* particles,
                         const relief_renderer_options* options, const relief_view* view);

#ifdef __cplusplus
}
#endif

#endif
