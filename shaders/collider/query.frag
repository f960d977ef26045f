// Evaluates a collider at the points of a texture, one a texel: `relief query --gpu`, and the tests of
// collider.glsl against its C++ twin. With RELIEF_QUERY_INSIDE by reliefSolid: the distance then is −1 inside and 1
// outside.
//!include collider/collider.glsl
uniform highp sampler2D u_points;  // xyz: object space

layout(location = 0) out vec4 o_normal_distance;
layout(location = 1) out vec4 o_map;  // x: deciding map, −1 for none

void main() {
    vec3 p = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0).xyz;
#ifdef RELIEF_QUERY_INSIDE
    ReliefField field = reliefSolid(p);
    bool inside = reliefInside(field);
    o_normal_distance = vec4(inside ? field.normal : vec3(0.0), inside ? -1.0 : 1.0);
    o_map = vec4(float(field.map), 0.0, 0.0, 0.0);
#else
    ReliefField field = reliefEvaluate(p);
    o_normal_distance = vec4(field.normal, field.distance);
    o_map = vec4(float(field.map), 0.0, 0.0, 0.0);
#endif
}
