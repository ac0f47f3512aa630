#pragma once

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <vector>

#include "meshgrain/context.h"

namespace meshgrain {

/// Makes a list increasing, with each value once.
template <typename T>
void sort_unique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

/// The same on all threads, for long lists.
template <typename T>
void sort_unique(std::vector<T>& list, const Context& context) {
  context.run([&] { tbb::parallel_sort(list); });
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace meshgrain
