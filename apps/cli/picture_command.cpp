#include "picture_command.h"

#include <filesystem>
#include <string>
#include <vector>

#include "arguments.h"
#include "meshgrain/io.h"
#include "meshgrain/picture.h"

namespace meshgrain::cli {

void picture_command(int argc, char** argv) {
  std::string input, output;
  std::vector<int> size;
  std::vector<float> view, up;
  bool no_edges = false, no_dots = false;
  PictureOptions options;
  CLI::App app(
      "Draws a mesh with its edges; irregular vertices as red (fewer neighbours than\n"
      "regular) and blue (more) dots, borders as red lines. Or the points of a cloud.",
      "meshgrain picture");
  app.add_option("MESH", input, "the mesh or point cloud")->required();
  app.add_option("FILE.png", output, "the picture to write")->required();
  app.add_option("--size", size, "width and height in pixels, or one for both (1200)")
      ->expected(1, 2)
      ->type_name("PIXELS");
  app.add_option("--view", view, "from where to look (1 0.6 1.4)")->expected(3)->type_name("X Y Z");
  app.add_option("--up", up, "what is up (0 1 0)")->expected(3)->type_name("X Y Z");
  app.add_option("--zoom", options.zoom, "1 shows all of it, 2 the middle half")->type_name("Z");
  app.add_flag("--no-edges", no_edges, "the surface alone");
  app.add_flag("--no-dots", no_dots, "do not mark what is irregular");
  if (!parse(app, argc, argv)) return;

  if (!size.empty()) {
    options.width = size.front();
    options.height = size.back();
  }
  if (!view.empty()) options.view = Eigen::Vector3f(view.data());
  if (!up.empty()) options.up = Eigen::Vector3f(up.data());
  options.edges = !no_edges;
  options.irregular = !no_dots;
  if (CLI::detail::to_lower(std::filesystem::path(output).extension().string()) != ".png") {
    throw UsageError("pictures are written as PNG: \"" + output + "\" does not end in .png");
  }
  check_place(output);
  Context context;
  interruptible(context, [&] {
    const Mesh mesh = read_mesh(input, {}, context);
    write_png(output, draw_picture(mesh, options, context));
  });
}

}  // namespace meshgrain::cli
