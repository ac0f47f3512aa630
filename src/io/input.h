#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "meshgrain/context.h"
#include "meshgrain/io.h"
#include "util/platform.h"

namespace meshgrain::io {

/// `path` as it is shown in messages: without control characters, so that they stay one line.
std::string display_name(const std::filesystem::path& path);

/// `text` out of a file, shortened and in quotes, as it is shown in messages.
std::string in_quotes(std::string_view text);

/// The item that is being read, for messages: "vertex 85 of 35947".
struct Item {
  const char* kind;
  std::uint64_t index;  // from 0
  std::uint64_t count;
  std::string text() const;
};

/// What is wrong with a face that names vertex `index`.
std::string out_of_range(std::string_view index, std::uint64_t vertices);

/// How many items to make room for: as many as the file says, but no more than its remaining
/// `bytes` can hold. A false count then ends with the file, not with the memory.
std::size_t plausible(std::uint64_t count, std::size_t bytes, std::size_t bytes_each);

/// A file that is being read: its bytes, what the caller asked for, and errors that name a place.
class Input {
 public:
  /// Throws Error if the file is missing, not a regular file or empty. Its progress is reported as
  /// that from `progress_from` to `progress_to` of the whole work.
  Input(const std::filesystem::path& path, const ReadOptions& options, const Context& context,
        double progress_from = 0, double progress_to = 1);

  const std::filesystem::path& path() const { return path_; }
  const ReadOptions& options() const { return options_; }
  const Context& context() const { return context_; }
  std::string_view bytes() const { return file_.bytes(); }
  const char* begin() const { return bytes().data(); }
  const char* end() const { return begin() + bytes().size(); }

  /// To be called now and then: reports progress, checks for cancellation, and lets go of the
  /// memory of what was read.
  void progress(const char* at) const;

  /// These throw Error.
  [[noreturn]] void fail(std::string_view what) const;
  [[noreturn]] void fail_at_byte(const char* at, std::string_view what) const;
  [[noreturn]] void fail_at_line(const char* at, char newline, std::string_view what) const;

 private:
  const std::filesystem::path& path_;
  const ReadOptions& options_;
  const Context& context_;
  double progress_from_;
  double progress_to_;
  mutable platform::MappedFile file_;
};

}  // namespace meshgrain::io
