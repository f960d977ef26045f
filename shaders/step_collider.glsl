// For step.glsl: one collider in its own object space.
Solid solid(vec3 p, float radius) {
    ReliefField field = reliefSolid(p);
#if defined(RELIEF_RADIUS)
    if (radius > 0.0 && !reliefInside(field)) {
        field = reliefTouch(0, u_relief_count.x, p, radius);
    }
#endif
    // Where no map votes nothing is known to be solid.
    return Solid(reliefInside(field) ? field.distance : RELIEF_FAR_OUTSIDE, field.normal, field.map, 0, vec3(0.0));
}

bool insideBefore(vec3 p, float radius, Solid s) {
#if defined(RELIEF_RADIUS)
    if (radius > 0.0 && reliefInside(reliefTouch(0, u_relief_count.x, p, radius))) {
        return true;
    }
#endif
    return reliefSolidAt(p, s.map);
}
