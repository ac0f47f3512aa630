#pragma once

#include <filesystem>

#include "meshgrain/context.h"
#include "meshgrain/fields.h"

namespace meshgrain {

/// Writes fields with their surface as a binary PLY file that other programs can open: at each
/// vertex the position x y z, the normal nx ny nz, the orientation ox oy oz and, if there are
/// positions, the lattice point px py pz and, if edge lengths differ, the `length`; the surface's
/// faces; and comments in the header:
///
///     comment meshgrain fields 1
///     comment rosy 4
///     comment posy 4
///     comment edge_length 0.0123
///     comment fine_lattice 1        (if it is)
///
/// The file appears whole or not at all. Throws Error if the fields do not have one value a vertex,
/// or if the place cannot be written.
void write_fields(const std::filesystem::path& path, const Fields& fields);

/// Reads what write_fields wrote or another program did: properties in any order and of any type,
/// text or binary of either byte order. Without px py pz there is no position field, and `comment
/// posy` and edge lengths are not needed; normals that are missing are computed, and polygons split
/// into triangles. Throws Error, naming the file and the place, as read_mesh does.
Fields read_fields(const std::filesystem::path& path, const Context& context = Context());

}  // namespace meshgrain
