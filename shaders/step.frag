// A step among the floor and colliders.
//!include step_mask.glsl
//!include collider.glsl
#if defined(RELIEF_TOUR)
//!include collider_tour.glsl
#endif
//!include air.glsl
//!include step.glsl
#if RELIEF_BODIES == 0
//!include step_still.glsl
//!include step_collider.glsl
#else
//!include step_bodies.glsl
#endif
