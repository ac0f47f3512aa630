// Stanford's Polygon File Format (PLY): text and both byte orders, any types and any order of
// elements and properties. Understood are the elements `vertex`, `face`, `edge`, `tristrips` and
// `range_grid`; others are skipped.

#include "io/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "io/coordinates.h"
#include "io/formats.h"
#include "io/paint.h"
#include "io/ply_body.h"
#include "io/ply_header.h"
#include "io/range_grid.h"
#include "io/text.h"

namespace meshgrain::io {
namespace {

using ply::BinaryBody;
using ply::Element;
using ply::Encoding;
using ply::Header;
using ply::Property;
using ply::TextBody;
using ply::Type;

/// Reads the elements in their order, from any kind of body.
template <class Body>
class Reader {
 public:
  /// `columns` get the numbers of the vertices under their names.
  Reader(const Input& input, const Text& text, const Header& header, std::span<ply::Column> columns,
         Body body)
      : input_(input), text_(text), header_(header), columns_(columns), body_(body) {}

  Mesh read() {
    const Element* const vertices = header_.find("vertex");
    if (!vertices) input_.fail("the header names no element \"vertex\"");
    vertices_ = vertices->count;
    if (vertices_ >= no_index) {
      text_.fail(vertices->at,
                 fmt::format("{} vertices are more than 32 bits can number", vertices_));
    }
    for (const Element& element : header_.elements) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (element.name == "edge") {
        read_edges(element);
      } else if (element.name == "tristrips") {
        read_strips(element);
      } else if (element.name == "range_grid") {
        read_grid(element);
      } else {
        skip(element);
      }
    }
    coordinates_.move_to(mesh_, input_);
    if (!grid_.empty()) triangulate_grid(grid_, header_.columns, mesh_);
    return std::move(mesh_);
  }

 private:
  void tick(std::uint64_t row) const {
    if (row % 65536 == 0) input_.progress(body_.at());
  }

  /// The fewest bytes that a row of `element` takes.
  std::size_t row_bytes(const Element& element) const {
    std::size_t bytes = 0;
    for (const Property& p : element.properties) {
      bytes += body_.least_bytes(p.count_type.value_or(p.type));
    }
    return std::max<std::size_t>(bytes, 1);
  }
  std::size_t plausible_rows(const Element& element) const {
    return plausible(element.count, body_.left(), row_bytes(element));
  }

  std::uint64_t list_size(const Property& property, const Item& item) {
    const double size = body_.number(*property.count_type, item);
    if (!(size >= 0 && size < no_index && size == std::floor(size))) {
      body_.fail_at_last(*property.count_type,
                         fmt::format("{} is no length of a list, in {}", size, item.text()));
    }
    return static_cast<std::uint64_t>(size);
  }

  void skip(const Property& property, const Item& item) {
    const std::uint64_t count = property.count_type ? list_size(property, item) : 1;
    body_.skip(property.type, count, item);
  }

  void skip(const Element& element) {
    if (element.properties.empty()) return;
    const std::string name = in_quotes(element.name);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      tick(row);
      const Item item{name.c_str(), row, element.count};
      for (const Property& property : element.properties) skip(property, item);
    }
  }

