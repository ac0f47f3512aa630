#include "meshgrain/context.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <optional>

#include "meshgrain/error.h"

namespace meshgrain {

struct Context::Arena {
  explicit Arena(int threads) : arena(threads) {
    // More threads than cores are used only where oneTBB is told; it warns on stderr else.
    if (threads > tbb::info::default_concurrency()) {
      more_threads.emplace(tbb::global_control::max_allowed_parallelism,
                           static_cast<std::size_t>(threads));
    }
  }
  std::optional<tbb::global_control> more_threads;
  tbb::task_arena arena;
};

Context::Context(int threads)
    : threads_(threads > 0 ? threads : tbb::info::default_concurrency()),
      arena_(std::make_unique<Arena>(threads_)) {}

Context::~Context() = default;

void Context::check() const {
  if (cancelled_.load(std::memory_order_relaxed)) throw Cancelled();
}

void Context::progress(std::string_view stage, double fraction) const {
  check();
  if (on_progress) on_progress(stage, std::clamp(fraction, 0.0, 1.0));
}

void Context::for_ranges(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)>& body) const {
  if (count == 0) return check();
  const std::size_t ranges = (count + grain - 1) / grain;
  const auto run_range = [&](std::size_t r) {
    check();
    body(r * grain, std::min(count, (r + 1) * grain));
  };
  if (ranges == 1 || threads_ == 1) {
    for (std::size_t r = 0; r < ranges; ++r) run_range(r);
    return;
  }
  arena_->arena.execute([&] { tbb::parallel_for(std::size_t{0}, ranges, run_range); });
}

void Context::run(const std::function<void()>& body) const {
  arena_->arena.execute(body);
}

}  // namespace meshgrain
