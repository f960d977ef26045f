// Everybody in the work group has come so far, and sees what all have written to shared memory.
void meet() {
    memoryBarrierShared();
    barrier();
}
