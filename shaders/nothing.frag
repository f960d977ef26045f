// For programs whose vertices alone matter: OpenGL ES wants a fragment shader all the same.
void main() {
}
