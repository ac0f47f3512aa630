#include "stats_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "arguments.h"
#include "meshgrain/error.h"
#include "meshgrain/fields_file.h"
#include "meshgrain/io.h"
#include "meshgrain/singularities.h"
#include "meshgrain/statistics.h"
#include "meshgrain/triangulate.h"
#include "report.h"

namespace meshgrain::cli {
namespace {

struct Comparison {
  double diagonal = 0;
  SurfaceDistance to_input, from_input;
  KeptLines lines;
};

void line(std::string_view name, const std::string& value, const std::string& remark = "") {
  fmt::print("  {:<24}{:>10}{}{}\n", name, value, remark.empty() ? "" : "   ", remark);
}

void row(std::string_view name, const char* format, std::initializer_list<double> numbers) {
  fmt::print("  {:<14}", name);
  for (const double number : numbers)
    fmt::print("{:>10}", fmt::format(fmt::runtime(format), number));
  fmt::print("\n");
}

void print(const std::string& name, const MeshStatistics& s,
           const std::optional<std::size_t>& of_orientation,
           const std::optional<std::size_t>& crossings,
           const std::optional<Comparison>& comparison) {
  fmt::print("{}\n\n", name);
  line("vertices", with_commas(s.vertices));
  line("faces", with_commas(s.faces), faces_by_kind(s));
  line("irregular vertices", with_commas(s.irregular_vertices));
  line("singularities", with_commas(s.singularities),
       of_orientation ? fmt::format("orientation field: {}", with_commas(*of_orientation)) : "");
  // Headings count as many columns as they have letters, but the Greek one has two bytes.
  fmt::print("\n  {:<14}{:>11}{:>10}{:>10}{:>12}{:>12}\n", "", "\u03c3", "least", "most",
             "mean least", "mean most");
  row("area", "{:.4f}", {s.area_sigma, s.area_min, s.area_max});
  fmt::print("  {:<14}{:>10.2f}{:>10.2f}{:>10.2f}{:>12.2f}{:>12.2f}   degrees\n", "angle",
             s.angle_sigma, s.angle_min, s.angle_max, s.angle_min_mean, s.angle_max_mean);
  fmt::print("  {:<14}{:>10.4f}{:>10}{:>10}   mean {:.6g}\n", "edge length", s.edge_sigma, "", "",
             s.edge_mean);
  fmt::print("\n");
  line("pieces", with_commas(s.components));
  line("borders", with_commas(s.boundary_loops));
  line("Euler number", std::to_string(s.euler));
  line("non-manifold edges", with_commas(s.non_manifold_edges));
  line("non-manifold vertices", with_commas(s.non_manifold_vertices));
  line("isolated vertices", with_commas(s.isolated_vertices));
  line("inverted quads", with_commas(s.inverted_quads));
  if (crossings) line("crossings", with_commas(*crossings), "pairs of faces");
  if (s.quads > 0) {
    line("scaled Jacobian",
         fmt::format("least {:.3f}, first percentile {:.3f}", s.jacobian_min, s.jacobian_p01));
  }
  if (s.marked_edges > 0) line("marked edges", with_commas(s.marked_edges));
  if (!comparison) return;
  fmt::print("\n  {:<24}{:>10}{:>10}   of the input's diagonal, {:.6g}\n", "distance", "mean",
             "most", comparison->diagonal);
  const auto distance = [](const char* title, const SurfaceDistance& d) {
    fmt::print("  {:<24}{:>10.2e}{:>10.2e}\n", title, d.mean, d.max);
  };
  distance("from mesh to input", comparison->to_input);
  distance("from input to mesh", comparison->from_input);
  const KeptLines& lines = comparison->lines;
  const auto share = [](const char* title, const std::optional<double>& kept) {
    if (kept) line(title, fmt::format("{:.1f} %", 100 * *kept));
  };
  if (lines.creases || lines.border) fmt::print("\n");
  share("creases followed", lines.creases);
  share("border followed", lines.border);
  if (lines.corners > 0) {
    line("corners kept", fmt::format("{} of {}", lines.corners_kept, lines.corners));
  }
}

}  // namespace

void stats_command(int argc, char** argv) {
  std::string path, against, fields_path;
  bool as_json = false, with_crossings = false;
  CLI::App app(
      "Prints the figures of a mesh. Areas are relative to the mean area; singularities are "
      "irregular\n"
      "vertices and faces other than the prevailing kind.",
      "meshgrain stats");
  app.add_option("MESH", path, "the mesh")->required();
  app.add_option(
         "--against", against,
         "also the distances to this mesh or point cloud, its input, and how much of its creases "
         "and border the edges follow")
      ->type_name("INPUT");
  app.add_option("--fields", fields_path, "also the singularities of the orientation field in here")
      ->type_name("FILE");
  app.add_flag("--crossings", with_crossings,
               "also how many pairs of faces pass through each other");
  app.add_flag("--json", as_json, "print JSON instead");
  if (!parse(app, argc, argv)) return;

  Context context;
  interruptible(context, [&] {
    const Mesh mesh = read_mesh(path, {}, context);
    if (mesh.is_point_cloud()) {
      throw Error(file_name(path) + ": is a point cloud; only meshes have figures");
    }
    const MeshStatistics statistics = mesh_statistics(mesh);
    std::optional<std::size_t> of_orientation;
    if (!fields_path.empty()) {
      const Fields fields = read_fields(fields_path, context);
      if (fields.surface.is_point_cloud()) {
        throw Error(file_name(fields_path) +
                    ": has no faces; only fields on meshes have singularities");
      }
      of_orientation = orientation_singularities(fields.surface, fields.surface.normals,
                                                 fields.orientation, context)
                           .size();
    }
    std::optional<std::size_t> crossings;
    if (with_crossings) crossings = find_crossings(mesh, context).size();
    std::optional<Comparison> comparison;
    if (!against.empty()) {
      const Mesh input = read_mesh(against, {}, context);
      comparison.emplace();
      comparison->diagonal = bounding_diagonal(input);
      comparison->to_input = surface_distance(mesh, input, comparison->diagonal, 100000, context);
      comparison->from_input = surface_distance(input, mesh, comparison->diagonal, 100000, context);
      if (!input.is_point_cloud()) comparison->lines = kept_lines(triangulate(input), mesh);
    }
    if (!as_json) return print(file_name(path), statistics, of_orientation, crossings, comparison);
    Json json = to_json(statistics);
    if (of_orientation) json["orientation_singularities"] = *of_orientation;
    if (crossings) json["crossings"] = *crossings;
    if (comparison) {
      json["diagonal"] = comparison->diagonal;
      json["distance_to_input"] = to_json(comparison->to_input);
      json["distance_from_input"] = to_json(comparison->from_input);
      const KeptLines& lines = comparison->lines;
      if (lines.creases) json["creases_followed"] = *lines.creases;
      if (lines.border) json["border_followed"] = *lines.border;
      if (lines.corners > 0) {
        json["corners"] = lines.corners;
        json["corners_kept"] = lines.corners_kept;
      }
    }
    fmt::print("{}\n", json.dump(2));
  });
}

}  // namespace meshgrain::cli
