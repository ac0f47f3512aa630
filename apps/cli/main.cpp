// The command line: `meshgrain INPUT -o OUTPUT`, and a few commands besides.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>

#include "arguments.h"
#include "meshgrain/context.h"
#include "meshgrain/error.h"
#include "meshgrain/system.h"
#include "picture_command.h"
#include "remesh_command.h"
#include "sample_command.h"
#include "stats_command.h"

namespace {

using namespace meshgrain;

struct Command {
  std::string_view name;
  void (*run)(int argc, char** argv);
};

// A file of such a name is still an input: as ./stats, say.
constexpr Command commands[] = {
    {"picture", cli::picture_command},
    {"sample", cli::sample_command},
    {"stats", cli::stats_command},
};

void run(int argc, char** argv) {
  for (const Command& command : commands) {
    if (argc > 1 && argv[1] == command.name) return command.run(argc - 1, argv + 1);
  }
  cli::remesh_command(argc, argv);
}

int fail(int status, std::string message) {
  // One line, whatever a library put into it.
  std::replace(message.begin(), message.end(), '\n', ' ');
  fmt::print(stderr, "meshgrain: error: {}\n", message);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int failure = 1;
  constexpr int wrong_usage = 2;
#ifdef MESHGRAIN_AVX2
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("bmi2")) {
    return fail(failure,
                "this was built for processors with AVX2, which this one has not: build it with "
                "-DMESHGRAIN_AVX2=OFF");
  }
#endif
  keep_freed_memory();
  try {
    run(argc, argv);
    if (std::fflush(stdout) != 0) return fail(failure, "the output could not be written");
    return 0;
  } catch (const cli::Interrupted& interrupted) {
    fmt::print(stderr, "meshgrain: interrupted\n");
    return 128 + interrupted.signal;
  } catch (const cli::UsageError& error) {
    return fail(wrong_usage, error.what());
  } catch (const std::bad_alloc&) {
    return fail(failure, "there is not enough memory");
  } catch (const std::exception& error) {
    return fail(failure, error.what());
  }
}
