// Where a sprite is in the picture. Needs grain_make.glsl.
uniform mat4 u_projection;
uniform vec2 u_target;            // pixels
uniform vec2 u_depth;             // window depth of view distance t: x + y / t

// How much nearer than its centre a grain's front is, as a share of the view distance. The depth is that of the front,
// so that grains on a surface are not half sunk into it; the place on the picture that of the centre. A large sprite's
// front does not pass the near plane before its centre does.
float nearerShare(float size, float distance) {
    float near = -u_depth.y / u_depth.x;
    return max(1.0 - 0.5 * size / distance, clamp(1.01 * near / distance, 0.05, 1.0));
}

// In clip space: the centre, at the depth of the front.
vec4 placeOf(Sprite sprite) {
    vec4 place = u_projection * vec4(sprite.center, 1.0);
    float nearer = nearerShare(sprite.size, sprite.distance);
    vec4 front = u_projection * vec4(sprite.center * nearer, 1.0);
    place.z = front.z / front.w * place.w;
    return place;
}
