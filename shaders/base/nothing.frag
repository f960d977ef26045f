// SPDX-License-Identifier: Apache-2.0
// For programs of a vertex shader alone: OpenGL ES requires a fragment shader all the same.
void main() {
}
