#include "util/dispatch.h"

#include <atomic>

namespace meshgrain {
namespace {

std::int64_t find_targets() {
  std::int64_t targets = HWY_STATIC_TARGET;
#if HWY_ARCH_X86
  // Every processor with AVX2 counts zeros and has half floats, every one with SSE4.2 and AES
  // multiplies without carry: what Highway's targets take for granted beside these.
  const auto add = [&](std::int64_t target, bool has) {
    if (has) targets |= target;
  };
  add(HWY_SSE4, __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("aes"));
  add(HWY_AVX2, __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2"));
  add(HWY_AVX3, __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                    __builtin_cpu_supports("avx512cd"));
#endif
  return targets;
}

std::atomic<std::int64_t> pretended{0};

}  // namespace

std::int64_t simd_targets() {
  static const std::int64_t found = find_targets();
  const std::int64_t instead = pretended.load(std::memory_order_relaxed);
  return instead != 0 ? instead : found;
}

void pretend_simd_targets(std::int64_t targets) {
  pretended.store(targets, std::memory_order_relaxed);
}

}  // namespace meshgrain
