#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"
#include "meshgrain/polylines.h"

namespace meshgrain {

struct ReadOptions {
  /// Merge vertices whose positions are exactly equal. STL, which has no shared vertices, is always
  /// welded.
  bool weld = false;
  /// Keep the scalar vertex property of this name (PLY) as Mesh::values; an error if it is absent.
  std::string value_name;
  /// Keep the colours of the vertices (PLY: `red`, `green`, `blue`; OBJ: three numbers after the
  /// position) as Mesh::values, for Sizing::Kind::paint: red - (green + blue) / 2, from -1 (cyan)
  /// over 0 (white and all greys) to 1 (red). An error if they are absent. Not with `value_name`.
  bool paint = false;
};

/// Reads OBJ, PLY (ASCII and both byte orders; `tristrips` and `range_grid` too), OFF (text and
/// binary), STL (both kinds), ALN, XYZ or PTS; the kind is told by the content where that is
/// possible, else by the name's extension. A file with vertices but no faces is a point cloud.
/// Mesh::marked_edges get the lines of OBJ (`l`), edges between faces of different materials
/// (`usemtl`) or of different normals at both ends (unless angles alone tell these, as in flat
/// shading), and the element `edge` (`vertex1`, `vertex2`) of PLY.
/// Throws Error, naming the file and the line or byte, if the file is missing, of an unknown kind
/// or cut off, or if an index is out of range or a number is not finite.
Mesh read_mesh(const std::filesystem::path& path, const ReadOptions& options = {},
               const Context& context = Context());

/// Reads the lines of a file, whatever faces it has beside: `l` of OBJ, the element `edge` of PLY.
/// All its vertices are points, in their order; lines that meet at a point are one if no third
/// does. Throws Error as read_mesh does, and if the file has no lines.
Polylines read_polylines(const std::filesystem::path& path, const Context& context = Context());

/// Writes OBJ, PLY (binary, little endian), OFF or STL (binary), chosen by the extension. The file
/// appears whole or not at all: it is written beside its place and renamed. STL splits polygons
/// into triangles. Marked edges become lines of OBJ and the element `edge` of PLY. Throws Error if
/// the extension is unknown or the place cannot be written.
void write_mesh(const std::filesystem::path& path, const Mesh& mesh);

/// Whether write_mesh() splits polygons into triangles there.
bool holds_triangles_only(const std::filesystem::path& path);

/// Throws the error that write_mesh would throw for an unknown extension or a missing or read-only
/// folder, so that a long computation need not end in one.
void check_writable(const std::filesystem::path& path);

/// Writes a file of any kind: like write_mesh, whole or not at all.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// As check_writable, for any extension.
void check_place(const std::filesystem::path& path);

}  // namespace meshgrain
