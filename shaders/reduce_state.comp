// The first pass of the statistics, where there are compute shaders.
//!include reduce_state.frag
