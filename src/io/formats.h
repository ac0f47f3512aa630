#pragma once

#include <string_view>

#include "io/input.h"
#include "io/output.h"
#include "meshgrain/mesh.h"

/// One file a format. Readers throw Error, which names the line or byte, and leave no index out of
/// range; read_mesh does what all formats have in common.
namespace meshgrain::io {

bool is_ply(std::string_view bytes);
bool is_off(std::string_view bytes);
bool is_stl(std::string_view bytes);

Mesh read_aln(const Input& input);
Mesh read_obj(const Input& input);
Mesh read_off(const Input& input);
Mesh read_ply(const Input& input);
Mesh read_pts(const Input& input);
Mesh read_stl(const Input& input);
Mesh read_xyz(const Input& input);

/// As read_obj, but only lines make marked edges.
Mesh read_obj_lines(const Input& input);

void write_obj(Output& output, const Mesh& mesh);
void write_off(Output& output, const Mesh& mesh);
void write_ply(Output& output, const Mesh& mesh);
void write_stl(Output& output, const Mesh& mesh);

}  // namespace meshgrain::io
