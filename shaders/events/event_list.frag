// SPDX-License-Identifier: Apache-2.0
// Writes lists of a step's events in ascending order of index, one below the other. Fragment k of a list finds its k-th
// event by descending through the levels of counts.
//
//     position  x y z   contact with the surface, or place of death; world space
//               w       seconds from the start of the step to the event
//     surface   x y z   normal, outwards from the body; 0 for a death by age
//               w       approach speed along it, relative to the surface
//     velocity  x y z   velocity of the particle before the event
//               w       body; -1 for the floor
//     identity  x       index     y  id modulo 2^24     z  type    w  flags (EventFlag) + RELIEF_EVENT_FLAGS * m, where
//               m is the index of the material's name + 1, or 0 without a material
//!include events/events.glsl
uniform highp sampler2D u_event_velocity;
uniform highp sampler2D u_position_before;
uniform highp sampler2D u_count_1;  // of particles
uniform highp sampler2D u_count_2;  // of the entries of u_count_1
uniform highp sampler2D u_count_3;
uniform highp sampler2D u_count_4;  // of all particles
uniform int u_width;                          // width of the particles' textures
uniform int u_first_row[RELIEF_EVENT_LISTS];  // for each list
uniform float u_radius[RELIEF_TYPES];

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_surface;
layout(location = 2) out vec4 o_velocity;
layout(location = 3) out vec4 o_identity;

// Returns the entry of a level, from `first` on, whose count includes event k. k: from 0 and relative to entry `first`;
// on return, relative to the returned entry. of: 1 in the component of the list.
int descended(highp sampler2D level, vec4 of, int first, inout float k) {
    int i = first;
    for (; i < first + RELIEF_EVENTS_PER_COUNT; ++i) {
        float count = dot(texelFetch(level, texelOf(i, RELIEF_EVENTS_WIDTH), 0), of);
        if (k < count) {
            break;
        }
        k -= count;
    }
    return i;
}

int indexOf(int list, int first, float k) {
    int i = first;
    for (; i < first + RELIEF_EVENTS_PER_COUNT; ++i) {
        ivec2 texel = texelOf(i, u_width);
        if (countsIn(list, texel, texelFetch(u_event_surface, texel, 0))) {
            if (k < 1.0) {
                break;
            }
            k -= 1.0;
        }
    }
    return i;
}

vec3 normalOf(vec2 two, int direction) {
    float largest = sqrt(max(1.0 - dot(two, two), 0.0)) * (direction % 2 == 0 ? 1.0 : -1.0);
    int axis = direction / 2;
    return axis == 0 ? vec3(largest, two) : axis == 1 ? vec3(two.y, largest, two.x) : vec3(two, largest);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int list = 0;
    for (int i = 1; i < RELIEF_EVENT_LISTS; ++i) {
        list = at.y >= u_first_row[i] ? i : list;
    }
    vec4 of = vec4(equal(ivec4(list), ivec4(0, 1, 2, 3)));
    float k = float((at.y - u_first_row[list]) * RELIEF_EVENTS_WIDTH + at.x);
    if (k >= dot(texelFetch(u_count_4, ivec2(0), 0), of)) {
        o_position = o_surface = o_velocity = o_identity = vec4(0.0);  // beyond the total, the counts are stale
        return;
    }
    int first = descended(u_count_3, of, 0, k);
    first = descended(u_count_2, of, first * RELIEF_EVENTS_PER_COUNT, k);
    first = descended(u_count_1, of, first * RELIEF_EVENTS_PER_COUNT, k);
    int index = indexOf(list, first * RELIEF_EVENTS_PER_COUNT, k);
    ivec2 texel = texelOf(index, u_width);

    vec4 surface = texelFetch(u_event_surface, texel, 0);
    vec4 velocity = texelFetch(u_event_velocity, texel, 0);
    vec4 birth = texelFetch(u_birth, texel, 0);
    int code = int(surface.w);
    int flags = code % RELIEF_EVENT_FLAGS;
    int place = code / (RELIEF_EVENT_FLAGS * RELIEF_EVENT_DIRECTIONS);
    int body = place / u_materials - 1;
    int material = materialOf(code);
    vec3 normal = vec3(0.0);
    float radius = 0.0;
    if ((flags & RELIEF_EVENT_COLLISION) != 0) {
        normal = normalOf(surface.xy, (code / RELIEF_EVENT_FLAGS) % RELIEF_EVENT_DIRECTIONS);
        radius = u_radius[clamp(int(birth.z), 0, RELIEF_TYPES - 1)];
    }
    vec3 center = texelFetch(u_position_before, texel, 0).xyz + velocity.w * velocity.xyz;
    o_position = vec4(center - radius * normal, velocity.w);
    o_surface = vec4(normal, surface.z);
    o_velocity = vec4(velocity.xyz, float(body));
    o_identity = vec4(float(index), birth.w, birth.z, float(flags + RELIEF_EVENT_FLAGS * material));
}
