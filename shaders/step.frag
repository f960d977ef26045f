// A step among the floor and colliders.
//!include collider.glsl
//!include air.glsl
//!include step.glsl

#if RELIEF_BODIES == 0

Solid solid(vec3 p, float radius) {
    ReliefField field = reliefSolid(p);
#if defined(RELIEF_RADIUS)
    if (radius > 0.0 && !reliefInside(field)) {
        field = reliefTouch(0, u_relief_count.x, p, radius);
    }
#endif
    // Where no map votes nothing is known to be solid.
    return Solid(reliefInside(field) ? field.distance : 1e30, field.normal, field.map, 0);
}

bool insideBefore(vec3 p, float radius, Solid s) {
#if defined(RELIEF_RADIUS)
    if (radius > 0.0 && reliefInside(reliefTouch(0, u_relief_count.x, p, radius))) {
        return true;
    }
#endif
    return reliefSolidAt(p, s.map);
}

#else

Solid solid(vec3 p, float radius) {
    int body;
    ReliefField field = reliefUnion(p, radius, false, body);
    return Solid(reliefInside(field) ? field.distance : 1e30, field.normal, field.map, body);
}

bool insideBefore(vec3 p, float radius, Solid s) {
    return reliefInside(reliefBodyField(s.body, reliefBodyBefore(s.body, p), radius, false));
}

vec3 pointBefore(int body, vec3 p) {
    return reliefWorldBefore(body, reliefBodyNow(body, p));
}

vec3 pointNow(int body, vec3 p) {
    // What stopped on a body of colliders that are no longer set stays where it is.
    return body < RELIEF_BODIES ? reliefWorldNow(body, reliefBodyBefore(body, p)) : p;
}

vec2 bodyResponse(int body) {
    return u_relief_bodies[body].response.yz;
}

#endif
