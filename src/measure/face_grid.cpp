#include "measure/face_grid.h"

#include <bit>
#include <numeric>

#include "util/indices.h"
#include "util/sum.h"

namespace meshgrain {
namespace {

struct Extent {
  Eigen::AlignedBox3f box;
  double sizes = 0;  // of the faces

  Extent operator+(const Extent& other) const {
    return {box.merged(other.box), sizes + other.sizes};
  }
};

}  // namespace

Eigen::AlignedBox3f face_box(const Mesh& mesh, Index f) {
  Eigen::AlignedBox3f box;
  for (const Index v : mesh.faces[f]) box.extend(mesh.positions[v]);
  return box;
}

std::vector<Eigen::AlignedBox3f> face_boxes(const Mesh& mesh, const Context& context) {
  std::vector<Eigen::AlignedBox3f> boxes(mesh.faces.size());
  const auto find = [&](Index f) { boxes[f] = face_box(mesh, f); };
  for_indices(boxes.size(), find, context);
  return boxes;
}

FaceGrid::FaceGrid(const Mesh& mesh, const Context& context) : boxes_(mesh.faces.size()) {
  const std::size_t count = boxes_.size();
  const auto [box, sizes] = sum_over_ranges(
      count,
      [&](std::size_t begin, std::size_t end) {
        Extent extent;
        for (std::size_t f = begin; f < end; ++f) {
          boxes_[f] = face_box(mesh, static_cast<Index>(f));
          extent = extent + Extent{boxes_[f], boxes_[f].sizes().maxCoeff()};
        }
        return extent;
      },
      context);
  if (!(sizes > 0)) return;
  constexpr double most_cells = (std::uint32_t{1} << bits_a_place) - 1;  // along an axis
  const double cells_a_length = std::min(static_cast<double>(count) / (1.5 * sizes),
                                         most_cells / double{box.sizes().maxCoeff()});
  const Vec3 lowest = box.min();
  const auto cell = [&](const Vec3& p) -> Cell {
    return ((p - lowest).cast<double>() * cells_a_length).cast<std::uint32_t>();
  };
  lows_.resize(count);
  highs_.resize(count);
  for (std::size_t f = 0; f < count; ++f) {
    lows_[f] = cell(boxes_[f].min());
    highs_[f] = cell(boxes_[f].max());
  }
  find_levels(context);
  fill();
}

/// At which a face touches few cells.
std::size_t FaceGrid::smallest_level(Index f) const {
  constexpr std::uint64_t few = 64;
  for (std::size_t level = 0;; ++level) {
    const Cell more = at(highs_[f], level) - at(lows_[f], level);
    if ((more.cast<std::uint64_t>() + 1).prod() <= few) return level;
  }
}

void FaceGrid::find_levels(const Context& context) {
  const std::size_t count = boxes_.size();
  std::vector<std::size_t> faces;  // of each grid
  std::vector<std::uint8_t> levels(count);
  context.for_ranges(count, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      levels[f] = static_cast<std::uint8_t>(smallest_level(static_cast<Index>(f)));
    }
  });
  for (const std::uint8_t level : levels) {
    if (level >= faces.size()) faces.resize(level + std::size_t{1});
    ++faces[level];
  }
  std::size_t buckets = 0;
  for (const std::size_t in_grid : faces) {
    const int bits = std::max(1, static_cast<int>(std::bit_width(in_grid)));
    grids_.push_back({buckets, bits});
    buckets += std::size_t{1} << bits;
  }
  starts_.assign(buckets + 1, 0);
  if (has_large_faces()) levels_ = std::move(levels);
}

/// A counting sort: starts_ are first the ends, and move down as the entries come in.
void FaceGrid::fill() {
  const auto for_each_entry = [&](const auto& body) {
    for (auto f = static_cast<Index>(boxes_.size()); f-- > 0;) {
      const std::size_t level = level_of(f);
      for_cells(f, level, [&](std::uint64_t cell) {
        body(bucket_of(cell, level), Entry{cell, f});
      });
    }
  };
  for_each_entry([&](std::size_t bucket, const Entry&) { ++starts_[bucket]; });
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  entries_.resize(starts_.back());
  for_each_entry(
      [&](std::size_t bucket, const Entry& entry) { entries_[--starts_[bucket]] = entry; });
}

}  // namespace meshgrain
