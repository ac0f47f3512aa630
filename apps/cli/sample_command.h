#pragma once

namespace meshgrain::cli {

/// `meshgrain sample NAME`: writes a made shape, or lists their names.
void sample_command(int argc, char** argv);

}  // namespace meshgrain::cli
