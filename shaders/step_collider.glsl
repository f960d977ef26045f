// For step.glsl: one collider in its own object space.
#if defined(RELIEF_RADIUS)

bool insideBefore(vec3 p, float radius, Solid s) {
    return reliefSolidAt(p - radius * s.normal, s.map) || reliefSolidAt(p, s.map);
}

#else

bool insideBefore(vec3 p, float radius, Solid s) {
    return reliefSolidAt(p, s.map);
}

#endif

Solid solidOf(ReliefField field) {
    // Where no map votes nothing is known to be solid.
    return Solid(reliefInside(field) ? field.distance : RELIEF_FAR_OUTSIDE, field.normal, field.map, 0, vec3(0.0));
}

#if defined(RELIEF_TOUR)

Solid solidOf(ReliefTour tour, vec3 p, float radius) {
    return solidOf(reliefToured(tour));
}

#else

Solid solid(vec3 p, float radius) {
#if defined(RELIEF_MASKS)
    if (!collidesWith(0)) {
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
