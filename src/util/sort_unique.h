#pragma once

#include <algorithm>
#include <vector>

namespace meshgrain {

/// Makes a list increasing, with each value once.
template <typename T>
void sort_unique(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace meshgrain
