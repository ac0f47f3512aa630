#pragma once

#include <string>
#include <vector>

#include "mesh/orient_faces.h"
#include "mesh/seams.h"
#include "meshgrain/clean.h"
#include "meshgrain/remesh.h"
#include "remesh/flaws.h"

namespace meshgrain {

/// What was taken out of an input or turned in it, a line each, for RemeshReport::notes.
std::vector<std::string> describe(const CleanReport& cleaned);
std::vector<std::string> describe(const OrientReport& oriented);
std::vector<std::string> describe(const SeamReport& seams);

/// Adds a line to the report if a finished mesh is off the count that was asked for by more than
/// one percent.
void note_missed_count(RemeshResult& result, const RemeshOptions& options);

/// Adds a line to the report if a finished mesh has faults.
void note_faults(RemeshResult& result, const FaultCounts& faults);

}  // namespace meshgrain
