#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string_view>

namespace meshgrain {

/// Carries the number of threads, progress and cancellation through every long call. Results never
/// depend on it: one thread and many give the same bytes.
class Context {
 public:
  /// `threads` = 0 takes all cores.
  explicit Context(int threads = 0);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  int threads() const { return threads_; }

  /// Called from the thread that runs the long call, with the name of the stage and the share of it
  /// that is done (0 to 1).
  std::function<void(std::string_view stage, double fraction)> on_progress;

  /// Asks the running call to stop: it throws Cancelled at its next check. Any thread may call
  /// this.
  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  void reset() { cancelled_.store(false, std::memory_order_relaxed); }

  /// Throws Cancelled if cancel() was called.
  void check() const;

  /// Reports progress, and checks for cancellation.
  void progress(std::string_view stage, double fraction) const;

  /// Runs `body(begin, end)` on ranges of at most `grain` items that cover [0, count), in parallel.
  /// The ranges are the same for any number of threads; the order in which they run is not.
  void for_ranges(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) const;

  /// Runs `body` where nested oneTBB algorithms use this context's threads.
  void run(const std::function<void()>& body) const;

 private:
  struct Arena;
  int threads_;
  std::atomic<bool> cancelled_{false};
  std::unique_ptr<Arena> arena_;
};

}  // namespace meshgrain
