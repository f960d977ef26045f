// SPDX-License-Identifier: Apache-2.0
// For collider.glsl: the maps of a collider and their texel layout.
struct ReliefMap {
    vec4 row[3];           // object space to map space; the rows are orthogonal. Orthographic maps: x and y are in
                           // texels
    vec4 column[3];        // xyz: an axis of map space in object units (the inverse of the rows); w: 0; width - 1;
                           // height - 1
    vec4 object_per_map;   // xyz; orthographic: z is z_scale; cube: xyz is the paper's s; patches: x is the size of a
                           // root, yzw the number of roots along x, y and z
    ivec4 place;           // index of texel (0,0) of face 0; texels from row to row; from face to face; width. Patches:
                           // texel 0; from root to root along y and z; levels
    ivec4 info;            // height; format; flags (sum of MapFlag); live maps: index of the texel (0,0) of its motion
                           // in u_relief_float, whose rows are as wide as that texture
};

// 1: a world of bodies with their own poses; 0: one collider, in its own object space.
#if !defined(RELIEF_BODIES)
#define RELIEF_BODIES 0
#endif

// 1: a body is live. Its maps are rendered before each step, together with the motion of the surface.
#if !defined(RELIEF_LIVE)
#define RELIEF_LIVE 0
#endif

ivec2 reliefTexel(int index, int log2_width) {
    return ivec2(index & ((1 << log2_width) - 1), index >> log2_width);
}

#if RELIEF_BODIES > 0
//!layer bodies/world.glsl
#else

layout(std140) uniform ReliefMaps {
    ivec4 u_relief_count;  // maps in use; then RELIEF_LOG2_WIDTHS
    ReliefMap u_relief_maps[RELIEF_MAP_CAPACITY];
};

// In a tour (collider_tour.glsl) each lane of a warp reads a different map. Uniform blocks serve different addresses
// one after another, shared memory nearly all at once. u_relief_maps is therefore the work group's copy in shared
// memory. The copy is read from the same buffer bound as storage, because copying also reads different addresses. The
// counts stay in the block.
#if defined(RELIEF_TOUR)
layout(std140, binding = RELIEF_TOUR_STORAGE) readonly buffer ReliefMapsStorage {
    ivec4 b_relief_count;
    ReliefMap b_relief_maps[RELIEF_MAP_CAPACITY];
};
shared ReliefMap s_relief_maps[RELIEF_MAP_CAPACITY];

// Copies the maps. Must be called first, in every invocation of the group.
void reliefShare(int lane, int lanes) {
    for (int i = lane; i < RELIEF_MAP_CAPACITY; i += lanes) {
        s_relief_maps[i] = b_relief_maps[i];
    }
    memoryBarrierShared();
    barrier();
}

#define u_relief_maps s_relief_maps
#endif

#define reliefMapRow(i, k) u_relief_maps[i].row[k]
#define reliefMapColumn(i, k) u_relief_maps[i].column[k]
#define reliefObjectPerMap(i) u_relief_maps[i].object_per_map
#define reliefMapPlace(i) u_relief_maps[i].place
#define reliefMapInfo(i) u_relief_maps[i].info
#endif

// The texels of all maps in sequence, wrapped at the texture's width: texel i is at (i mod width, i / width). Maps of
// any size are thus packed without gaps. RELIEF_LOG2_WIDTHS: log2 of the widths.
uniform highp sampler2D u_relief_float;
uniform highp sampler2D u_relief_fixed;
uniform highp usampler2D u_relief_front_back;

// 1: a texel of planes may have only one surface. ColliderTextures copies the plane of a texel's only surface to
// the other one on upload, which changes no vote. Maps of live bodies are used as rendered.
#define RELIEF_HALF_EMPTY (RELIEF_LIVE == 1)

bool reliefIsPlane(ivec4 info) {
#if !defined(RELIEF_HAS_PLANE)
    return false;
#elif defined(RELIEF_HAS_PROJECTED)
    return (info.z & RELIEF_DECODES_PLANE) != 0;
#else
    return true;
#endif
}

// The flags that all maps have in common.
#if !defined(RELIEF_ALL)
#define RELIEF_ALL 0
#endif

bool reliefHas(ivec4 info, int flag) {
    return (RELIEF_ALL & flag) != 0 || (info.z & flag) != 0;
}
