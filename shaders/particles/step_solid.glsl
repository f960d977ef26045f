// SPDX-License-Identifier: Apache-2.0
// For step.glsl: the solids of a step. Without RELIEF_COLLIDER there is only the floor. With RELIEF_BODIES there are
// bodies, which may move in the step and may be live; otherwise one collider in its own object space.
#if !defined(RELIEF_BODIES)
#define RELIEF_BODIES 0
#endif

#if !defined(RELIEF_COLLIDER)

Solid solid(vec3 p, float radius) {
    return Solid(RELIEF_FAR_OUTSIDE, vec3(0.0), -1, -1, vec3(0.0));
}

bool insideBefore(vec3 p, float radius, Solid s, bool free) {
    return false;
}

#elif RELIEF_BODIES == 0

bool insideBefore(vec3 p, float radius, Solid s, bool free) {
#if defined(RELIEF_RADIUS)
    return reliefSolidAt(p - radius * s.normal, s.map) || reliefSolidAt(p, s.map);
#else
    return reliefSolidAt(p, s.map);
#endif
}

Solid solidOf(ReliefField field) {
    // Also outside if no map votes.
    return Solid(reliefInside(field) ? field.distance : RELIEF_FAR_OUTSIDE, field.normal, field.map, 0, vec3(0.0));
}

#if defined(RELIEF_TOUR)

Solid solidOf(ReliefTour tour, vec3 p, float radius) {
    return solidOf(reliefToured(tour));
}

#else

Solid solid(vec3 p, float radius) {
#if defined(RELIEF_MASKS)
    if (!collidesWith(1)) {
        return Solid(RELIEF_FAR_OUTSIDE, vec3(0.0), -1, -1, vec3(0.0));
    }
#endif
#if defined(RELIEF_RADIUS)
    return solidOf(reliefBall(0, u_relief_count.x, p, radius));
#else
    return solidOf(reliefSolid(p));
#endif
}

#endif

#else

bool reliefDeeper(ReliefField field, float depth) {
    return reliefInside(field) && field.distance < -depth;
}

Solid solidOf(ReliefField field, int body) {
    return Solid(reliefInside(field) ? field.distance : RELIEF_FAR_OUTSIDE, field.normal, field.map, body, vec3(0.0));
}

Solid solid(vec3 p, float radius) {
    int body;
    ReliefField field = reliefUnion(p, radius, false, body);
    return solidOf(field, body);
}

// The maps of a live body only represent the surface at the end of the step. The particle is therefore moved with the
// piece of surface that it hit, and tested at the end. This is exact if the surface nearby moves uniformly; otherwise
// the error is of second order in the length of a step. Silhouettes in the maps of the previous step were off by up to
// half a texel: a particle that was free in those maps counts as outside if it is less than a texel deep.
bool insideBefore(vec3 p, float radius, Solid s, bool free) {
    vec3 q = reliefMoved(s.body, p) + s.motion;
    float least = free && s.motion != vec3(0.0) ? reliefBodyTexel(s.body) : 0.0;
    bool inside = reliefDeeper(reliefBodyField(s.body, q, 0.0, false), least);
#if defined(RELIEF_RADIUS)
    inside = inside || reliefDeeper(reliefBodyField(s.body, q - radius * s.normal, 0.0, false), least);
#endif
    return inside;
}

vec3 pointBefore(Solid s, vec3 p) {
    return reliefMovedBack(s.body, p - s.motion);
}

// A particle that stopped on a body of a collider that is no longer set stays in place.
vec3 placedNow(int body, vec3 p) {
    return body < reliefBodyCount() ? reliefMoved(body, p) : p;
}

vec3 motionOf(int body, vec3 p) {
    return body < reliefBodyCount() ? reliefBodyMotion(body, p) : vec3(0.0);
}

vec2 bodyResponse(int body) {
    return reliefBodyResponse(body).yz;
}

#endif

#if !defined(RELIEF_MATERIALS)
// Defined in step.glsl.
#elif RELIEF_BODIES == 0

vec4 materialOf(int body, vec3 p, vec3 n) {
    return reliefMaterial(0, p, n);
}

#else

vec4 materialOf(int body, vec3 p, vec3 n) {
    return reliefMaterial(body, reliefToObject(body, p), reliefTurned(body, n));
}

#endif

#if RELIEF_BODIES == 0
//!include particles/step_still.glsl
#endif
