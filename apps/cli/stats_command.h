#pragma once

namespace meshgrain::cli {

/// `meshgrain stats MESH`: figures of a mesh, on stdout.
void stats_command(int argc, char** argv);

}  // namespace meshgrain::cli
