#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "meshgrain/remesh.h"
#include "meshgrain/statistics.h"

/// What the program says of meshes, mostly in JSON.
namespace meshgrain::cli {

using Json = nlohmann::ordered_json;

/// "4,960 quads, 12 triangles, 1 larger": the kinds that there are.
std::string faces_by_kind(const MeshStatistics& statistics);

Json to_json(const MeshStatistics& statistics);
Json to_json(const SurfaceDistance& distance);
Json to_json(const RemeshReport& report);
Json to_json(const RemeshOptions& options);

}  // namespace meshgrain::cli
