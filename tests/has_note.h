#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "meshgrain/remesh.h"

namespace meshgrain::made {

/// Whether a note begins so.
inline bool has_note(const RemeshResult& result, std::string_view beginning) {
  return std::ranges::any_of(result.report.notes,
                             [&](const std::string& note) { return note.starts_with(beginning); });
}

}  // namespace meshgrain::made
