#include "util/platform.h"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <random>
#include <system_error>

#if defined(__unix__) || defined(__APPLE__)
#define MESHGRAIN_POSIX
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace meshgrain::platform {
namespace {

[[noreturn]] void fail(int error) {
  throw std::system_error(error, std::generic_category());
}

std::string read_whole(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) fail(errno != 0 ? errno : EIO);
  std::string bytes(static_cast<std::size_t>(file.tellg()), '\0');
  file.seekg(0);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) fail(EIO);
  return bytes;
}

}  // namespace

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int large = 1 << 30;  // bytes
  ::mallopt(M_MMAP_THRESHOLD, large);
  ::mallopt(M_TRIM_THRESHOLD, large);
#endif
}

#ifdef MESHGRAIN_POSIX

MappedFile::MappedFile(const std::filesystem::path& path) {
  struct Descriptor {
    int value;
    ~Descriptor() {
      if (value >= 0) ::close(value);
    }
  };
  // Non-blocking, so that opening a pipe that nobody writes to returns and can be refused.
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (file.value < 0) fail(errno);
  struct stat status {};
  if (::fstat(file.value, &status) != 0) fail(errno);
  if (S_ISDIR(status.st_mode)) fail(EISDIR);
  if (!S_ISREG(status.st_mode)) fail(EINVAL);
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return;
  void* const data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.value, 0);
  if (data == MAP_FAILED) {  // some network and virtual file systems cannot map
    copy_ = read_whole(path);
    bytes_ = copy_;
    return;
  }
  ::madvise(data, size, MADV_SEQUENTIAL);
  bytes_ = {static_cast<const char*>(data), size};
  mapped_ = true;
}

MappedFile::~MappedFile() {
  if (mapped_) ::munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

void MappedFile::release_before(std::size_t offset) {
  constexpr std::size_t step = std::size_t{16} << 20;  // a multiple of every page size
  offset = offset / step * step;
  if (!mapped_ || offset <= released_) return;
  ::madvise(const_cast<char*>(bytes_.data()) + released_, offset - released_, MADV_DONTNEED);
  released_ = offset;
}

std::size_t peak_memory() {
  struct rusage usage {};
  if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
  return static_cast<std::size_t>(usage.ru_maxrss);
#else
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
#endif
}

bool stdout_is_terminal() {
  return ::isatty(STDOUT_FILENO) != 0;
}
bool stderr_is_terminal() {
  return ::isatty(STDERR_FILENO) != 0;
}

int terminal_width() {
  struct winsize size {};
  for (const int file : {STDOUT_FILENO, STDERR_FILENO}) {
    if (::ioctl(file, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  }
  return 80;
}

#else

MappedFile::MappedFile(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) fail(EISDIR);
  copy_ = read_whole(path);
  bytes_ = copy_;
}

MappedFile::~MappedFile() = default;
void MappedFile::release_before(std::size_t) {}
std::size_t peak_memory() {
  return 0;
}
bool stdout_is_terminal() {
  return false;
}
bool stderr_is_terminal() {
  return false;
}
int terminal_width() {
  return 80;
}

#endif

namespace {

void (*interrupt_handler)(int) = nullptr;

void handle_interrupt(int number) {
  std::signal(number, SIG_DFL);
  if (interrupt_handler != nullptr) interrupt_handler(number);
}

}  // namespace

void on_interrupt(void (*handler)(int signal)) {
  if (handler != nullptr) interrupt_handler = handler;
  for (const int number : {SIGINT, SIGTERM}) {
    const auto before = std::signal(number, handler != nullptr ? handle_interrupt : SIG_DFL);
    if (before == SIG_IGN) std::signal(number, SIG_IGN);
  }
}

bool is_stream(const std::filesystem::path& path) {
#ifdef MESHGRAIN_POSIX
  // They may lead to a file that others write to, too, and that must not be replaced.
  const std::string& name = path.native();
  if (name == "/dev/stdout" || name == "/dev/stderr" || name.starts_with("/dev/fd/")) return true;
#endif
  std::error_code ignored;
  return is_other(path, ignored);
}

// The standard demands what POSIX does: an existing file is replaced in one step.
void replace_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::filesystem::rename(from, to);
}

std::filesystem::path temporary_beside(const std::filesystem::path& path) {
  static const std::uint32_t process = std::random_device()();
  static std::atomic<unsigned long> count{0};
  return path.parent_path() / fmt::format(".meshgrain-{:08x}-{}.tmp", process, count++);
}

std::filesystem::path make_file_beside(const std::filesystem::path& path) {
  for (;;) {
    std::filesystem::path made = temporary_beside(path);
    errno = 0;
    if (std::FILE* const file = std::fopen(made.string().c_str(), "wbx")) {
      std::fclose(file);
      return made;
    }
    if (errno != EEXIST) fail(errno != 0 ? errno : EIO);
  }
}

}  // namespace meshgrain::platform
