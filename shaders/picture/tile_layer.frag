// SPDX-License-Identifier: Apache-2.0
// Blends the painted layer of tiles over the target as one sprite.
uniform highp sampler2D u_layer;

layout(location = 0) out vec4 o_color;  // premultiplied by alpha

void main() {
    o_color = texelFetch(u_layer, ivec2(gl_FragCoord.xy), 0);
    if (o_color == vec4(0.0)) {
        discard;
    }
}
