#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "meshgrain/context.h"
#include "meshgrain/mesh.h"

namespace meshgrain {

struct PictureOptions {
  int width = 1200;
  int height = 1200;
  Eigen::Vector3f view{1.0f, 0.6f, 1.4f};  ///< From the surface's centre towards the eye.
  Eigen::Vector3f up{0.0f, 1.0f, 0.0f};
  float zoom = 1;  ///< 1 shows the whole surface.
  bool edges = true;
  bool irregular = true;  ///< Dots on irregular vertices, tints on odd faces.
};

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< width x height x 3, row after row from the top.
};

/// Draws a mesh with its edges, borders (red lines), irregular interior vertices (dots, red: fewer
/// neighbours than regular, blue: more) and tints on faces other than the regular kind; or the
/// points of a cloud. Seen from behind, faces are red. A small software rasteriser: orthographic,
/// z-buffered, antialiased. Edges and dots fade where they are too dense to be told apart. Throws
/// Error for options that make no sense.
Image draw_picture(const Mesh& mesh, const PictureOptions& options = {},
                   const Context& context = Context());

/// Writes the whole file or, throwing Error, none.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace meshgrain
