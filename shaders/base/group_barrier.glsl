// SPDX-License-Identifier: Apache-2.0
// Barrier: all invocations of the work group have reached this point, and see what all have written to shared memory.
void groupBarrier() {
    memoryBarrierShared();
    barrier();
}
