#pragma once

#include <span>
#include <string>
#include <vector>

#include "features/chain_edges.h"
#include "meshgrain/guides.h"

namespace meshgrain {

/// A guide, or a part of one, on the surface: dense points, less than an edge of the surface apart.
struct GuideRun {
  struct Point {
    Eigen::Vector3d position;
    Eigen::Vector3d direction;  ///< That of the guide, over a quarter of an edge of the output.
    Index face;                 ///< Of the surface, or its vertex if it is a point cloud.
  };
  std::vector<Point> points;  ///< If closed, the last is the first again.
  bool closed = false;
  float strength = 1;
};

struct TracedGuides {
  std::vector<GuideRun> runs;
  std::vector<std::string> notes;  ///< What was left out, a line each.
};

/// Puts guides onto a surface of triangles, or near the points of a cloud. They are broken at their
/// corners, and where they leave the surface. What runs beside another line (of `lines` or of
/// another guide) at less than about `edge_length`, that of the output, is left out, as no two
/// chains of edges fit there; ends that nearly reach a line are led up to it. Throws Error for a
/// guide that is nowhere near the surface, of which a unit is `scale` units of the input.
TracedGuides trace_guides(const Mesh& surface, std::span<const Guide> guides,
                          std::span<const EdgeOfLine> lines, double edge_length, double scale);

}  // namespace meshgrain
