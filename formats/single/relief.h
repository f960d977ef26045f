/* SPDX-License-Identifier: Apache-2.0 */
/* Relief colliders as a single-header library for C99 and C++11. It depends only on the C standard library. Define
 * RELIEF_IMPLEMENTATION in one source file before the include; other files only include it.
 *
 *     relief_collider bunny;
 *     relief_status status = relief_load(&bunny, "bunny.relief", NULL);
 *     if (status != RELIEF_OK) printf("bunny.relief: %s\n", relief_message(status));
 *
 *     float p[3] = {0, 0.1F, 0}, n[3];
 *     float d = relief_distance(&bunny, p, n);     d < 0: p is inside; n is the normal of the surface
 *     relief_close(&bunny);
 *
 * It reads the containers that `relief bake` writes by default: one map of patches, not compressed. Containers baked
 * with `--compress` also need a decompressor: pass ZSTD_decompress of <zstd.h>. Containers with other maps
 * (`--map`, `--paper`) are rejected as RELIEF_UNSUPPORTED.
 *
 * Files may be hostile. relief_open() validates a container completely, as formats/README.md specifies. The other
 * functions therefore never read outside the texels.
 *
 * Points, distances and bounds are in the units and axes of the mesh. Distances are positive outside. Normals have unit
 * length and point outwards.
 *
 * Results equal those of the library bit for bit unless the compiler fuses a*b + c into one operation. Pragmas below
 * prevent this for clang. GCC fuses on processors such as ARM64, except with -std=c99 or -ffp-contract=off. Do not use
 * the fast-math option.
 *
 * Optional macros for the implementation:
 *     RELIEF_MALLOC(bytes), RELIEF_FREE(pointer)   replace malloc and free; define both
 *     RELIEF_NO_STDIO                              omits relief_load()
 *     RELIEF_UNPACKED_MAX                          maximum bytes that a compressed container may unpack to (default:
 *                                                  64 MiB), or 16 times the size of the container if that is larger
 *
 * The C API of Relief's library is a different header, relief_runtime.h. A program can use both, in different files. */
#ifndef RELIEF_H
#define RELIEF_H

#ifdef RELIEF_RUNTIME_H
#error "relief.h and relief_runtime.h both define relief_collider; include them in different source files"
#endif

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The numbers that a shader needs besides the texels. The 80 bytes are laid out as a uniform block (std140).
 *
 * The rows transform a point to map space, whose unit is the edge of a root cell: x' = row_x[0]*x + (row_x[1]*y +
 * (row_x[2]*z + row_x[3])), likewise y' and z'.
 *
 * size: edge of a root cell in object units; number of root cells along x', y' and z'.
 * place: index of the collider's first texel in the texture (0); stride of root cells along y' and z', in texels;
 * levels below the root cells. To pack colliders into one texture, set place[0] in your copies of the constants. */
typedef struct relief_constants {
    float row_x[4];
    float row_y[4];
    float row_z[4];
    float size[4];
    int32_t place[4];
} relief_constants;

/* An open collider, which is read-only. Create it with relief_open() or relief_load(); free it with relief_close().
 * Upload `texels` as an RGBA16UI texture (four unsigned 16-bit integers), with nearest filtering and one level. */
typedef struct relief_collider {
    relief_constants constants;
    uint16_t* texels; /* 4 * width * height numbers, row by row */
    int32_t width;    /* RELIEF_WIDTH */
    int32_t height;
    float bounds_min[3]; /* box of the mesh */
    float bounds_max[3];
    char unit[17]; /* unit of length, such as "m"; "" if unknown */
} relief_collider;

#define RELIEF_LOG2_WIDTH 11
#define RELIEF_WIDTH (1 << RELIEF_LOG2_WIDTH) /* texels in a row of the texture */
#define RELIEF_FAR_OUTSIDE 1e30F              /* distance of points outside all root cells */

typedef enum relief_status {
    RELIEF_OK = 0,
    RELIEF_CANNOT_READ,     /* the file does not exist, or cannot be read */
    RELIEF_NOT_A_CONTAINER, /* the signature of a .relief file is missing */
    RELIEF_WRONG_VERSION,   /* not version 2 */
    RELIEF_DAMAGED,         /* truncated, longer than stated, or a checksum does not match */
    RELIEF_INVALID,         /* violates the format, or has values of a later version */
    RELIEF_UNSUPPORTED,     /* not exactly one map of patches */
    RELIEF_COMPRESSED,      /* needs a decompressor */
    RELIEF_TOO_LARGE,       /* exceeds RELIEF_UNPACKED_MAX, or the maximum file size (144 MiB) */
    RELIEF_OUT_OF_MEMORY
} relief_status;

/* Returns one line in English that states what is wrong and how to fix it, without the name of the file. */
const char* relief_message(relief_status status);

/* Decompresses one zstd frame. Returns the number of bytes written to `out`; any other value than `out_size` is an
 * error. ZSTD_decompress has this signature. */
typedef size_t (*relief_decompress)(void* out, size_t out_size, const void* in, size_t in_size);

/* Reads a container from memory. `bytes` may have any alignment; they are not used after the call. `decompress` may be
 * NULL, which rejects compressed containers. On failure, *collider is zero and owns nothing. Allocates at most `size`
 * bytes plus 16 kB; for a compressed container, at most the bytes that RELIEF_UNPACKED_MAX permits plus 12 MiB. */
relief_status relief_open(relief_collider* collider, const void* bytes, size_t size,
                          relief_decompress decompress);

#ifndef RELIEF_NO_STDIO
/* Reads a container from a file. `path` is passed to fopen(). */
relief_status relief_load(relief_collider* collider, const char* path, relief_decompress decompress);
#endif

/* Frees the texels of a collider and sets it to zero. Does nothing if it is zero. */
void relief_close(relief_collider* collider);

/* Returns the signed distance of a point. `normal` may be NULL. Outside all root cells, and if a coordinate is NaN or
 * infinite, the distance is RELIEF_FAR_OUTSIDE and the normal is zero. Threads may share a collider. */
float relief_distance(const relief_collider* collider, const float point[3], float normal[3]);

/* Collides a particle with a collider. If the distance of `position` is less than `radius`, moves the particle along
 * the normal to the distance `radius`. If its velocity points inwards, multiplies the normal velocity by -restitution
 * and the tangential velocity by 1 - friction. `restitution` and `friction` are in 0...1: with 0 and 0 the particle
 * slides, with 0 and 1 it sticks. Returns whether the particle hit. Threads may share a collider. */
int relief_collide(const relief_collider* collider, float position[3], float velocity[3], float radius,
                   float restitution, float friction);

#ifdef __cplusplus
}
#endif
#endif /* RELIEF_H */

/* ----------------------------------------------------------------------------------------------------------------- */

#ifdef RELIEF_IMPLEMENTATION
#ifndef RELIEF_IMPLEMENTED
#define RELIEF_IMPLEMENTED

#include <float.h>
#include <limits.h>
#include <math.h>
#include <string.h>
#ifndef RELIEF_NO_STDIO
#include <stdio.h>
#endif
#ifndef RELIEF_MALLOC
#include <stdlib.h>
#define RELIEF_MALLOC(bytes) malloc(bytes)
#define RELIEF_FREE(pointer) free(pointer)
#endif
#ifndef RELIEF_UNPACKED_MAX
#define RELIEF_UNPACKED_MAX (64 << 20)
#endif
#ifdef __clang__
#define RLF_EXACT _Pragma("STDC FP_CONTRACT OFF") /* at the start of functions */
#else
#define RLF_EXACT
#endif

/* --- numbers in bytes of any alignment, little-endian --- */

static uint16_t rlf_u16(const unsigned char* p) {
    return (uint16_t)(p[0] | p[1] << 8);
}

static uint32_t rlf_u32(const unsigned char* p) {
    return (uint32_t)rlf_u16(p) | (uint32_t)rlf_u16(p + 2) << 16;
}

static uint64_t rlf_u64(const unsigned char* p) {
    return (uint64_t)rlf_u32(p) | (uint64_t)rlf_u32(p + 4) << 32;
}

static float rlf_float_of(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof(value));
    return value;
}

static int rlf_finite(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof(bits));
    return (bits & 0x7f800000U) != 0x7f800000U;
}

/* --- XXH3, 64 bits, seed 0, with its default secret --- */

