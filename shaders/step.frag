// A step among the floor and a collider.
//!include collider.glsl
//!include step.glsl

Solid solid(vec3 p) {
    ReliefField field = reliefSolid(p);
    // Where no map votes nothing is known to be solid.
    return Solid(reliefInside(field) ? field.distance : 1e30, field.normal, field.map);
}

bool solidAt(vec3 p, int map) {
    return reliefSolidAt(p, map);
}
