// The command line, by running the program as a user would.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "mesh/border.h"
#include "meshgrain/error.h"
#include "meshgrain/fields_file.h"
#include "meshgrain/io.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "meshgrain/system.h"
#include "util/platform.h"

namespace meshgrain {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Cli : public testing::Test {
 protected:
  struct Run {
    int status;
    std::string out, err;
  };

  void SetUp() override {
    const auto* const info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = platform::temporary_beside(fs::path(testing::TempDir()) / "x");
    folder_ += std::string("-cli-") + info->name();
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  bool exists(const std::string& name) const { return fs::exists(folder_ / name); }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  /// Runs the program within the folder.
  Run run(const std::string& arguments) const {
    const fs::path log = folder_.string() + "-log";
    fs::create_directories(log);
    const std::string command = fmt::format(
        "cd '{}' && '{}' {} >'{}/out' 2>'{}/err'; echo $? >'{}/status'", folder_.string(),
        MESHGRAIN_PROGRAM, arguments, log.string(), log.string(), log.string());
    EXPECT_EQ(std::system(command.c_str()), 0);
    const auto text = [&](const char* name) {
      std::ifstream file(log / name, std::ios::binary);
      return std::string(std::istreambuf_iterator<char>(file), {});
    };
    Run result{std::stoi(text("status")), text("out"), text("err")};
    fs::remove_all(log);
    return result;
  }
  /// The same; it must succeed and say nothing.
  void run_well(const std::string& arguments) const {
    const Run result = run(arguments);
    EXPECT_EQ(result.status, 0) << arguments << "\n" << result.err;
    EXPECT_EQ(result.out + result.err, "") << arguments;
  }

  void sample(const std::string& name, const std::string& file, double resolution = 0.3) const {
    write_mesh(folder_ / file, sample_shape(name, resolution));
  }

  /// Remeshes in.obj with these options; the bytes that are written.
  std::string bytes(const std::string& options) const {
    run_well("in.obj -o out.obj " + options);
    return read("out.obj");
  }
  Mesh mesh(const std::string& options) const {
    run_well("in.obj -o out.obj " + options);
    return exists("out.obj") ? read_mesh(folder_ / "out.obj") : Mesh();
  }
  MeshStatistics statistics(const std::string& options) const {
    return mesh_statistics(mesh(options));
  }

  /// It must end with one line on stderr that holds `text`, with this status, and leave no file but
  /// those there were.
  void expect_refused(const std::string& arguments, int status, const std::string& text) const {
    const std::size_t before = files();
    const Run result = run(arguments);
    EXPECT_EQ(result.status, status) << arguments << "\n" << result.err;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_TRUE(result.err.starts_with("meshgrain: error: ")) << result.err;
    EXPECT_NE(result.err.find(text), std::string::npos) << arguments << "\n" << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(files(), before) << arguments;
  }

  fs::path folder_;
};

double near(double value, double target) {
  return std::abs(value / target - 1);
}

TEST_F(Cli, HelpAndVersion) {
  EXPECT_EQ(run("--version").out, "meshgrain " + std::string(version()) + "\n");
  for (const char* command : {"", "stats ", "sample ", "picture "}) {
    for (const char* option : {"-h", "--help"}) {
      const Run help = run(std::string(command) + option);
      EXPECT_EQ(help.status, 0);
      EXPECT_EQ(help.err, "");
      EXPECT_NE(help.out.find(std::string("Usage: meshgrain ") + command), std::string::npos);
      std::size_t line = 0;
      for (const char c : help.out) {
        line = c == '\n' ? 0 : line + 1;
        EXPECT_LE(line, 100u) << help.out;
      }
    }
  }
  EXPECT_NE(run("-h").out.find("Instant Meshes"), std::string::npos);
}

TEST_F(Cli, TargetsMeanTheWrittenMesh) {
  sample("sphere", "in.obj", 0.5);
  EXPECT_LT(near(static_cast<double>(statistics("-f 800").faces), 800), 0.1);
  EXPECT_LT(near(static_cast<double>(statistics("--faces 400").faces), 400), 0.1);
  EXPECT_LT(near(static_cast<double>(statistics("-v 800").vertices), 800), 0.1);
  EXPECT_LT(near(static_cast<double>(statistics("--vertices 400 -D").vertices), 400), 0.1);
  EXPECT_LT(near(statistics("-s 0.15").edge_mean, 0.15), 0.1);
  EXPECT_LT(near(statistics("--scale 0.2 -p 6").edge_mean, 0.2), 0.1);
}

TEST_F(Cli, Faces) {
  sample("sphere", "in.obj", 0.5);
  MeshStatistics s = statistics("-f 600");
  EXPECT_EQ(s.quads, s.faces);
  s = statistics("-f 600 -D");
  EXPECT_LT(s.quads, s.faces);
  EXPECT_GT(s.quads, s.faces * 9 / 10);
  EXPECT_EQ(statistics("-f 600 --dominant").quads, s.quads);
  for (const char* options : {"-f 600 -p 6", "-f 600 -r 6 -p 6", "-f 600 --posy 6 --rosy 6 -D"}) {
    s = statistics(options);
    EXPECT_GT(s.triangles, s.faces * 98 / 100) << options;
  }
  s = statistics("-f 300 --hexagons");
  EXPECT_GT(s.larger, s.faces * 9 / 10);
  EXPECT_EQ(statistics("-f 600 -p 4 -r 4").quads, statistics("-f 600").quads);
}

TEST_F(Cli, OrientationSymmetry) {
  sample("bracket", "in.obj");
  const std::string four = bytes("-f 500");
  EXPECT_EQ(bytes("-f 500 -r 4"), four);
  EXPECT_NE(bytes("-f 500 -r 2"), four);
  EXPECT_NE(bytes("-f 500 --rosy 1"), four);
  EXPECT_NE(bytes("-f 500 -p 6 -r 2"), bytes("-f 500 -p 6"));
}

TEST_F(Cli, ManifoldDropsWhatIsNot) {
  // Three leaves on one edge.
  Mesh book;
  const int n = 12;
  for (int leaf = 0; leaf < 3; ++leaf) {
    const double angle = 2.0943951 * leaf;
    const auto first = static_cast<Index>(book.positions.size());
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= n; ++j) {
        book.positions.emplace_back(static_cast<float>(i * std::cos(angle)),
                                    static_cast<float>(i * std::sin(angle)), static_cast<float>(j));
      }
    }
    const auto at = [&](int i, int j) {
      return i == 0 ? static_cast<Index>(j) : first + static_cast<Index>(i * (n + 1) + j);
    };
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        book.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        book.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }
  write_mesh(folder_ / "in.obj", book);
  std::size_t changed = 0;
  for (const std::string options : {"-f 300 --quiet", "-f 300 -D --quiet", "-f 300 -p 6 --quiet"}) {
    const std::string plain = bytes(options);
    if (bytes(options + " --manifold") != plain) ++changed;
    const MeshStatistics s = mesh_statistics(read_mesh(folder_ / "out.obj"));
    EXPECT_EQ(s.non_manifold_edges, 0u) << options;
    EXPECT_EQ(s.non_manifold_vertices, 0u) << options;
  }
  EXPECT_GT(changed, 0u);
}

