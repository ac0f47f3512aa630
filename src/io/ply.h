#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "io/input.h"
#include "io/output.h"
#include "meshgrain/mesh.h"

/// PLY files with more than a mesh: comments, and named numbers at the vertices.
namespace meshgrain::io::ply {

/// A number of every vertex that is to be read.
struct Column {
  std::string name;
  bool required = false;  // reading fails without it
  bool found = false;
  std::vector<double> numbers{};  // one a vertex if found; finite in single precision
  double largest = 1;             // that the file's type holds; 1 if that is not of whole numbers
};

Mesh read(const Input& input, std::span<Column> columns,
          std::vector<std::string>* comments = nullptr);

/// A number of every vertex that is to be written: vertex i has first[i * stride] + offset, in
/// double precision if there is an offset.
struct Attribute {
  const char* name;
  const float* first;
  std::size_t stride = 1;
  double offset = 0;
};

void write(Output& output, const Mesh& mesh, std::span<const std::string> comments,
           std::span<const Attribute> attributes);

}  // namespace meshgrain::io::ply