static const unsigned char rlf_secret[192] = {
    0xb8, 0xfe, 0x6c, 0x39, 0x23, 0xa4, 0x4b, 0xbe, 0x7c, 0x01, 0x81, 0x2c, 0xf7, 0x21, 0xad, 0x1c,
    0xde, 0xd4, 0x6d, 0xe9, 0x83, 0x90, 0x97, 0xdb, 0x72, 0x40, 0xa4, 0xa4, 0xb7, 0xb3, 0x67, 0x1f,
    0xcb, 0x79, 0xe6, 0x4e, 0xcc, 0xc0, 0xe5, 0x78, 0x82, 0x5a, 0xd0, 0x7d, 0xcc, 0xff, 0x72, 0x21,
    0xb8, 0x08, 0x46, 0x74, 0xf7, 0x43, 0x24, 0x8e, 0xe0, 0x35, 0x90, 0xe6, 0x81, 0x3a, 0x26, 0x4c,
    0x3c, 0x28, 0x52, 0xbb, 0x91, 0xc3, 0x00, 0xcb, 0x88, 0xd0, 0x65, 0x8b, 0x1b, 0x53, 0x2e, 0xa3,
    0x71, 0x64, 0x48, 0x97, 0xa2, 0x0d, 0xf9, 0x4e, 0x38, 0x19, 0xef, 0x46, 0xa9, 0xde, 0xac, 0xd8,
    0xa8, 0xfa, 0x76, 0x3f, 0xe3, 0x9c, 0x34, 0x3f, 0xf9, 0xdc, 0xbb, 0xc7, 0xc7, 0x0b, 0x4f, 0x1d,
    0x8a, 0x51, 0xe0, 0x4b, 0xcd, 0xb4, 0x59, 0x31, 0xc8, 0x9f, 0x7e, 0xc9, 0xd9, 0x78, 0x73, 0x64,
    0xea, 0xc5, 0xac, 0x83, 0x34, 0xd3, 0xeb, 0xc3, 0xc5, 0x81, 0xa0, 0xff, 0xfa, 0x13, 0x63, 0xeb,
    0x17, 0x0d, 0xdd, 0x51, 0xb7, 0xf0, 0xda, 0x49, 0xd3, 0x16, 0x55, 0x26, 0x29, 0xd4, 0x68, 0x9e,
    0x2b, 0x16, 0xbe, 0x58, 0x7d, 0x47, 0xa1, 0xfc, 0x8f, 0xf8, 0xb8, 0xd1, 0x7a, 0xd0, 0x31, 0xce,
    0x45, 0xcb, 0x3a, 0x8f, 0x95, 0x16, 0x04, 0x28, 0xaf, 0xd7, 0xfb, 0xca, 0xbb, 0x4b, 0x40, 0x7e};

static const uint32_t rlf_prime32_1 = 0x9e3779b1U, rlf_prime32_2 = 0x85ebca77U, rlf_prime32_3 = 0xc2b2ae3dU;
static const uint64_t rlf_prime64_1 = 0x9e3779b185ebca87U, rlf_prime64_2 = 0xc2b2ae3d27d4eb4fU,
                      rlf_prime64_3 = 0x165667b19e3779f9U, rlf_prime64_4 = 0x85ebca77c2b2ae63U,
                      rlf_prime64_5 = 0x27d4eb2f165667c5U;

/* Returns the exclusive or of the halves of the 128-bit product. */
static uint64_t rlf_multiply_fold(uint64_t a, uint64_t b) {
    uint64_t a_low = a & 0xffffffffU, a_high = a >> 32, b_low = b & 0xffffffffU, b_high = b >> 32;
    uint64_t low = a_low * b_low, middle_1 = a_high * b_low, middle_2 = a_low * b_high;
    uint64_t carry = (low >> 32) + (middle_1 & 0xffffffffU) + middle_2; /* at most 2^64 - 1 */
    uint64_t high = a_high * b_high + (middle_1 >> 32) + (carry >> 32);
    return high ^ (carry << 32 | (low & 0xffffffffU));
}

static uint64_t rlf_avalanche(uint64_t h) {
    h = (h ^ h >> 37) * 0x165667919e3779f9U;
    return h ^ h >> 32;
}

static uint64_t rlf_avalanche_short(uint64_t h) {
    h = (h ^ h >> 33) * rlf_prime64_2;
    h = (h ^ h >> 29) * rlf_prime64_3;
    return h ^ h >> 32;
}

static uint64_t rlf_rotate(uint64_t h, int bits) {
    return h << bits | h >> (64 - bits);
}

/* Mixes 16 bytes of data with 16 bytes of the secret. */
static uint64_t rlf_mix(const unsigned char* p, size_t secret) {
    const unsigned char* key = rlf_secret + secret;
    return rlf_multiply_fold(rlf_u64(p) ^ rlf_u64(key), rlf_u64(p + 8) ^ rlf_u64(key + 8));
}

/* Hashes at most 16 bytes. */
static uint64_t rlf_hash_short(const unsigned char* p, size_t size) {
    const unsigned char* key = rlf_secret;
    uint64_t low, high, swapped = 0;
    int i;
    if (size == 0) {
        return rlf_avalanche_short(rlf_u64(key + 56) ^ rlf_u64(key + 64));
    }
    if (size <= 3) {
        uint32_t all = (uint32_t)p[0] << 16 | (uint32_t)p[size / 2] << 24 | p[size - 1] | (uint32_t)size << 8;
        return rlf_avalanche_short(all ^ (rlf_u32(key) ^ rlf_u32(key + 4)));
    }
    if (size <= 8) {
        uint64_t h = rlf_u32(p + size - 4) | (uint64_t)rlf_u32(p) << 32;
        h ^= rlf_u64(key + 8) ^ rlf_u64(key + 16);
        h ^= rlf_rotate(h, 49) ^ rlf_rotate(h, 24);
        h *= 0x9fb21c651e98df25U;
        h = (h ^ ((h >> 35) + size)) * 0x9fb21c651e98df25U;
        return h ^ h >> 28;
    }
    low = rlf_u64(p) ^ (rlf_u64(key + 24) ^ rlf_u64(key + 32));
    high = rlf_u64(p + size - 8) ^ (rlf_u64(key + 40) ^ rlf_u64(key + 48));
    for (i = 0; i < 64; i += 8) {
        swapped = swapped << 8 | (low >> i & 0xffU);
    }
    return rlf_avalanche(size + swapped + high + rlf_multiply_fold(low, high));
}

/* Adds a stripe of 64 bytes to the eight accumulators. */
static void rlf_accumulate(uint64_t sum[8], const unsigned char* p, size_t secret) {
    int i;
    for (i = 0; i < 8; ++i) {
        uint64_t data = rlf_u64(p + 8 * i);
        uint64_t key = data ^ rlf_u64(rlf_secret + secret + 8 * i);
        sum[i ^ 1] += data;
        sum[i] += (key & 0xffffffffU) * (key >> 32);
    }
}

/* Hashes more than 240 bytes. */
static uint64_t rlf_hash_long(const unsigned char* p, size_t size) {
    uint64_t sum[8] = {rlf_prime32_3, rlf_prime64_1, rlf_prime64_2, rlf_prime64_3,
                       rlf_prime64_4, rlf_prime32_2, rlf_prime64_5, rlf_prime32_1};
    uint64_t h = size * rlf_prime64_1;
    size_t stripes = (size - 1) / 64, stripe;
    int i;
    for (stripe = 0; stripe < stripes; ++stripe) {
        rlf_accumulate(sum, p + 64 * stripe, stripe % 16 * 8);
        for (i = 0; stripe % 16 == 15 && i < 8; ++i) { /* after 1024 bytes */
            sum[i] = (sum[i] ^ sum[i] >> 47 ^ rlf_u64(rlf_secret + 128 + 8 * i)) * rlf_prime32_1;
        }
    }
    rlf_accumulate(sum, p + size - 64, 121);
    for (i = 0; i < 4; ++i) {
        const unsigned char* key = rlf_secret + 11 + 16 * i;
        h += rlf_multiply_fold(sum[2 * i] ^ rlf_u64(key), sum[2 * i + 1] ^ rlf_u64(key + 8));
    }
    return rlf_avalanche(h);
}

static uint64_t rlf_xxh3(const unsigned char* p, size_t size) {
    uint64_t h = size * rlf_prime64_1;
    size_t i;
    if (size <= 16) {
        return rlf_hash_short(p, size);
    }
    if (size > 240) {
        return rlf_hash_long(p, size);
    }
    if (size <= 128) {
        for (i = 0; i <= (size - 1) / 32; ++i) { /* pairs from both ends; sums do not depend on the order */
            h += rlf_mix(p + 16 * i, 32 * i) + rlf_mix(p + size - 16 * (i + 1), 32 * i + 16);
        }
        return rlf_avalanche(h);
    }
    for (i = 0; i < 8; ++i) {
        h += rlf_mix(p + 16 * i, 16 * i);
    }
    h = rlf_avalanche(h);
    for (i = 8; i < size / 16; ++i) {
        h += rlf_mix(p + 16 * i, 16 * (i - 8) + 3);
    }
    return rlf_avalanche(h + rlf_mix(p + size - 16, 119));
}

