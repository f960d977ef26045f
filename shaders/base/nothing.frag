// For programs of a vertex shader alone: OpenGL ES requires a fragment shader all the same.
void main() {
}