  void read_vertices(const Element& element) {
    // Each property goes to the place of its name; the last place takes what nobody wants.
    constexpr std::string_view names[] = {"x", "y", "z", "nx", "ny", "nz"};
    constexpr std::size_t unwanted = std::size(names);
    constexpr std::size_t no_column = ~std::size_t{0};
    std::vector<std::size_t> places;
    std::vector<std::size_t> column_of;  // each property's column, or no_column
    std::array<int, unwanted + 1> found{};
    for (const Property& property : element.properties) {
      std::size_t place = unwanted;
      std::size_t column = no_column;
      if (!property.count_type) {
        place = static_cast<std::size_t>(
            std::find(std::begin(names), std::end(names), property.name) - std::begin(names));
        for (std::size_t c = 0; c < columns_.size(); ++c) {
          if (columns_[c].name != property.name) continue;
          if (columns_[c].found) {
            text_.fail(element.at, "element vertex has two numbers " + in_quotes(property.name));
          }
          columns_[c].found = true;
          columns_[c].largest = ply::largest_of(property.type);
          column = c;
        }
      }
      places.push_back(place);
      column_of.push_back(column);
      ++found[place];
    }
    for (std::size_t place = 0; place < 3; ++place) {
      if (found[place] != 1) {
        text_.fail(element.at, fmt::format("element vertex must have one number \"{}\", has {}",
                                           names[place], found[place]));
      }
    }
    const bool normals = found[3] == 1 && found[4] == 1 && found[5] == 1;
    for (const ply::Column& column : columns_) {
      if (column.required && !column.found) {
        text_.fail(element.at, "element vertex has no number " + in_quotes(column.name));
      }
    }

    const bool any_column = std::ranges::any_of(columns_, &ply::Column::found);
    if (!any_column && read_plain_vertices(element, places, normals)) return;
    const std::size_t expected = plausible_rows(element);
    coordinates_.reserve(expected);
    if (normals) mesh_.normals.reserve(expected);
    for (ply::Column& column : columns_) {
      if (column.found) column.numbers.reserve(expected);
    }
    std::array<double, unwanted> row{};
    for (std::uint64_t v = 0; v < element.count; ++v) {
      tick(v);
      const Item item{"vertex", v, element.count};
      for (std::size_t p = 0; p < places.size(); ++p) {
        const Property& property = element.properties[p];
        if (places[p] == unwanted && column_of[p] == no_column) {
          skip(property, item);
          continue;
        }
        const bool of_normal = places[p] >= 3 && places[p] < unwanted && column_of[p] == no_column;
        const double number = of_normal ? body_.number_or_nan(property.type, item)
                                        : body_.number(property.type, item);
        if (!of_normal && !(std::abs(number) <= std::numeric_limits<float>::max())) {
          body_.fail_at_last(property.type,
                             fmt::format("{} is not finite in single precision, in {}",
                                         in_quotes(property.name), item.text()));
        }
        if (places[p] != unwanted) row[places[p]] = number;
        if (column_of[p] != no_column) columns_[column_of[p]].numbers.push_back(number);
      }
      coordinates_.push(row[0], row[1], row[2]);
      if (!normals) continue;
      const Vec3 normal = Eigen::Vector3d(&row[3]).cast<float>();
      mesh_.normals.push_back(normal.allFinite() ? normal : Vec3(Vec3::Zero()));
    }
  }

  /// Reads rows of numbers in single precision in a plain loop. Returns false, having read nothing,
  /// if there are other numbers among those at a place, or if one of them is not finite or all are
  /// so far from zero that they need an origin, so that the general way looks at each.
  bool read_plain_vertices(const Element& element, std::span<const std::size_t> places,
                           bool normals) {
    if constexpr (std::is_same_v<Body, TextBody>) {
      return false;
    } else {
      std::array<std::size_t, 6> offsets{};
      std::size_t bytes = 0;
      for (std::size_t p = 0; p < places.size(); ++p) {
        const Property& property = element.properties[p];
        if (property.count_type) return false;
        if (places[p] < offsets.size()) {
          if (property.type != Type::f32) return false;
          offsets[places[p]] = bytes;
        }
        bytes += size_of(property.type);
      }
      if (element.count > body_.left() / bytes) return false;
      const auto vector_at = [&](const char* row, std::size_t place) {
        return Vec3(body_.template load<float>(row + offsets[place]),
                    body_.template load<float>(row + offsets[place + 1]),
                    body_.template load<float>(row + offsets[place + 2]));
      };
      const char* const begin = body_.at();
      std::vector<Vec3> positions(element.count), directions(normals ? element.count : 0);
      std::atomic<bool> all_finite{true};
      for_rows(element.count, bytes, [&](std::size_t first, std::size_t last) {
        bool finite = true;
        for (std::size_t v = first; v < last; ++v) {
          positions[v] = vector_at(begin + bytes * v, 0);
          finite &= positions[v].allFinite();
          if (!normals) continue;
          directions[v] = vector_at(begin + bytes * v, 3);
          finite &= directions[v].allFinite();
        }
        if (!finite) all_finite = false;
      });
      if (!all_finite || !coordinates_.take_if_near(positions, input_.context())) return false;
      body_.advance(bytes * element.count);
      mesh_.normals = std::move(directions);
      return true;
    }
  }

  /// Calls `read(first, last)` for ranges of rows of the same size, in parallel.
  template <typename Read>
  void for_rows(std::size_t rows, std::size_t bytes, const Read& read) {
    constexpr std::size_t grain = 1 << 14, block = std::size_t{64} * grain;
    for (std::size_t first = 0; first < rows; first += block) {
      input_.progress(body_.at() + bytes * first);
      const std::size_t count = std::min(block, rows - first);
      input_.context().for_ranges(count, grain, [&](std::size_t begin, std::size_t end) {
        read(first + begin, first + end);
      });
    }
  }

