#include "mesh/frame.h"

#include <Eigen/Geometry>
#include <cmath>

#include "util/bounding_box.h"

namespace meshgrain {

Frame unit_frame(const Mesh& mesh, const Context& context) {
  const auto box = Eigen::AlignedBox3d(bounding_box(mesh.positions, context).cast<double>());
  Frame frame;
  frame.origin = mesh.origin;
  const double diagonal = mesh.positions.empty() ? 0 : box.diagonal().norm();
  if (diagonal > 0) frame.scale = std::ldexp(1.0, std::ilogb(diagonal));
  return frame;
}

void enter(const Frame& frame, Mesh& mesh, const Context& context) {
  context.for_ranges(mesh.positions.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      mesh.positions[v] = (mesh.positions[v].cast<double>() / frame.scale).cast<float>();
    }
  });
  mesh.origin.setZero();
}

void leave(const Frame& frame, Mesh& mesh) {
  for (Vec3& p : mesh.positions) p = (p.cast<double>() * frame.scale).cast<float>();
  mesh.origin = frame.origin;
}

void leave(const Frame& frame, Fields& fields) {
  leave(frame, fields.surface);
  for (Vec3& p : fields.position.points) p = (p.cast<double>() * frame.scale).cast<float>();
  for (float& length : fields.position.edge_length.values) {
    length = static_cast<float>(length * frame.scale);
  }
}

}  // namespace meshgrain