/* --- metadata: a FlatBuffers table of formats/collider.fbs --- */

/* The kinds of fields. RLF_VALUE is a number or a structure in the table; the others are offsets. */
enum { RLF_END, RLF_VALUE, RLF_TEXT, RLF_VALUES, RLF_TABLE, RLF_TABLES };

/* A field of a table. The fields of a table are in the order of the schema; RLF_END ends them. */
typedef struct rlf_field {
    unsigned char kind, required;
    unsigned char size;             /* bytes of the value, or of one element */
    unsigned char align;            /* of the value, in bytes */
    const struct rlf_field* fields; /* RLF_TABLE, RLF_TABLES: of the tables referred to */
} rlf_field;

/* clang-format off */
enum { RLF_OPTION_NAME, RLF_OPTION_VALUE };
static const rlf_field rlf_option[] = {{RLF_TEXT, 1, 1, 1, NULL}, {RLF_TEXT, 1, 1, 1, NULL}, {RLF_END, 0, 0, 0, NULL}};

enum { RLF_MESH_NAME, RLF_MESH_HASH, RLF_TRIANGLES, RLF_TOOL_VERSION, RLF_OPTIONS };
static const rlf_field rlf_provenance[] = {
    {RLF_TEXT, 1, 1, 1, NULL}, {RLF_TEXT, 1, 1, 1, NULL}, {RLF_VALUE, 0, 8, 8, NULL}, {RLF_TEXT, 1, 1, 1, NULL},
    {RLF_TABLES, 0, 4, 4, rlf_option}, {RLF_END, 0, 0, 0, NULL}};

enum { RLF_FORMAT, RLF_COMPARE, RLF_MAP_WIDTH, RLF_MAP_HEIGHT, RLF_OBJECT_TO_MAP, RLF_OBJECT_PER_MAP, RLF_ENCLOSES,
       RLF_EMPTY_IS_OUTSIDE, RLF_COMPRESSION, RLF_PAYLOAD, RLF_DECODE };
static const rlf_field rlf_map[] = {
    {RLF_VALUE, 0, 1, 1, NULL}, {RLF_VALUE, 0, 1, 1, NULL}, {RLF_VALUE, 0, 4, 4, NULL}, {RLF_VALUE, 0, 4, 4, NULL},
    {RLF_VALUE, 1, 48, 4, NULL}, {RLF_VALUE, 1, 12, 4, NULL}, {RLF_VALUE, 0, 1, 1, NULL}, {RLF_VALUE, 0, 1, 1, NULL},
    {RLF_VALUE, 0, 1, 1, NULL}, {RLF_VALUE, 1, 32, 8, NULL}, {RLF_VALUE, 0, 1, 1, NULL}, {RLF_END, 0, 0, 0, NULL}};

enum { RLF_MATERIAL_NAME, RLF_RESTITUTION, RLF_FRICTION, RLF_LIFETIME_LOSS, RLF_AREA_FRACTION };
static const rlf_field rlf_material[] = {
    {RLF_TEXT, 1, 1, 1, NULL}, {RLF_VALUE, 0, 4, 4, NULL}, {RLF_VALUE, 0, 4, 4, NULL}, {RLF_VALUE, 0, 4, 4, NULL},
    {RLF_VALUE, 0, 4, 4, NULL}, {RLF_END, 0, 0, 0, NULL}};

enum { RLF_LIST, RLF_SIDES, RLF_ORIGIN, RLF_CUBE_SIZE, RLF_NODES, RLF_NODES_COMPRESSION, RLF_NODES_SIZE };
static const rlf_field rlf_materials[] = {
    {RLF_TABLES, 1, 4, 4, rlf_material}, {RLF_VALUES, 0, 3, 1, NULL}, {RLF_VALUE, 1, 12, 4, NULL},
    {RLF_VALUE, 0, 4, 4, NULL}, {RLF_VALUES, 0, 1, 1, NULL}, {RLF_VALUE, 0, 1, 1, NULL}, {RLF_VALUE, 0, 4, 4, NULL},
    {RLF_END, 0, 0, 0, NULL}};

enum { RLF_BOUNDS_MIN, RLF_BOUNDS_MAX, RLF_UNIT, RLF_PROVENANCE, RLF_MAPS, RLF_ANIMATION, RLF_MATERIALS };
static const rlf_field rlf_collider[] = {
    {RLF_VALUE, 1, 12, 4, NULL}, {RLF_VALUE, 1, 12, 4, NULL}, {RLF_TEXT, 1, 1, 1, NULL},
    {RLF_TABLE, 1, 4, 4, rlf_provenance}, {RLF_TABLES, 1, 4, 4, rlf_map}, {RLF_VALUES, 0, 1, 1, NULL},
    {RLF_TABLE, 0, 4, 4, rlf_materials}, {RLF_END, 0, 0, 0, NULL}};
/* clang-format on */

/* Places are offsets into the metadata. Tables are counted during verification. */
typedef struct rlf_metadata {
    const unsigned char* bytes;
    uint64_t size;
    uint32_t tables;
} rlf_metadata;

/* Returns whether `size` bytes at a place are within the metadata, and the place is a multiple of `align`. FlatBuffers
 * also rejects a range that covers the whole metadata. */
static int rlf_holds(const rlf_metadata* m, uint64_t place, uint64_t size, uint64_t align) {
    return place % align == 0 && size < m->size && place <= m->size - size;
}

/* Returns the target of an offset. */
static uint64_t rlf_target(const rlf_metadata* m, uint64_t place) {
    return place + rlf_u32(m->bytes + place);
}

/* Returns whether an offset is valid, and neither 0 nor negative. */
static int rlf_is_offset(const rlf_metadata* m, uint64_t place) {
    return rlf_holds(m, place, 4, 4) && rlf_u32(m->bytes + place) - 1U < 0x7fffffffU &&
           rlf_holds(m, rlf_target(m, place), 1, 1);
}

/* Returns the place of a table's vtable. A negative place wraps to a large number. */
static uint64_t rlf_vtable(const rlf_metadata* m, uint64_t table) {
    return table - (uint64_t)(int64_t)(int32_t)rlf_u32(m->bytes + table);
}

/* Returns the place of a field of a table, or 0 if the field is absent. */
static uint64_t rlf_find(const rlf_metadata* m, uint64_t table, unsigned field) {
    const unsigned char* vtable = m->bytes + rlf_vtable(m, table);
    unsigned entry = 4 + 2 * field, offset = entry < rlf_u16(vtable) ? rlf_u16(vtable + entry) : 0;
    return offset == 0 ? 0 : table + offset;
}

static int rlf_verify_field(rlf_metadata* m, uint64_t place, const rlf_field* field);

/* Verifies a table and everything that it refers to, as flatbuffers::Verifier does with a limit of a million tables.
 * Recursion ends after the three levels of the schema. */
static int rlf_verify(rlf_metadata* m, uint64_t table, const rlf_field* fields) {
    uint64_t vtable, place;
    unsigned i;
    if (!rlf_holds(m, table, 4, 4) || ++m->tables > 1000000) {
        return 0;
    }
    vtable = rlf_vtable(m, table);
    if (!rlf_holds(m, vtable, 2, 2) || rlf_u16(m->bytes + vtable) % 2 != 0 ||
        !rlf_holds(m, vtable, rlf_u16(m->bytes + vtable), 1)) {
        return 0;
    }
    for (i = 0; fields[i].kind != RLF_END; ++i) {
        place = rlf_find(m, table, i);
        if (place == 0 ? fields[i].required : !rlf_verify_field(m, place, &fields[i])) {
            return 0;
        }
    }
    return 1;
}

static int rlf_verify_field(rlf_metadata* m, uint64_t place, const rlf_field* field) {
    uint64_t end;
    if (field->kind == RLF_VALUE) {
        return rlf_holds(m, place, field->size, field->align);
    }
    if (!rlf_is_offset(m, place)) {
        return 0;
    }
    place = rlf_target(m, place);
    if (field->kind == RLF_TABLE) {
        return rlf_verify(m, place, field->fields);
    }
    if (!rlf_holds(m, place, 4, 4)) { /* the number of elements */
        return 0;
    }
    end = place + 4 + (uint64_t)rlf_u32(m->bytes + place) * field->size;
    if (!rlf_holds(m, place, end - place, 1)) {
        return 0;
    }
    if (field->kind == RLF_TEXT) {
        return rlf_holds(m, end, 1, 1) && m->bytes[end] == 0;
    }
    for (place += 4; field->kind == RLF_TABLES && place < end; place += 4) {
        if (!rlf_verify(m, rlf_target(m, place), field->fields)) {
            return 0;
        }
    }
    return 1;
}

