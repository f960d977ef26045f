// A step among the floor and colliders, where there are compute shaders.
//!include step.frag
