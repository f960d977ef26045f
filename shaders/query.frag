// Evaluates a collider at the points of a texture, one a texel: `relief query --gpu`, and the tests of
// collider.glsl against its C++ twin.
//!include collider.glsl
uniform highp sampler2D u_points;  // xyz: object space

layout(location = 0) out vec4 o_normal_distance;
layout(location = 1) out vec4 o_map;  // x: deciding map, −1 for none

void main() {
    ReliefField field = reliefEvaluate(texelFetch(u_points, ivec2(gl_FragCoord.xy), 0).xyz);
    o_normal_distance = vec4(field.normal, field.distance);
    o_map = vec4(float(field.map), 0.0, 0.0, 0.0);
}