TEST_F(Cli, SeedAndThreads) {
  sample("blob", "in.obj", 0.5);
  const std::string plain = bytes("-f 600");
  EXPECT_EQ(bytes("-f 600 --seed 0 -d -C"), plain);
  EXPECT_EQ(bytes("-f 600 -t 1"), plain);
  EXPECT_EQ(bytes("-f 600 --threads 3 --deterministic --compat"), plain);
  EXPECT_NE(bytes("-f 600 --seed 1"), plain);
}

TEST_F(Cli, SolverOptionsChangeTheResult) {
  sample("bracket", "in.obj");
  const std::string plain = bytes("-f 500");
  EXPECT_EQ(bytes("-f 500 --solver blocks --energy extrinsic --graph vertices --weights "
                  "uniform --sizing uniform --orientation-energy extrinsic -S 32 -k 10"),
            plain);
  for (const char* options : {"--solver random",
                              "--solver jacobi",
                              "--sweeps 2",
                              "--sweeps 6",
                              "--single-level",
                              "-i",
                              "--intrinsic",
                              "--energy intrinsic",
                              "--orientation-energy intrinsic",
                              "--orientation-energy convex",
                              "--graph faces",
                              "--weights geometric",
                              "-S 0",
                              "--smooth 3",
                              "-c off",
                              "--crease 100",
                              "--crease-normals 30",
                              "--curvature 0.5",
                              "--curvature-hard 10",
                              "--bends 0"}) {
    EXPECT_NE(bytes(std::string("-f 500 ") + options), plain) << options;
  }
  EXPECT_EQ(bytes("-f 500 -i"), bytes("-f 500 --energy intrinsic"));
  EXPECT_EQ(bytes("-f 500 -c auto"), plain);
  EXPECT_EQ(bytes("-f 500 -c 40"), plain);
}

TEST_F(Cli, BoundariesAreFollowed) {
  Mesh plate = sample_shape("plate", 0.5);
  for (Vec3& p : plate.positions) p = Vec3(p.x() - p.y(), p.x() + p.y(), 0);
  write_mesh(folder_ / "in.obj", plate);
  const auto angle_sigma = [&](const char* options) { return statistics(options).angle_sigma; };
  EXPECT_EQ(bytes("-f 400 -b"), bytes("-f 400"));
  EXPECT_NE(bytes("-f 400 --free-boundaries"), bytes("-f 400"));
  EXPECT_EQ(bytes("-f 400 -b"), bytes("-f 400 --boundaries"));
  EXPECT_LT(angle_sigma("-f 400 -b -S 0"), 2);
}

