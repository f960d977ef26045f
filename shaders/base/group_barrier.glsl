// SPDX-License-Identifier: Apache-2.0
// Waits for all invocations of the work group and makes their writes to shared memory visible.
void groupBarrier() {
    memoryBarrierShared();
    barrier();
}
