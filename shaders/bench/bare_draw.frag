// SPDX-License-Identifier: Apache-2.0
// Fills with one colour. RELIEF_ALPHA: opacity.
layout(location = 0) out vec4 o_texel;

void main() {
    o_texel = vec4(0.25, 0.5, 0.75, RELIEF_ALPHA);
}