/// A line across the plate, in the input itself or in a file of its own.
TEST_F(Cli, Features) {
  Mesh plate = sample_shape("plate", 0.3);
  write_mesh(folder_ / "in.obj", plate);
  const std::string without = bytes("-f 300");
  float x = 1;
  for (const Vec3& p : plate.positions) x = p.x() > 0.1f ? std::min(x, p.x()) : x;
  write("lines.obj", fmt::format("v 9 9 9\nv {} -0.5 0\nv {} 0.5 0\nl -2 -1\n", x, x));
  const std::string with = bytes("-f 300 --features lines.obj");
  EXPECT_NE(with, without);
  const Mesh result = read_mesh(folder_ / "out.obj");
  const auto on_line = [&](const Vec3& p) { return std::abs(p.x() - x) < 1e-5f; };
  EXPECT_GT(std::count_if(result.positions.begin(), result.positions.end(), on_line), 10);

  mark_edges(plate, read_polylines(folder_ / "lines.obj"));
  write_mesh(folder_ / "in.obj", plate);
  EXPECT_EQ(bytes("-f 300"), with);
  EXPECT_EQ(bytes("-f 300 -c off"), without);
  EXPECT_EQ(bytes("-f 300 -c 60"), with);
  EXPECT_NE(run("stats in.obj").out.find("marked edges"), std::string::npos);

  write("off.obj", "v -0.5 0.5 0\nv 0.25 0.5 1\nl 1 2\n");
  expect_refused("in.obj -o no.obj --features off.obj", 1, "off.obj: vertex 2, at (0.25, 0.5, 1)");
  expect_refused("in.obj -o no.obj --features missing.obj", 1, "missing.obj");
  write("none.obj", "v 0 0 0\n");
  expect_refused("in.obj -o no.obj --features none.obj", 1, "none.obj: has no lines");
  expect_refused("in.obj -o no.obj --features lines.obj -c off", 2, "--features");
  expect_refused("none.obj -o no.obj --features lines.obj", 2, "point cloud");
}

TEST_F(Cli, Guides) {
  sample("plate", "in.obj");
  const std::string plain = bytes("-f 300");
  write("stroke.obj", "o Stroke\nv -0.3 -0.3 0\nv 0.3 0.3 0\nl 1 2\n");
  const std::string followed = bytes("-f 300 --guides stroke.obj");
  EXPECT_NE(followed, plain);
  EXPECT_EQ(bytes("-f 300 --guides stroke.obj:1"), followed);
  const std::string drawn = bytes("-f 300 --guides stroke.obj:0.5");
  EXPECT_NE(drawn, followed);
  EXPECT_NE(drawn, plain);
  write("other.obj", "v -0.3 0.3 0\nv 0.3 -0.2 0\nl 1 2\n");
  EXPECT_NE(bytes("-f 300 --guides stroke.obj --guides other.obj:0.5"), followed);
  EXPECT_EQ(bytes("-f 300 --guides stroke.obj:0"), plain);

  write("far.obj", "v -0.3 -0.3 9\nv 0.3 0.3 9\nl 1 2\n");
  EXPECT_NE(run("in.obj -o no.obj --guides far.obj").err.find("guide 1 lies off the surface"),
            std::string::npos);
  EXPECT_NE(run("in.obj -o no.obj --guides in.obj").err.find("has no lines"), std::string::npos);
  EXPECT_EQ(run("in.obj -o no.obj --guides stroke.obj:2").status, 2);
  EXPECT_FALSE(exists("no.obj"));
}

TEST_F(Cli, Sizing) {
  sample("bracket", "in.obj", 0.5);
  const double uniform = statistics("-f 400 -D").area_sigma;
  EXPECT_GT(statistics("-f 400 -D --adaptive 1").area_sigma, 1.3 * uniform);
  EXPECT_EQ(bytes("-f 400 --adaptive 1"), bytes("-f 400 --sizing curvature"));
  EXPECT_GT(statistics("-f 400 -D --sizing curvature").area_sigma, 1.3 * uniform);
  EXPECT_GT(statistics("-f 400 -D --sizing distance:0,0,0").area_sigma, 1.3 * uniform);
  EXPECT_GT(statistics("-f 400 -D --sizing distance:1,-1,.5 --sizing-ratio 8").area_sigma,
            statistics("-f 400 -D --sizing distance:1,-1,.5 --sizing-ratio 2").area_sigma);

  const Mesh cube = sample_shape("cube", 0.5);
  std::string ply = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty "
      "float "
      "z\nproperty float size\nelement face {}\nproperty list uchar int "
      "vertex_indices\nend_header\n",
      cube.positions.size(), cube.faces.size());
  for (const Vec3& p : cube.positions) {
    ply += fmt::format("{} {} {} {}\n", p.x(), p.y(), p.z(), 1.5 + 2 * p.x());
  }
  for (std::size_t f = 0; f < cube.faces.size(); ++f) {
    ply += fmt::format("3 {} {} {}\n", cube.faces[f][0], cube.faces[f][1], cube.faces[f][2]);
  }
  write("in.ply", ply);
  run_well("in.ply -o a.obj -f 300 -D");
  run_well("in.ply -o b.obj -f 300 -D --sizing value:size");
  EXPECT_GT(mesh_statistics(read_mesh(folder_ / "b.obj")).area_sigma,
            1.5 * mesh_statistics(read_mesh(folder_ / "a.obj")).area_sigma);
  run_well("in.ply -o b.obj -f 300 -D --density size");
  EXPECT_GT(mesh_statistics(read_mesh(folder_ / "b.obj")).area_sigma,
            1.3 * mesh_statistics(read_mesh(folder_ / "a.obj")).area_sigma);
  expect_refused("in.ply -o c.obj --sizing value:other", 1, "other");
  expect_refused("in.ply -o c.obj --density other", 1, "other");
  expect_refused("in.ply -o c.obj --density colors", 1, "red");
  expect_refused("in.ply -o c.obj --density size --sizing value:size", 2, "--density");
  expect_refused("in.ply -o c.obj --adaptive 1.1", 2, "--adaptive");
  expect_refused("in.ply -o c.obj --grading 1", 2, "--grading");
  for (const char* wrong :
       {"big", "distance", "distance:1,2", "distance:1,2,x", "value:", "value", "curvature:3"}) {
    expect_refused(std::string("in.ply -o c.obj --sizing ") + wrong, 2, "--sizing");
  }
}

