#pragma once

namespace meshgrain::cli {

/// `meshgrain INPUT -o OUTPUT`.
void remesh_command(int argc, char** argv);

}  // namespace meshgrain::cli
