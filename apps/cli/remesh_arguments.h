#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "meshgrain/io.h"
#include "meshgrain/remesh.h"

namespace meshgrain::cli {

/// What the command line of remesh_command says.
struct Arguments {
  std::vector<std::string> words;  // as they were given
  std::string input, output, report, features, fields, fields_out;
  int threads = 0;
  bool quiet = false;
  bool energies = false;
  int posy = 4;
  bool posy_given = false, dominant = false, hexagons = false, single_level = false;
  bool ignored = false;
  bool target_given = false;
  std::vector<std::size_t> levels;  // of --lod
  std::string energy, orientation_energy, sizing, density;
  std::vector<std::string> guides;
  ReadOptions read;
  RemeshOptions remesh;
};

/// Returns whether there is anything to do: false if --help or --version was. Throws UsageError for
/// what contradicts itself.
bool parse_remesh(int argc, char** argv, Arguments& arguments);

/// The meshes that are written.
std::vector<std::string> output_paths(const Arguments& arguments);

}  // namespace meshgrain::cli
