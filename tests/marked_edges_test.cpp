// Edges that the input marks, from the file to the result.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "mesh/border.h"
#include "mesh/edges.h"
#include "mesh/weld.h"
#include "meshgrain/clean.h"
#include "meshgrain/error.h"
#include "meshgrain/features.h"
#include "meshgrain/io.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "meshgrain/statistics.h"
#include "meshgrain/surface.h"
#include "meshgrain/symmetry.h"
#include "meshgrain/triangulate.h"
#include "same_topology.h"
#include "util/platform.h"
#include "util/triangle.h"
#include "util/union_find.h"

namespace meshgrain {
namespace {

namespace fs = std::filesystem;
using Edges = std::vector<std::array<Index, 2>>;

class MarkedEdges : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = platform::temporary_beside(fs::path(testing::TempDir()) / "x");
    folder_ += "-marked";
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  Mesh read(const std::string& name, const std::string& bytes) const {
    return read_mesh(file(name, bytes));
  }

  fs::path folder_;
};

/// Vertices of a unit cube: four at the bottom, four of a loop around it that rises by `slope`
/// towards x, four at the top.
std::vector<Vec3> points(float slope) {
  std::vector<Vec3> result;
  const float square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const int layer : {0, 1, 2}) {
    for (const auto& [x, y] : square) {
      result.emplace_back(x, y, layer == 1 ? 0.3f + slope * x : 0.5f * static_cast<float>(layer));
    }
  }
  return result;
}

std::string points_as_obj(float slope) {
  std::string text;
  for (const Vec3& p : points(slope)) text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
  return text;
}

constexpr const char* lower_faces = "f 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
constexpr const char* upper_faces =
    "f 9 10 11 12\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n";
const Edges loop = {{4, 5}, {4, 7}, {5, 6}, {6, 7}};

Mesh marked_cube(float slope) {
  Mesh mesh;
  mesh.positions = points(slope);
  for (const auto& face : {std::array<Index, 4>{3, 2, 1, 0},
                           {0, 1, 5, 4},
                           {1, 2, 6, 5},
                           {2, 3, 7, 6},
                           {3, 0, 4, 7},
                           {8, 9, 10, 11},
                           {4, 5, 9, 8},
                           {5, 6, 10, 9},
                           {6, 7, 11, 10},
                           {7, 4, 8, 11}}) {
    mesh.faces.push_back(face);
  }
  mesh.marked_edges = loop;
  return mesh;
}

Edges sorted(Edges edges) {
  for (auto& edge : edges) std::sort(edge.begin(), edge.end());
  std::sort(edges.begin(), edges.end());
  return edges;
}

double length_of(const Mesh& mesh, const Edges& edges) {
  double sum = 0;
  for (const auto& [a, b] : edges) sum += (mesh.positions[a] - mesh.positions[b]).norm();
  return sum;
}

/// Whether all marked edges are edges of faces, each once.
void expect_of_faces(const Mesh& mesh) {
  std::set<std::array<Index, 2>> all;
  for (const Edge& edge : edges_of(mesh)) all.insert({edge.a, edge.b});
  const Edges marks = sorted(mesh.marked_edges);
  for (const auto& edge : marks) EXPECT_TRUE(all.contains(edge)) << edge[0] << " " << edge[1];
  EXPECT_EQ(std::adjacent_find(marks.begin(), marks.end()), marks.end());
}

/// The largest distance of points along the marked edges of a mesh to the edges of another.
double farthest_from_edges(const Mesh& marked, const Mesh& output) {
  const std::vector<Edge> edges = edges_of(output);
  const Vec3 shift = (marked.origin - output.origin).cast<float>();
  double worst = 0;
  for (const auto& [a, b] : marked.marked_edges) {
    constexpr int samples = 64;
    for (int k = 0; k <= samples; ++k) {
      const float t = static_cast<float>(k) / samples;
      const Vec3 p = (1 - t) * marked.positions[a] + t * marked.positions[b] + shift;
      float least = 1e30f;
      for (const Edge& edge : edges) {
        const Vec3 q =
            closest_point_on_segment<Vec3>(p, output.positions[edge.a], output.positions[edge.b]);
        least = std::min(least, (q - p).squaredNorm());
      }
      worst = std::max(worst, std::sqrt(static_cast<double>(least)));
    }
  }
  return worst;
}

// --------------------------------------------------------------------------------------- reading

