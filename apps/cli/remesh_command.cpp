#include "remesh_command.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "arguments.h"
#include "meshgrain/error.h"
#include "meshgrain/fields_file.h"
#include "meshgrain/io.h"
#include "meshgrain/remesh.h"
#include "meshgrain/statistics.h"
#include "meshgrain/system.h"
#include "progress_bar.h"
#include "remesh_arguments.h"
#include "report.h"

namespace meshgrain::cli {
namespace {

/// "FILE" or "FILE:STRENGTH".
std::vector<Guide> read_guides(const std::string& text, const Context& context) {
  const std::size_t colon = text.rfind(':');
  float strength = 1;
  const bool is_given = colon != text.npos && !std::filesystem::exists(text) &&
                        CLI::detail::lexical_cast(text.substr(colon + 1), strength);
  if (!is_given) return guides_of(read_polylines(text, context));
  if (!(strength >= 0 && strength <= 1)) {
    throw UsageError("--guides " + file_name(text) + ": the strength must lie between 0 and 1");
  }
  return guides_of(read_polylines(text.substr(0, colon), context), strength);
}

/// Fewer faces were asked for than the file has.
void note_split_faces(const std::string& path, RemeshResult& result) {
  const Faces& faces = result.mesh.faces;
  if (!holds_triangles_only(path)) return;
  const std::size_t triangles = faces.corners().size() - 2 * faces.size();
  if (triangles == faces.size()) return;
  result.report.notes.push_back(fmt::format("STL holds triangles only: {} faces are {} in the file",
                                            faces.size(), triangles));
}

/// Given fields decide what they decide.
void check_fields(const Arguments& a, const Fields& fields) {
  const std::string name = file_name(a.fields);
  if (a.remesh.rosy != 0 && a.remesh.rosy != fields.orientation.rosy) {
    throw UsageError(fmt::format("{} holds orientations of symmetry {}, not -r {}", name,
                                 fields.orientation.rosy, a.remesh.rosy));
  }
  const int posy = a.hexagons ? 6 : a.posy;
  if (!fields.position.points.empty() && fields.position.posy != posy) {
    throw UsageError(fmt::format(
        "{} holds positions for {}", name,
        fields.position.posy == 6 ? "triangles: add -p 6" : "quads: leave out -p and --hexagons"));
  }
}

/// Marks the edges of the input that are drawn in a file.
void add_features(const Arguments& a, Mesh& input, const Context& context) {
  if (input.is_point_cloud()) {
    throw UsageError("--features needs a mesh: " + file_name(a.input) + " is a point cloud");
  }
  const Polylines lines = read_polylines(a.features, context);
  try {
    mark_edges(input, lines, context);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    throw Error(file_name(a.features) + ": " + error.what());
  }
}

std::string describe(const MeshStatistics& s) {
  return fmt::format("{}, {}, {} irregular", faces_by_kind(s),
                     counted(s.vertices, "vertex", "vertices"), with_commas(s.irregular_vertices));
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Json stage(const char* name, double seconds) {
  return {{"name", name}, {"seconds", seconds}};
}

/// What is written, and what there is to say of it.
struct Written {
  std::string path;
  RemeshReport report;
  MeshStatistics statistics;
};

Json output(const Written& written) {
  Json json = {{"file", written.path}};
  json.update(to_json(written.statistics));
  return json;
}

/// Of one mesh all is told at the top; of several, each is in a list of its own.
void write_report(const Arguments& a, const std::vector<Written>& meshes, int threads,
                  double read_seconds, double write_seconds, double seconds) {
  const RemeshReport& first = meshes.front().report;
  Json json = {
      {"version", version()},
      {"arguments", a.words},
      {"input",
       {{"file", a.input}, {"vertices", first.input_vertices}, {"faces", first.input_faces}}},
      {"options", to_json(a.remesh)},
      {"threads", threads},
      {"seconds", seconds}};
  Json stages = Json::array({stage("read", read_seconds)});
  if (a.levels.empty()) {
    json.update(to_json(first));
    stages.insert(stages.end(), json["stages"].begin(), json["stages"].end());
    json["output"] = output(meshes.front());
  } else {
    for (const Written& mesh : meshes) {
      Json level = to_json(mesh.report);
      level["output"] = output(mesh);
      json["levels"].push_back(level);
    }
  }
  stages.push_back(stage("write", write_seconds));
  json["stages"] = stages;
  json["peak_memory_bytes"] = peak_memory();
  // Names need not be UTF-8, which JSON must be.
  write_file(a.report, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

/// Each line once, though several levels may have it.
void print_notes(const std::vector<Written>& meshes) {
  std::vector<std::string> printed;
  for (const Written& mesh : meshes) {
    for (const std::string& note : mesh.report.notes) {
      if (std::ranges::find(printed, note) != printed.end()) continue;
      fmt::print(stderr, "meshgrain: note: {}\n", note);
      printed.push_back(note);
    }
  }
}

std::vector<RemeshResult> make_meshes(const Arguments& a, Mesh input, const Context& context) {
  if (!a.levels.empty()) return remesh_levels(std::move(input), a.levels, a.remesh, context);
  std::vector<RemeshResult> results;
  results.push_back(remesh(std::move(input), a.remesh, context));
  return results;
}

void run(Arguments& a, Context& context) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<std::string> paths = output_paths(a);
  for (const std::string& path : paths) check_writable(path);
  for (const std::string& path : {a.fields_out, a.report}) {
    if (!path.empty()) check_place(path);
  }
  ProgressBar bar(!a.quiet);
  context.on_progress = [&](std::string_view stage, double share) { bar.show(stage, share); };

  Mesh input = read_mesh(a.input, a.read, context);
  if (!a.features.empty()) add_features(a, input, context);
  Fields fields;
  if (!a.fields.empty()) {
    fields = read_fields(a.fields, context);
    check_fields(a, fields);
    a.remesh.fields = &fields;
  }
  for (const std::string& text : a.guides) {
    const std::vector<Guide> guides = read_guides(text, context);
    a.remesh.guides.insert(a.remesh.guides.end(), guides.begin(), guides.end());
  }
  const double read_seconds = seconds_since(start);
  std::vector<RemeshResult> results = make_meshes(a, std::move(input), context);
  if (a.target_given && !fields.position.points.empty()) {
    results.front().report.notes.push_back(
        "the given positions decide how fine the mesh is, not -f, -v or -s");
  }

  context.progress("write", 0);
  const auto write_start = std::chrono::steady_clock::now();
  if (!a.fields_out.empty()) write_fields(a.fields_out, results.front().fields);
  for (std::size_t k = 0; k < results.size(); ++k) {
    write_mesh(paths[k], results[k].mesh);
    note_split_faces(paths[k], results[k]);
  }
  const double write_seconds = seconds_since(write_start);
  const double seconds = seconds_since(start);
  const bool summary = !a.quiet && stderr_is_terminal();
  std::vector<Written> written;
  for (std::size_t k = 0; k < results.size(); ++k) {
    written.push_back({paths[k], std::move(results[k].report), {}});
    if (summary || !a.report.empty()) written[k].statistics = mesh_statistics(results[k].mesh);
  }
  bar.clear();
  if (!a.quiet) print_notes(written);
  if (!a.report.empty()) {
    write_report(a, written, context.threads(), read_seconds, write_seconds, seconds);
  }
  for (std::size_t k = 0; summary && k < written.size(); ++k) {
    fmt::print(stderr, "{}: {} ({:.2f} s)\n", file_name(written[k].path),
               describe(written[k].statistics), seconds);
  }
}

}  // namespace

void remesh_command(int argc, char** argv) {
  Arguments arguments;
  if (!parse_remesh(argc, argv, arguments)) return;
  Context context(arguments.threads);
  interruptible(context, [&] { run(arguments, context); });
}

}  // namespace meshgrain::cli