TEST_F(Cli, PointCloudsAndNeighbours) {
  Mesh cloud = sample_shape("sphere", 0.5);
  cloud.faces.clear();
  write_mesh(folder_ / "in.obj", cloud);
  const std::string plain = bytes("-f 400");
  const MeshStatistics s = mesh_statistics(read_mesh(folder_ / "out.obj"));
  EXPECT_EQ(s.boundary_loops, 0u);
  EXPECT_EQ(s.euler, 2);
  EXPECT_NE(bytes("-f 400 -k 6"), plain);
  EXPECT_NE(bytes("-f 400 --knn 16"), plain);
}

/// A sixteenth of its eight vertices would be none.
TEST_F(Cli, ACubeWithoutACountHasHundredsOfFaces) {
  write_mesh(folder_ / "in.obj", sample_shape("cube", 0.1));
  EXPECT_NEAR(static_cast<double>(statistics("").vertices), 500, 25);
  EXPECT_NEAR(static_cast<double>(statistics("--symmetry x --quiet").vertices), 500, 50);
}

TEST_F(Cli, WeldJoinsTorn) {
  const Mesh shape = sample_shape("sphere");
  Mesh torn;
  for (const Index v : shape.faces.corners()) torn.positions.push_back(shape.positions[v]);
  torn.faces = Faces::uniform(shape.faces.size(), 3);
  for (std::size_t c = 0; c < torn.positions.size(); ++c) {
    torn.faces.corners()[c] = static_cast<Index>(c);
  }
  write_mesh(folder_ / "in.obj", torn);
  EXPECT_EQ(statistics("-f 300 --weld").euler, 2);
  // So much is torn that nobody can have meant it.
  const Run plain = run("in.obj -o out.obj -f 300");
  EXPECT_NE(plain.err.find("note: merged"), std::string::npos) << plain.err;
  EXPECT_EQ(statistics("-f 300 --quiet").euler, 2);
  EXPECT_EQ(statistics("-f 300 --symmetry x --quiet").euler, 2);
  // How many faces there are without a count is a matter of the vertices that are left.
  const auto faces = static_cast<double>(std::max<std::size_t>(shape.positions.size() / 16, 500));
  EXPECT_NEAR(static_cast<double>(statistics("--quiet").faces), faces, 0.1 * faces);
  EXPECT_NEAR(static_cast<double>(statistics("--symmetry x --quiet").faces), faces, 0.25 * faces);
}

/// Two halves of a sphere that meet at a seam, as programs write what has two textures.
TEST_F(Cli, NotesTellOfSeams) {
  const Mesh shape = sample_shape("sphere");
  Mesh halves = shape;
  halves.positions.insert(halves.positions.end(), shape.positions.begin(), shape.positions.end());
  const auto count = static_cast<Index>(shape.positions.size());
  for (std::size_t f = 0; f < halves.faces.size(); ++f) {
    const std::span<Index> face = halves.faces[f];
    if (shape.positions[face[0]].z() < 0) continue;
    for (Index& v : face) v += count;
  }
  write_mesh(folder_ / "in.obj", halves);
  const Run kept = run("in.obj -o out.obj -f 300 --no-retries");
  EXPECT_NE(kept.err.find("border edges lie on each other"), std::string::npos) << kept.err;
  EXPECT_EQ(mesh_statistics(read_mesh(folder_ / "out.obj")).components, 2u);
  // The two would pass through each other.
  const Run joined = run("in.obj -o out.obj -f 300");
  EXPECT_NE(joined.err.find("along seams: faces of this size"), std::string::npos) << joined.err;
  EXPECT_EQ(mesh_statistics(read_mesh(folder_ / "out.obj")).euler, 2);
  const Run welded = run("in.obj -o out.obj -f 300 --weld");
  EXPECT_EQ(welded.err, "");
  EXPECT_EQ(mesh_statistics(read_mesh(folder_ / "out.obj")).euler, 2);
}

