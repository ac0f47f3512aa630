#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

/// All that differs between operating systems, and nothing else.
namespace meshgrain::platform {

/// The bytes of a file, mapped into memory where the system can, else read into it. They stay valid
/// as long as the object lives.
class MappedFile {
 public:
  /// Throws std::system_error if the file cannot be opened or is not a regular file.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return bytes_; }

  /// Hints that the bytes before `offset` were consumed, so that they need not stay in memory. They
  /// can still be read.
  void release_before(std::size_t offset);

 private:
  std::string_view bytes_;
  std::string copy_;  // holds the bytes where mapping is not to be had
  std::size_t released_ = 0;
  bool mapped_ = false;
};

/// Keeps memory that is freed for what is allocated next, where the system's allocator would return
/// it: a program that takes one large array after the other waits long for new pages.
void keep_freed_memory();

/// The most memory in bytes that the process has had resident so far, or 0 if unknown.
std::size_t peak_memory();

bool stdout_is_terminal();
bool stderr_is_terminal();

/// Columns of the terminal, or 80 if there is none.
int terminal_width();

/// Calls `handler` with the signal's number when the user interrupts the program (Ctrl-C) or it is
/// asked to terminate: once, the second time the program ends. Null: the program ends the first
/// time. A signal that the program was started to ignore stays ignored. The handler must be safe in
/// signals.
void on_interrupt(void (*handler)(int signal));

/// Whether a path names no place for a file, but something that takes bytes as they come: a device,
/// a pipe, or one of the streams of a process.
bool is_stream(const std::filesystem::path& path);

/// Renames `from` to `to` in one step that replaces an existing file. Both must lie in one file
/// system. Throws std::filesystem::filesystem_error.
void replace_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// A path in the folder of `path` that nobody else is likely to choose.
std::filesystem::path temporary_beside(const std::filesystem::path& path);

/// Makes an empty file at such a path, where none was: for this caller alone, even if other
/// containers or machines write into the folder. Throws std::system_error.
std::filesystem::path make_file_beside(const std::filesystem::path& path);

}  // namespace meshgrain::platform
