#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "io/text.h"
#include "meshgrain/mesh.h"

namespace meshgrain::io {

/// One corner of an OBJ face: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
struct ObjCorner {
  enum class Kind { index, no_number, out_of_range };
  Kind kind = Kind::no_number;
  std::int64_t vertex = 0;  // as it is written: from 1, or negative
  std::int64_t normal = 0;  // the same, or 0 if there is none
  std::string_view name;    // of the vertex, for messages
};
ObjCorner parse_corner(std::string_view word);

/// Bytes of a run that a thread reads at a time, and how many such parts may be held at once.
constexpr std::size_t run_part = 1 << 18, most_run_parts = 64;

/// Most of a large OBJ file is runs of `v`, `vn` or `f` lines, one like the other, which several
/// threads can read. These functions read so many parts of such a run from the cursor on, and leave
/// the cursor at the first line that is different, or in any way special: what that means, and
/// whether it is an error, is for the reader of single lines to say. Parts beyond the end of a run
/// are read in vain, so that one should ask for many only within a long one.
using ObjNumbers = std::vector<std::array<double, 3>>;
std::vector<ObjNumbers> read_run_of_numbers(Text& text, std::string_view name, std::size_t parts,
                                            const Input& input);

/// `corners` and `normals` face after face, counted from 0; no_index for no normal, and no normals
/// at all if no corner has any.
struct ObjFaces {
  std::vector<Index> corners, normals;
  std::vector<Index> degrees;
};
/// Of vertices that are known: so many.
std::vector<ObjFaces> read_run_of_faces(Text& text, std::size_t vertices, std::size_t parts,
                                        const Input& input);

}  // namespace meshgrain::io
