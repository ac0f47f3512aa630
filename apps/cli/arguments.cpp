#include "arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "meshgrain/error.h"
#include "meshgrain/system.h"

namespace meshgrain::cli {

bool parse(CLI::App& app, int argc, char** argv) {
  app.get_formatter()->column_width(34);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    return false;
  } catch (const CLI::CallForVersion& call) {
    fmt::print("{}\n", call.what());
    return false;
  } catch (const CLI::ParseError& error) {
    std::string text = error.what();
    std::replace(text.begin(), text.end(), '\n', ' ');
    throw UsageError(text + " (--help lists the options)");
  }
  return true;
}

std::string with_commas(std::size_t number) {
  std::string digits = std::to_string(number);
  for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, 1, ',');
  return digits;
}

std::string counted(std::size_t number, const char* one, const char* many) {
  return fmt::format("{} {}", with_commas(number), number == 1 ? one : many);
}

std::string file_name(const std::string& path) {
  std::string name = std::filesystem::path(path).filename().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 127; }, '?');
  return name;
}

void interruptible(Context& context, const std::function<void()>& body) {
  const CancelOnInterrupt guard(context);
  try {
    body();
  } catch (const Cancelled&) {
    throw Interrupted{guard.signal()};
  }
}

}  // namespace meshgrain::cli
