#include "sample_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "arguments.h"
#include "meshgrain/io.h"
#include "meshgrain/shapes.h"
#include "meshgrain/system.h"

namespace meshgrain::cli {

void sample_command(int argc, char** argv) {
  std::string name, output;
  double resolution = 1, noise = 0;
  CLI::App app("Makes a shape to try things on; without a name, lists the names.",
               "meshgrain sample");
  app.add_option("NAME", name, "the shape");
  app.add_option("-o,--output", output, "the file to write (NAME.obj); OBJ, PLY, OFF or STL")
      ->type_name("FILE");
  app.add_option("--resolution", resolution, "vertices along a side, relative to the usual (1)")
      ->type_name("R");
  app.add_option("--noise", noise, "move every vertex by this share of an edge, as in a scan (0)")
      ->check(CLI::Range(0.0, 10.0))
      ->type_name("SHARE");
  if (!parse(app, argc, argv)) return;

  const auto names = sample_names();
  if (name.empty()) {
    if (!output.empty()) throw UsageError("which shape? `meshgrain sample` lists the names");
    for (const std::string& known : names) fmt::print("{}\n", known);
    return;
  }
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw UsageError("there is no shape named " + name + "; known are " +
                     fmt::format("{}", fmt::join(names, ", ")));
  }
  if (output.empty()) output = name + ".obj";
  check_writable(output);
  Mesh mesh = sample_shape(name, resolution);
  if (noise > 0) add_noise(mesh, noise);
  write_mesh(output, mesh);
  if (stderr_is_terminal()) {
    fmt::print(stderr, "{}: {}, {}\n", file_name(output),
               counted(mesh.faces.size(), "triangle", "triangles"),
               counted(mesh.positions.size(), "vertex", "vertices"));
  }
}

}  // namespace meshgrain::cli
