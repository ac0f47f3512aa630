#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace meshgrain {

/// An allocator that leaves new numbers as they are, in place of zero: large arrays that several
/// threads fill are then first touched by these, and only once.
template <typename T>
struct UninitializedAllocator : std::allocator<T> {
  static_assert(std::is_trivially_copyable_v<T>);

  template <typename U>
  struct rebind {
    using other = UninitializedAllocator<U>;
  };

  using std::allocator<T>::allocator;

  template <typename U>
  void construct(U* place) noexcept {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Args>
  void construct(U* place, Args&&... args) {
    ::new (static_cast<void*>(place)) U(std::forward<Args>(args)...);
  }
};

/// Elements that resize() adds are to be written before they are read.
template <typename T>
using UninitializedVector = std::vector<T, UninitializedAllocator<T>>;

}  // namespace meshgrain