TEST_F(Cli, NotesSayWhatWasMended) {
  sample("cube", "in.obj");
  write("in.obj", read("in.obj") + "f 1 1 2\nf 1 2 2\nv 5 5 5\n");
  const Run plain = run("in.obj -o out.obj -f 200");
  EXPECT_EQ(plain.status, 0);
  EXPECT_EQ(plain.out, "");
  EXPECT_NE(plain.err.find("meshgrain: note: removed 1 vert"), std::string::npos) << plain.err;
  EXPECT_TRUE(plain.err.starts_with("meshgrain: note: ")) << plain.err;
  run_well("in.obj -o out.obj -f 200 --quiet");
}

TEST_F(Cli, ReportTellsAll) {
  sample("torus", "in.obj");
  run_well("in.obj -o out.obj -f 500 --report report.json --energies --seed 7 -t 2");
  const json report = json::parse(read("report.json"));
  EXPECT_EQ(report["version"], version());
  EXPECT_EQ(report["arguments"][0], "in.obj");
  EXPECT_EQ(report["options"]["seed"], 7);
  EXPECT_EQ(report["options"]["faces"], 500);
  EXPECT_EQ(report["threads"], 2);
  EXPECT_EQ(report["input"]["faces"], sample_shape("torus", 0.3).faces.size());
  EXPECT_GT(report["seconds"].get<double>(), 0);
  EXPECT_GT(report["peak_memory_bytes"].get<std::size_t>(), 0u);
  EXPECT_GT(report["graph"]["levels"].get<int>(), 3);
  EXPECT_GT(report["graph"]["edges"].get<int>(), report["graph"]["nodes"].get<int>());
  EXPECT_TRUE(report["singularities"]["orientation"].is_number());
  EXPECT_EQ(report["output"]["faces"], read_mesh(folder_ / "out.obj").faces.size());
  EXPECT_EQ(report["notes"].size(), 0u);
  const auto levels = report["graph"]["levels"].get<std::size_t>();
  for (const char* field : {"orientation", "position"}) {
    const json& energies = report["energies"][field];
    ASSERT_GE(energies.size(), 6u * (levels - 3) + 2u * 3) << field;
    EXPECT_EQ(energies.back()["level"], 0);
  }
  std::vector<std::string> names;
  for (const json& stage : report["stages"]) {
    names.push_back(stage["name"]);
    EXPECT_GE(stage["seconds"].get<double>(), 0);
  }
  for (const char* name : {"read", "graph", "hierarchy", "orientation field", "position field",
                           "extraction", "smoothing", "write"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), name) > 0, true) << name;
  }
}

TEST_F(Cli, EnergiesAreMeasuredOnlyIfAskedFor) {
  sample("torus", "in.obj");
  run_well("in.obj -o out.obj -f 500 --report report.json");
  const json report = json::parse(read("report.json"));
  EXPECT_TRUE(report["energies"]["orientation"].empty());
  EXPECT_TRUE(report["energies"]["position"].empty());
  expect_refused("in.obj -o out.obj -f 500 --energies", 2, "--report");
}

TEST_F(Cli, MemoryLimitRefusesAtOnce) {
  sample("torus", "in.obj");
  const std::string plain = bytes("-f 500");
  for (const char* limit : {"1G", "1.5G", "900M", "1000000K", "2000000000"}) {
    EXPECT_EQ(bytes(std::string("-f 500 --memory-limit ") + limit), plain) << limit;
  }
  expect_refused("in.obj -o none.obj -f 50000000 --memory-limit 1G", 1, "limit of 1.0 GiB");
  expect_refused("in.obj -o none.obj -f 500 --memory-limit 5M", 1, "limit of 5 MiB");
  for (const char* wrong : {"0", "-1", "G", "1X", "nan", "many"}) {
    expect_refused(std::string("in.obj -o none.obj --memory-limit ") + wrong, 2, "--memory-limit");
  }
}

/// The estimate is an upper bound, but not by much.
TEST_F(Cli, MemoryIsEstimatedFromAbove) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "sanitizers take memory of their own";
#endif
  sample("blob", "mesh.ply", 2);
  sample("blob", "coarse.ply", 0.5);  // of fewer vertices than are asked for
  Mesh cloud = sample_shape("blob", 2);
  cloud.faces.clear();
  write_mesh(folder_ / "cloud.ply", cloud);
  for (const char* options :
       {"mesh.ply", "mesh.ply -f 10000", "mesh.ply -D -f 4000", "mesh.ply -p 6 -f 10000",
        "mesh.ply -f 200", "mesh.ply --adaptive 1 -f 8000", "mesh.ply --regularity 1 -f 10000",
        "coarse.ply -f 40000", "mesh.ply --graph faces -f 8000", "cloud.ply", "cloud.ply -k 20"}) {
    const std::string command = std::string(options) + " -o out.ply -t 2 --quiet";
    run_well(command + " --report report.json");
    const auto peak = json::parse(read("report.json"))["peak_memory_bytes"].get<double>();
    const std::string text = run(command + " --memory-limit 1").err;
    const std::size_t at = text.find("take ") + 5;
    ASSERT_NE(text.find(" MiB", at), std::string::npos) << text;
    const double ratio = std::stod(text.substr(at)) * (1 << 20) / peak;
    EXPECT_GT(ratio, 1) << options;
    EXPECT_LT(ratio, 1.65) << options;
  }
}

