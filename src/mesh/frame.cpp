#include "mesh/frame.h"

#include <Eigen/Geometry>
#include <cmath>

namespace meshgrain {

Frame unit_frame(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.positions) box.extend(p.cast<double>());
  Frame frame;
  frame.origin = mesh.origin;
  const double diagonal = mesh.positions.empty() ? 0 : box.diagonal().norm();
  if (diagonal > 0) frame.scale = std::ldexp(1.0, std::ilogb(diagonal));
  return frame;
}

void enter(const Frame& frame, Mesh& mesh) {
  for (Vec3& p : mesh.positions) p = (p.cast<double>() / frame.scale).cast<float>();
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
