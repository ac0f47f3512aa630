#pragma once

#include <string>

#include "meshgrain/error.h"

namespace meshgrain {

/// Calls `f.operator()<N>()` for the N that is known at run time. The lists of symmetries that
/// exist are here and nowhere else.
template <typename F>
decltype(auto) with_rosy(int rosy, F&& f) {
  switch (rosy) {
    case 1:
      return f.template operator()<1>();
    case 2:
      return f.template operator()<2>();
    case 4:
      return f.template operator()<4>();
    case 6:
      return f.template operator()<6>();
    default:
      throw Error("orientation symmetry " + std::to_string(rosy) + " is not one of 1, 2, 4 and 6");
  }
}

template <typename F>
decltype(auto) with_posy(int posy, F&& f) {
  switch (posy) {
    case 4:
      return f.template operator()<4>();
    case 6:
      return f.template operator()<6>();
    default:
      throw Error("position symmetry " + std::to_string(posy) + " is not one of 4 and 6");
  }
}

/// Calls `f.operator()<E>()` for the kind of energy: whatever is not intrinsic is measured in
/// space.
template <typename Energy, typename F>
decltype(auto) with_energy(Energy energy, F&& f) {
  return energy == Energy::intrinsic ? f.template operator()<Energy::intrinsic>()
                                     : f.template operator()<Energy::extrinsic>();
}

}  // namespace meshgrain
