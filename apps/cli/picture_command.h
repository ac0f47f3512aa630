#pragma once

namespace meshgrain::cli {

/// `meshgrain picture MESH FILE.png`: draws a mesh.
void picture_command(int argc, char** argv);

}  // namespace meshgrain::cli