TEST_F(MarkedEdges, LinesOfObj) {
  const Mesh mesh = read("a.obj", "l 5 6/1 7\n" + points_as_obj(0) + lower_faces + upper_faces +
                                      "l -5 -8\nl 8 7 8\nl 3\n");
  EXPECT_EQ(sorted(mesh.marked_edges), sorted({{4, 5}, {5, 6}, {7, 4}, {7, 6}, {6, 7}}));
  EXPECT_EQ(mesh_statistics(mesh).marked_edges, 4u);
}

TEST_F(MarkedEdges, MaterialsOfObj) {
  const std::string vertices = points_as_obj(0);
  EXPECT_EQ(
      sorted(read("a.obj", vertices + "usemtl a b\n" + lower_faces + "usemtl c\n" + upper_faces)
                 .marked_edges),
      loop);
  // Faces before the first material have none.
  EXPECT_EQ(sorted(read("b.obj", vertices + lower_faces + "usemtl a\n" + upper_faces).marked_edges),
            loop);
  // A comment needs a blank before it: names may have the sign within.
  EXPECT_EQ(sorted(read("d.obj", vertices + "usemtl m#1\n" + lower_faces + "usemtl m#2 # two\n" +
                                     upper_faces)
                       .marked_edges),
            loop);
  EXPECT_TRUE(
      read("e.obj", vertices + "usemtl m#2\n" + lower_faces + "usemtl m#2 # two\n" + upper_faces)
          .marked_edges.empty());
  EXPECT_TRUE(read("c.obj", vertices + "usemtl a\n" + lower_faces + "usemtl a\n" + upper_faces)
                  .marked_edges.empty());
}

/// Normals that go around the cube smoothly, above the loop and below it, but not across.
std::string split_cube(const char* below, const char* above) {
  std::string text = points_as_obj(0);
  for (const Vec3& p : points(0)) {
    const Vec3 n(p.x() - 0.5f, p.y() - 0.5f, p.z() - 0.5f);
    text += fmt::format("vn {} {} {}\n", n.x(), n.y(), n.z());
  }
  text += fmt::format("vn {}\nvn {}\n", below, above);
  const auto shaded = [](std::string faces, const char* normal) {
    std::string result;
    for (std::size_t at = 0; at < faces.size();) {
      const std::size_t end = faces.find_first_of(" \n", at);
      const std::string word = faces.substr(at, end - at);
      const bool on_loop = word == "5" || word == "6" || word == "7" || word == "8";
      result += word == "f" ? word : word + "//" + (on_loop ? normal : word.c_str());
      result += faces[end];
      at = end + 1;
    }
    return result;
  };
  return text + shaded(lower_faces, "13") + shaded(upper_faces, "-1");
}

TEST_F(MarkedEdges, SplitNormalsOfObj) {
  EXPECT_EQ(sorted(read("a.obj", split_cube("0 0 -1", "0 0 1")).marked_edges), loop);
  // The same by value, whatever their indices and lengths.
  EXPECT_TRUE(read("b.obj", split_cube("0 0 1", "0 0 2")).marked_edges.empty());
  // None where a normal is none.
  EXPECT_TRUE(read("c.obj", split_cube("0 0 1", "0 0 0")).marked_edges.empty());
}

/// A mesh as OBJ, with a normal for each corner: the mean of the faces around its vertex up to the
/// hard edges.
std::string shaded(const Mesh& mesh, const Edges& hard) {
  std::string text;
  for (const Vec3& p : mesh.positions) text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
  const Edges sharp = sorted(hard);
  const auto corner = [&](std::size_t f, Index v) {
    const auto face = mesh.faces[f];
    return static_cast<Index>(mesh.faces.first(f)) +
           static_cast<Index>(std::find(face.begin(), face.end(), v) - face.begin());
  };
  UnionFind fans(mesh.faces.corners().size());
  const auto is_smooth = [&](const InnerEdge& edge) {
    return !std::binary_search(sharp.begin(), sharp.end(), edge.ends);
  };
  for (const InnerEdge& edge : inner_edges(mesh, is_smooth)) {
    for (const Index v : edge.ends) fans.unite(corner(edge.left, v), corner(edge.right, v));
  }
  std::vector<Vec3> normals(mesh.faces.corners().size(), Vec3::Zero());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto face = mesh.faces[f];
    const Vec3 n = (mesh.positions[face[1]] - mesh.positions[face[0]])
                       .cross(mesh.positions[face[2]] - mesh.positions[face[0]]);
    for (const Index v : face) normals[fans.find(corner(f, v))] += n;
  }
  std::size_t count = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    std::string line = "f";
    for (const Index v : mesh.faces[f]) {
      const Vec3 n = normals[fans.find(corner(f, v))].normalized();
      text += fmt::format("vn {:.4f} {:.4f} {:.4f}\n", n.x(), n.y(), n.z());
      line += fmt::format(" {}//{}", v + 1, ++count);
    }
    text += line + "\n";
  }
  return text;
}

