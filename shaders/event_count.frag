// How many of RELIEF_EVENTS_COUNTED particles in a row of indices have an event that counts.
//!include events.glsl
uniform ivec2 u_particles;  // width of their textures, and how many there are

layout(location = 0) out vec4 o_count;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int first = (at.y * RELIEF_EVENTS_WIDTH + at.x) * RELIEF_EVENTS_COUNTED;
    int end = min(first + RELIEF_EVENTS_COUNTED, u_particles.y);
    float count = 0.0;
    for (int i = first; i < end; ++i) {
        count += counts(texelOf(i, u_particles.x)) ? 1.0 : 0.0;
    }
    o_count = vec4(count, 0.0, 0.0, 0.0);
}