/* The accessors below need verified metadata. Absent integers are 0. */

static unsigned rlf_get_byte(const rlf_metadata* m, uint64_t table, unsigned field) {
    uint64_t place = rlf_find(m, table, field);
    return place == 0 ? 0 : m->bytes[place];
}

static uint32_t rlf_get_u32(const rlf_metadata* m, uint64_t table, unsigned field) {
    uint64_t place = rlf_find(m, table, field);
    return place == 0 ? 0 : rlf_u32(m->bytes + place);
}

static float rlf_get_float(const rlf_metadata* m, uint64_t table, unsigned field, float absent) {
    uint64_t place = rlf_find(m, table, field);
    return place == 0 ? absent : rlf_float_of(rlf_u32(m->bytes + place));
}

/* Reads a structure of floats. Returns whether all are finite. */
static int rlf_get_floats(const rlf_metadata* m, uint64_t place, float* out, int count) {
    int finite = 1, i;
    for (i = 0; i < count; ++i) {
        out[i] = rlf_float_of(rlf_u32(m->bytes + place + 4 * (uint64_t)i));
        finite = finite && rlf_finite(out[i]);
    }
    return finite;
}

/* A text or a vector: its elements and their number. NULL and 0 if the field is absent. */
typedef struct rlf_list {
    const unsigned char* items;
    uint64_t place;
    uint32_t count;
} rlf_list;

static rlf_list rlf_get_list(const rlf_metadata* m, uint64_t table, unsigned field) {
    rlf_list list = {NULL, 0, 0};
    uint64_t place = rlf_find(m, table, field);
    if (place != 0) {
        place = rlf_target(m, place);
        list.count = rlf_u32(m->bytes + place);
        list.place = place + 4;
        list.items = m->bytes + list.place;
    }
    return list;
}

/* Returns an element of a vector of tables. */
static uint64_t rlf_item(const rlf_metadata* m, rlf_list list, uint32_t index) {
    return rlf_target(m, list.place + 4 * (uint64_t)index);
}

/* --- descriptions: texts, materials, frame --- */

/* The rest of a UTF-8 character: the number of bytes to read, and the valid range of the next byte. */
typedef struct rlf_utf8 {
    int rest;
    unsigned low, high;
} rlf_utf8;

/* Returns whether bytes continue a text of well-formed UTF-8 without control characters. */
static int rlf_is_text(rlf_utf8* state, rlf_list text) {
    uint32_t i;
    for (i = 0; i < text.count; ++i) {
        unsigned c = text.items[i];
        if (state->rest > 0) {
            if (c < state->low || c > state->high) {
                return 0;
            }
            state->low = 0x80;
            state->high = 0xbf;
            --state->rest;
        } else if (c < 0x20 || c == 0x7f || (c >= 0x80 && c < 0xc2) || c > 0xf4) {
            return 0;
        } else if (c >= 0x80) {
            state->rest = c < 0xe0 ? 1 : c < 0xf0 ? 2 : 3;
            /* no control characters from U+0080 to U+009F, overlong forms, surrogates, or values beyond U+10FFFF */
            state->low = c == 0xc2 || c == 0xe0 ? 0xa0 : c == 0xf0 ? 0x90 : 0x80;
            state->high = c == 0xed ? 0x9f : c == 0xf4 ? 0x8f : 0xbf;
        }
    }
    return 1;
}

static int rlf_is_whole_text(rlf_list text, uint32_t size_max) {
    rlf_utf8 state = {0, 0, 0};
    return text.count <= size_max && rlf_is_text(&state, text) && state.rest == 0;
}

/* Checks bounds, unit and provenance, and writes bounds and unit. */
static int rlf_read_description(const rlf_metadata* m, uint64_t root, relief_collider* collider) {
    uint64_t provenance = rlf_target(m, rlf_find(m, root, RLF_PROVENANCE));
    rlf_list unit = rlf_get_list(m, root, RLF_UNIT);
    rlf_list name = rlf_get_list(m, provenance, RLF_MESH_NAME);
    rlf_list hash = rlf_get_list(m, provenance, RLF_MESH_HASH);
    rlf_list options = rlf_get_list(m, provenance, RLF_OPTIONS);
    rlf_utf8 state = {0, 0, 0}; /* the texts of options count as one text */
    uint64_t option_bytes = 0;
    uint32_t i;
    if (!rlf_get_floats(m, rlf_find(m, root, RLF_BOUNDS_MIN), collider->bounds_min, 3) ||
        !rlf_get_floats(m, rlf_find(m, root, RLF_BOUNDS_MAX), collider->bounds_max, 3)) {
        return 0;
    }
    for (i = 0; i < 3; ++i) {
        if (collider->bounds_min[i] > collider->bounds_max[i]) {
            return 0;
        }
    }
    if (!rlf_is_whole_text(unit, 16) || !rlf_is_whole_text(name, 255) ||
        !rlf_is_whole_text(rlf_get_list(m, provenance, RLF_TOOL_VERSION), 64)) {
        return 0;
    }
    memcpy(collider->unit, unit.items, unit.count); /* the rest is zero */
    for (i = 0; i < name.count; ++i) {
        if (name.items[i] == '/') {
            return 0;
        }
    }
    if (hash.count != 0 && hash.count != 32) {
        return 0;
    }
    for (i = 0; i < hash.count; ++i) {
        if ((hash.items[i] < '0' || hash.items[i] > '9') && (hash.items[i] < 'a' || hash.items[i] > 'f')) {
            return 0;
        }
    }
    for (i = 0; i < options.count; ++i) {
        uint64_t option = rlf_item(m, options, i);
        rlf_list key = rlf_get_list(m, option, RLF_OPTION_NAME);
        rlf_list value = rlf_get_list(m, option, RLF_OPTION_VALUE);
        option_bytes += (uint64_t)key.count + value.count;
        if (option_bytes > 1 << 20 || !rlf_is_text(&state, key) || !rlf_is_text(&state, value)) {
            return 0;
        }
    }
    return state.rest == 0;
}

static int rlf_is_fraction(float value) {
    return value >= 0 && value <= 1;
}

/* Checks the materials of the list. */
static int rlf_are_materials(const rlf_metadata* m, rlf_list list) {
    uint32_t i, k;
    for (i = 0; i < list.count; ++i) {
        uint64_t one = rlf_item(m, list, i);
        rlf_list name = rlf_get_list(m, one, RLF_MATERIAL_NAME);
        float loss = rlf_get_float(m, one, RLF_LIFETIME_LOSS, 0);
        if (!rlf_is_whole_text(name, 256) || !rlf_is_fraction(rlf_get_float(m, one, RLF_RESTITUTION, 1)) ||
            !rlf_is_fraction(rlf_get_float(m, one, RLF_FRICTION, 0)) ||
            !rlf_is_fraction(rlf_get_float(m, one, RLF_AREA_FRACTION, 0)) || !(loss >= 0 && loss <= 1e6F)) {
            return 0;
        }
        for (k = 0; k + 2 < name.count;
             ++k) { /* U+202A to U+202E and U+2066 to U+2069 change the direction of text */
            const unsigned char* c = name.items + k;
            if (c[0] == 0xe2 && ((c[1] == 0x80 && c[2] >= 0xaa && c[2] <= 0xae) ||
                                 (c[1] == 0x81 && c[2] >= 0xa6 && c[2] <= 0xa9))) {
                return 0;
            }
        }
        for (k = 0; k < i; ++k) {
            rlf_list other = rlf_get_list(m, rlf_item(m, list, k), RLF_MATERIAL_NAME);
            if (other.count == name.count && memcmp(other.items, name.items, name.count) == 0) {
                return 0;
            }
        }
    }
    return 1;
}

/* Checks the octree of materials: nodes of 12 bytes, level by level, each with one parent. */
static int rlf_are_nodes(const unsigned char* nodes, uint32_t count, uint32_t leaves) {
    uint32_t reached = count > 0 ? 1 : 0, level_end = reached, level = 1, i, octant;
    for (i = 0; i < count; ++i) {
        const unsigned char* node = nodes + 12 * (size_t)i;
        uint32_t mask = node[0];
        if (i == level_end) {
            ++level;
            level_end = reached;
        }
        if (i >= reached || level > 20 || rlf_u32(node) >> 8 != (mask == 0 ? 0 : reached)) {
            return 0;
        }
        for (octant = 0; octant < 8; ++octant) {
            uint32_t is_node = mask >> octant & 1U;
            reached += is_node;
            if (is_node ? node[4 + octant] != 0 : node[4 + octant] >= leaves) {
                return 0;
            }
        }
    }
    return reached == count;
}

