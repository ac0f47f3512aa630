#include "io/output.h"

#include <cerrno>
#include <system_error>

#include "io/input.h"
#include "meshgrain/error.h"
#include "util/platform.h"

namespace meshgrain::io {

Output::Output(const std::filesystem::path& path) : path_(path), target_(path) {
  std::error_code ignored;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!is_directory(folder, ignored)) {
    fail(fmt::format("the folder \"{}\" does not exist", display_name(folder)));
  }
  if (is_directory(path, ignored)) fail("is a folder, not a file");
  if (!platform::is_stream(path)) {
    if (is_symlink(path, ignored)) {
      std::error_code problem;
      target_ = weakly_canonical(path, problem);
      if (problem) fail("cannot be written: " + problem.message());
    }
    try {
      temporary_ = platform::make_file_beside(target_);
    } catch (const std::system_error& error) {
      fail("cannot be written: " + error.code().message());
    }
  }
  errno = 0;
  if (temporary_.empty()) {
    file_.open(target_, std::ios::binary | std::ios::app);  // others may write there, too
  } else {
    file_.open(temporary_, std::ios::binary | std::ios::trunc);
  }
  if (!file_) fail_with_system_error();
}

Output::~Output() {
  file_.close();
  if (temporary_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);  // there is none any more after commit()
}

void Output::flush() {
  errno = 0;
  if (!file_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()))) {
    fail_with_system_error();
  }
  buffer_.clear();
}

void Output::commit() {
  flush();
  file_.close();
  if (!file_) fail_with_system_error();
  if (temporary_.empty()) return;
  try {
    platform::replace_file(temporary_, target_);
  } catch (const std::filesystem::filesystem_error& error) {
    fail("cannot be written: " + error.code().message());
  }
}

void Output::fail(std::string_view what) const {
  throw Error(fmt::format("{}: {}", display_name(path_), what));
}

void Output::fail_with_system_error() const {
  const int error = errno != 0 ? errno : EIO;
  fail("cannot be written: " + std::generic_category().message(error));
}

}  // namespace meshgrain::io
