// Binary PLY, in memory that the system keeps of the file: what the disk takes is not in it.

#include <filesystem>

#include "inputs.h"
#include "meshgrain/io.h"
#include "util/platform.h"

namespace meshgrain::bench {
namespace {

/// A file of its own, removed at the end.
class TemporaryFile {
 public:
  TemporaryFile()
      : path_(platform::temporary_beside(std::filesystem::temp_directory_path() / "x")) {
    path_ += ".ply";
  }
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::size_t bytes() const { return std::filesystem::file_size(path_); }

 private:
  std::filesystem::path path_;
};

void read(benchmark::State& state) {
  const TemporaryFile file;
  write_mesh(file.path(), shape());
  const Context context(threads(state));
  for (auto _ : state) benchmark::DoNotOptimize(read_mesh(file.path(), {}, context));
  count(state, file.bytes() + bytes(shape()));
}

void write(benchmark::State& state) {
  const TemporaryFile file;
  const Mesh& mesh = shape();
  for (auto _ : state) write_mesh(file.path(), mesh);
  count(state, bytes(shape()) + file.bytes());
}

BENCHMARK(read)->Apply(with_threads);
BENCHMARK(write)->ArgName("threads")->Arg(1)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace meshgrain::bench
