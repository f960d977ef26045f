// A stable sort by digits of RELIEF_RADIX_DIGITS values, the least one first (LSD radix sort): for each digit of the
// keys radix_count.comp counts by blocks how often each value is there, radix_scan.comp says where the elements of each
// value and block begin, and radix_move.comp moves them there. No two invocations store the same word but by sums and
// unions of whole numbers, so the result is the same each time.
//
// Elements are x: index of a particle, y: its key (sort_key.glsl). The greatest key comes first, so digits are those of
// its complement. A block is u_turns rows of one element an invocation.
//!include meet.glsl
layout(local_size_x = RELIEF_RADIX_DIGITS) in;

uniform uint u_count;   // elements; with RELIEF_RADIX_COUNTED the word behind b_totals' sums says
uniform uint u_turns;   // rows of a block
uniform uint u_blocks;
uniform uint u_shift;   // of the digit, bits

uint digitOf(uint key) {
    return (~key >> u_shift) & uint(RELIEF_RADIX_DIGITS - 1);
}

/// The element of this invocation in a row of its block; may lie beyond u_count.
uint elementIn(uint turn) {
    return (gl_WorkGroupID.x * u_turns + turn) * uint(RELIEF_RADIX_DIGITS) + gl_LocalInvocationIndex;
}

#if defined(RELIEF_RADIX_COUNTED)
#define elementCount() b_totals[RELIEF_RADIX_DIGITS]
#else
#define elementCount() u_count
#endif

/// Where u_blocks counts of a digit begin.
uint countsOf(uint digit) {
    return digit * u_blocks;
}
