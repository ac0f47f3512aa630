#include "meshgrain/normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "mesh/vertex_faces.h"
#include "mesh/vertex_normals.h"
#include "util/indices.h"

namespace meshgrain {
namespace {

using Eigen::Vector3d;

/// Newell's normal of a polygon, as a unit vector; zero if the polygon is thinner than the rounding
/// of its coordinates, since the direction would be that of the rounding.
Vec3 face_normal(std::span<const Vec3> positions, std::span<const Index> face) {
  if (face.size() < 3) return Vec3::Zero();
  const Vector3d base = positions[face[0]].cast<double>();
  Vector3d area = Vector3d::Zero();
  double length = 0, scale = base.cwiseAbs().maxCoeff();
  Vector3d previous = positions[face.back()].cast<double>() - base;
  for (const Index v : face) {
    const Vector3d p = positions[v].cast<double>();
    const Vector3d current = p - base;
    area += previous.cross(current);
    length = std::max(length, (current - previous).norm());
    scale = std::max(scale, p.cwiseAbs().maxCoeff());
    previous = current;
  }
  const double norm = area.norm();
  const double rounding = 2 * std::numeric_limits<float>::epsilon() * scale * length;
  return norm > rounding ? Vec3((area / norm).cast<float>()) : Vec3(Vec3::Zero());
}

/// A face seen from one of its vertices.
struct Corner {
  Vector3d normal;
  double angle;
  Index previous, next;
};

Corner corner(const Mesh& mesh, const Vec3& face_normal, Index f, Index v) {
  const std::span<const Index> face = mesh.faces[f];
  const std::size_t i = corner_of(face, v);
  const Index previous = face[i == 0 ? face.size() - 1 : i - 1];
  const Index next = face[i + 1 == face.size() ? 0 : i + 1];
  const Vector3d p = mesh.positions[v].cast<double>();
  const Vector3d a = mesh.positions[next].cast<double>() - p;
  const Vector3d b = mesh.positions[previous].cast<double>() - p;
  const Vector3d normal = face_normal.cast<double>();
  const Vector3d cross = a.cross(b);
  double angle = std::atan2(cross.norm(), a.dot(b));
  if (cross.dot(normal) < 0) angle = 2 * std::numbers::pi - angle;  // a reflex corner of a polygon
  return {normal, angle, previous, next};
}

/// Whether two of the corners meet in a crease edge, that is, turn by more than the angle with this
/// cosine. `ends` is scratch space.
struct EdgeEnd {
  Index vertex;
  bool outgoing;
  std::uint32_t corner;
};

bool on_crease(std::span<const Corner> corners, double cosine, std::vector<EdgeEnd>& ends) {
  ends.clear();
  for (std::uint32_t c = 0; c < corners.size(); ++c) {
    ends.push_back({corners[c].next, true, c});
    ends.push_back({corners[c].previous, false, c});
  }
  std::sort(ends.begin(), ends.end(), [](const EdgeEnd& a, const EdgeEnd& b) {
    return a.vertex != b.vertex ? a.vertex < b.vertex : a.corner < b.corner;
  });
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const EdgeEnd &a = ends[i], &b = ends[i + 1];
    if (a.vertex != b.vertex || a.corner == b.corner) continue;
    // Faces that run along the edge in the same direction are oriented against each other.
    const double sign = a.outgoing == b.outgoing ? -1 : 1;
    if (sign * corners[a.corner].normal.dot(corners[b.corner].normal) < cosine) return true;
  }
  return false;
}

/// Finds the normals of vertices one by one, or zero; `normal_of(f)` is that of a face.
template <typename NormalOf>
class NormalFinder {
 public:
  NormalFinder(const Mesh& mesh, const VertexFaces& around, double crease_degrees,
               const NormalOf& normal_of)
      : mesh_(mesh),
        around_(around),
        creases_(crease_degrees >= 0),
        cosine_(std::cos(crease_degrees * std::numbers::pi / 180)),
        normal_of_(normal_of) {}

