#include "progress_bar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "meshgrain/system.h"

namespace meshgrain::cli {

ProgressBar::ProgressBar(bool wanted)
    : active_(wanted && stderr_is_terminal()), width_(terminal_width()) {}

void ProgressBar::show(std::string_view stage, double fraction) {
  if (!active_) return;
  // Often enough to look alive, seldom enough to cost nothing.
  constexpr auto interval = std::chrono::milliseconds(50);
  const auto now = std::chrono::steady_clock::now();
  if (drawn_ && stage == stage_ && now - last_ < interval) return;
  last_ = now;
  stage_ = stage;
  constexpr int name_width = 18, percent_width = 6;
  const int bar = std::clamp(width_ - name_width - percent_width - 4, 0, 40);
  const int filled = static_cast<int>(fraction * bar);
  fmt::print(stderr, "\r{:<{}} [{:=<{}}{: <{}}] {:3.0f} %\x1b[K", stage, name_width, "", filled, "",
             bar - filled, 100 * fraction);
  std::fflush(stderr);
  drawn_ = true;
}

void ProgressBar::clear() {
  if (!drawn_) return;
  fmt::print(stderr, "\r\x1b[K");
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace meshgrain::cli
