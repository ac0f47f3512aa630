#pragma once

#include <stdexcept>
#include <string>

namespace meshgrain {

/// The one exception of the library. The message says what is wrong, where (file, line or byte)
/// and, where it helps, what to do; it is one line without a final full stop.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown by a long call whose Context was cancelled.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace meshgrain
