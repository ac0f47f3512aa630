#include "remesh_arguments.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>

#include "arguments.h"
#include "meshgrain/error.h"
#include "meshgrain/system.h"
#include "option_names.h"

namespace meshgrain::cli {
namespace {

/// An option that takes one of several names.
template <class T>
CLI::Option* add_choice(CLI::App& app, const std::string& option, T& value, const Names<T>& names,
                        const std::string& type_name, const std::string& text) {
  const auto set = [&value, &names, option](const std::string& name) {
    const auto found = names.find(name);
    if (found == names.end()) {
      throw CLI::ValidationError(option, "\"" + name + "\" is none of " + list_of(names));
    }
    value = found->second;
  };
  return app.add_option_function<std::string>(option, set, text)->type_name(type_name);
}

/// Not "nan" and "inf", which CLI11's ranges let through.
std::optional<double> finite_number(const std::string& text) {
  double number = 0;
  if (!CLI::detail::lexical_cast(text, number) || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::string refuse_unless_finite(const std::string& text) {
  return finite_number(text) ? "" : "\"" + text + "\" is not a number";
}

std::string refuse_unless_positive(const std::string& text) {
  return finite_number(text).value_or(0) > 0 ? "" : "\"" + text + "\" is not a positive number";
}

std::string refuse_if_negative(const std::string& text) {
  return finite_number(text).value_or(-1) >= 0 ? "" : "\"" + text + "\" is not a number from 0 on";
}

/// Of faces or vertices.
std::string refuse_unless_count(const std::string& text) {
  constexpr Index most = std::numeric_limits<Index>::max();
  if (finite_number(text).value_or(0) > most) {
    return fmt::format("\"{}\" is more than the {} that a mesh can have", text, most);
  }
  if (text.find_first_not_of("0123456789") != text.npos) {
    return "\"" + text + "\" is not a whole positive number, in digits alone";
  }
  return refuse_unless_positive(text);
}

/// "auto", "marked", "off" or degrees.
void parse_creases(const std::string& text, FeatureOptions& features) {
  if (text == "auto") {
    features.creases = Creases::automatic;
  } else if (text == "marked") {
    features.creases = Creases::marked;
  } else if (text == "off") {
    features.creases = Creases::none;
  } else {
    double& degrees = features.crease_degrees;
    if (!CLI::detail::lexical_cast(text, degrees) || !(degrees >= 0 && degrees <= 180)) {
      throw CLI::ValidationError(
          "--crease", "\"" + text + "\" is none of auto, marked, off, degrees from 0 to 180");
    }
    features.creases = Creases::by_angle;
  }
}

/// "auto", or axes.
void parse_symmetry(const std::string& text, Symmetry& symmetry) {
  symmetry.automatic = text == "auto";
  if (symmetry.automatic) return;
  if (text.empty() || text.find_first_not_of("xyz") != text.npos) {
    throw CLI::ValidationError("--symmetry", "\"" + text + "\" is neither auto nor axes: x, y, z");
  }
  for (const char c : text) {
    symmetry.axes[static_cast<std::size_t>(c - 'x')] = true;
  }
}

/// "500M", "2G" or a number of bytes.
std::size_t parse_memory(const std::string& text) {
  constexpr std::string_view units = "KMGT";
  const std::size_t unit = text.empty() ? units.npos : units.find(text.back());
  const bool has_unit = unit != units.npos;
  double number = 0;
  const bool is_number =
      CLI::detail::lexical_cast(text.substr(0, text.size() - (has_unit ? 1 : 0)), number);
  const double bytes = has_unit ? std::ldexp(number, 10 * static_cast<int>(unit + 1)) : number;
  constexpr double most = 1e18;
  if (!is_number || !(bytes >= 1 && bytes <= most)) {
    throw CLI::ValidationError(
        "--memory-limit", "\"" + text + "\" is no amount of memory, such as 500M, 2G or bytes");
  }
  return static_cast<std::size_t>(bytes);
}

/// "50000,5000,500" as numbers of faces.
void parse_levels(const std::string& text, std::vector<std::size_t>& levels) {
  for (const std::string& word : CLI::detail::split(text, ',')) {
    std::size_t count = 0;
    const std::string refusal = refuse_unless_count(word);
    if (!refusal.empty()) throw CLI::ValidationError("--lod", refusal);
    if (!CLI::detail::lexical_cast(word, count)) {
      throw CLI::ValidationError("--lod", "\"" + word + "\" is no number of faces");
    }
    levels.push_back(count);
  }
}

constexpr const char* description =
    "Meshgrain turns a mesh or point cloud into a mesh of well-shaped quads, triangles or "
    "hexagons\n"
    "that follow its shape.";

constexpr const char* commands =
    "Other commands (each has a --help of its own):\n"
    "  meshgrain stats MESH            figures of a mesh, and its distance to another\n"
    "  meshgrain picture MESH FILE.png draw a mesh\n"
    "  meshgrain sample [NAME]         make a shape to try things on\n"
    "A file with the name of a command is meant by ./stats, for example.\n"
    "\n"
    "-f, -v and -s always mean the mesh that is written. (Instant Meshes, whose options these "
    "are,\n"
    "writes four times as many faces and vertices as its pure quads are asked for.)";

void add_options(CLI::App& app, Arguments& a) {
  RemeshOptions& o = a.remesh;
  app.set_version_flag("--version", "meshgrain " + std::string(version()), "show the version");

  app.add_option("INPUT", a.input, "mesh or point cloud: OBJ, PLY, OFF, STL, ALN, XYZ or PTS")
      ->required()
      ->type_name("");
  app.add_option("-o,--output", a.output, "the mesh to write: OBJ, PLY, OFF or STL")
      ->required()
      ->type_name("FILE");

  app.add_option("-f,--faces", o.face_count, "so many faces, in the mesh that is written")
      ->check(refuse_unless_count)
      ->type_name("N")
      ->group(
          "How fine (one of these; by default about a sixteenth of the input's vertices, but 500 "
          "at least)");
  app.add_option("-v,--vertices", o.vertex_count, "so many vertices, in the mesh that is written")
      ->check(refuse_unless_count)
      ->type_name("N")
      ->group(app.get_option("-f")->get_group());
  app.add_option("-s,--scale", o.edge_length, "edges so long, in the mesh that is written")
      ->check(refuse_unless_positive)
      ->type_name("LENGTH")
      ->group(app.get_option("-f")->get_group());
  app.add_option_function<std::string>(
         "--lod", [&a](const std::string& text) { parse_levels(text, a.levels); },
         "several sizes in one run, numbers of faces; -o out.obj writes out_lod0.obj, out_lod1.obj "
         "and so on")
      ->type_name("N,N,...")
      ->group(app.get_option("-f")->get_group());
  app.get_option("-f")->excludes("-v")->excludes("-s")->excludes("--lod");
  app.get_option("-v")->excludes("-s")->excludes("--lod");
  app.get_option("-s")->excludes("--lod");

  const auto sizes = [&](CLI::Option* option) { option->group("Faces of different sizes"); };
  sizes(app.add_option("--adaptive", o.sizing.adaptive,
                       "smaller faces where the surface bends: 0 (off) to 1")
            ->check(refuse_unless_finite)
            ->check(CLI::Range(0.0, 1.0))
            ->type_name("X"));
  sizes(
      app.add_option("--density", a.density,
                     "painted: by the vertices' colors (red: four times as many faces as white "
                     "or grey, cyan: a quarter; PLY or OBJ), or by the number of this name (faces "
                     "per area; PLY)")
          ->type_name("colors|NAME"));
  sizes(app.add_option(
               "--sizing", a.sizing,
               "where faces are small: uniform, curvature (--adaptive 1), distance:X,Y,Z "
               "(near a point) or value:NAME (edge lengths by a number of the PLY's vertices)")
            ->type_name("HOW"));
  sizes(app.add_option("--sizing-ratio", o.sizing.ratio,
                       "largest to smallest edge length (4); of paint: cyan to red")
            ->check(refuse_unless_finite)
            ->check(CLI::Range(1.0, 1000.0))
            ->type_name("R"));

  sizes(app.add_option("--grading", o.sizing.grading,
                       "sizes grow at most by this factor over three faces (2)")
            ->check(refuse_unless_finite)
            ->check(CLI::Range(1.01, 1000.0))
            ->type_name("R"));

  const auto faces = [&](CLI::Option* option) {
    option->group("Which faces (default: only quads)");
  };
  faces(
      app.add_flag("-D,--dominant", a.dominant, "mostly quads, with some triangles and pentagons"));
  faces(app.add_option("-p,--posy", a.posy, "position symmetry: 4 (quads) or 6 (triangles)")
            ->check(CLI::IsMember({4, 6}))
            ->type_name("N"));
  faces(app.add_option("-r,--rosy", o.rosy,
                       "orientation symmetry: 1, 2, 4 or 6 (4 for quads, 6 for triangles)")
            ->check(CLI::IsMember({1, 2, 4, 6}))
            ->type_name("N"));
  faces(app.add_flag("--hexagons", a.hexagons, "hexagons: the dual of triangles"));
  faces(app.add_option("--regularity", o.regularity,
                       "0 (best shapes) to 1 (fewest irregular vertices) (0.5)")
            ->type_name("X"));
  faces(app.add_option("--min-component", o.min_component,
                       "leave out pieces with room for fewer faces than this (0)")
            ->check(refuse_if_negative)
            ->type_name("N"));
  faces(app.add_flag("--manifold", o.manifold, "drop faces where the result is not manifold"));

  const auto follow = [&](CLI::Option* option) { option->group("What to follow"); };
  follow(
      app.add_option_function<std::string>(
             "-c,--crease", [&o](const std::string& text) { parse_creases(text, o.features); },
             "creases: auto (of mechanical parts, default), or where the angle between faces is "
             "larger than this; beside edges that the input marks. marked: only these; off: none")
          ->type_name("DEGREES"));
  follow(
      app.add_option("--features", a.features,
                     "also the lines in this file, drawn on the input from vertex to vertex: OBJ "
                     "with l, or PLY with edges")
          ->type_name("FILE"));
  follow(
      app.add_option("--guides", a.guides,
                     "curves (the lines of an OBJ or PLY file) that edges follow; FILE:0.5 draws "
                     "only the fields to them, by so much; may be given again")
          ->allow_extra_args(false)
          ->type_name("FILE"));
  follow(app.add_flag("-b,--boundaries", o.features.align_border,
                      "follow the border of an open mesh (yes)"));
  follow(app.add_flag_callback(
      "--free-boundaries", [&o] { o.features.align_border = false; }, "do not follow it"));
  follow(app.add_flag("--lock-borders", o.lock_borders,
                      "the border's vertices stay exactly where they are, and its edges as they "
                      "are, so that the result can be sewn to what lay beside the input (only "
                      "where faces would be folded, edges far longer than these are divided)"));
  follow(app.add_option_function<std::string>(
                "--symmetry", [&o](const std::string& text) { parse_symmetry(text, o.symmetry); },
                "exactly symmetric about planes across x, y, z (xy: both), or auto: about the one "
                "that suits best")
             ->type_name("AXES"));
  follow(app.add_option("--curvature", o.curvature.strength,
                        "pull towards the directions of curvature: 0 (off) to 1")
             ->check(refuse_unless_finite)
             ->check(CLI::Range(0.0, 1.0))
             ->type_name("STRENGTH"));
  follow(
      app.add_option("--curvature-hard", o.curvature.hard_degrees,
                     "follow them exactly where the surface bends more over an edge's length (off)")
          ->check(refuse_unless_finite)
          ->check(CLI::Range(0.0, 180.0))
          ->type_name("DEGREES"));
  follow(app.add_option("--bends", o.curvature.bends,
                        "pull along bends that are sharp over an edge's length, such as the rims "
                        "of thin parts: 0 (off) to 1 (0.5)")
             ->check(refuse_unless_finite)
             ->check(CLI::Range(0.0, 1.0))
             ->type_name("STRENGTH"));

  const auto method = [&](CLI::Option* option) { option->group("Method"); };
  method(app.add_flag_callback(
      "-i,--intrinsic", [&a] { a.energy = "intrinsic"; }, "the same as --energy intrinsic"));
  method(app.add_option("--energy", a.energy, "of both fields: extrinsic (default) or intrinsic")
             ->check(CLI::IsMember(&position_energies))
             ->type_name("ENERGY"));
  app.get_option("--energy")->excludes("-i");
  method(app.add_option("--orientation-energy", a.orientation_energy,
                        "of the orientation field alone: extrinsic, intrinsic or convex")
             ->check(CLI::IsMember(&orientation_energies))
             ->type_name("ENERGY"));
  method(add_choice(app, "--solver", o.solver.schedule, schedules, "SOLVER",
                    "blocks (parallel Gauss-Seidel, default), random (order) or jacobi"));
  method(app.add_option("--sweeps", o.solver.sweeps,
                        "on each level (6 or 8, but 1 or 2 on each of the three finest)")
             ->check(CLI::Range(1, 1000000))
             ->type_name("N"));
  method(app.add_flag("--single-level", a.single_level, "no multiresolution"));
  method(app.add_flag_callback(
      "--no-coarsen", [&o] { o.coarsen = false; },
      "solve over all vertices of the input, also where far fewer are enough"));
  method(
      add_choice(app, "--graph", o.graph.nodes, graph_nodes, "NODES",
                 "fields live on the input's vertices (default) or faces (the paper's extraction: "
                 "follows no creases and borders, and may change the topology)"));
  method(add_choice(app, "--weights", o.graph.weights, graph_weights, "WEIGHTS",
                    "of the graph's edges: uniform (default) or geometric"));
  method(app.add_option("--crease-normals", o.graph.crease_degrees,
                        "where faces meet at a larger angle, vertices have the normal of one (off)")
             ->check(refuse_unless_finite)
             ->check(CLI::Range(0.0, 180.0))
             ->type_name("DEGREES"));
  method(app.add_option("-k,--knn", o.graph.neighbors, "neighbours of each point of a cloud (10)")
             ->check(CLI::Range(3, 1000))
             ->type_name("N"));
  method(app.add_option("-S,--smooth", o.smoothing,
                        fmt::format("smoothing steps at the end ({})", RemeshOptions().smoothing))
             ->check(CLI::Range(0, 100000))
             ->type_name("N"));
  method(app.add_flag_callback(
      "--no-retries", [&o] { o.retries = false; },
      "keep the first faces: several times as fast where they have faults that others may not "
      "have"));
  method(app.add_option("--seed", o.solver.seed, "of the random start (0)")->type_name("N"));
  method(app.add_flag("--weld", a.read.weld, "merge vertices at the same place first"));

  const auto files = [&](CLI::Option* option) { option->group("Files and running"); };
  files(app.add_option("--fields", a.fields,
                       "use the fields in this file instead of solving for them")
            ->type_name("FILE"));
  files(app.add_option("--fields-out", a.fields_out, "write the fields to this file (PLY)")
            ->type_name("FILE"));
  files(app.add_option("--report", a.report, "write times, counts and memory to this file")
            ->type_name("FILE.json"));
  files(app.add_flag(
      "--energies", a.energies,
      "in the report, those of both fields after each sweep (as costly as the sweeps)"));
  files(app.add_option("-t,--threads", a.threads, "threads to use (all cores)")
            ->check(CLI::Range(1, 4096))
            ->type_name("N"));
  files(app.add_option_function<std::string>(
               "--memory-limit",
               [&o](const std::string& text) { o.memory_limit = parse_memory(text); },
               "refuse at once what may take more memory than this: 500M, 2G or bytes (no limit)")
            ->type_name("SIZE"));
  files(app.add_flag("--quiet", a.quiet, "print nothing but errors"));
  files(app.add_flag("-d,--deterministic", a.ignored,
                     "always so; accepted for Instant Meshes' scripts"));
  files(app.add_flag("-C,--compat", a.ignored, "no effect; accepted for Instant Meshes' scripts"));
  app.footer(commands);
}

/// "1.5,0,-2" as three numbers.
Eigen::Vector3d parse_point(const std::string& text) {
  Eigen::Vector3d point;
  std::size_t at = 0;
  for (int i = 0; i < 3; ++i) {
    const std::size_t end = i < 2 ? text.find(',', at) : text.size();
    double number = 0;
    if (end == text.npos || !CLI::detail::lexical_cast(text.substr(at, end - at), number) ||
        !std::isfinite(number)) {
      throw UsageError("--sizing distance:X,Y,Z needs three numbers, got \"" + text + "\"");
    }
    point[i] = number;
    at = end + 1;
  }
  return point;
}

void parse_sizing(Arguments& a) {
  Sizing& sizing = a.remesh.sizing;
  const std::size_t colon = a.sizing.find(':');
  const std::string kind = a.sizing.substr(0, colon);
  const std::string rest = colon == a.sizing.npos ? "" : a.sizing.substr(colon + 1);
  if (kind == "distance") {
    sizing.kind = Sizing::Kind::distance;
    sizing.point = parse_point(rest);
  } else if (kind == "value" && !rest.empty()) {
    sizing.kind = Sizing::Kind::values;
    a.read.value_name = rest;
  } else if (a.sizing == "curvature") {
    if (sizing.adaptive == 0) sizing.adaptive = 1;
  } else if (a.sizing == "uniform") {
    if (sizing.adaptive != 0)
      throw UsageError("--adaptive and --sizing uniform exclude each other");
  } else if (!a.sizing.empty()) {
    throw UsageError("--sizing \"" + a.sizing +
                     "\" is none of uniform, curvature, distance:X,Y,Z, value:NAME");
  }
  if (a.density.empty()) return;
  if (sizing.kind != Sizing::Kind::uniform) {
    throw UsageError("--density and --sizing " + kind + " exclude each other");
  }
  a.read.paint = a.density == "colors";
  if (!a.read.paint) a.read.value_name = a.density;
  sizing.kind = a.read.paint ? Sizing::Kind::paint : Sizing::Kind::density;
}

/// Level k of out.obj is out_lod<k>.obj.
std::string level_path(const std::string& output, std::size_t level) {
  std::filesystem::path path(output);
  const std::string extension = path.extension().string();
  path.replace_filename(path.stem().string() + fmt::format("_lod{}", level) + extension);
  return path.string();
}

/// What needs more than one option to tell.
void resolve(Arguments& a) {
  RemeshOptions& o = a.remesh;
  parse_sizing(a);
  if (a.hexagons && a.dominant) throw UsageError("--hexagons and -D exclude each other");
  if (a.hexagons && a.posy_given && a.posy == 4) {
    throw UsageError("--hexagons are the dual of triangles, and need -p 6 or none");
  }
  const bool triangular = a.hexagons || a.posy == 6;
  o.faces = a.hexagons   ? OutputFaces::hexagons
            : triangular ? OutputFaces::triangles
            : a.dominant ? OutputFaces::quad_dominant
                         : OutputFaces::quads;
  if (o.rosy != 0 && (triangular ? 6 : 4) % o.rosy != 0) {
    throw UsageError(triangular
                         ? "-r 4 does not fit triangles and hexagons: use -r 1, 2 or 6"
                         : "-r 6 does not fit quads: use -r 1, 2 or 4, or -p 6 for triangles");
  }
  if (!a.features.empty() && o.features.creases == Creases::none) {
    throw UsageError("--features and -c off exclude each other");
  }
  if (!a.features.empty() && o.graph.nodes == GraphNodes::faces) {
    throw UsageError("--features and --graph faces exclude each other");
  }
  if (!a.energy.empty()) {
    o.orientation_energy = orientation_energies.at(a.energy);
    o.position_energy = position_energies.at(a.energy);
  }
  if (!a.orientation_energy.empty()) {
    o.orientation_energy = orientation_energies.at(a.orientation_energy);
  }
  o.solver.multiresolution = !a.single_level;
  if (a.energies && a.report.empty()) {
    throw UsageError("--energies are written into a report: add --report FILE.json");
  }
  o.solver.record_energy = a.energies;
  o.count_singularities = !a.report.empty();

  if (!a.levels.empty() && !a.fields_out.empty()) {
    throw UsageError("--fields-out goes with one size, and --lod with several");
  }

  // Two results in one file would leave one.
  std::vector<std::string> outputs = output_paths(a);
  outputs.insert(outputs.end(), {a.fields_out, a.report});
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!outputs[i].empty() && std::filesystem::path(outputs[i]).lexically_normal() ==
                                     std::filesystem::path(outputs[j]).lexically_normal()) {
        throw UsageError("two outputs have the same name, " + file_name(outputs[i]));
      }
    }
  }
}

}  // namespace

std::vector<std::string> output_paths(const Arguments& a) {
  if (a.levels.empty()) return {a.output};
  std::vector<std::string> paths;
  for (std::size_t k = 0; k < a.levels.size(); ++k) paths.push_back(level_path(a.output, k));
  return paths;
}

bool parse_remesh(int argc, char** argv, Arguments& a) {
  CLI::App app(description, "meshgrain");
  add_options(app, a);
  if (!parse(app, argc, argv)) return false;
  a.words.assign(argv + 1, argv + argc);
  a.posy_given = app.count("--posy") > 0;
  a.target_given = app.count("-f") + app.count("-v") + app.count("-s") > 0;
  resolve(a);
  return true;
}

}  // namespace meshgrain::cli
