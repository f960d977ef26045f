// One soft round grain, shaded as the half of a ball that faces the viewer.
flat in vec3 v_sun;
flat in vec3 v_above;
flat in vec3 v_below;
flat in float v_alpha;
flat in float v_pixels;

uniform vec3 u_color;      // linear
uniform vec3 u_sun_view;   // unit vectors in view space
uniform vec3 u_up_view;

layout(location = 0) out vec4 o_color;  // premultiplied by alpha

void main() {
    vec2 at = vec2(2.0, -2.0) * gl_PointCoord + vec2(-1.0, 1.0);
    float radius = length(at);
    // The edge falls off over a third of the radius, and over a pixel at least.
    float soft = max(0.35, 2.0 / v_pixels);
    float alpha = v_alpha * (1.0 - smoothstep(1.0 - soft, 1.0, radius));
    if (alpha <= 0.003) {
        discard;
    }
    vec3 n = vec3(at, sqrt(max(1.0 - radius * radius, 0.0)));
    // Snow scatters: the terminator is soft, and no side is dark.
    float sun = 0.42 + 0.58 * max((dot(n, u_sun_view) + 0.5) / 1.5, 0.0);
    vec3 light = 0.72 * sun * v_sun + mix(v_below, v_above, 0.5 + 0.5 * dot(n, u_up_view));
    o_color = vec4(u_color * light * alpha, alpha);
}
