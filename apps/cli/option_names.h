#pragma once

#include <map>
#include <string>

#include "meshgrain/remesh.h"

namespace meshgrain::cli {

/// What the values of an option are called, on the command line and in reports.
template <class T>
using Names = std::map<std::string, T>;

inline const Names<Schedule> schedules = {
    {"blocks", Schedule::blocks}, {"random", Schedule::random_order}, {"jacobi", Schedule::jacobi}};
inline const Names<OrientationEnergy> orientation_energies = {
    {"extrinsic", OrientationEnergy::extrinsic},
    {"intrinsic", OrientationEnergy::intrinsic},
    {"convex", OrientationEnergy::convex}};
inline const Names<PositionEnergy> position_energies = {{"extrinsic", PositionEnergy::extrinsic},
                                                        {"intrinsic", PositionEnergy::intrinsic}};
inline const Names<GraphNodes> graph_nodes = {{"vertices", GraphNodes::vertices},
                                              {"faces", GraphNodes::faces}};
inline const Names<GraphWeights> graph_weights = {{"uniform", GraphWeights::uniform},
                                                  {"geometric", GraphWeights::geometric}};
inline const Names<OutputFaces> output_faces = {{"quads", OutputFaces::quads},
                                                {"quad-dominant", OutputFaces::quad_dominant},
                                                {"triangles", OutputFaces::triangles},
                                                {"hexagons", OutputFaces::hexagons}};
inline const Names<Sizing::Kind> sizing_kinds = {{"uniform", Sizing::Kind::uniform},
                                                 {"distance", Sizing::Kind::distance},
                                                 {"value", Sizing::Kind::values},
                                                 {"density", Sizing::Kind::density},
                                                 {"paint", Sizing::Kind::paint}};

/// That of a value; empty if it has none.
template <class T>
std::string name_of(T value, const Names<T>& names) {
  for (const auto& [name, named] : names) {
    if (named == value) return name;
  }
  return {};
}

/// All of them, separated by commas.
template <class T>
std::string list_of(const Names<T>& names) {
  std::string list;
  for (const auto& entry : names) list += (list.empty() ? "" : ", ") + entry.first;
  return list;
}

}  // namespace meshgrain::cli