  /// Reads each row's list of vertices from row `first` on, and calls `use` with it.
  template <class Use>
  void for_each_list(const Element& element, std::uint64_t first, bool restarts, const Use& use) {
    const auto is_wanted = [](const Property& p) {
      return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    const auto& properties = element.properties;
    if (element.count > 0 && std::count_if(properties.begin(), properties.end(), is_wanted) != 1) {
      text_.fail(element.at,
                 fmt::format("element {} must have one list \"vertex_indices\"", element.name));
    }
    const std::string name(element.name);
    std::vector<Index> list;
    for (std::uint64_t row = first; row < element.count; ++row) {
      tick(row);
      const Item item{name.c_str(), row, element.count};
      for (const Property& property : properties) {
        if (is_wanted(property)) {
          read_list(property, item, restarts, list);
          use(list);
        } else {
          skip(property, item);
        }
      }
    }
  }

  /// Reads indices; no_index stands for -1, which is allowed where `restarts`.
  void read_list(const Property& property, const Item& item, bool restarts,
                 std::vector<Index>& list) {
    const std::uint64_t size = list_size(property, item);
    if (size > body_.left() / body_.least_bytes(property.type) + 1) body_.fail_at_end(item);
    list.clear();
    list.reserve(size);
    for (std::uint64_t i = 0; i < size; ++i) list.push_back(read_index(property, item, restarts));
  }

  Index read_index(const Property& property, const Item& item, bool restarts) {
    const double index = body_.number(property.type, item);
    if (index >= 0 && index < static_cast<double>(vertices_) && index == std::floor(index)) {
      return static_cast<Index>(index);
    }
    if (restarts && index == -1) return no_index;
    body_.fail_at_last(property.type,
                       out_of_range(fmt::format("{}", index), vertices_) + ", in " + item.text());
  }

  void read_edges(const Element& element) {
    constexpr std::string_view names[] = {"vertex1", "vertex2"};
    for (const std::string_view name : names) {
      const auto is_named = [&](const Property& p) { return !p.count_type && p.name == name; };
      const auto& properties = element.properties;
      if (std::count_if(properties.begin(), properties.end(), is_named) != 1) return skip(element);
    }
    mesh_.marked_edges.reserve(plausible_rows(element));
    for (std::uint64_t row = 0; row < element.count; ++row) {
      tick(row);
      const Item item{"edge", row, element.count};
      std::array<Index, 2> edge{};
      for (const Property& property : element.properties) {
        const auto end = std::find(std::begin(names), std::end(names), property.name);
        if (property.count_type || end == std::end(names)) {
          skip(property, item);
        } else {
          edge[static_cast<std::size_t>(end - std::begin(names))] =
              read_index(property, item, false);
        }
      }
      mesh_.marked_edges.push_back(edge);
    }
  }

  void read_faces(const Element& element) {
    const std::uint64_t read = mesh_.faces.empty() ? read_plain_triangles(element) : 0;
    if (read == 0) mesh_.faces.reserve(plausible_rows(element), 3 * plausible_rows(element));
    for_each_list(element, read, false, [&](const std::vector<Index>& face) {
      if (face.size() >= 3) mesh_.faces.push_back(face);
    });
  }

  /// Reads the layout that most files have in a plain loop: triangles of a byte 3 and three indices
  /// of 32 bits. Returns the number of rows read, which ends before the first that is different,
  /// and is 0 if an index is out of range, so that the general way finds its place.
  std::uint64_t read_plain_triangles(const Element& element) {
    if constexpr (std::is_same_v<Body, TextBody>) {
      return 0;
    } else {
      if (element.properties.size() != 1) return 0;
      const Property& list = element.properties[0];
      if (list.count_type != Type::u8 || (list.type != Type::i32 && list.type != Type::u32) ||
          (list.name != "vertex_indices" && list.name != "vertex_index")) {
        return 0;
      }
      constexpr std::size_t bytes = 13;
      const char* const begin = body_.at();
      std::size_t rows = std::min<std::uint64_t>(element.count, body_.left() / bytes);
      std::mutex mutex;
      for_rows(rows, bytes, [&](std::size_t first, std::size_t last) {
        std::size_t row = first;
        while (row < last && begin[bytes * row] == 3) ++row;
        if (row == last) return;
        const std::lock_guard lock(mutex);
        rows = std::min(rows, row);
      });
      Faces triangles = Faces::uniform(rows, 3);
      Index* const corners = triangles.corners().data();
      Index highest = 0;
      for_rows(rows, bytes, [&](std::size_t first, std::size_t last) {
        Index here = 0;
        for (std::size_t row = first; row < last; ++row) {
          for (std::size_t c = 0; c < 3; ++c) {
            const Index index = body_.template load<Index>(begin + bytes * row + 1 + 4 * c);
            corners[3 * row + c] = index;
            here = std::max(here, index);
          }
        }
        const std::lock_guard lock(mutex);
        highest = std::max(highest, here);
      });
      if (rows == 0 || highest >= vertices_) return 0;
      body_.advance(bytes * rows);
      mesh_.faces = std::move(triangles);
      return rows;
    }
  }

  /// Every vertex of a strip but its first two makes a triangle with the two before it; every other
  /// one is turned around. An index of -1 begins a new strip.
  void read_strips(const Element& element) {
    for_each_list(element, 0, true, [&](const std::vector<Index>& list) {
      std::size_t begin = 0;
      for (std::size_t i = 0; i < list.size(); ++i) {
        if (list[i] == no_index) begin = i + 1;
        if (i < begin + 2) continue;
        const bool turned = (i - begin) % 2 == 1;
        const Index a = list[turned ? i - 1 : i - 2];
        const Index b = list[turned ? i - 2 : i - 1];
        const Index c = list[i];
        // A repeated vertex joins strips or changes their direction: it is no triangle of the
        // shape.
        if (a != b && b != c && c != a) mesh_.faces.push_back({a, b, c});
      }
    });
  }

  void read_grid(const Element& element) {
    const std::uint64_t columns = header_.columns;
    if (columns == 0 || element.count % columns != 0 || element.count / columns != header_.rows) {
      text_.fail(element.at,
                 fmt::format("element range_grid has {} cells, but obj_info num_cols and num_rows "
                             "give {} x {}",
                             element.count, columns, header_.rows));
    }
    grid_.reserve(plausible_rows(element));
    for_each_list(element, 0, false, [&](const std::vector<Index>& list) {
      if (list.size() > 1) {
        input_.fail_at_byte(body_.at(), fmt::format("a cell of the range_grid has {} vertices, "
                                                    "expected none or one",
                                                    list.size()));
      }
      grid_.push_back(list.empty() ? no_index : list[0]);
    });
  }

  const Input& input_;
  const Text& text_;  // for places in the header
  const Header& header_;
  std::span<ply::Column> columns_;
  Body body_;
  std::uint64_t vertices_ = 0;  // as the header says
  Mesh mesh_;
  Coordinates coordinates_;
  std::vector<Index> grid_;  // the vertex of each cell, or no_index; empty if there is no grid
};

}  // namespace

