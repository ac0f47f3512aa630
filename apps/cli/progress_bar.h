#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace meshgrain::cli {

/// A line on stderr, drawn over and over: the stage's name and how much of it is done. Nothing
/// unless stderr is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(bool wanted);
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(std::string_view stage, double fraction);

  /// Takes the line away again.
  void clear();

 private:
  bool active_;
  bool drawn_ = false;
  int width_ = 80;
  std::string stage_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace meshgrain::cli
