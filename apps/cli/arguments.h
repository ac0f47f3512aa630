#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

#include "meshgrain/context.h"

/// What the commands have in common.
namespace meshgrain::cli {

/// A command line that contradicts itself: exit status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses what follows the name of a command. Returns false if that was all, as for --help. Throws
/// UsageError.
bool parse(CLI::App& app, int argc, char** argv);

/// 5000 as "5,000".
std::string with_commas(std::size_t number);

/// "1 quad", "5,000 quads".
std::string counted(std::size_t number, const char* one, const char* many);

/// Only the name of the file, without control characters.
std::string file_name(const std::string& path);

/// Ends the program without a result, because the user wants it so.
struct Interrupted {
  int signal;
};

/// Calls `body`, which works with `context`, so that a signal ends it: throws Interrupted.
void interruptible(Context& context, const std::function<void()>& body);

}  // namespace meshgrain::cli
