#pragma once

#include <cstdint>

namespace meshgrain {

/// A well-mixed 64-bit hash (the finaliser of SplitMix64): the source of everything "random", so
/// that nothing depends on the order in which threads run.
constexpr std::uint64_t hash64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

constexpr std::uint64_t hash64(std::uint64_t a, std::uint64_t b) {
  return hash64(a ^ hash64(b));
}

/// A number in [0, 1) from a hash.
constexpr float unit_float(std::uint64_t hash) {
  return static_cast<float>(hash >> 40) * (1.0f / 16777216.0f);
}

}  // namespace meshgrain