TEST_F(MarkedEdges, FlatAndSmoothShadingMarkNothing) {
  for (const char* name : {"blob", "sphere", "cylinder", "cube"}) {
    const Mesh mesh = sample_shape(name, 0.5);
    EXPECT_TRUE(read("smooth.obj", shaded(mesh, {})).marked_edges.empty()) << name;
    EXPECT_TRUE(read("flat.obj", shaded(mesh, crease_edges(mesh, 0))).marked_edges.empty()) << name;
  }
}

/// Programs split normals where faces meet at more than an angle: on a coarse or a rough shape that
/// is no modeller's choice.
TEST_F(MarkedEdges, NormalsSplitByAnAngleMarkNothing) {
  Mesh rough = sample_shape("blob", 0.5);
  const auto step = static_cast<float>(0.3 * edge_lengths(rough).mean);
  for (std::size_t v = 0; v < rough.positions.size(); ++v) {
    const auto x = static_cast<float>(v);
    rough.positions[v] +=
        step * Vec3(std::sin(12.9f * x), std::sin(78.2f * x), std::sin(37.7f * x));
  }
  for (const double degrees : {10, 20, 30, 45}) {
    const Edges hard = crease_edges(rough, degrees);
    ASSERT_GT(hard.size(), 50u);
    EXPECT_TRUE(read("a.obj", shaded(rough, hard)).marked_edges.empty()) << degrees;
  }
}

/// A cylinder with smooth sides and hard rims, or only one.
TEST_F(MarkedEdges, HardEdgesAreThoseOfTheModeller) {
  const Mesh mesh = sample_shape("cylinder", 0.5);
  Edges rims = crease_edges(mesh, 60);
  EXPECT_EQ(sorted(read("a.obj", shaded(mesh, rims)).marked_edges), sorted(rims));
  const std::size_t both = rims.size();
  std::erase_if(rims, [&](const auto& edge) { return mesh.positions[edge[0]].y() < 0; });
  EXPECT_EQ(2 * rims.size(), both);
  EXPECT_EQ(sorted(read("b.obj", shaded(mesh, rims)).marked_edges), sorted(rims));
}

/// Exporters may give each face vertices of its own.
TEST_F(MarkedEdges, HardEdgesAreFoundAfterWelding) {
  const Mesh mesh = sample_shape("cylinder", 0.5);
  const std::string shared = shaded(mesh, crease_edges(mesh, 60));
  std::string vertices, faces;
  std::size_t count = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    faces += "f";
    for (const Index v : mesh.faces[f]) {
      const Vec3& p = mesh.positions[v];
      vertices += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
      ++count;
      faces += fmt::format(" {}//{}", count, count);
    }
    faces += "\n";
  }
  for (std::size_t at = 0; (at = shared.find("vn", at)) != shared.npos; ++at) {
    vertices += shared.substr(at, shared.find('\n', at) + 1 - at);
  }
  ReadOptions options;
  options.weld = true;
  const Mesh welded = read_mesh(file("a.obj", vertices + faces), options);
  EXPECT_EQ(welded.positions.size(), mesh.positions.size());
  EXPECT_EQ(sorted(welded.marked_edges), sorted(crease_edges(welded, 60)));
  EXPECT_FALSE(welded.marked_edges.empty());
}

TEST_F(MarkedEdges, AreWrittenAndReadAgain) {
  const Mesh mesh = marked_cube(0.1f);
  for (const char* name : {"a.obj", "a.ply"}) {
    write_mesh(folder_ / name, mesh);
    const Mesh again = read_mesh(folder_ / name);
    EXPECT_EQ(sorted(again.marked_edges), loop) << name;
    EXPECT_EQ(again.faces.size(), mesh.faces.size());
  }
}

