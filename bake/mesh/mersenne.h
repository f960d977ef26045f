// SPDX-License-Identifier: Apache-2.0
// Generates random bits: SplitMix64, and a 64-bit Mersenne Twister (Nishimura 2000) for short sequences from many
// seeds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace relief {

/// The SplitMix64 finalizer (Steele, Lea, Flood 2014), applied to the state after `z`.
[[nodiscard]] constexpr std::uint64_t splitMix64(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
}

/// Generates the sequence of std::mt19937_64 incrementally. The library computes 312 words at a time, but a random
/// point needs only six.
class Mersenne64 {
  public:
    explicit Mersenne64(std::uint64_t seed) { words_[0] = seed; }

    std::uint64_t operator()() {
        const std::size_t second = next_ + 1 < kWords ? next_ + 1 : 0;
        const std::size_t middle = next_ < kWords - kMiddle ? next_ + kMiddle : next_ + kMiddle - kWords;
        seedUpTo(middle);
        const std::uint64_t joined = (words_[next_] & kUpper) | (words_[second] & ~kUpper);
        const std::uint64_t word =
            words_[middle] ^ (joined >> 1U) ^ ((joined & 1U) != 0 ? 0xb5026f5aa96619e9U : 0U);
        words_[next_] = word;
        next_ = second;
        return tempered(word);
    }

  private:
    static constexpr std::size_t kWords = 312;
    static constexpr std::size_t kMiddle = 156;
    static constexpr std::uint64_t kUpper = ~std::uint64_t{0} << 31U;

    /// Seeds the words up to `last`. Seeding never reads a word that has been replaced.
    void seedUpTo(std::size_t last) {
        for (; seeded_ <= last; ++seeded_) {
            const std::uint64_t before = words_[seeded_ - 1];
            words_[seeded_] = 6364136223846793005U * (before ^ (before >> 62U)) + seeded_;
        }
    }

    static std::uint64_t tempered(std::uint64_t z) {
        z ^= (z >> 29U) & 0x5555555555555555U;
        z ^= (z << 17U) & 0x71d67fffeda60000U;
        z ^= (z << 37U) & 0xfff7eee000000000U;
        return z ^ (z >> 43U);
    }

    // [0, seeded_) are valid; [0, next_) belong to the current round.
    std::array<std::uint64_t, kWords> words_;
    std::size_t seeded_ = 1;
    std::size_t next_ = 0;
};

}  // namespace relief