bool is_ply(std::string_view bytes) {
  return bytes.starts_with("ply\n") || bytes.starts_with("ply\r");
}

Mesh read_ply(const Input& input) {
  const std::string& value_name = input.options().value_name;
  std::vector<ply::Column> columns;
  if (!value_name.empty()) columns.push_back({.name = value_name, .required = true});
  if (input.options().paint) {
    for (const char* name : {"red", "green", "blue"}) {
      columns.push_back({.name = name, .required = true});
    }
  }
  Mesh mesh = ply::read(input, columns);
  if (!value_name.empty()) {
    mesh.values.assign(columns[0].numbers.begin(), columns[0].numbers.end());
  } else if (input.options().paint) {
    mesh.values.resize(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.values.size(); ++v) {
      const auto share = [&](std::size_t c) { return columns[c].numbers[v] / columns[c].largest; };
      mesh.values[v] = paint_of(share(0), share(1), share(2));
    }
  }
  return mesh;
}

namespace ply {

Mesh read(const Input& input, std::span<Column> columns, std::vector<std::string>* comments) {
  Text text(input);
  const Header header = read_header(text);
  if (comments) comments->assign(header.comments.begin(), header.comments.end());
  switch (header.encoding) {
    case Encoding::text:
      return Reader(input, text, header, columns, TextBody(input, text)).read();
    case Encoding::little_endian:
      return Reader(input, text, header, columns, BinaryBody<std::endian::little>(input, text.at()))
          .read();
    case Encoding::big_endian:
      break;
  }
  return Reader(input, text, header, columns, BinaryBody<std::endian::big>(input, text.at()))
      .read();
}

}  // namespace ply
}  // namespace meshgrain::io
