// SPDX-License-Identifier: Apache-2.0
// A step with the floor and, with RELIEF_COLLIDER, colliders. In a compute shader, one invocation is one particle.
#if defined(RELIEF_MASKS)

uniform int u_collides[RELIEF_TYPES];  // see ParticleType::collides_with
int g_collides;                        // mask of this invocation's particle

bool collidesWith(int bits) {
    return (g_collides & bits) != 0;
}

#endif

#if defined(RELIEF_COLLIDER)
//!include collider/collider.glsl
#endif
#if defined(RELIEF_TOUR)
//!include collider/collider_tour.glsl
#endif
#if defined(RELIEF_COLLIDER) && defined(RELIEF_MATERIALS)
//!layer bodies/materials.glsl
#endif
//!layer air/air.glsl
//!include particles/step.glsl
//!include particles/step_solid.glsl
