// A step among the floor and colliders.
//!include collider.glsl
//!include step.glsl

#if RELIEF_BODIES == 0

Solid solid(vec3 p, float radius) {
#if defined(RELIEF_MARGIN)
    relief_margin = radius;
#endif
    ReliefField field = reliefSolid(p);
    // Where no map votes nothing is known to be solid.
    return Solid(reliefInside(field) ? field.distance : 1e30, field.normal, field.map, 0);
}

bool insideBefore(vec3 p, float radius, Solid s) {
    return reliefSolidAt(p, s.map);
}

vec3 pointBefore(int body, vec3 p) {
    return p;
}

vec3 pointNow(int body, vec3 p) {
    return p;
}

vec2 bodyResponse(int body) {
    return vec2(1.0);
}

#else

Solid solid(vec3 p, float radius) {
    int body;
    ReliefField field = reliefUnion(p, true, radius, body);
    return Solid(reliefInside(field) ? field.distance : 1e30, field.normal, field.map, body);
}

bool insideBefore(vec3 p, float radius, Solid s) {
#if defined(RELIEF_MARGIN)
    relief_margin = radius / u_relief_bodies[s.body].response.x;
#endif
    return reliefInside(reliefBodyField(s.body, reliefBodyBefore(s.body, p), true));
}

vec3 pointBefore(int body, vec3 p) {
    return reliefWorldBefore(body, reliefBodyNow(body, p));
}

vec3 pointNow(int body, vec3 p) {
    return reliefWorldNow(body, reliefBodyBefore(body, p));
}

vec2 bodyResponse(int body) {
    return u_relief_bodies[body].response.yz;
}

#endif
