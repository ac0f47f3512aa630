#include "meshgrain/system.h"

#include <atomic>

#include "util/platform.h"

namespace meshgrain {
namespace {

// A signal's handler can reach nothing else. Both are lock-free, as a handler needs.
std::atomic<Context*> interrupted_context{nullptr};
std::atomic<int> interrupting_signal{0};
static_assert(std::atomic<Context*>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void interrupt(int signal) {
  interrupting_signal.store(signal);
  if (Context* const context = interrupted_context.load()) context->cancel();
}

}  // namespace

std::string_view version() {
  return MESHGRAIN_VERSION;
}

void keep_freed_memory() {
  platform::keep_freed_memory();
}
std::size_t peak_memory() {
  return platform::peak_memory();
}
bool stdout_is_terminal() {
  return platform::stdout_is_terminal();
}
bool stderr_is_terminal() {
  return platform::stderr_is_terminal();
}
int terminal_width() {
  return platform::terminal_width();
}

CancelOnInterrupt::CancelOnInterrupt(Context& context) {
  interrupted_context.store(&context);
  interrupting_signal.store(0);
  platform::on_interrupt(interrupt);
}

CancelOnInterrupt::~CancelOnInterrupt() {
  platform::on_interrupt(nullptr);
  interrupted_context.store(nullptr);
}

int CancelOnInterrupt::signal() const {
  return interrupting_signal.load();
}

}  // namespace meshgrain
