#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "io/text.h"

/// The header of a PLY file: which elements and properties follow, and how their numbers are
/// stored.
namespace meshgrain::io::ply {

/// What a number is stored as.
enum class Type : std::uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

constexpr std::size_t size_of(Type type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

/// The largest number of a type of whole numbers; 1 of the others.
constexpr double largest_of(Type type) {
  constexpr double largest[] = {127, 255, 32767, 65535, 2147483647, 4294967295, 1, 1};
  return largest[static_cast<std::size_t>(type)];
}

struct Property {
  std::string_view name;
  Type type;
  std::optional<Type> count_type;  // of a list
};

struct Element {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
  const char* at = nullptr;  // its line in the header
};

enum class Encoding { text, little_endian, big_endian };

struct Header {
  Encoding encoding = Encoding::text;
  std::vector<Element> elements;
  std::vector<std::string_view> comments;
  std::uint64_t columns = 0, rows = 0;  // of a range_grid

  /// Null if there is none of that name.
  const Element* find(std::string_view name) const;
};

/// Reads the header and leaves `text` at the first byte of the data. Names point into the file.
Header read_header(Text& text);

}  // namespace meshgrain::io::ply
