// SPDX-License-Identifier: Apache-2.0
// For collider.glsl: the vote of a map of patches, whose distance relief.glsl evaluates.

// Returns the number of roots along x, y and z.
vec3 reliefPatchRoots(int i) {
    return reliefObjectPerMap(i).yzw;
}

// p: map space. Without `whole`, any distance >= 0 means outside.
ReliefVote reliefVotePatches(int i, ivec4 info, vec3 p, bool whole) {
    bool encloses = reliefHas(info, RELIEF_ENCLOSES);
    ReliefVote vote = ReliefVote(encloses ? RELIEF_FAR_OUTSIDE : RELIEF_FAR_INSIDE, RELIEF_NO_CODE);
    if (reliefInRoots(p, reliefPatchRoots(i))) {
        vec4 surface = reliefPatches(u_relief_front_back, reliefMapPlace(i), p, whole);
        float root_size = reliefObjectPerMap(i).x;
        bool known = surface.w < RELIEF_FAR_OUTSIDE;
        vote.distance = known ? surface.w * root_size : RELIEF_FAR_OUTSIDE;
        if (known && (whole || surface.w < 0.0)) {
            vote.normal = reliefFromMap(i, surface.xyz) * (1.0 / root_size);
        }
    }
    return vote;
}
