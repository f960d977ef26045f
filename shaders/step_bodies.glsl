// For step.glsl: bodies that have a pose at the step's beginning and one at its end, and may be live.
Solid solidOf(ReliefField field, int body, vec3 p, float radius) {
    bool inside = reliefInside(field);
    vec3 motion = vec3(0.0);
    if (inside) {
        // What a ball touches is on its rim.
        motion = reliefBodyMotion(body, field.map, reliefBodyNow(body, p - radius * field.normal), field.normal);
    }
    return Solid(inside ? field.distance : RELIEF_FAR_OUTSIDE, field.normal, field.map, body, motion);
}

#if defined(RELIEF_TOUR)

Solid solidOf(ReliefTour tour, vec3 p, float radius) {
    return solidOf(reliefToured(tour), tour.best_body, p, radius);
}

#else

Solid solid(vec3 p, float radius) {
    int body;
    ReliefField field = reliefUnion(p, radius, false, body);
    return solidOf(field, body, p, radius);
}

#endif

// The maps of a live body show the surface at the end of the step alone. So the particle goes with the piece of surface
// that it met, and is asked for at the end: right where all of the surface near it moves alike, as it does but for
// second order in the way of a step.
bool insideBefore(vec3 p, float radius, Solid s) {
    vec3 q = reliefBodyBefore(s.body, p) + s.motion;
    bool inside = reliefInside(reliefBodyField(s.body, q, 0.0, false));
#if defined(RELIEF_RADIUS)
    vec3 towards = reliefBodyNow(s.body, radius * s.normal) - reliefBodyNow(s.body, vec3(0.0));
    inside = inside || reliefInside(reliefBodyField(s.body, q - towards, 0.0, false));
#endif
    return inside;
}

vec3 pointBefore(Solid s, vec3 p) {
    return reliefWorldBefore(s.body, reliefBodyNow(s.body, p) - s.motion);
}

vec3 pointNow(int body, vec3 p) {
    vec3 now = p;
    // What stopped on a body of colliders that are no longer set stays where it is.
    if (body < RELIEF_BODIES) {
        vec3 q = reliefBodyBefore(body, p);
        now = reliefWorldNow(body, q + reliefNearestMotion(body, q));
    }
    return now;
}

vec2 bodyResponse(int body) {
    return u_relief_bodies[body].response.yz;
}
