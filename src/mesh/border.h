#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "meshgrain/uninitialized.h"

namespace meshgrain {

/// The edges that only one face uses, as the vertices at their ends in the order of that face.
std::vector<std::array<Index, 2>> border_edges(const Mesh& mesh,
                                               const Context& context = Context(1));

/// The edges that are not simply between two faces of opposite direction: the border, and where
/// more than two faces or sides that disagree meet. Each once, the smaller index first.
std::vector<std::array<Index, 2>> rim_edges(const Mesh& mesh, const Context& context = Context(1));

/// The same, and whether each is of the border.
struct RimEdge {
  std::array<Index, 2> ends;
  bool is_border;
};
std::vector<RimEdge> classified_rim(const Mesh& mesh, const Context& context = Context(1));

/// Those that are not.
std::vector<std::array<Index, 2>> branch_edges(const Mesh& mesh,
                                               const Context& context = Context(1));

/// Of each of so many vertices, whether one of the edges ends there.
std::vector<std::uint8_t> mark_ends(std::span<const std::array<Index, 2>> edges,
                                    std::size_t vertices);

/// Of each vertex, whether it is on the border, or on an edge at which the mesh is not manifold.
std::vector<std::uint8_t> rim_vertices(const Mesh& mesh, const Context& context);

/// An edge between two faces of opposite direction, from the smaller index to the larger as `left`
/// has it.
struct InnerEdge {
  std::array<Index, 2> ends;
  Index left, right;
};

/// Those for which `wanted`, which is asked in several threads at once, says yes; sorted.
std::vector<InnerEdge> inner_edges(const Mesh& mesh,
                                   const std::function<bool(const InnerEdge&)>& wanted,
                                   const Context& context = Context(1));

/// An edge between two faces, the smaller index first, and whether they run along it in opposite
/// directions.
struct TwoFacedEdge {
  std::array<Index, 2> ends, faces;
  bool agree;
};
std::vector<TwoFacedEdge> two_faced_edges(const Mesh& mesh, const Context& context);
/// Whether there are any that do not agree: needs far less memory.
bool disagree_somewhere(const Mesh& mesh, const Context& context);

/// An edge between two faces, the smaller index first, and the cosine of the angle between their
/// normals.
struct SharpEdge {
  std::array<Index, 2> ends;
  double cosine;
};

/// What that cosine is less than where an edge is sharper than so many degrees; below none, all
/// are.
double sharp_cosine(double degrees);

/// rim_edges() and sharp_edges(), found together.
struct RimAndSharpEdges {
  std::vector<std::array<Index, 2>> rim;
  UninitializedVector<SharpEdge> sharp;  // scans have as many as other edges
};
RimAndSharpEdges rim_and_sharp_edges(const Mesh& mesh, double degrees, const Context& context);

/// The edges between two faces whose normals differ by more than `degrees`.
UninitializedVector<SharpEdge> sharp_edges(const Mesh& mesh, double degrees,
                                           const Context& context = Context(1));
std::vector<std::array<Index, 2>> crease_edges(const Mesh& mesh, double degrees,
                                               const Context& context = Context(1));

}  // namespace meshgrain
