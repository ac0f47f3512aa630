#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>

#include "io/input.h"
#include "io/ply_header.h"
#include "io/text.h"

/// What follows the header of a PLY file: numbers, in the order that it gives.
namespace meshgrain::io::ply {

/// The numbers of a text file, one after the other; line breaks mean nothing.
class TextBody {
 public:
  TextBody(const Input& input, Text& text) : input_(input), text_(text) {}

  static constexpr std::size_t least_bytes(Type) { return 2; }
  const char* at() const { return text_.at(); }
  std::size_t left() const { return static_cast<std::size_t>(input_.end() - at()); }

  double number(Type, const Item& item) {
    const double value = text_.number(item, "a number");
    last_ = text_.at();
    return value;
  }
  double number_or_nan(Type, const Item& item) { return text_.number_or_nan(item, "a number"); }
  void skip(Type, std::uint64_t count, const Item& item) {
    for (std::uint64_t i = 0; i < count; ++i) {
      if (text_.file_ends()) text_.fail("the file ends within " + item.text());
      text_.word();
    }
  }
  [[noreturn]] void fail_at_last(Type, const std::string& what) const { text_.fail(last_, what); }
  [[noreturn]] void fail_at_end(const Item& item) const {
    text_.fail(input_.end(), "the file ends within " + item.text());
  }

 private:
  const Input& input_;
  Text& text_;
  const char* last_ = nullptr;  // behind the last number
};

/// The numbers of a binary file.
template <std::endian order>
class BinaryBody {
 public:
  BinaryBody(const Input& input, const char* begin) : input_(input), at_(begin) {}

  static constexpr std::size_t least_bytes(Type type) { return size_of(type); }
  const char* at() const { return at_; }
  std::size_t left() const { return static_cast<std::size_t>(input_.end() - at_); }

  template <class T>
  T load(const char* at) const {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), at, sizeof(T));
    if constexpr (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }
  double number_or_nan(Type type, const Item& item) { return number(type, item); }
  double number(Type type, const Item& item) {
    if (left() < size_of(type)) fail_at_end(item);
    const char* const at = std::exchange(at_, at_ + size_of(type));
    switch (type) {
      case Type::i8:
        return load<std::int8_t>(at);
      case Type::u8:
        return load<std::uint8_t>(at);
      case Type::i16:
        return load<std::int16_t>(at);
      case Type::u16:
        return load<std::uint16_t>(at);
      case Type::i32:
        return load<std::int32_t>(at);
      case Type::u32:
        return load<std::uint32_t>(at);
      case Type::f32:
        return load<float>(at);
      case Type::f64:
        break;
    }
    return load<double>(at);
  }
  void skip(Type type, std::uint64_t count, const Item& item) {
    if (count > left() / size_of(type)) fail_at_end(item);
    at_ += count * size_of(type);
  }
  void advance(std::size_t bytes) { at_ += bytes; }
  [[noreturn]] void fail_at_last(Type type, const std::string& what) const {
    input_.fail_at_byte(at_ - size_of(type), what);
  }
  [[noreturn]] void fail_at_end(const Item& item) const {
    input_.fail_at_byte(input_.end(), "the file ends within " + item.text());
  }

 private:
  const Input& input_;
  const char* at_;
};

}  // namespace meshgrain::io::ply
