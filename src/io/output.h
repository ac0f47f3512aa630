#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

namespace meshgrain::io {

/// A file that is being written: it appears under its name on commit(), whole, and else not at all.
/// Where the name is a link, what it leads to is replaced; devices and pipes are written to at
/// once.
class Output {
 public:
  /// Throws Error if the folder is missing or nothing can be created in it.
  explicit Output(const std::filesystem::path& path);
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  void write(std::string_view text) {
    buffer_.append(text);
    flush_if_full();
  }
  /// Numbers appear with as few digits as give them back exactly.
  template <class... Args>
  void print(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<Args>(args)...);
    flush_if_full();
  }
  /// Writes the bytes of a number, lowest first.
  template <class T>
  void put(T value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes.begin(), bytes.end());
    buffer_.append(bytes.data(), bytes.data() + bytes.size());
    flush_if_full();
  }

  /// Gives the file its name. Throws Error if it could not be written.
  void commit();

  [[noreturn]] void fail(std::string_view what) const;

 private:
  void flush_if_full() {
    if (buffer_.size() >= (std::size_t{1} << 20)) flush();
  }
  void flush();
  [[noreturn]] void fail_with_system_error() const;

  std::filesystem::path path_;
  std::filesystem::path target_;     // where path_ leads to
  std::filesystem::path temporary_;  // empty if the target is written to at once
  std::ofstream file_;
  fmt::memory_buffer buffer_;
};

}  // namespace meshgrain::io