// ----------------------------------------------------------------------------------- before
// remeshing

TEST_F(MarkedEdges, AreCleaned) {
  Mesh mesh = marked_cube(0);
  mesh.positions.insert(mesh.positions.begin(), Vec3(9, 9, 9));  // unused
  for (Index& v : mesh.faces.corners()) ++v;
  mesh.marked_edges = {{6, 5}, {5, 6}, {7, 6}, {7, 7}, {5, 7}, {0, 5}};  // two are of no face
  const CleanReport report = clean(mesh);
  EXPECT_EQ(report.loose_marks, 2u);
  EXPECT_EQ(mesh.marked_edges, (Edges{{4, 5}, {5, 6}}));
}

TEST_F(MarkedEdges, SurviveWelding) {
  // Two halves that share no vertex.
  Mesh mesh = marked_cube(0);
  const Mesh whole = mesh;
  for (std::size_t f = 5; f < mesh.faces.size(); ++f) {
    for (Index& v : mesh.faces[f]) v += 12;
  }
  mesh.positions.insert(mesh.positions.end(), whole.positions.begin(), whole.positions.end());
  for (const auto& [a, b] : whole.marked_edges) mesh.marked_edges.push_back({a + 12, b + 12});
  weld(mesh);
  clean(mesh);
  EXPECT_EQ(mesh.marked_edges, loop);
}

TEST_F(MarkedEdges, SurviveTrianglesSubdivisionAndOrder) {
  Mesh mesh = triangulate(marked_cube(0.25f));
  EXPECT_EQ(mesh.marked_edges, loop);
  const double length = length_of(mesh, mesh.marked_edges);
  subdivide(mesh, 0.07);
  EXPECT_GT(mesh.marked_edges.size(), 4 * 14u);
  EXPECT_NEAR(length_of(mesh, mesh.marked_edges), length, 1e-5);
  expect_of_faces(mesh);
  sort_along_curve(mesh);
  EXPECT_NEAR(length_of(mesh, mesh.marked_edges), length, 1e-5);
  expect_of_faces(mesh);
}

TEST_F(MarkedEdges, OfSmallPiecesGoWithThem) {
  Mesh mesh = marked_cube(0);
  const Mesh large = mesh;
  for (Vec3& p : mesh.positions) p *= 0.1f;
  for (std::size_t f = 0; f < large.faces.size(); ++f) {
    std::vector<Index> face(large.faces[f].begin(), large.faces[f].end());
    for (Index& v : face) v += 12;
    mesh.faces.push_back(face);
  }
  mesh.positions.insert(mesh.positions.end(), large.positions.begin(), large.positions.end());
  for (const auto& [a, b] : large.marked_edges) mesh.marked_edges.push_back({a + 12, b + 12});
  EXPECT_EQ(drop_small_pieces(mesh, 1), 1u);
  EXPECT_EQ(sorted(mesh.marked_edges), loop);
}

TEST_F(MarkedEdges, AreCutAtAMirrorPlaneAndMirrored) {
  Mesh mesh = marked_cube(0.2f);
  cut_at(mesh, {1, 0.5, 0});
  expect_of_faces(mesh);
  EXPECT_NEAR(length_of(mesh, mesh.marked_edges), 1 + std::hypot(1, 0.2), 1e-5);
  for (const auto& edge : mesh.marked_edges) {
    for (const Index v : edge) {
      EXPECT_NEAR(mesh.positions[v].z(), 0.3 + 0.2 * mesh.positions[v].x(), 1e-6);
    }
  }
  add_mirror_image(mesh, 1, 1e-6);
  expect_of_faces(mesh);
  EXPECT_NEAR(length_of(mesh, mesh.marked_edges), 2 + 2 * std::hypot(1, 0.2), 1e-5);
}

// ------------------------------------------------------------------------------------ feature
// lines

FeatureLines features_of(const Mesh& mesh, const FeatureOptions& options = {}) {
  return find_features(triangulate(mesh), options, 0.1);
}

TEST_F(MarkedEdges, AreFeatureLines) {
  const Mesh mesh = marked_cube(0);
  const FeatureLines lines = features_of(mesh);
  EXPECT_EQ(lines.size(), 20u);  // of the cube's 12 edges the loop parts 4; the loop has 4
  EXPECT_EQ(lines.corners.size(), 12u);
  const FeatureLines alone = features_of(mesh, {Creases::by_angle, 170});
  EXPECT_EQ(alone.size(), 4u);
  EXPECT_TRUE(features_of(mesh, {Creases::none}).empty());
}

