#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/input.h"

namespace meshgrain::io {

/// Whether two words are the same, but for capital letters.
bool is_same_word(std::string_view a, std::string_view b);

/// A cursor over the text of a file, whose lines may end in LF, CR LF or CR alone. Everything else
/// up to the space character separates words, and so does a backslash at the end of a line, which
/// continues it. A `#` where a word would begin starts a comment.
class Text {
 public:
  /// From the beginning of the file, without a byte order mark.
  explicit Text(const Input& input);

  /// A cursor over some of the lines of the same file.
  Text part(const char* begin, const char* end) const {
    Text result(*this);
    result.at_ = begin;
    result.end_ = end;
    return result;
  }
  /// The beginning of the first line, not one that is continued, that lies so many bytes or more
  /// after `from`; or the end.
  const char* line_after(const char* from, std::size_t bytes) const;

  const char* at() const { return at_; }
  bool at_end() const { return at_ == end_; }
  char peek() const { return *at_; }
  char newline() const { return newline_; }
  void advance(std::size_t count) { at_ += count; }

  /// Moves to the next word of the line; true if there is none.
  bool line_ends() {
    skip_blanks();
    return at_ == end_ || *at_ == newline_ || *at_ == '#';
  }
  /// Moves to the next word of the file; true if there is none.
  bool file_ends() {
    while (line_ends()) {
      if (at_ == end_) return true;
      next_line();
    }
    return false;
  }
  /// Moves to the beginning of the next line. A line that continues this one counts as the next.
  void next_line();

  /// Whether the word here is `name`, up to its end.
  bool word_is(std::string_view name) const;
  /// The same, whether in capital letters or small ones.
  bool word_is_in_any_case(std::string_view name) const;
  /// Reads the word here; empty if the line ends.
  std::string_view word();
  /// Reads the rest of the line, without the space around it and up to a comment.
  std::string_view rest_of_line();

  /// Reads a number that single precision can hold. Throws Error, which says that `what` was
  /// expected, if the line ends, or if the next word is no number or one that is not finite.
  double number(const char* what);
  /// The same across lines; the error says that the file ends within `item` if it does.
  double number(const Item& item, const char* what);
  /// The same, but NaN instead of a number that is not finite.
  double number_or_nan(const char* what);
  double number_or_nan(const Item& item, const char* what);
  /// Reads a number if there is one; else stays put and returns false.
  bool try_number(double& value);
  /// Reads a whole number that is not negative.
  std::uint64_t count(const char* what);

  /// Throws Error, naming the line of the cursor or of `at`.
  [[noreturn]] void fail(std::string_view what) const { fail(at_, what); }
  [[noreturn]] void fail(const char* at, std::string_view what) const {
    input_.fail_at_line(at, newline_, what);
  }

 private:
  enum class Parsed { number, no_number, not_finite };
  Parsed parse(double& value, const char*& after) const;

  bool is_blank(char c) const { return static_cast<unsigned char>(c) <= ' ' && c != newline_; }
  bool is_continuation(const char* p) const {
    return *p == '\\' && (p + 1 == end_ || p[1] == newline_ ||
                          (p[1] == '\r' && p + 2 != end_ && p[2] == newline_));
  }
  bool ends_word(const char* p) const {
    return p == end_ || static_cast<unsigned char>(*p) <= ' ' || is_continuation(p);
  }
  void skip_blanks() {
    while (at_ != end_) {
      if (is_blank(*at_)) {
        ++at_;
      } else if (is_continuation(at_)) {
        next_line();
      } else {
        break;
      }
    }
  }

  const Input& input_;
  const char* at_;
  const char* end_;
  char newline_;
};

}  // namespace meshgrain::io
