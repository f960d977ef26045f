// SPDX-License-Identifier: Apache-2.0
// The position of a sprite in the picture. Needs sprite.glsl.
uniform mat4 u_projection;
uniform vec2 u_target;            // pixels
uniform vec2 u_depth;             // window depth of view distance t: x + y / t

// Returns the distance of a sprite's front as a fraction of that of its centre. Depth uses the front, so that sprites
// on a surface are not half hidden by it; the position in the picture uses the centre. A large sprite's front does not
// pass the near plane before its centre does.
float nearerFraction(float size, float distance) {
    float near = -u_depth.y / u_depth.x;
    return max(1.0 - 0.5 * size / distance, clamp(1.01 * near / distance, 0.05, 1.0));
}

// Returns the clip-space position of the centre, at the depth of the front.
vec4 placeOf(Sprite sprite) {
    vec4 place = u_projection * vec4(sprite.center, 1.0);
    float nearer = nearerFraction(sprite.size, sprite.distance);
    vec4 front = u_projection * vec4(sprite.center * nearer, 1.0);
    place.z = front.z / front.w * place.w;
    return place;
}

#ifdef RELIEF_STRETCH
// Returns the pixels from a sprite's centre to its tail, clipped in front of the viewer.
vec2 tailOf(Sprite sprite) {
    if (!sprite.stretched) {
        return vec2(0.0);
    }
    float near = -u_depth.y / u_depth.x;
    float share = sprite.tail.z > 0.0 ? min((sprite.distance - 1.01 * near) / sprite.tail.z, 1.0) : 1.0;
    vec4 head = u_projection * vec4(sprite.center, 1.0);
    vec4 tail = u_projection * vec4(sprite.center + max(share, 0.0) * sprite.tail, 1.0);
    return 0.5 * u_target * (tail.xy / tail.w - head.xy / head.w);
}
#endif

// Returns cosine and sine of a sprite's rotation in the picture. The right side of a stretched sprite is its head.
vec2 turnOf(Sprite sprite, vec2 tail) {
#ifdef RELIEF_STRETCH
    if (sprite.stretched) {
        float pixels = length(tail);
        return pixels > 0.0 ? -tail / pixels : vec2(1.0, 0.0);
    }
#endif
    return vec2(cos(sprite.rotation), sin(sprite.rotation));
}
