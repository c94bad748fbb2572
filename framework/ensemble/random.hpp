// Random numbers that are a function of their place: Philox4x32-10, a counter-based generator.
//
// Four 32-bit words follow from a key of two words and a counter of four by ten rounds of
//   (c0, c1, c2, c3) -> (hi(M1 c2) ^ c1 ^ k0, lo(M1 c2), hi(M0 c0) ^ c3 ^ k1, lo(M0 c0)),
// k0 += W0, k1 += W1 between the rounds. The seed is the key, a member of an ensemble the counter:
// its numbers do not depend on any other's. Source: Salmon, Moraes, Dror, Shaw, Parallel random
// numbers: as easy as 1, 2, 3, SC 2011. Not installed.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <utility>

namespace hamel::ensemble {

using Words4 = std::array<uint32_t, 4>;
using Words2 = std::array<uint32_t, 2>;

constexpr Words4 philox(Words4 counter, Words2 key) {
  for (int round = 0; round < 10; ++round) {
    const uint64_t first = uint64_t{0xD2511F53} * counter[0],
                   second = uint64_t{0xCD9E8D57} * counter[2];
    counter = {
        static_cast<uint32_t>(second >> 32) ^ counter[1] ^ key[0], static_cast<uint32_t>(second),
        static_cast<uint32_t>(first >> 32) ^ counter[3] ^ key[1], static_cast<uint32_t>(first)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

/// Key that distinguishes the numbers of two names: FNV-1a, 32 bits.
constexpr uint32_t stream_of(std::string_view name) {
  uint32_t hash = 2166136261u;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash;
}

/// The numbers of one member for one name, one after the other.
class Draws {
 public:
  Draws(uint64_t seed, uint64_t member, uint32_t stream)
      : counter_{static_cast<uint32_t>(member), static_cast<uint32_t>(member >> 32), stream, 0},
        key_{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)} {}

  /// In (0, 1), a multiple of 2^-53 and a half of it.
  double uniform() {
    if (left_ == 0) {
      words_ = philox(counter_, key_);
      ++counter_[3];
      left_ = 2;
    }
    const size_t at = 2 * (2 - left_--);
    const uint64_t bits = (uint64_t{words_[at + 1]} << 32 | words_[at]) >> 11;
    return (static_cast<double>(bits) + 0.5) * 0x1p-53;
  }
  /// Normal draw of mean 0 and deviation 1, by Box and Muller.
  double normal() {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  Words4 counter_, words_ = {};
  Words2 key_;
  size_t left_ = 0;
};

}  // namespace hamel::ensemble
