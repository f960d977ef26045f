// A sum over the invocations of a group that come before this one.
shared uint s_sums[RELIEF_RADIX_DIGITS];

uint sumBefore(uint mine) {
    uint self = gl_LocalInvocationIndex;
    s_sums[self] = mine;
    for (uint reach = 1u; reach < uint(RELIEF_RADIX_DIGITS); reach *= 2u) {
        meet();
        uint other = self >= reach ? s_sums[self - reach] : 0u;
        meet();
        s_sums[self] += other;
    }
    return s_sums[self] - mine;
}
