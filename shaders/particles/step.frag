// SPDX-License-Identifier: Apache-2.0
// A step among the floor and, with RELIEF_COLLIDER, colliders. As a compute shader an invocation is a particle.
#if defined(RELIEF_MASKS)

uniform int u_collides[RELIEF_TYPES];  // ParticleType::collides
int g_collides;                        // that of this invocation's particle

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
