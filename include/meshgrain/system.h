#pragma once

#include <cstddef>
#include <string_view>

#include "meshgrain/context.h"

namespace meshgrain {

/// The version of the library, as "0.1.0".
std::string_view version();

/// For a program that does nothing but to remesh, at its start: memory that is freed is kept for
/// what is allocated next, which saves up to a tenth of the time. Does nothing where the system has
/// no way to ask for it.
void keep_freed_memory();

/// The most memory in bytes that the process has had resident so far, or 0 if unknown.
std::size_t peak_memory();

bool stdout_is_terminal();
bool stderr_is_terminal();

/// Columns of the terminal, or 80 if there is none.
int terminal_width();

/// While it lives, the user's interruption (Ctrl-C, or the system's request to terminate) cancels
/// `context`; a second one ends the process at once. One at a time.
class CancelOnInterrupt {
 public:
  explicit CancelOnInterrupt(Context& context);
  ~CancelOnInterrupt();
  CancelOnInterrupt(const CancelOnInterrupt&) = delete;
  CancelOnInterrupt& operator=(const CancelOnInterrupt&) = delete;

  /// The number of the signal that arrived, or 0.
  int signal() const;
};

}  // namespace meshgrain