TEST_F(MarkedEdges, ThatAreCreasesOrBorderCountOnce) {
  Mesh mesh = sample_shape("cylinder");
  const FeatureLines creases = features_of(mesh);
  mesh.marked_edges = crease_edges(mesh, 60);
  mesh.marked_edges.resize(mesh.marked_edges.size() /
                           3);  // a crease that is marked in part goes on
  EXPECT_EQ(features_of(mesh).vertices, creases.vertices);
  EXPECT_EQ(features_of(mesh).corners, creases.corners);

  Mesh plate = sample_shape("plate");
  const FeatureLines border = features_of(plate);
  plate.marked_edges = border_edges(plate);
  plate.marked_edges.push_back({0, 200});  // no edge
  const FeatureLines marked = features_of(plate, {.align_border = false});
  EXPECT_EQ(marked.vertices, border.vertices);
  for (const float aligned : marked.align) EXPECT_EQ(aligned, 0);
}

// ---------------------------------------------------------------------------------------- results

TEST_F(MarkedEdges, AreCoveredByEdgesOfTheResult) {
  for (const float slope : {0.0f, 0.3f}) {
    const Mesh cube = marked_cube(slope);
    for (const std::size_t count : {500, 5000}) {
      for (const OutputFaces faces :
           {OutputFaces::quads, OutputFaces::quad_dominant, OutputFaces::triangles}) {
        SCOPED_TRACE(fmt::format("{} {} {}", slope, count, static_cast<int>(faces)));
        RemeshOptions options;
        options.faces = faces;
        options.face_count = count;
        const RemeshResult result = remesh(cube, options);
        EXPECT_TRUE(result.report.notes.empty());
        made::expect_same_topology(mesh_statistics(result.mesh), mesh_statistics(cube));
        EXPECT_LT(farthest_from_edges(cube, result.mesh), 1e-4);
      }
    }
    // Nothing else would bring edges there.
    RemeshOptions options;
    options.face_count = 5000;
    options.features.creases = Creases::none;
    EXPECT_GT(farthest_from_edges(cube, remesh(cube, options).mesh), 1e-3);
  }
}

TEST_F(MarkedEdges, OfEveryKindOfFileAreCovered) {
  Mesh cube = marked_cube(0);
  write_mesh(folder_ / "marked.ply", cube);
  const std::string vertices = points_as_obj(0);
  file("lines.obj", vertices + lower_faces + upper_faces + "l 5 6 7 8 5\n");
  file("materials.obj", vertices + "usemtl a\n" + lower_faces + "usemtl b\n" + upper_faces);
  file("normals.obj", split_cube("0 0 -1", "0 0 1"));
  RemeshOptions options;
  options.face_count = 500;
  const Mesh expected = remesh(cube, options).mesh;
  EXPECT_LT(farthest_from_edges(cube, expected), 1e-4);
  for (const char* name : {"marked.ply", "lines.obj", "materials.obj", "normals.obj"}) {
    EXPECT_EQ(remesh(read_mesh(folder_ / name), options).mesh.positions, expected.positions)
        << name;
  }
}

/// The circle on top of a torus, which the result's edges follow as chords.
TEST_F(MarkedEdges, AreCoveredWhereTheSurfaceIsRound) {
  Mesh torus = sample_shape("torus");
  float top = 0;
  for (const Vec3& p : torus.positions) top = std::max(top, p.z());
  for (const Edge& edge : edges_of(torus)) {
    const bool on_top = std::min(torus.positions[edge.a].z(), torus.positions[edge.b].z()) == top;
    if (on_top) torus.marked_edges.push_back({edge.a, edge.b});
  }
  ASSERT_EQ(torus.marked_edges.size(), 80u);
  const FeatureLines lines = features_of(torus);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines.is_closed(0));
  RemeshOptions options;
  options.face_count = 3000;
  const Mesh result = remesh(torus, options).mesh;
  const double edge = edge_lengths(result).max, own = 2 * std::numbers::pi / 80;
  EXPECT_LT(farthest_from_edges(torus, result), (edge * edge + own * own) / 8);  // radius 1
}

