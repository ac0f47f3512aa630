#include "io/coordinates.h"

#include "util/bounding_box.h"

namespace meshgrain::io {
namespace {

bool is_far(const Eigen::AlignedBox3d& box, double factor) {
  return box.center().norm() > factor * box.diagonal().norm();
}

}  // namespace

void Coordinates::push_far(const Eigen::Vector3d& p) {
  far_.push_back(p);
  box_.extend(p);
  if (is_far(box_, 15)) return;  // a little less than 15.5, for the rounding
  near_ = true;
  store(Eigen::Vector3d::Zero());
}

bool Coordinates::take_if_near(std::vector<Vec3>& positions, const Context& context) {
  if (size() > 0 || is_far(bounding_box(positions, context).cast<double>(), 16)) return false;
  positions_ = std::move(positions);
  near_ = true;
  return true;
}

void Coordinates::store(const Eigen::Vector3d& origin) {
  for (const Eigen::Vector3d& p : far_) positions_.push_back((p - origin).cast<float>());
  far_ = {};
}

void Coordinates::move_to(Mesh& mesh, const Input& input) {
  if (size() == 0) input.fail("the file holds no vertices");
  if (size() >= no_index) input.fail("the file holds more vertices than 32 bits can number");
  if (!far_.empty()) {
    // A single-precision origin keeps single-precision coordinates exact when they are written.
    if (is_far(box_, 16)) mesh.origin = box_.center().cast<float>().cast<double>();
    store(mesh.origin);
  }
  mesh.positions = std::move(positions_);
}

}  // namespace meshgrain::io
