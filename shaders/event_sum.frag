// The sum of RELIEF_EVENTS_COUNTED counts in a row.
uniform highp sampler2D u_counts;
uniform int u_count;  // how many counts there are

layout(location = 0) out vec4 o_count;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int first = (at.y * RELIEF_EVENTS_WIDTH + at.x) * RELIEF_EVENTS_COUNTED;
    int end = min(first + RELIEF_EVENTS_COUNTED, u_count);
    float count = 0.0;
    for (int i = first; i < end; ++i) {
        count += texelFetch(u_counts, ivec2(i % RELIEF_EVENTS_WIDTH, i / RELIEF_EVENTS_WIDTH), 0).x;
    }
    o_count = vec4(count, 0.0, 0.0, 0.0);
}