/* Returns whether bytes are exactly one zstd frame (RFC 8878) that states a content size of `unpacked`. Checks the
 * header of the frame and the sizes of its blocks, not their contents. */
static int rlf_is_frame(const unsigned char* p, uint64_t size, uint64_t unpacked) {
    static const unsigned char dictionary_sizes[4] = {0, 1, 2, 4};
    uint64_t place = 5, stated = 0, block;
    unsigned flags, content_bytes, single, i;
    if (size < 6 || rlf_u32(p) != 0xfd2fb528U) {
        return 0;
    }
    flags = p[4];
    single = flags >> 5 & 1U;
    content_bytes = flags >> 6 == 0 ? single : 1U << (flags >> 6);
    if ((flags & 8U) != 0 || content_bytes == 0) {
        return 0;
    }
    place += (single ? 0U : 1U) + dictionary_sizes[flags & 3U];
    if (place + content_bytes > size) {
        return 0;
    }
    for (i = 0; i < content_bytes; ++i) {
        stated |= (uint64_t)p[place + i] << 8 * i;
    }
    stated += content_bytes == 2 ? 256 : 0;
    place += content_bytes;
    do { /* a block header: bit 0: last; 1-2: raw, repeated byte, compressed, reserved; then the size */
        if (place + 3 > size) {
            return 0;
        }
        block = rlf_u16(p + place) | (uint64_t)p[place + 2] << 16;
        place += 3 + ((block >> 1 & 3U) == 1 ? 1 : block >> 3);
        if ((block >> 1 & 3U) == 3 || place > size) {
            return 0;
        }
    } while ((block & 1U) == 0);
    return stated == unpacked && place + ((flags & 4U) != 0 ? 4 : 0) == size;
}

/* Decompresses a frame. */
static relief_status rlf_unpack(unsigned char* out, uint64_t out_size, const unsigned char* in, uint64_t size,
                                relief_decompress decompress) {
    if (!rlf_is_frame(in, size, out_size)) {
        return RELIEF_INVALID;
    }
    return decompress(out, (size_t)out_size, in, (size_t)size) == out_size ? RELIEF_OK : RELIEF_INVALID;
}

/* Validates the materials, which are not returned. */
static relief_status rlf_check_materials(const rlf_metadata* m, uint64_t root, relief_decompress decompress) {
    uint64_t place = rlf_find(m, root, RLF_MATERIALS), table;
    rlf_list list, sides, nodes;
    float origin[3], size;
    uint32_t nodes_size, compression, i;
    int finite, has_nodes;
    relief_status status = RELIEF_OK;
    if (place == 0) {
        return RELIEF_OK;
    }
    table = rlf_target(m, place);
    list = rlf_get_list(m, table, RLF_LIST);
    sides = rlf_get_list(m, table, RLF_SIDES);
    nodes = rlf_get_list(m, table, RLF_NODES);
    finite = rlf_get_floats(m, rlf_find(m, table, RLF_ORIGIN), origin, 3);
    size = rlf_get_float(m, table, RLF_CUBE_SIZE, 0);
    nodes_size = rlf_get_u32(m, table, RLF_NODES_SIZE);
    compression = rlf_get_byte(m, table, RLF_NODES_COMPRESSION);
    has_nodes = nodes.items != NULL || nodes_size != 0;
    if (has_nodes &&
        (nodes_size > 12U << 20 || nodes_size % 12 != 0 ||
         (compression == 0 ? nodes_size != nodes.count : compression != 1 || nodes_size <= nodes.count))) {
        return RELIEF_INVALID;
    }
    if (list.count == 0) {
        return sides.count == 0 && origin[0] == 0 && origin[1] == 0 && origin[2] == 0 && size == 0 &&
                       nodes_size == 0
                   ? RELIEF_OK
                   : RELIEF_INVALID;
    }
    if (list.count > 255 || (uint64_t)list.count + sides.count > 256 || !finite || !(size >= 0) ||
        !rlf_finite(size) || (size == 0 && nodes_size != 0) || !rlf_are_materials(m, list)) {
        return RELIEF_INVALID;
    }
    for (i = 0; i < sides.count; ++i) {
        const unsigned char* pair = sides.items + 3 * (size_t)i;
        if (pair[0] > 8 || pair[1] >= list.count || pair[2] >= list.count) {
            return RELIEF_INVALID;
        }
    }
    if (!has_nodes || compression == 0) {
        return rlf_are_nodes(nodes.items, nodes_size / 12, list.count + sides.count) ? RELIEF_OK
                                                                                     : RELIEF_INVALID;
    }
    if (decompress == NULL) {
        return RELIEF_COMPRESSED;
    } else {
        unsigned char* unpacked = (unsigned char*)RELIEF_MALLOC(nodes_size);
        if (unpacked == NULL) {
            return RELIEF_OUT_OF_MEMORY;
        }
        status = rlf_unpack(unpacked, nodes_size, nodes.items, nodes.count, decompress);
        if (status == RELIEF_OK && !rlf_are_nodes(unpacked, nodes_size / 12, list.count + sides.count)) {
            status = RELIEF_INVALID;
        }
        RELIEF_FREE(unpacked);
        return status;
    }
}

/* Checks that the rows of the transform are orthogonal, and that `scale` contains the reciprocals of their lengths. */
static int rlf_is_transform(const float rows[12], const float scale[3]) {
    RLF_EXACT
    double unit[3][3], length[3], cosine;
    int i, k, next;
    for (i = 0; i < 3; ++i) {
        double x = rows[4 * i], y = rows[4 * i + 1], z = rows[4 * i + 2];
        length[i] = sqrt(x * x + y * y + z * z);
        if (!(length[i] > 0)) {
            return 0;
        }
        unit[i][0] = x / length[i];
        unit[i][1] = y / length[i];
        unit[i][2] = z / length[i];
    }
    for (i = 0; i < 3; ++i) {
        next = (i + 1) % 3;
        cosine = unit[i][0] * unit[next][0] + unit[i][1] * unit[next][1] + unit[i][2] * unit[next][2];
        if (!(fabs(cosine) <= 1e-4)) {
            return 0;
        }
    }
    for (k = 0; k < 3; ++k) {
        double expected = 1.0 / length[k], given = scale[k];
        if (!(given > 0) || !rlf_finite(scale[k]) || !(fabs(given - expected) <= 1e-3 * expected)) {
            return 0;
        }
    }
    return 1;
}

/* --- patches --- */

/* A texel: a record of the tree, or heights. */
typedef struct rlf_record {
    uint32_t low, high;
} rlf_record;

static rlf_record rlf_texel(const uint16_t* texels, uint32_t index) {
    const uint16_t* word = texels + 4 * (size_t)index;
    rlf_record record;
    record.low = (uint32_t)word[0] | (uint32_t)word[1] << 16;
    record.high = (uint32_t)word[2] | (uint32_t)word[3] << 16;
    return record;
}

enum { RLF_OUTSIDE, RLF_INSIDE, RLF_SPLIT, RLF_PATCH };

static unsigned rlf_kind(rlf_record record) {
    return record.low & 3U;
}

static int rlf_is_pair(rlf_record record) {
    return (record.low & 15U) == 15U;
}

/* Returns the index of the first child, of the heights, or of the first patch of a pair. */
static uint32_t rlf_first(rlf_record record) {
    return record.high & 0xffffffU;
}

/* Returns the number of heights along a side of a patch, or 0 for a pair. */
static uint32_t rlf_side(rlf_record record) {
    static const unsigned char sides[4] = {2, 3, 5, 0};
    return sides[record.low >> 2 & 3U];
}

static uint32_t rlf_count_bits(uint32_t byte) {
    byte -= byte >> 1 & 0x55U;
    byte = (byte & 0x33U) + (byte >> 2 & 0x33U);
    return (byte + (byte >> 4)) & 15U;
}

/* Checks the record of a patch. Heights must follow the records of cells, which end at `records`. */
static int rlf_is_patch(const uint16_t* texels, uint32_t count, uint32_t records, uint32_t index) {
    rlf_record record = rlf_texel(texels, index);
    uint32_t side = rlf_side(record);
    if (rlf_kind(record) != RLF_PATCH || side == 0 || (record.low >> 5 & 3U) > 2 ||
        (record.low >> 7 & 3U) > 2) {
        return 0;
    }
    return side == 2 || (rlf_first(record) >= records && rlf_first(record) + (side * side - 1) / 8 <= count);
}

