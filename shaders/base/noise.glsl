// SPDX-License-Identifier: Apache-2.0
// Returns a uniform number in [0, 1) and advances the seed (PCG's output permutation).
float noise(inout uint seed) {
    seed = seed * 747796405u + 2891336453u;
    uint word = ((seed >> ((seed >> 28) + 4u)) ^ seed) * 277803737u;
    return float(((word >> 22) ^ word) >> 8) / 16777216.0;
}
