#include "mesh/splitting.h"

#include <algorithm>

#include "util/edge_of.h"

namespace meshgrain {

Splitting::Splitting(Mesh& mesh, const Context& context)
    : mesh_(mesh), around_(vertex_faces(mesh, context)), faces_(mesh.faces.size()) {
  for (std::size_t k = 0; k < mesh.marked_edges.size(); ++k) {
    const auto [a, b] = mesh.marked_edges[k];
    marked_[edge_of(a, b)] = k;
  }
}

std::vector<Index> Splitting::around(Index v) const {
  const auto found = changed_.find(v);
  if (found != changed_.end()) return found->second;
  return {around_[v].begin(), around_[v].end()};
}

std::vector<Index> Splitting::parts(Index f) const {
  const auto found = parts_.find(f);
  return found != parts_.end() ? found->second : std::vector<Index>{f};
}

Index Splitting::split_edge(Index a, Index b, double share) {
  const Index m = add_vertex({a, b, a}, {1 - share, share, 0});
  for (const Index f : around(a)) {
    const auto corners = face(f);
    if (std::find(corners.begin(), corners.end(), b) == corners.end()) continue;
    const Index g = copy_face(f);
    replace(f, b, m);
    replace(g, a, m);
  }
  if (const auto mark = marked_.extract(edge_of(a, b))) {
    mesh_.marked_edges[mark.mapped()] = {a, m};
    marked_[edge_of(a, m)] = mark.mapped();
    marked_[edge_of(m, b)] = mesh_.marked_edges.size();
    mesh_.marked_edges.push_back({m, b});
  }
  return m;
}

Index Splitting::split_face(Index f, const std::array<double, 3>& weights) {
  const std::array<Index, 3> v{face(f)[0], face(f)[1], face(f)[2]};
  const Index m = add_vertex(v, weights);
  const Index g = copy_face(f), h = copy_face(f);
  replace(f, v[2], m);
  replace(g, v[0], m);
  replace(h, v[1], m);
  return m;
}

std::vector<Index>& Splitting::changed(Index v) {
  const auto found = changed_.find(v);
  return found != changed_.end() ? found->second : changed_[v] = around(v);
}

Index Splitting::add_vertex(const std::array<Index, 3>& of, const std::array<double, 3>& weights) {
  const auto mean = [&]<typename T>(std::vector<T>& values) {
    if (values.empty()) return;
    T sum = values[of[0]] * static_cast<float>(weights[0]);
    for (std::size_t k = 1; k < 3; ++k) sum += values[of[k]] * static_cast<float>(weights[k]);
    values.push_back(sum);
  };
  const auto m = static_cast<Index>(mesh_.positions.size());
  mean(mesh_.positions);
  mean(mesh_.values);
  mean(mesh_.normals);
  if (!mesh_.normals.empty()) mesh_.normals[m].normalize();
  changed_[m] = {};
  return m;
}

Index Splitting::copy_face(Index f) {
  const std::array<Index, 3> v{face(f)[0], face(f)[1], face(f)[2]};
  const auto g = static_cast<Index>(mesh_.faces.size());
  mesh_.faces.push_back(v);
  for (const Index c : v) changed(c).push_back(g);
  const Index origin = f < faces_ ? f : origin_.at(f);
  origin_[g] = origin;
  parts_.try_emplace(origin, 1, origin).first->second.push_back(g);
  return g;
}

void Splitting::replace(Index f, Index from, Index to) {
  const auto corners = mesh_.faces[f];
  *std::find(corners.begin(), corners.end(), from) = to;
  std::erase(changed(from), f);
  changed(to).push_back(f);
}

}  // namespace meshgrain
