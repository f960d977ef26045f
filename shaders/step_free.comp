// A step with nothing solid but the floor, where there are compute shaders.
//!include step_free.frag
