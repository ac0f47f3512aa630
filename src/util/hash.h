#pragma once

#include <cstdint>

namespace meshgrain {

/// The finaliser of SplitMix64 (Steele, Lea and Flood 2014): every bit of the input changes every
/// bit of the output with about even odds.
inline std::uint64_t mix_bits(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9u;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace meshgrain