/* Checks that every record refers to texels of the tree: children are the next texels, level by level. */
static int rlf_is_tree(const uint16_t* texels, uint32_t count) {
    rlf_record head = rlf_texel(texels, 0);
    uint32_t levels = head.high >> 16, level, at = 1, end, next, children;
    uint64_t roots = (uint64_t)(head.low & 0xffffU) * (head.low >> 16) * (head.high & 0xffffU);
    if (roots == 0 || levels > 15 || 1 + roots > count) {
        return 0;
    }
    end = 1 + (uint32_t)roots;
    for (level = 0; at < end;
         ++level) { /* from `at` to `end`: the records of a level; `next`: end of the next level */
        for (next = end; at < end; ++at) {
            rlf_record record = rlf_texel(texels, at);
            if (rlf_kind(record) == RLF_SPLIT) {
                children = rlf_count_bits(record.low >> 2 & 0xffU);
                if (level == levels || rlf_first(record) != next || next + children > count) {
                    return 0;
                }
                next += children;
            } else if (rlf_kind(record) != RLF_PATCH &&
                       ((record.low >> 16 & 0xffU) == 0xffU || record.low >> 24 == 0xffU ||
                        !rlf_finite(rlf_float_of(record.high)))) {
                return 0;
            }
        }
        end = next;
    }
    for (at = 1; at < end; ++at) {
        rlf_record record = rlf_texel(texels, at);
        if (rlf_kind(record) != RLF_PATCH) {
            continue;
        }
        if (!rlf_is_pair(record)) {
            if (!rlf_is_patch(texels, count, end, at)) {
                return 0;
            }
        } else if (rlf_first(record) < end || rlf_first(record) + 2 > count ||
                   !rlf_is_patch(texels, count, end, rlf_first(record)) ||
                   !rlf_is_patch(texels, count, end, rlf_first(record) + 1)) {
            return 0;
        }
    }
    return 1;
}

/* The vote of a leaf: the distance, and the normal in map space. */
typedef struct rlf_vote {
    float distance, normal[3];
} rlf_vote;

static float rlf_dot(const float a[3], const float b[3]) {
    RLF_EXACT
    return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]);
}

static void rlf_set_unit(float out[3], float x, float y, float z) {
    RLF_EXACT
    float length = sqrtf(x * x + y * y + z * z);
    out[0] = x / length;
    out[1] = y / length;
    out[2] = z / length;
}

/* Returns height i of a patch, in code steps. */
static float rlf_code(const uint16_t* texels, rlf_record patch, uint32_t side, uint32_t i) {
    rlf_record texel = patch;
    if (i == side * side - 1) {
        return (float)(patch.low >> 23 & 0xffU);
    }
    if (side == 2) {
        return (float)(patch.high >> 8 * i & 0xffU);
    }
    texel = rlf_texel(texels, rlf_first(patch) + i / 8);
    return (float)(((i & 4U) != 0 ? texel.high : texel.low) >> 8 * (i & 3U) & 0xffU);
}

/* The vote of a patch at q in the unit cube of its cell. The distance is in edges of the cell. */
static rlf_vote rlf_vote_patch(const uint16_t* texels, rlf_record patch, const float q[3]) {
    RLF_EXACT
    unsigned diagonal = patch.low >> 5 & 3U, first = patch.low >> 7 & 3U, axis;
    int mirror_a = (patch.low >> 9 & 1U) != 0, mirror_b = (patch.low >> 10 & 1U) != 0;
    uint32_t side = rlf_side(patch), scale = patch.high >> 24, corner;
    float last = (float)(side - 1), a = q[first], b = q[(first + 1) % 3], c = q[(first + 2) % 3];
    float u, v, w, column, row, s, t, c00, c10, c01, c11, lower, upper, step, base, height, by_u, by_v, by[3];
    float per_length, sign = (patch.low & 16U) != 0 ? -1.0F : 1.0F;
    rlf_vote vote;

    /* into the axes of the patch */
    a = mirror_a ? 1.0F - a : a;
    b = mirror_b ? 1.0F - b : b;
    u = diagonal == 0 ? b : 0.5F * (a - b + 1.0F);
    v = diagonal != 2 ? c : 0.25F * (a + b - 2.0F * c + 2.0F);
    w = diagonal == 0 ? a : diagonal == 1 ? a + b : a + b + c;

    /* the height and its derivatives, from four neighbours */
    column = floorf(u * last);
    row = floorf(v * last);
    column = column < 0.0F ? 0.0F : column > last - 1.0F ? last - 1.0F : column;
    row = row < 0.0F ? 0.0F : row > last - 1.0F ? last - 1.0F : row;
    s = u * last - column;
    t = v * last - row;
    corner = (uint32_t)row * side + (uint32_t)column;
    c00 = rlf_code(texels, patch, side, corner);
    c10 = rlf_code(texels, patch, side, corner + 1);
    c01 = rlf_code(texels, patch, side, corner + side);
    c11 = rlf_code(texels, patch, side, corner + side + 1);
    lower = c00 + s * (c10 - c00);
    upper = c01 + s * (c11 - c01);
    step = (float)((16U + (scale & 15U)) << (scale >> 4)) * (1.0F / 65536.0F) * (1.0F / 255.0F);
    base = ((float)(patch.low >> 11 & 0xfffU) - 2048.0F) * (1.0F / 512.0F);
    height = base + step * (lower + t * (upper - lower));
    by_u = (step * last) * ((c10 - c00) + t * ((c11 - c01) - (c10 - c00)));
    by_v = (step * last) * (upper - lower);

    /* the gradient of w - height with respect to a, b, c */
    by[0] = 1.0F;
    by[1] = -by_u;
    by[2] = -by_v;
    if (diagonal == 1) {
        by[0] = 1.0F - 0.5F * by_u;
        by[1] = 1.0F + 0.5F * by_u;
    } else if (diagonal == 2) {
        by[0] = 1.0F - 0.5F * by_u - 0.25F * by_v;
        by[1] = 1.0F + 0.5F * by_u - 0.25F * by_v;
        by[2] = 1.0F + 0.5F * by_v;
    }
    by[0] = mirror_a ? -by[0] : by[0];
    by[1] = mirror_b ? -by[1] : by[1];
    for (axis = 0; axis < 3; ++axis) {
        vote.normal[(first + axis) % 3] = by[axis];
    }
    per_length = 1.0F / sqrtf(rlf_dot(vote.normal, vote.normal));
    vote.distance = sign * ((w - height) * per_length);
    for (axis = 0; axis < 3; ++axis) {
        vote.normal[axis] = (sign * per_length) * vote.normal[axis];
    }
    return vote;
}

/* Returns a distance on the given side, at least `nearest` from the surface. */
static float rlf_on_side(int inside, float distance, float nearest) {
    return inside ? (-nearest < distance ? -nearest : distance) : (distance < nearest ? nearest : distance);
}

/* Decodes a normal of the plane of a leaf, from codes 0...254. */
static void rlf_decode_normal(float out[3], uint32_t s_code, uint32_t t_code) {
    RLF_EXACT
    float s = ((float)s_code - 127.0F) / 127.0F, t = ((float)t_code - 127.0F) / 127.0F;
    float z = 1.0F - fabsf(s) - fabsf(t);
    if (z < 0.0F) {
        rlf_set_unit(out, (s < 0.0F ? -1.0F : 1.0F) * (1.0F - fabsf(t)),
                     (t < 0.0F ? -1.0F : 1.0F) * (1.0F - fabsf(s)), z);
    } else {
        rlf_set_unit(out, s, t, z);
    }
}

/* Decodes a normal of the coarse plane of a split cell, from codes 0...126. */
static void rlf_decode_coarse_normal(float out[3], uint32_t s_code, uint32_t t_code) {
    RLF_EXACT
    float x = (float)s_code - 63.0F, y = (float)t_code - 63.0F;
    float z = 63.0F - fabsf(x) - fabsf(y), beyond = z < 0.0F ? -z : 0.0F;
    rlf_set_unit(out, x < 0.0F ? x + beyond : x - beyond, y < 0.0F ? y + beyond : y - beyond, z);
}

