// A further pass of the statistics, where there are compute shaders.
//!include reduce_sum.frag