/// What is written has the same numbers on the border as what was read.
TEST_F(Cli, LockedBordersAreWrittenAsTheyWere) {
  sample("plate", "in.obj", 0.4);
  run_well("in.obj -o out.obj -f 800 --lock-borders");
  const Mesh before = read_mesh(folder_ / "in.obj"), after = read_mesh(folder_ / "out.obj");
  const std::vector<std::array<Index, 2>> border = border_edges(before);
  EXPECT_EQ(border_edges(after).size(), border.size());
  const std::string text = "\n" + read("in.obj"), written = "\n" + read("out.obj");
  std::size_t found = 0;
  for (std::size_t v = 0, at = 0; v < before.positions.size(); ++v) {
    at = text.find("\nv ", at) + 1;
    const bool on_border =
        std::ranges::any_of(border, [&](const auto& e) { return e[0] == v || e[1] == v; });
    if (!on_border) continue;
    const std::string line = text.substr(at - 1, text.find('\n', at) - at + 2);
    EXPECT_NE(written.find(line), std::string::npos) << line;
    ++found;
  }
  EXPECT_EQ(found, border.size());
  expect_refused("in.obj -o out.obj --lock-borders --hexagons", 1, "hexagons");
  expect_refused("in.obj -o out.obj --lock-borders --symmetry x", 1, "symmetric");
}

TEST_F(Cli, SeveralSizesInOneRun) {
  sample("torus", "in.obj");
  run_well("in.obj -o out.v1.ply --lod 1200,400 --report report.json");
  const json report = json::parse(read("report.json"));
  ASSERT_EQ(report["levels"].size(), 2u);
  const std::size_t counts[] = {1200, 400};
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string name = fmt::format("out.v1_lod{}.ply", k);
    const std::size_t faces = read_mesh(folder_ / name).faces.size();
    EXPECT_NEAR(static_cast<double>(faces) / static_cast<double>(counts[k]), 1, 0.0101);
    EXPECT_EQ(report["levels"][k]["output"]["file"], name);
    EXPECT_EQ(report["levels"][k]["output"]["faces"], faces);
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.v1.ply"));
  expect_refused("in.obj -o out.obj --lod 500,x", 2, "--lod");
  expect_refused("in.obj -o out.obj --lod 500,0", 2, "--lod");
  expect_refused("in.obj -o out.obj --lod -5", 2, "--lod");
  expect_refused("in.obj -o out.obj -f 0", 2, "\"0\" is not a positive number");
  expect_refused("in.obj -o out.obj -f 99999999999", 2, "more than the 4294967295");
  expect_refused("in.obj -o out.obj -s -1", 2, "\"-1\" is not a positive number");
  expect_refused("in.obj -o out.obj --lod 500 -f 100", 2, "--lod");
  expect_refused("in.obj -o out.obj --lod 500 --fields-out f.ply", 2, "--lod");
  expect_refused("in.obj -o out.obj --lod 500,50 --symmetry x", 1, "symmetric");
  expect_refused("in.obj -o none/out.obj --lod 500,50", 1, "none");
}

TEST_F(Cli, ReportDoesNotChangeTheResult) {
  sample("torus", "in.obj");
  const std::string plain = bytes("-f 500");
  EXPECT_EQ(bytes("-f 500 --report report.json --fields-out fields.ply"), plain);
}

TEST_F(Cli, FieldsOutAndIn) {
  sample("torus", "in.obj", 0.4);
  const Mesh first = mesh("-f 500 --fields-out fields.ply");
  const Fields fields = read_fields(folder_ / "fields.ply");
  EXPECT_FALSE(fields.position.points.empty());
  EXPECT_EQ(fields.orientation.rosy, 4);

  // The same mesh comes of them, but for rounding.
  const Run again = run("in.obj -o out.obj -f 500 --seed 9 --fields fields.ply");
  EXPECT_EQ(again.status, 0);
  EXPECT_NE(again.err.find("note: the given positions"), std::string::npos) << again.err;
  const Mesh second = read_mesh(folder_ / "out.obj");
  ASSERT_EQ(second.faces.size(), first.faces.size());
  ASSERT_EQ(second.positions.size(), first.positions.size());
  for (std::size_t v = 0; v < first.positions.size(); ++v) {
    EXPECT_LT((second.positions[v] - first.positions[v]).norm(), 1e-3f);
  }

  // Orientations alone leave the positions to be solved for.
  Fields orientations = fields;
  orientations.position.points.clear();
  write_fields(folder_ / "orientations.ply", orientations);
  EXPECT_LT(near(static_cast<double>(statistics("-f 900 --fields orientations.ply").faces), 900),
            0.1);

  expect_refused("in.obj -o no.obj -p 6 --fields fields.ply", 2, "positions for quads");
  expect_refused("in.obj -o no.obj -r 2 --fields fields.ply", 2, "symmetry 4");
  expect_refused("in.obj -o no.obj --fields missing.ply", 1, "missing.ply");
  expect_refused("in.obj -o no.obj --fields in.obj", 1, "in.obj");

  run_well("in.obj -o out.obj -f 300 --graph faces --fields-out cloud.ply");
  EXPECT_TRUE(read_fields(folder_ / "cloud.ply").surface.is_point_cloud());
}

