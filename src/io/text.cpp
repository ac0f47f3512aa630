#include "io/text.h"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace meshgrain::io {
namespace {

/// The first line decides how lines end: what follows it may be binary.
char find_newline(std::string_view bytes) {
  const std::size_t first = bytes.find_first_of("\r\n");
  if (first == bytes.npos || bytes[first] == '\n') return '\n';
  return first + 1 < bytes.size() && bytes[first + 1] == '\n' ? '\n' : '\r';
}

}  // namespace

bool is_same_word(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::ranges::equal(a, b, {}, small, small);
}

Text::Text(const Input& input)
    : input_(input), at_(input.begin()), end_(input.end()), newline_(find_newline(input.bytes())) {
  if (input.bytes().starts_with("\xef\xbb\xbf")) at_ += 3;
}

void Text::next_line() {
  const void* const found = std::memchr(at_, newline_, static_cast<std::size_t>(end_ - at_));
  at_ = found ? static_cast<const char*>(found) + 1 : end_;
}

const char* Text::line_after(const char* from, std::size_t bytes) const {
  Text cursor = part(from, end_);
  cursor.at_ += std::min(bytes, static_cast<std::size_t>(end_ - from));
  while (cursor.at_ != end_) {
    cursor.next_line();
    const char* last = cursor.at_ - 1;  // the end of the line before
    if (*last == newline_ && last != from && last[-1] == '\r') --last;
    if (last == from || last[-1] != '\\') break;
  }
  return cursor.at_;
}

bool Text::word_is(std::string_view name) const {
  return std::string_view(at_, end_).starts_with(name) && ends_word(at_ + name.size());
}

bool Text::word_is_in_any_case(std::string_view name) const {
  const std::string_view here = std::string_view(at_, end_).substr(0, name.size());
  return is_same_word(here, name) && ends_word(at_ + name.size());
}

std::string_view Text::word() {
  if (line_ends()) return {};
  const char* const begin = at_;
  while (!ends_word(at_)) ++at_;
  return {begin, at_};
}

std::string_view Text::rest_of_line() {
  if (line_ends()) return {};
  const char* const begin = at_;
  const char* last = at_;  // behind the last character that is not blank
  for (; at_ != end_ && *at_ != newline_; ++at_) {
    if (*at_ == '#' && last != at_) break;  // names may have it within
    if (!is_blank(*at_)) last = at_ + 1;
  }
  return {begin, last};
}

Text::Parsed Text::parse(double& value, const char*& after) const {
  const char* begin = at_;
  if (*begin == '+' && begin + 1 != end_ && begin[1] != '-') ++begin;
  const auto result = fast_float::from_chars(begin, end_, value);
  if (result.ec == std::errc::invalid_argument || !ends_word(result.ptr)) return Parsed::no_number;
  if (!(std::abs(value) <= std::numeric_limits<float>::max())) return Parsed::not_finite;
  after = result.ptr;
  return Parsed::number;
}

double Text::number(const char* what) {
  if (line_ends()) {
    fail(fmt::format("expected {}, found the end of the {}", what, at_ == end_ ? "file" : "line"));
  }
  double value = 0;
  const Parsed parsed = parse(value, at_);
  if (parsed == Parsed::number) return value;
  const char* const at = at_;
  const std::string found = in_quotes(word());
  fail(at, parsed == Parsed::no_number
               ? fmt::format("expected {}, found {}", what, found)
               : fmt::format("expected {}, found {}, which is not finite in single precision", what,
                             found));
}

double Text::number(const Item& item, const char* what) {
  if (file_ends()) fail("the file ends within " + item.text());
  return number(what);
}

double Text::number_or_nan(const char* what) {
  double value = 0;
  const char* after = nullptr;
  if (line_ends() || parse(value, after) != Parsed::not_finite) return number(what);
  word();
  return std::numeric_limits<double>::quiet_NaN();
}

double Text::number_or_nan(const Item& item, const char* what) {
  if (file_ends()) fail("the file ends within " + item.text());
  return number_or_nan(what);
}

bool Text::try_number(double& value) {
  return !line_ends() && parse(value, at_) == Parsed::number;
}

std::uint64_t Text::count(const char* what) {
  const bool ended = line_ends();
  const char* const at = at_;
  const std::string_view digits = word();
  std::uint64_t value = 0;
  const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (ended || result.ec != std::errc() || result.ptr != digits.data() + digits.size()) {
    fail(at, fmt::format("expected {}, found {}", what,
                         ended ? "the end of the line" : in_quotes(digits)));
  }
  return value;
}

}  // namespace meshgrain::io