  Vec3 at(Index v) {
    corners_.clear();
    Index last = no_index;
    for (const Index f : around_[v]) {
      if (f == std::exchange(last, f)) continue;
      const Vec3 normal = normal_of_(f);
      if (!normal.isZero(0)) corners_.push_back(corner(mesh_, normal, f, v));
    }
    if (corners_.empty()) return Vec3::Zero();
    Vector3d sum = Vector3d::Zero();
    double angles = 0;
    const Corner* widest = &corners_.front();
    for (const Corner& c : corners_) {
      sum += c.angle * c.normal;
      angles += c.angle;
      // Rounding must not decide between angles that are equal by design.
      if (c.angle > widest->angle * (1 + 1e-5)) widest = &c;
    }
    // Faces that lie back to back cancel; one side is then as good as the other.
    const bool one_face = (creases_ && on_crease(corners_, cosine_, ends_)) ||
                          sum.norm() <= 1e-6 * angles || angles == 0;
    return (one_face ? widest->normal : sum).normalized().cast<float>();
  }

 private:
  const Mesh& mesh_;
  const VertexFaces& around_;
  bool creases_;
  double cosine_;
  const NormalOf& normal_of_;
  std::vector<Corner> corners_;
  std::vector<EdgeEnd> ends_;
};

/// Gives each vertex without a normal (zero) that of the vertex which a walk along the faces from
/// all others reaches it from first, or (0, 0, 1).
void fill_missing(const Mesh& mesh, const VertexFaces& around, std::vector<Vec3>& normals,
                  const Context& context) {
  const auto is_missing = [&](Index v) { return normals[v].isZero(0); };
  const std::vector<Index> missing = indices_where(normals.size(), is_missing, context);
  std::vector<Index> front;
  for (const Index v : missing) {
    for (const Index f : around[v])
      for (const Index w : mesh.faces[f])
        if (!normals[w].isZero(0)) front.push_back(w);
  }
  for (std::size_t i = 0; i < front.size(); ++i)
    for (const Index f : around[front[i]])
      for (const Index w : mesh.faces[f])
        if (normals[w].isZero(0)) {
          normals[w] = normals[front[i]];
          front.push_back(w);
        }
  for (const Index v : missing)
    if (normals[v].isZero(0)) normals[v] = Vec3::UnitZ();
}

}  // namespace

std::vector<Vec3> vertex_normals(const Mesh& mesh, double crease_degrees, const Context& context) {
  return vertex_normals(mesh, vertex_faces(mesh, context), crease_degrees, context);
}

std::vector<Vec3> vertex_normals(const Mesh& mesh, const VertexFaces& around, double crease_degrees,
                                 const Context& context) {
  std::vector<Vec3> face_normals(mesh.faces.size());
  context.for_ranges(mesh.faces.size(), 4096, [&](std::size_t begin, std::size_t end) {
    context.check();
    for (std::size_t f = begin; f < end; ++f)
      face_normals[f] = face_normal(mesh.positions, mesh.faces[f]);
  });

  const auto normal_of = [&](Index f) { return face_normals[f]; };
  std::vector<Vec3> normals(mesh.positions.size());
  context.for_ranges(normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
    context.check();
    NormalFinder finder(mesh, around, crease_degrees, normal_of);
    for (std::size_t v = begin; v < end; ++v) normals[v] = finder.at(static_cast<Index>(v));
  });
  fill_missing(mesh, around, normals, context);
  return normals;
}

void complete_normals(const Mesh& mesh, const VertexFaces& around, std::vector<Vec3>& normals,
                      const Context& context) {
  const auto normal_of = [&](Index f) { return face_normal(mesh.positions, mesh.faces[f]); };
  context.for_ranges(normals.size(), 4096, [&](std::size_t begin, std::size_t end) {
    NormalFinder finder(mesh, around, -1, normal_of);
    for (std::size_t v = begin; v < end; ++v) {
      if (normals[v].isZero(0)) normals[v] = finder.at(static_cast<Index>(v));
    }
  });
  fill_missing(mesh, around, normals, context);
}

}  // namespace meshgrain