TEST_F(Cli, WrongUsageIsRefused) {
  sample("cube", "in.obj", 0.2);
  const auto refused = [&](const std::string& options, const std::string& text) {
    expect_refused("in.obj -o out.obj " + options, 2, text);
  };
  refused("-f 100 -v 100", "--vertices");
  refused("-f 100 -s 1", "--scale");
  refused("-v 100 -s 1", "--scale");
  refused("-f 0", "--faces");
  refused("-f -3", "--faces");
  refused("-f many", "--faces");
  refused("-f 1e3", "digits");
  refused("--adaptive 1 --sizing uniform", "--adaptive");
  refused("-s nan", "--scale");
  refused("-s inf", "--scale");
  refused("-c nan", "--crease");
  refused("--symmetry w", "--symmetry");
  refused("--symmetry ''", "--symmetry");
  refused("-c 181", "--crease");
  refused("-c sharp", "auto, marked, off");
  refused("-p 5", "--posy");
  refused("-r 3", "--rosy");
  refused("-r 6", "-p 6");
  refused("-p 6 -r 4", "-r 1, 2 or 6");
  refused("--hexagons -D", "-D");
  refused("--hexagons -p 4", "-p 6");
  refused("--solver best", "blocks");
  refused("--graph edges", "vertices");
  refused("--weights heavy", "uniform");
  refused("--energy convex", "--energy");
  refused("--energy intrinsic -i", "--intrinsic");
  refused("--sweeps 0", "--sweeps");
  refused("-t 0", "--threads");
  refused("-S -1", "--smooth");
  refused("--curvature 2", "--curvature");
  refused("--bends 2", "--bends");
  refused("--nonsense", "--nonsense");
  refused("second.obj", "second.obj");
  refused("--report out.obj", "same name");
  expect_refused("in.obj", 2, "--output");
  expect_refused("-o out.obj", 2, "INPUT");
  expect_refused("", 2, "--help");
}

TEST_F(Cli, FailuresLeaveNoFile) {
  sample("cube", "in.obj", 0.2);
  expect_refused("missing.obj -o out.obj", 1, "missing.obj");
  expect_refused("in.obj -o out.unknown", 1, "out.unknown");
  expect_refused("in.obj -o nowhere/out.obj", 1, "nowhere");
  expect_refused("in.obj -o out.obj --report nowhere/report.json", 1, "nowhere");
  expect_refused("in.obj -o out.obj --fields-out nowhere/fields.ply", 1, "nowhere");
  write_mesh(folder_ / "whole.ply", sample_shape("cube", 0.2));
  const std::string whole = read("whole.ply");
  write("cut.ply", whole.substr(0, whole.size() / 2));
  expect_refused("cut.ply -o out.obj", 1, "cut.ply");
  write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  expect_refused("index.obj -o out.obj", 1, "line 4");
  write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
  expect_refused("nan.obj -o out.obj", 1, "line 2");
  write("what.txt", "hello\n");
  expect_refused("what.txt -o out.obj", 1, "what.txt");
  write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  expect_refused("flat.obj -o out.obj", 1, "surface");
}

TEST(CancelOnInterrupt, CancelsItsContext) {
  Context context;
  {
    const CancelOnInterrupt guard(context);
    EXPECT_EQ(guard.signal(), 0);
    EXPECT_NO_THROW(context.check());
    std::raise(SIGINT);
    EXPECT_EQ(guard.signal(), SIGINT);
    EXPECT_THROW(remesh(sample_shape("cube"), {}, context), Cancelled);
  }
  context.reset();
  const CancelOnInterrupt guard(context);
  EXPECT_EQ(guard.signal(), 0);
  std::raise(SIGTERM);
  EXPECT_THROW(context.check(), Cancelled);
}

TEST_F(Cli, EveryFormatIsWritten) {
  sample("cube", "in.obj", 0.2);
  for (const char* name : {"out.obj", "out.ply", "out.off"}) {
    run_well(std::string("in.obj -f 200 --output ") + name);
    EXPECT_FALSE(read_mesh(folder_ / name).faces.empty());
  }
  run_well("in.obj -f 200 -p 6 --output triangles.stl");
  EXPECT_FALSE(read_mesh(folder_ / "triangles.stl").faces.empty());
  // Two triangles for each quad were not asked for.
  const std::size_t quads = read_mesh(folder_ / "out.obj").faces.size();
  const Run split = run("in.obj -f 200 --output out.stl");
  EXPECT_EQ(split.status, 0);
  EXPECT_EQ(split.err,
            fmt::format("meshgrain: note: STL holds triangles only: {} faces are {} in the "
                        "file\n",
                        quads, 2 * quads));
  EXPECT_EQ(read_mesh(folder_ / "out.stl").faces.size(), 2 * quads);
}