/* The vote at p in map space, within the root cells. The distance is in edges of a root cell. */
static rlf_vote rlf_vote_tree(const relief_collider* collider, const float p[3]) {
    RLF_EXACT
    const int32_t* place = collider->constants.place;
    const uint16_t* texels = collider->texels;
    float q[3], root[3], centred[3], cell = 1.0F, along;
    rlf_record record;
    rlf_vote vote, other;
    int inside, beside = 0, i;
    int32_t level;
    for (i = 0; i < 3; ++i) {
        root[i] = floorf(p[i]);
        q[i] = p[i] - root[i];
    }
    record = rlf_texel(texels, 1U + (uint32_t)root[2] * (uint32_t)place[2] +
                                   (uint32_t)root[1] * (uint32_t)place[1] + (uint32_t)root[0]);
    inside = rlf_kind(record) == RLF_INSIDE;
    for (level = 0; level < place[3] && rlf_kind(record) == RLF_SPLIT && !beside; ++level) {
        uint32_t octant = 0, children = record.low >> 2 & 0xffU;
        float child[3];
        for (i = 0; i < 3; ++i) {
            child[i] = 2.0F * q[i];
            octant |= (child[i] >= 1.0F ? 1U : 0U) << i;
        }
        if ((children >> octant & 1U) == 0) { /* the octant has no record */
            beside = 1;
            inside = (record.low >> (10 + octant) & 1U) != 0;
            break;
        }
        for (i = 0; i < 3; ++i) {
            q[i] = child[i] - (child[i] >= 1.0F ? 1.0F : 0.0F);
        }
        cell *= 0.5F;
        record = rlf_texel(texels, rlf_first(record) + rlf_count_bits(children & ((1U << octant) - 1U)));
        inside = rlf_kind(record) == RLF_INSIDE;
    }
    if (rlf_is_pair(record)) {
        vote = rlf_vote_patch(texels, rlf_texel(texels, rlf_first(record)), q);
        other = rlf_vote_patch(texels, rlf_texel(texels, rlf_first(record) + 1), q);
        if ((record.low & 16U) != 0 ? other.distance > vote.distance : other.distance < vote.distance) {
            vote = other;
        }
        vote.distance *= cell;
        return vote;
    }
    if (rlf_kind(record) == RLF_PATCH) {
        vote = rlf_vote_patch(texels, record, q);
        vote.distance *= cell;
        return vote;
    }
    for (i = 0; i < 3; ++i) {
        centred[i] = q[i] - 0.5F;
    }
    if (rlf_kind(record) == RLF_SPLIT) {
        rlf_decode_coarse_normal(vote.normal, record.low >> 18 & 127U, record.low >> 25);
        along = rlf_dot(vote.normal, centred) + ((float)(record.high >> 24) - 128.0F) * (1.0F / 128.0F);
        vote.distance = cell * rlf_on_side(inside, along, 1.0F / 1024.0F);
    } else {
        rlf_decode_normal(vote.normal, record.low >> 24, record.low >> 16 & 0xffU);
        along = rlf_float_of(record.high) + cell * rlf_dot(vote.normal, centred);
        vote.distance = rlf_on_side(inside, along, cell * (1.0F / 1024.0F));
    }
    return vote;
}

/* Like relief_distance(), but extrapolates the surface up to `reach` beyond the root cells. */
static float rlf_near(const relief_collider* collider, const float point[3], float reach, float normal[3]) {
    RLF_EXACT
    const relief_constants* constants = &collider->constants;
    const float* rows[3];
    const float scale = constants->size[0];
    float held[3], offset[3] = {0, 0, 0}, distance, end, q;
    rlf_vote vote;
    int i, k, within = 1;
    rows[0] = constants->row_x;
    rows[1] = constants->row_y;
    rows[2] = constants->row_z;
    normal[0] = normal[1] = normal[2] = 0;
    for (i = 0; i < 3; ++i) { /* the nearest point of the root cells, and the offset from it */
        q = rows[i][0] * point[0] + (rows[i][1] * point[1] + (rows[i][2] * point[2] + rows[i][3]));
        end = 0.99999994F * constants->size[1 + i]; /* the largest float below the size */
        held[i] = q < 0.0F ? 0.0F : q > end ? end : q;
        within = within && held[i] == q; /* false for NaN */
        for (k = 0; k < 3; ++k) {
            offset[k] += scale * scale * (q - held[i]) * rows[i][k];
        }
    }
    if (collider->texels == NULL || (!within && !(reach > 0.0F && rlf_dot(offset, offset) < reach * reach))) {
        return RELIEF_FAR_OUTSIDE;
    }
    vote = rlf_vote_tree(collider, held);
    distance = vote.distance * scale;
    if (!(distance >= -FLT_MAX)) { /* an overflow to -infinity is not inside */
        return RELIEF_FAR_OUTSIDE;
    }
    for (i = 0; i < 3; ++i) {
        normal[i] = rows[0][i] * scale * vote.normal[0] +
                    (rows[1][i] * scale * vote.normal[1] + rows[2][i] * scale * vote.normal[2]);
    }
    return within ? distance : distance + rlf_dot(offset, normal);
}

float relief_distance(const relief_collider* collider, const float point[3], float normal[3]) {
    float unused[3];
    return rlf_near(collider, point, 0.0F, normal != NULL ? normal : unused);
}

int relief_collide(const relief_collider* collider, float position[3], float velocity[3], float radius,
                   float restitution, float friction) {
    RLF_EXACT
    float normal[3], distance = rlf_near(collider, position, radius, normal) - radius, along;
    int i;
    if (!(distance < 0.0F)) {
        return 0;
    }
    along = rlf_dot(velocity, normal);
    for (i = 0; i < 3; ++i) {
        position[i] -= distance * normal[i];
        if (along < 0.0F) {
            velocity[i] =
                (1.0F - friction) * (velocity[i] - along * normal[i]) - (restitution * along) * normal[i];
        }
    }
    return 1;
}

/* --- container --- */

/* The place of the payload in the container. */
typedef struct rlf_payload {
    uint64_t offset, stored_size, raw_size, hash;
    int compressed;
} rlf_payload;

/* Checks header and sizes. On success, sets the metadata. */
static relief_status rlf_read_header(rlf_metadata* m, const unsigned char* bytes, uint64_t size) {
    static const unsigned char signature[12] = {0xab, 'R',  'E',  'L',  'I',  'E',
                                                'F',  0xbb, 0x0d, 0x0a, 0x1a, 0x0a};
    if (size == 0 || memcmp(bytes, signature, size < 12 ? (size_t)size : 12) != 0) {
        return RELIEF_NOT_A_CONTAINER;
    }
    if (size < 64) {
        return RELIEF_DAMAGED;
    }
    if (rlf_u16(bytes + 12) != 2) {
        return RELIEF_WRONG_VERSION;
    }
    if (rlf_u64(bytes + 56) != rlf_xxh3(bytes, 56) || rlf_u64(bytes + 24) != size) {
        return RELIEF_DAMAGED;
    }
    m->bytes = bytes + 64;
    m->size = rlf_u64(bytes + 40);
    m->tables = 0;
    if (rlf_u32(bytes + 16) != 64 || rlf_u32(bytes + 20) != 0 || rlf_u64(bytes + 32) != 64 ||
        m->size > 16 << 20 || m->size > size - 64) {
        return RELIEF_INVALID;
    }
    return rlf_u64(bytes + 48) == rlf_xxh3(m->bytes, (size_t)m->size) ? RELIEF_OK : RELIEF_DAMAGED;
}

/* Checks the map, and sets the constants and the payload. */
static relief_status rlf_read_map(const rlf_metadata* m, uint64_t root, relief_constants* constants,
                                  rlf_payload* payload) {
    rlf_list maps = rlf_get_list(m, root, RLF_MAPS);
    const unsigned char* stored;
    float rows[12], scale[3];
    uint32_t width, height, compression;
    uint64_t map;
    if (maps.count != 1) {
        return maps.count == 0 || maps.count > 1024 ? RELIEF_INVALID : RELIEF_UNSUPPORTED;
    }
    map = rlf_item(m, maps, 0);
    if (rlf_get_byte(m, map, RLF_FORMAT) != 5) {
        return rlf_get_byte(m, map, RLF_FORMAT) > 5 ? RELIEF_INVALID : RELIEF_UNSUPPORTED;
    }
    width = rlf_get_u32(m, map, RLF_MAP_WIDTH);
    height = rlf_get_u32(m, map, RLF_MAP_HEIGHT);
    compression = rlf_get_byte(m, map, RLF_COMPRESSION);
    if (rlf_get_byte(m, map, RLF_COMPARE) > 1 || rlf_get_byte(m, map, RLF_DECODE) != 1 || compression > 1 ||
        width < 1 || height < 1 || width > 16384 || height > 16384 ||
        !rlf_get_floats(m, rlf_find(m, map, RLF_OBJECT_TO_MAP), rows, 12) ||
        !rlf_get_floats(m, rlf_find(m, map, RLF_OBJECT_PER_MAP), scale, 3) || scale[0] != scale[1] ||
        scale[0] != scale[2] || !rlf_is_transform(rows, scale)) {
        return RELIEF_INVALID;
    }
    memcpy(constants->row_x, rows, sizeof(constants->row_x));
    memcpy(constants->row_y, rows + 4, sizeof(constants->row_y));
    memcpy(constants->row_z, rows + 8, sizeof(constants->row_z));
    constants->size[0] = scale[0];

    stored = m->bytes + rlf_find(m, map, RLF_PAYLOAD);
    payload->offset = rlf_u64(stored);
    payload->stored_size = rlf_u64(stored + 8);
    payload->raw_size = rlf_u64(stored + 16);
    payload->hash = rlf_u64(stored + 24);
    payload->compressed = compression == 1;
    if (payload->raw_size != (uint64_t)width * height * 8 || payload->raw_size > (uint64_t)8 << 24) {
        return RELIEF_INVALID;
    }
    return (payload->compressed ? payload->stored_size >= payload->raw_size ||
                                      payload->raw_size / 32768 > payload->stored_size
                                : payload->stored_size != payload->raw_size)
               ? RELIEF_INVALID
               : RELIEF_OK;
}