TEST_F(MarkedEdges, AreCoveredInSymmetricResults) {
  Mesh cube = marked_cube(0.3f);
  for (Vec3& p : cube.positions) p.y() += 3;
  RemeshOptions options;
  options.face_count = 1000;
  options.symmetry.axes[1] = true;
  const RemeshResult result = remesh(cube, options);
  EXPECT_EQ(result.report.notes, std::vector<std::string>{"made symmetric across y"});
  EXPECT_LT(farthest_from_edges(cube, result.mesh), 1e-4);
}

TEST_F(MarkedEdges, ThatNoFaceHasAreTold) {
  Mesh cube = marked_cube(0);
  cube.marked_edges.push_back({4, 6});
  RemeshOptions options;
  options.face_count = 300;
  EXPECT_EQ(remesh(cube, options).report.notes,
            std::vector<std::string>{"removed 1 marked edges that no face has"});
}

// ----------------------------------------------------------------------------------- mark_edges()

Polylines polyline(const std::vector<Eigen::Vector3d>& points) {
  Polylines lines;
  lines.points = points;
  for (Index p = 0; p < points.size(); ++p) lines.vertices.push_back(p);
  lines.starts.push_back(static_cast<Index>(points.size()));
  return lines;
}

TEST_F(MarkedEdges, AreFoundAlongLines) {
  Mesh mesh = marked_cube(0);
  mesh.marked_edges.clear();
  mesh.origin = {1e6, 0, 0};
  Polylines lines =
      polyline({{1e6, 0, 0.3}, {1e6 + 1 + 1e-5, 1e-5, 0.3}, {1e6 + 1, 1, 0.3}, {1e6, 1, 0.3}});
  lines.points.push_back({0, 0, 0});  // of no line
  mark_edges(mesh, lines);
  EXPECT_EQ(sorted(mesh.marked_edges), sorted({{4, 5}, {5, 6}, {6, 7}}));
}

/// Vertices that no edge joins: the shortest way between them, and in a grid, where many are
/// equally short, one near the straight line.
TEST_F(MarkedEdges, AreTheShortestWayBetweenPoints) {
  Mesh cube = marked_cube(0);
  cube.marked_edges.clear();
  mark_edges(cube, polyline({{0, 0, 0}, {0, 0, 1}}));  // down to the loop, and on
  EXPECT_EQ(sorted(cube.marked_edges), (Edges{{0, 4}, {4, 8}}));

  Mesh grid;
  constexpr Index n = 11;
  for (Index i = 0; i < n * n; ++i) {
    grid.positions.emplace_back(static_cast<float>(i % n), static_cast<float>(i / n), 0.0f);
  }
  for (Index y = 0; y + 1 < n; ++y) {
    for (Index x = 0; x + 1 < n; ++x) {
      const Index v = y * n + x;
      grid.faces.push_back({v, v + 1, v + n + 1, v + n});
    }
  }
  mark_edges(grid, polyline({{0, 0, 0}, {10, 10, 0}}));
  EXPECT_EQ(grid.marked_edges.size(), 20u);
  for (const auto& edge : grid.marked_edges) {
    for (const Index v : edge) {
      EXPECT_LT(std::abs(grid.positions[v].x() - grid.positions[v].y()), 1.5f);
    }
  }
}

TEST_F(MarkedEdges, LinesOffTheMeshAreRefused) {
  const auto error_of = [](Mesh mesh, const Polylines& lines) -> std::string {
    try {
      mark_edges(mesh, lines);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  const Mesh cube = marked_cube(0);
  EXPECT_EQ(error_of(cube, polyline({{0, 0, 0}, {0, 0, 0.301}})),
            "vertex 2, at (0, 0, 0.301), lies at no vertex of the mesh: the nearest is 0.001 away");
  Mesh two = cube;
  two.positions.insert(two.positions.end(), {Vec3(5, 0, 0), Vec3(6, 0, 0), Vec3(5, 1, 0)});
  two.faces.push_back({12, 13, 14});
  EXPECT_EQ(error_of(two, polyline({{0, 0, 0}, {5, 0, 0}})),
            "no edges of the mesh lead from vertex 1 to vertex 2");
  Mesh cloud = cube;
  cloud.faces.clear();
  EXPECT_EQ(error_of(cloud, polyline({{0, 0, 0}, {1, 0, 0}})),
            "edges can only be marked of a mesh: the input has no faces");
}

}  // namespace
}  // namespace meshgrain
