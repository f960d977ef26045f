// SPDX-License-Identifier: Apache-2.0
// For programs that only need a vertex shader: OpenGL ES requires a fragment shader.
void main() {
}
