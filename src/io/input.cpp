#include "io/input.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "meshgrain/error.h"

namespace meshgrain::io {
namespace {

platform::MappedFile open(const std::filesystem::path& path) {
  const std::string name = display_name(path);
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw Error(name + ": there is no such file");
  }
  if (is_directory(status)) throw Error(name + ": is a folder, not a file");
  if (exists(status) && !is_regular_file(status)) throw Error(name + ": is not a regular file");
  try {
    return platform::MappedFile(path);
  } catch (const std::system_error& error) {
    throw Error(fmt::format("{}: cannot be read: {}", name, error.code().message()));
  }
}

}  // namespace

std::string display_name(const std::filesystem::path& path) {
  const std::u8string bytes = path.u8string();
  std::string name(bytes.begin(), bytes.end());
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 127; }, '?');
  return name;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 24;
  std::string shown(text.substr(0, longest));
  std::replace_if(
      shown.begin(), shown.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return fmt::format("\"{}{}\"", shown, text.size() > longest ? "..." : "");
}

std::string Item::text() const {
  return fmt::format("{} {} of {}", kind, index + 1, count);
}

std::string out_of_range(std::string_view index, std::uint64_t vertices) {
  return fmt::format("vertex index {} is out of range: the file holds {} vertices", index,
                     vertices);
}

std::size_t plausible(std::uint64_t count, std::size_t bytes, std::size_t bytes_each) {
  return static_cast<std::size_t>(std::min<std::uint64_t>(count, bytes / bytes_each + 1));
}

Input::Input(const std::filesystem::path& path, const ReadOptions& options, const Context& context,
             double progress_from, double progress_to)
    : path_(path),
      options_(options),
      context_(context),
      progress_from_(progress_from),
      progress_to_(progress_to),
      file_(open(path)) {
  if (bytes().empty()) fail("the file is empty");
}

void Input::progress(const char* at) const {
  const auto offset = static_cast<std::size_t>(at - begin());
  const double share = static_cast<double>(offset) / static_cast<double>(bytes().size());
  context_.progress("read", progress_from_ + share * (progress_to_ - progress_from_));
  file_.release_before(offset);
}

void Input::fail(std::string_view what) const {
  throw Error(fmt::format("{}: {}", display_name(path_), what));
}

void Input::fail_at_byte(const char* at, std::string_view what) const {
  fail(fmt::format("byte {}: {}", at - begin(), what));
}

void Input::fail_at_line(const char* at, char newline, std::string_view what) const {
  // The end of the file counts as the end of its last line.
  if (at == end() && at[-1] == newline) --at;
  fail(fmt::format("line {}: {}", 1 + std::count(begin(), at, newline), what));
}

}  // namespace meshgrain::io
