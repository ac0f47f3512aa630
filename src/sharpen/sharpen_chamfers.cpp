#include "sharpen/sharpen_chamfers.h"

#include "sharpen/chamfer_sharpening.h"
#include "sharpen/crease_net.h"

namespace meshgrain {

std::vector<std::array<Index, 2>> sharpen_chamfers(Mesh& triangles, double shortest, Chamfered part,
                                                   const Context& context) {
  const bool is_certain = part == Chamfered::yes;
  ChamferSharpening sharpening(triangles, context);
  // Of thin walls a third was; and of what is no such part some always is.
  const double most_put_back = is_certain ? 0.2 : 0.03;
  if (sharpening.share_put_back() > most_put_back) return {};
  const auto creases = [&] {
    return drop_scraps(triangles, sharpening.creases(), shortest, context);
  };
  const std::vector<std::array<Index, 2>> found = creases();
  // Those of a part end in others. In parts it was one of 250 edges that did not, in sculptures one
  // of 70 and more, in shapes with wider roundings one of 30.
  const std::size_t few = is_certain ? 100 : 1000;
  if (few * sharpening.loose_ends(found) > found.size()) return {};
  sharpening.give_up_loose();
  return creases();
}

}  // namespace meshgrain
