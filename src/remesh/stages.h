#pragma once

#include <chrono>
#include <type_traits>

#include "meshgrain/remesh.h"

namespace meshgrain {

/// Runs the stages of a long call one after the other, each under its name and with its time taken.
class Stages {
 public:
  Stages(const Context& context, std::vector<StageTime>& times)
      : context_(context), times_(times) {}

  template <typename Body>
  auto operator()(const char* name, const Body& body) {
    context_.progress(name, 0);
    const auto start = std::chrono::steady_clock::now();
    const auto finish = [&] {
      const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
      times_.push_back({name, time.count()});
      context_.progress(name, 1);
    };
    if constexpr (std::is_void_v<decltype(body())>) {
      body();
      finish();
    } else {
      auto result = body();
      finish();
      return result;
    }
  }

 private:
  const Context& context_;
  std::vector<StageTime>& times_;
};

}  // namespace meshgrain
