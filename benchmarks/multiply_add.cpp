#include "multiply_add.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "multiply_add.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace meshgrain::bench {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

std::size_t multiply_add(std::size_t rounds, float& result) {
  const hn::ScalableTag<float> lanes;
  const auto factor = hn::Set(lanes, 0.999f), term = hn::Set(lanes, 0.001f);
  // Ten chains: two units that start one each cycle, and take five. By name, as vectors of a width
  // that is known only at run time cannot stand in an array.
  auto a = term, b = term, c = term, d = term, e = term;
  auto f = term, g = term, h = term, i = term, j = term;
  for (std::size_t round = 0; round < rounds; ++round) {
    a = hn::MulAdd(a, factor, term);
    b = hn::MulAdd(b, factor, term);
    c = hn::MulAdd(c, factor, term);
    d = hn::MulAdd(d, factor, term);
    e = hn::MulAdd(e, factor, term);
    f = hn::MulAdd(f, factor, term);
    g = hn::MulAdd(g, factor, term);
    h = hn::MulAdd(h, factor, term);
    i = hn::MulAdd(i, factor, term);
    j = hn::MulAdd(j, factor, term);
  }
  const auto sum = ((a + b) + (c + d)) + ((e + f) + (g + h)) + (i + j);
  result = hn::GetLane(hn::SumOfLanes(lanes, sum));
  return 10 * rounds * hn::Lanes(lanes);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace meshgrain::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace meshgrain::bench {

HWY_EXPORT(multiply_add);

std::size_t multiply_add(std::size_t rounds, float& result) {
  return HWY_DYNAMIC_DISPATCH(multiply_add)(rounds, result);
}

}  // namespace meshgrain::bench
#endif
