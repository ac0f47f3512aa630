#include "util/radix_sort.h"

#include <array>
#include <cstddef>

namespace meshgrain {
namespace {

constexpr int digit_bits = 11;  // the counts of a range stay in the innermost cache
constexpr std::size_t digits = std::size_t{1} << digit_bits;
constexpr std::size_t grain = 1 << 16;

}  // namespace

// From the last digit on: each pass keeps the order of the one before among equal digits.
void radix_sort_by_upper(std::vector<std::uint64_t>& numbers, int bits, const Context& context) {
  const std::size_t count = numbers.size();
  std::vector<std::uint64_t> sorted(count);
  // How many of a range have each digit; then where the next one goes.
  std::vector<std::array<std::uint32_t, digits>> places((count + grain - 1) / grain);
  for (int shift = 32; shift < 32 + bits; shift += digit_bits) {
    const auto digit = [&](std::uint64_t number) { return number >> shift & (digits - 1); };
    context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
      auto& counts = places[begin / grain];
      counts.fill(0);
      for (std::size_t k = begin; k < end; ++k) ++counts[digit(numbers[k])];
    });
    std::uint32_t place = 0;
    for (std::size_t d = 0; d < digits; ++d) {
      for (auto& of_range : places) {
        const std::uint32_t here = of_range[d];
        of_range[d] = place;
        place += here;
      }
    }
    context.for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
      auto& next = places[begin / grain];
      for (std::size_t k = begin; k < end; ++k) sorted[next[digit(numbers[k])]++] = numbers[k];
    });
    numbers.swap(sorted);
  }
}

}  // namespace meshgrain
