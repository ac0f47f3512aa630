#include "io/ply_header.h"

#include <algorithm>
#include <utility>

namespace meshgrain::io::ply {
namespace {

constexpr std::pair<std::string_view, Type> type_names[] = {
    {"char", Type::i8},   {"int8", Type::i8},     {"uchar", Type::u8},   {"uint8", Type::u8},
    {"short", Type::i16}, {"int16", Type::i16},   {"ushort", Type::u16}, {"uint16", Type::u16},
    {"int", Type::i32},   {"int32", Type::i32},   {"uint", Type::u32},   {"uint32", Type::u32},
    {"float", Type::f32}, {"float32", Type::f32}, {"double", Type::f64}, {"float64", Type::f64},
};

Type read_type(Text& text) {
  if (text.line_ends()) text.fail("expected a type, found the end of the line");
  const char* const at = text.at();
  const std::string_view word = text.word();
  for (const auto& [name, type] : type_names) {
    if (word == name) return type;
  }
  text.fail(at, "unknown type " + in_quotes(word));
}

std::string_view read_name(Text& text) {
  if (text.line_ends()) text.fail("expected a name, found the end of the line");
  return text.word();
}

Encoding read_encoding(Text& text) {
  text.line_ends();
  const char* const at = text.at();
  const std::string_view word = text.word();
  if (word == "ascii") return Encoding::text;
  if (word == "binary_little_endian") return Encoding::little_endian;
  if (word == "binary_big_endian") return Encoding::big_endian;
  text.fail(at, "unknown format " + in_quotes(word));
}

}  // namespace

const Element* Header::find(std::string_view name) const {
  const auto found = std::find_if(elements.begin(), elements.end(),
                                  [&](const Element& element) { return element.name == name; });
  return found == elements.end() ? nullptr : &*found;
}

Header read_header(Text& text) {
  Header header;
  bool has_format = false;
  if (!text.word_is("ply")) text.fail("expected \"ply\" at the beginning of the file");
  for (text.next_line();; text.next_line()) {
    if (text.at_end()) text.fail("the file ends within its header: there is no \"end_header\"");
    if (text.line_ends()) continue;
    const char* const at = text.at();
    const std::string_view word = text.word();
    if (word == "format") {
      header.encoding = read_encoding(text);
      has_format = true;
    } else if (word == "obj_info") {
      const std::string_view name = text.word();
      if (name == "num_cols") header.columns = text.count("the number of columns");
      if (name == "num_rows") header.rows = text.count("the number of rows");
    } else if (word == "element") {
      const std::string_view name = read_name(text);
      const std::uint64_t count = text.count("the number of elements");
      if (header.find(name)) text.fail(at, "there is already an element " + in_quotes(name));
      header.elements.push_back({name, count, {}, at});
    } else if (word == "property") {
      if (header.elements.empty()) text.fail(at, "a property must follow an element");
      std::optional<Type> count_type;
      text.line_ends();
      if (text.word_is("list")) {
        text.word();
        count_type = read_type(text);
      }
      const Type type = read_type(text);
      header.elements.back().properties.push_back({read_name(text), type, count_type});
    } else if (word == "end_header") {
      break;
    } else if (word == "comment") {
      header.comments.push_back(text.rest_of_line());
    } else {
      text.fail(at, "unknown header line " + in_quotes(word));
    }
  }
  if (!has_format) text.fail("the header names no format");
  text.next_line();
  return header;
}

}  // namespace meshgrain::io::ply
