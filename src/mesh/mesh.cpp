#include "meshgrain/mesh.h"

namespace meshgrain {

void Faces::push_back(std::span<const Index> face) {
  if (count_ == 0) degree_ = face.size();
  if (starts_.empty() && face.size() != degree_) {
    starts_.reserve(count_ + 2);
    for (std::size_t f = 0; f <= count_; ++f) starts_.push_back(f * degree_);
  }
  corners_.insert(corners_.end(), face.begin(), face.end());
  ++count_;
  if (!starts_.empty()) starts_.push_back(corners_.size());
}

void Faces::append(std::span<const Index> corners, std::size_t degree) {
  const std::size_t count = corners.size() / degree;
  if (count_ > 0 && uniform_degree() != degree) {
    for (std::size_t f = 0; f < count; ++f) push_back(corners.subspan(f * degree, degree));
    return;
  }
  degree_ = degree;
  corners_.insert(corners_.end(), corners.begin(), corners.end());
  count_ += count;
}

void Faces::reserve(std::size_t faces, std::size_t corners) {
  corners_.reserve(corners);
  if (!starts_.empty()) starts_.reserve(faces + 1);
}

Faces Faces::uniform(std::size_t count, std::size_t degree) {
  Faces faces;
  faces.corners_.resize(count * degree);
  faces.count_ = count;
  faces.degree_ = degree;
  return faces;
}

}  // namespace meshgrain
