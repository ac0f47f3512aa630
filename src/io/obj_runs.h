#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "io/text.h"
#include "meshgrain/mesh.h"

namespace meshgrain::io {

/// One corner of an OBJ face: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
struct ObjCorner {
  enum class Kind { index, no_index, out_of_range };
  Kind kind;
  std::int64_t vertex;    // as it is written: from 1, or negative
  std::int64_t normal;    // the same, or 0 if there is none
  std::string_view name;  // of the vertex, for messages
};
ObjCorner parse_corner(std::string_view word);

/// Most of a large OBJ file is runs of `v`, `vn` or `f` lines, one like the other, which several
/// threads can read. These functions read such a run from the cursor on, or its beginning, and
/// leave the cursor at the first line that is different, or in any way special: what that means,
/// and whether it is an error, is for the reader of single lines to say.
using ObjNumbers = std::vector<std::array<double, 3>>;
std::vector<ObjNumbers> read_run_of_numbers(Text& text, std::string_view name, const Input& input);

/// `corners` and `normals` face after face, counted from 0; no_index for no normal, and no normals
/// at all if no corner has any.
struct ObjFaces {
  std::vector<Index> corners, normals;
  std::vector<Index> degrees;
};
/// Of vertices that are known: so many.
std::vector<ObjFaces> read_run_of_faces(Text& text, std::size_t vertices, const Input& input);

}  // namespace meshgrain::io
