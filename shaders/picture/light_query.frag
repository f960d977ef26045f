// The light at the points of a texture, one a texel: for tests of particle_light.glsl against closed forms.
//!include picture/particle_light.glsl
uniform highp sampler2D u_points;  // xyz: object space

layout(location = 0) out vec4 o_light;  // shares of sun and sky, each the mean over all turns and jitters

void main() {
    vec3 point = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0).xyz;
    o_light = vec4(0.0);
    for (int i = 0; i < 64; ++i) {
        ParticleLight light = particleLight(point, (float(i & 7) + 0.5) / 8.0, (float(i >> 3) + 0.5) / 8.0);
        o_light += vec4(light.sun, light.sky, 0.0, 0.0) / 64.0;
    }
}
