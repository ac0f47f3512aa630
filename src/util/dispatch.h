// To be included after hwy/foreach_target.h, or where no code is made for several targets.
#pragma once

#include <hwy/highway.h>

#include <cstdint>

namespace meshgrain {

/// The instruction sets that this processor has among those that code is made for, as the bits of
/// Highway's targets. Highway's library would say so too, and dispatch; but it measures the timer
/// whenever a program loads it, for 3.7 ms: of 49 that a small model takes.
std::int64_t simd_targets();

/// For tests: as if it had these alone; 0 for what it has.
void pretend_simd_targets(std::int64_t targets);

}  // namespace meshgrain

/// The function of that name in the HWY_NAMESPACE of the best target.
#if HWY_ARCH_X86
#define MESHGRAIN_BEST_TARGET(FUNCTION)                                                \
  ::meshgrain::best_target<decltype(&HWY_STATIC_DISPATCH(FUNCTION))>(                  \
      HWY_CHOOSE_AVX3(FUNCTION), HWY_CHOOSE_AVX2(FUNCTION), HWY_CHOOSE_SSE4(FUNCTION), \
      &HWY_STATIC_DISPATCH(FUNCTION))

namespace meshgrain {

template <typename Function>
Function best_target(Function avx3, Function avx2, Function sse4, Function baseline) {
  const std::int64_t targets = simd_targets();
  if (avx3 != nullptr && (targets & HWY_AVX3) != 0) return avx3;
  if (avx2 != nullptr && (targets & HWY_AVX2) != 0) return avx2;
  if (sse4 != nullptr && (targets & HWY_SSE4) != 0) return sse4;
  return baseline;
}

}  // namespace meshgrain
#else
#define MESHGRAIN_BEST_TARGET(FUNCTION) (&HWY_STATIC_DISPATCH(FUNCTION))
#endif
