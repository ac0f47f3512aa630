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
