#pragma once

#include <nlohmann/json.hpp>

#include "meshgrain/remesh.h"
#include "meshgrain/statistics.h"

/// What the program says in JSON.
namespace meshgrain::cli {

using Json = nlohmann::ordered_json;

Json to_json(const MeshStatistics& statistics);
Json to_json(const SurfaceDistance& distance);
Json to_json(const RemeshReport& report);
Json to_json(const RemeshOptions& options);

}  // namespace meshgrain::cli
