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
    bool inside = reliefInside(field);
#if RELIEF_LIVE
    // What a ball touches is on its rim.
    vec3 motion = vec3(0.0);
    if (inside) {
        motion = reliefBodyMotion(body, field.map, reliefBodyNow(body, p - radius * field.normal), field.normal);
    }
#endif
    return RELIEF_SOLID(inside ? field.distance : 1e30, field.normal, field.map, body, motion);
}

#if RELIEF_LIVE

// The maps show the surface at the end of the step alone. So the particle goes with the piece of surface that it met,
// and is asked for at the end: right where all of the surface near it moves alike, as it does but for second order in
// the way of a step.
bool insideBefore(vec3 p, float radius, Solid s) {
    return reliefInside(reliefBodyField(s.body, reliefBodyBefore(s.body, p) + s.motion, radius, false));
}

vec3 pointBefore(Solid s, vec3 p) {
    return reliefWorldBefore(s.body, reliefBodyNow(s.body, p) - s.motion);
}

vec3 pointNow(int body, vec3 p) {
    if (body >= RELIEF_BODIES) {
        return p;
    }
    vec3 q = reliefBodyBefore(body, p);
    if (u_relief_bodies[body].maps.z != 0) {
        q += reliefNearestMotion(body, q);
    }
    return reliefWorldNow(body, q);
}

#else

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

#endif

vec2 bodyResponse(int body) {
    return u_relief_bodies[body].response.yz;
}

#endif