/* Checks that the payload extends from the next multiple of 64 after the metadata to the end. Checks its checksum. */
static relief_status rlf_check_place(const rlf_payload* payload, const unsigned char* bytes, uint64_t size,
                                     uint64_t metadata_end) {
    uint64_t i, begin = (metadata_end + 63) / 64 * 64;
    if (payload->offset != begin || begin > size || payload->stored_size != size - begin) {
        return RELIEF_INVALID;
    }
    for (i = metadata_end; i < begin; ++i) {
        if (bytes[i] != 0) {
            return RELIEF_INVALID;
        }
    }
    return payload->hash == rlf_xxh3(bytes + begin, (size_t)payload->stored_size) ? RELIEF_OK
                                                                                  : RELIEF_DAMAGED;
}

/* Allocates the texture and fills it from the payload. */
static relief_status rlf_read_texels(relief_collider* collider, const rlf_payload* payload,
                                     const unsigned char* bytes, uint64_t size,
                                     relief_decompress decompress) {
    uint32_t texels = (uint32_t)(payload->raw_size / 8), height = (texels + RELIEF_WIDTH - 1) / RELIEF_WIDTH;
    size_t words = (size_t)height * RELIEF_WIDTH * 4, i;
    unsigned char* raw;
    relief_status status = RELIEF_OK;
    rlf_record head;
    if (payload->compressed && decompress == NULL) {
        return RELIEF_COMPRESSED;
    }
    if (payload->compressed && payload->raw_size > RELIEF_UNPACKED_MAX && payload->raw_size > 16 * size) {
        return RELIEF_TOO_LARGE;
    }
    collider->texels = (uint16_t*)RELIEF_MALLOC(2 * words);
    if (collider->texels == NULL) {
        return RELIEF_OUT_OF_MEMORY;
    }
    collider->width = RELIEF_WIDTH;
    collider->height = (int32_t)height;
    raw = (unsigned char*)collider->texels;
    memset(raw + payload->raw_size, 0, 2 * words - (size_t)payload->raw_size);
    if (payload->compressed) {
        status =
            rlf_unpack(raw, payload->raw_size, bytes + payload->offset, payload->stored_size, decompress);
        if (status != RELIEF_OK) {
            return status;
        }
    } else {
        memcpy(raw, bytes + payload->offset, (size_t)payload->raw_size);
    }
    for (i = 0; i < words; ++i) { /* changes nothing on little-endian processors */
        uint16_t word = rlf_u16(raw + 2 * i);
        memcpy(raw + 2 * i, &word, 2);
    }
    if (!rlf_is_tree(collider->texels, texels)) {
        return RELIEF_INVALID;
    }
    head = rlf_texel(collider->texels, 0);
    collider->constants.size[1] = (float)(head.low & 0xffffU);
    collider->constants.size[2] = (float)(head.low >> 16);
    collider->constants.size[3] = (float)(head.high & 0xffffU);
    collider->constants.place[0] = 0;
    collider->constants.place[1] = (int32_t)(head.low & 0xffffU);
    collider->constants.place[2] = (int32_t)((head.low & 0xffffU) * (head.low >> 16));
    collider->constants.place[3] = (int32_t)(head.high >> 16);
    return RELIEF_OK;
}

static relief_status rlf_read(relief_collider* collider, const unsigned char* bytes, uint64_t size,
                              relief_decompress decompress) {
    rlf_metadata m;
    rlf_payload payload;
    uint64_t root;
    relief_status status = rlf_read_header(&m, bytes, size);
    if (status != RELIEF_OK) {
        return status;
    }
    if (m.size < 10 || memcmp(m.bytes + 4, "RLF2", 4) != 0 || !rlf_is_offset(&m, 0)) {
        return RELIEF_INVALID;
    }
    root = rlf_target(&m, 0);
    if (!rlf_verify(&m, root, rlf_collider) || !rlf_read_description(&m, root, collider)) {
        return RELIEF_INVALID;
    }
    status = rlf_read_map(&m, root, &collider->constants, &payload);
    status = status == RELIEF_OK ? rlf_check_place(&payload, bytes, size, 64 + m.size) : status;
    status = status == RELIEF_OK ? rlf_check_materials(&m, root, decompress) : status;
    return status == RELIEF_OK ? rlf_read_texels(collider, &payload, bytes, size, decompress) : status;
}

relief_status relief_open(relief_collider* collider, const void* bytes, size_t size,
                          relief_decompress decompress) {
    relief_status status;
    memset(collider, 0, sizeof(*collider));
    status = rlf_read(collider, (const unsigned char*)bytes, size, decompress);
    if (status != RELIEF_OK) {
        relief_close(collider);
    }
    return status;
}

void relief_close(relief_collider* collider) {
    if (collider->texels != NULL) {
        RELIEF_FREE(collider->texels);
    }
    memset(collider, 0, sizeof(*collider));
}

#ifndef RELIEF_NO_STDIO
relief_status relief_load(relief_collider* collider, const char* path, relief_decompress decompress) {
    const long longest = 64L + (16L << 20) + 64L + (128L << 20); /* header, metadata, padding, payload */
    FILE* file = fopen(path, "rb");
    long size = -1;
    unsigned char* bytes = NULL;
    relief_status status = RELIEF_CANNOT_READ;
    memset(collider, 0, sizeof(*collider));
    if (file == NULL) {
        return RELIEF_CANNOT_READ;
    }
    if (fseek(file, 0, SEEK_END) == 0) {
        size = ftell(file);
    }
    if (size >= 0 && size <= longest && fseek(file, 0, SEEK_SET) == 0) {
        bytes = (unsigned char*)RELIEF_MALLOC((size_t)size + 1);
        if (bytes == NULL) {
            status = RELIEF_OUT_OF_MEMORY;
        } else if (fread(bytes, 1, (size_t)size, file) == (size_t)size) {
            status = relief_open(collider, bytes, (size_t)size, decompress);
        }
    } else if (size > longest && size < LONG_MAX) { /* LONG_MAX: a folder */
        status = RELIEF_TOO_LARGE;
    }
    if (bytes != NULL) {
        RELIEF_FREE(bytes);
    }
    fclose(file);
    return status;
}
#endif

const char* relief_message(relief_status status) {
    switch (status) {
        case RELIEF_OK:
            return "no error";
        case RELIEF_CANNOT_READ:
            return "the file cannot be read";
        case RELIEF_NOT_A_CONTAINER:
            return "it is not a .relief container; bake a mesh: relief bake MESH -o FILE.relief";
        case RELIEF_WRONG_VERSION:
            return "it is not a container of version 2; bake the mesh again, or use the relief.h of a newer "
                   "Relief";
        case RELIEF_DAMAGED:
            return "it is truncated or damaged; copy the file again, or bake the mesh again";
        case RELIEF_INVALID:
            return "its contents are invalid, or from a newer Relief; bake the mesh again";
        case RELIEF_UNSUPPORTED:
            return "it is not one map of patches; bake the mesh again without --map and --paper";
        case RELIEF_COMPRESSED:
            return "it is compressed; bake the mesh again without --compress, or pass ZSTD_decompress";
        case RELIEF_TOO_LARGE:
            return "it is too large, or unpacks to too many bytes; bake the mesh again without --compress "
                   "and --map";
        case RELIEF_OUT_OF_MEMORY:
            return "there is not enough memory";
    }
    return "unknown status";
}

#endif /* RELIEF_IMPLEMENTED */
#endif /* RELIEF_IMPLEMENTATION */
