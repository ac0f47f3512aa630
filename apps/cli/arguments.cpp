#include "arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "meshgrain/error.h"
#include "meshgrain/system.h"

namespace meshgrain::cli {
namespace {

/// Help in two columns, without what CLI11 says about types and ranges, which are in the texts.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_usage(const CLI::App* app, std::string) const override {
    std::string usage = "\nUsage: " + app->get_name();
    for (const CLI::Option* option : app->get_options()) {
      if (option->get_positional()) {
        usage += option->get_required() ? " " + option->get_name(true)
                                        : " [" + option->get_name(true) + "]";
      } else if (option->get_required()) {
        const std::string names = option->get_name(false, true);
        usage += " " + names.substr(0, names.find(',')) + " " + type(option);
      }
    }
    return usage + " [OPTIONS]\n\n";
  }

  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override {
    std::string text = group + ":\n";
    for (const CLI::Option* option : options) text += make_option(option, is_positional);
    return text;
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    constexpr std::size_t column = 32, width = 100;
    std::string text = "  " + option->get_name(is_positional, !is_positional);
    std::replace(text.begin(), text.end(), ',', ' ');
    if (!is_positional && !type(option).empty()) text += " " + type(option);
    text.append(text.size() + 1 < column ? column - text.size() : 1, ' ');
    std::size_t at = text.size();  // within the line
    if (at > column) {
      text += '\n' + std::string(column, ' ');
      at = column;
    }
    std::istringstream words(option->get_description());
    for (std::string word; words >> word;) {
      if (at + word.size() > width) {
        text.back() = '\n';
        text.append(column, ' ');
        at = column;
      }
      text += word + ' ';
      at += word.size() + 1;
    }
    text.back() = '\n';
    return text;
  }

  std::string make_positionals(const CLI::App* app) const override {
    const auto positionals =
        app->get_options([](const CLI::Option* option) { return option->get_positional(); });
    return positionals.empty() ? "" : make_group("Arguments", true, positionals) + '\n';
  }

  std::string make_footer(const CLI::App* app) const override {
    const std::string footer = app->get_footer();
    return footer.empty() ? "" : "\n" + footer + "\n";
  }

 private:
  /// Without what validators add to it.
  static std::string type(const CLI::Option* option) {
    const std::string name = option->get_type_name();
    return name.substr(0, name.find(':'));
  }
};

/// The last first, as CLI11 wants them; it would take -.5 for an option.
std::vector<std::string> reversed_arguments(int argc, char** argv) {
  std::vector<std::string> result;
  for (int i = argc - 1; i > 0; --i) {
    std::string argument = argv[i];
    const bool is_number = argument.size() > 2 && argument.starts_with("-.") &&
                           argument[2] >= '0' && argument[2] <= '9';
    if (is_number) argument.insert(1, "0");
    result.push_back(std::move(argument));
  }
  return result;
}

}  // namespace

bool parse(CLI::App& app, int argc, char** argv) {
  app.formatter(std::make_shared<HelpFormatter>());
  app.get_help_ptr()->description("show this text");
  try {
    app.parse(reversed_arguments(argc, argv));
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