TEST_F(Cli, AFileMayHaveTheNameOfACommand) {
  sample("cube", "stats.ply", 0.2);
  fs::rename(folder_ / "stats.ply", folder_ / "stats");
  run_well("./stats -o out.obj -f 200");
  run_well("-o out2.obj stats -f 200");
  EXPECT_EQ(read("out.obj"), read("out2.obj"));
}

TEST_F(Cli, Stats) {
  sample("bracket", "in.obj");
  run_well("in.obj -o out.obj -f 500 --fields-out fields.ply");
  const MeshStatistics s = mesh_statistics(read_mesh(folder_ / "out.obj"));

  const Run plain = run("stats out.obj");
  EXPECT_EQ(plain.status, 0);
  EXPECT_EQ(plain.err, "");
  EXPECT_NE(plain.out.find(fmt::format("{} quads", s.faces)), std::string::npos) << plain.out;
  EXPECT_EQ(plain.out.find("orientation"), std::string::npos);
  EXPECT_EQ(plain.out.find("distance"), std::string::npos);
  const Run all = run("stats out.obj --against in.obj --fields fields.ply");
  EXPECT_NE(all.out.find("orientation field: "), std::string::npos);
  EXPECT_NE(all.out.find("from input to mesh"), std::string::npos);

  const json numbers =
      json::parse(run("stats --json out.obj --against in.obj --fields fields.ply").out);
  EXPECT_EQ(numbers["vertices"], s.vertices);
  EXPECT_EQ(numbers["singularities"], s.singularities);
  EXPECT_DOUBLE_EQ(numbers["area"]["sigma"].get<double>(), s.area_sigma);
  EXPECT_DOUBLE_EQ(numbers["angle"]["max_mean"].get<double>(), s.angle_max_mean);
  EXPECT_EQ(numbers["euler"], s.euler);
  EXPECT_GT(numbers["orientation_singularities"].get<int>(), 0);
  EXPECT_LT(numbers["distance_to_input"]["mean"].get<double>(), 0.01);
  EXPECT_GT(numbers["distance_from_input"]["max"].get<double>(), 0);
  EXPECT_GT(numbers["diagonal"].get<double>(), 0);

  write("crossing.obj",
        "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0.5 0.5 -1\nv 0.5 0.5 1\nv 3 3 0\nf 1 2 3\nf 4 5 6\n");
  EXPECT_EQ(json::parse(run("stats --json --crossings crossing.obj").out)["crossings"], 1);
  EXPECT_FALSE(json::parse(run("stats --json crossing.obj").out).contains("crossings"));
  EXPECT_NE(run("stats --crossings crossing.obj").out.find("crossings"), std::string::npos);

  expect_refused("stats missing.obj", 1, "missing.obj");
  expect_refused("stats out.obj --against missing.obj", 1, "missing.obj");
  expect_refused("stats", 2, "MESH");
  write("points.obj", "v 0 0 0\nv 1 0 0\n");
  expect_refused("stats points.obj", 1, "point cloud");
}

TEST_F(Cli, Sample) {
  std::string names;
  for (const std::string& name : sample_names()) names += name + "\n";
  EXPECT_EQ(run("sample").out, names);
  run_well("sample torus --resolution 0.3");
  const Mesh torus = read_mesh(folder_ / "torus.obj");
  EXPECT_EQ(torus.faces.size(), sample_shape("torus", 0.3).faces.size());
  run_well("sample cube -o out.stl --resolution 0.2");
  EXPECT_TRUE(exists("out.stl"));
  expect_refused("sample teapot", 2, "teapot");
  expect_refused("sample cube -o cube.unknown", 1, "cube.unknown");
  expect_refused("sample cube --resolution -1", 1, "resolution");
}

TEST_F(Cli, Picture) {
  sample("bracket", "in.obj");
  run_well("picture in.obj plain.png --size 100");
  const std::string plain = read("plain.png");
  EXPECT_TRUE(plain.starts_with("\x89PNG"));
  for (const char* option :
       {"--size 120", "--size 100 80", "--view -1 0 0", "--up 0 0 1", "--zoom 2", "--no-edges"}) {
    const bool sized = std::string(option).starts_with("--size");
    run_well(std::string("picture in.obj other.png ") + option + (sized ? "" : " --size 100"));
    EXPECT_NE(read("other.png"), plain) << option;
  }
  sample("cube", "cube.obj", 0.2);
  run_well("picture cube.obj plain.png --size 400");
  run_well("picture cube.obj other.png --size 400 --no-dots");
  EXPECT_NE(read("other.png"), read("plain.png"));
  expect_refused("picture in.obj", 2, "FILE.png");
  expect_refused("picture in.obj out.jpg", 2, ".png");
  run_well("picture in.obj out.PNG --size 100");
  run_well("picture in.obj out.PNG --size 100 --view 1 -1.4 -.8");  // no option either
  expect_refused("picture missing.obj out.png", 1, "missing.obj");
  expect_refused("picture in.obj out.png --size 0", 1, "pixels");
}

}  // namespace
}  // namespace meshgrain
