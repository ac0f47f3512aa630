#include "meshgrain/io.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "io/output.h"
#include "mesh/weld.h"
#include "meshgrain/error.h"
#include "meshgrain/shapes.h"
#include "util/platform.h"

namespace meshgrain {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;
using Polygons = std::vector<std::vector<Index>>;

/// Gives every test a folder of its own.
class Io : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = platform::temporary_beside(fs::path(testing::TempDir()) / "x");
    folder_ += std::string("-") + info->name();
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path file(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  Mesh read(const std::string& name, const std::string& bytes,
            const ReadOptions& options = {}) const {
    return read_mesh(file(name, bytes), options);
  }
  /// What reading such a file throws, without the folder.
  std::string error_of(const std::string& name, const std::string& bytes,
                       const ReadOptions& options = {}) const {
    file(name, bytes);
    return error_of_reading(name, options);
  }
  std::string error_of_reading(const std::string& name, const ReadOptions& options = {}) const {
    try {
      read_mesh(folder_ / name, options);
    } catch (const Error& error) {
      return without_folder(error);
    }
    return "no error";
  }
  std::string error_of_writing(const std::string& name, const Mesh& mesh) const {
    try {
      write_mesh(folder_ / name, mesh);
    } catch (const Error& error) {
      return without_folder(error);
    }
    return "no error";
  }
  std::string without_folder(const Error& error) const {
    std::string text = error.what();
    EXPECT_EQ(text.find('\n'), text.npos) << text;
    const std::string prefix = folder_.string() + "/";
    for (std::size_t at = 0; (at = text.find(prefix)) != text.npos;) text.erase(at, prefix.size());
    return text;
  }
  std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

Polygons polygons(const Mesh& mesh) {
  Polygons all;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    all.emplace_back(mesh.faces[f].begin(), mesh.faces[f].end());
  }
  return all;
}

/// The least that every mesh that was read must keep to.
void expect_valid(const Mesh& mesh) {
  EXPECT_FALSE(mesh.positions.empty());
  for (const Vec3& p : mesh.positions) ASSERT_TRUE(p.allFinite());
  EXPECT_TRUE(mesh.origin.allFinite());
  EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  for (const Vec3& n : mesh.normals) ASSERT_TRUE(n.allFinite());
  EXPECT_TRUE(mesh.values.empty() || mesh.values.size() == mesh.positions.size());
  for (const float value : mesh.values) ASSERT_TRUE(std::isfinite(value));
  for (const Index v : mesh.faces.corners()) ASSERT_LT(v, mesh.positions.size());
  for (const auto& edge : mesh.marked_edges) {
    for (const Index v : edge) ASSERT_LT(v, mesh.positions.size());
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) ASSERT_GE(mesh.faces.degree(f), 3u);
}

/// A quad and two triangles over numbers that decimals hold only when printed in full.
Mesh sample() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0.1f}, {1, 1, 1.0f / 3}, {0, 1, -1e-7f}, {2, 0.7f, 1e6f}};
  mesh.faces.push_back({0, 1, 2, 3});
  mesh.faces.push_back({1, 4, 2});
  mesh.faces.push_back({2, 4, 3});
  return mesh;
}

Mesh marked_sample() {
  Mesh mesh = sample();
  mesh.marked_edges = {{0, 1}, {1, 2}};
  return mesh;
}

Mesh sample_points() {
  Mesh mesh;
  mesh.positions = sample().positions;
  mesh.normals.assign(mesh.positions.size(), Vec3(0, 0, 1));
  mesh.normals[2] = Vec3(0.3f, -0.2f, 0.9f).normalized();
  return mesh;
}

template <class T>
std::string bytes_of(T value, std::endian order = std::endian::little) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// `text` with the first `old` in it replaced.
std::string replaced(const std::string& text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  return text.substr(0, at) + by + text.substr(at + old.size());
}

// ------------------------------------------------------------------------------- round trips

TEST_F(Io, FacesSurviveARoundTrip) {
  for (const char* name : {"a.obj", "a.ply", "a.off", "UPPER.PLY"}) {
    SCOPED_TRACE(name);
    write_mesh(folder_ / name, sample());
    const Mesh mesh = read_mesh(folder_ / name);
    EXPECT_EQ(mesh.positions, sample().positions);
    EXPECT_EQ(polygons(mesh), polygons(sample()));
    EXPECT_TRUE(mesh.normals.empty());
  }
}

TEST_F(Io, PointsAndNormalsSurviveARoundTrip) {
  for (const char* name : {"a.obj", "a.ply", "a.off"}) {
    SCOPED_TRACE(name);
    write_mesh(folder_ / name, sample_points());
    const Mesh mesh = read_mesh(folder_ / name);
    EXPECT_TRUE(mesh.is_point_cloud());
    EXPECT_EQ(mesh.positions, sample_points().positions);
    EXPECT_EQ(mesh.normals, sample_points().normals);
  }
}

TEST_F(Io, StlSplitsQuadsAndIsWelded) {
  write_mesh(folder_ / "a.stl", sample());
  EXPECT_EQ(fs::file_size(folder_ / "a.stl"), 84u + 4 * 50);
  const Mesh mesh = read_mesh(folder_ / "a.stl");
  EXPECT_EQ(mesh.positions.size(), 5u);
  EXPECT_EQ(mesh.faces.size(), 4u);
  EXPECT_EQ(mesh.faces.uniform_degree(), 3u);
  expect_valid(mesh);
}

TEST_F(Io, StlSplitsQuadsAlongTheShorterDiagonal) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {4, -1, 0}, {8, 0, 0}, {4, 1, 0}};
  mesh.faces.push_back({0, 1, 2, 3});
  write_mesh(folder_ / "a.stl", mesh);
  const Mesh split = read_mesh(folder_ / "a.stl");
  ASSERT_EQ(split.faces.size(), 2u);
  for (const auto& face : polygons(split)) {
    float area = 0;
    const Vec3 &a = split.positions[face[0]], &b = split.positions[face[1]],
               &c = split.positions[face[2]];
    area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    EXPECT_EQ(area, 8);
  }
}

TEST_F(Io, LongPolygonsSurvivePly) {
  Mesh mesh;
  std::vector<Index> face(300);
  for (Index v = 0; v < face.size(); ++v) {
    face[v] = v;
    const float angle = 0.02f * static_cast<float>(v);
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.0f);
  }
  mesh.faces.push_back(face);
  write_mesh(folder_ / "a.ply", mesh);
  EXPECT_EQ(polygons(read_mesh(folder_ / "a.ply")), Polygons{face});
}

TEST_F(Io, ManyVerticesCrossTheBuffer) {
  Mesh mesh;
  for (float x = 0; x < 200000; ++x) mesh.positions.emplace_back(x, 0.1f * x, 3.7f - x);
  for (Index i = 0; i + 2 < 200000; ++i) mesh.faces.push_back({i, i + 1, i + 2});
  for (const char* name : {"a.obj", "a.ply", "a.off"}) {
    write_mesh(folder_ / name, mesh);
    const Mesh back = read_mesh(folder_ / name);
    EXPECT_EQ(back.positions, mesh.positions);
    EXPECT_TRUE(std::ranges::equal(back.faces.corners(), mesh.faces.corners()));
  }
}

// ------------------------------------------------------------------------------------- origin

TEST_F(Io, FarFromZeroGetsAnOrigin) {
  const std::string text =
      "v 4500000.0625 5400000.125 100\nv 4500001.0625 5400000.125 100\n"
      "v 4500001.0625 5400001.125 100.001\nf 1 2 3\n";
  const Mesh mesh = read("map.obj", text);
  EXPECT_NEAR(mesh.origin.x(), 4500000.5, 0.5);
  EXPECT_EQ(mesh.origin.cast<float>().cast<double>(), mesh.origin);
  const Eigen::Vector3d p = mesh.positions[2].cast<double>() + mesh.origin;
  EXPECT_NEAR(p.z(), 100.001, 1e-6);
  EXPECT_EQ(p.x(), 4500001.0625);

  for (const char* name : {"a.obj", "a.ply", "a.off"}) {
    SCOPED_TRACE(name);
    write_mesh(folder_ / name, mesh);
    const Mesh back = read_mesh(folder_ / name);
    EXPECT_EQ(back.origin, mesh.origin);
    EXPECT_EQ(back.positions, mesh.positions);
  }
}

TEST_F(Io, NearZeroKeepsItsNumbers) {
  const Mesh mesh = read("a.obj", "v 10 0 0\nv 10.01 0 0\nv 11 0.1 0\nf 1 2 3\n");
  EXPECT_TRUE(mesh.origin.isZero(0));
  EXPECT_EQ(mesh.positions[1].x(), 10.01f);
}

TEST_F(Io, FarVerticesThatTurnOutNearKeepTheirNumbers) {
  // The first vertices alone would be far from zero.
  std::string text;
  for (int i = 0; i < 100; ++i) text += fmt::format("v 100 {} 0\n", 0.01 * i);
  const Mesh mesh = read("a.obj", text + "v 0.3 0 0\n");
  EXPECT_TRUE(mesh.origin.isZero(0));
  EXPECT_EQ(mesh.positions[7], Vec3(100, 0.07f, 0));
  EXPECT_EQ(mesh.positions.back(), Vec3(0.3f, 0, 0));
}

// ---------------------------------------------------------------------------------------- OBJ

TEST_F(Io, ObjTakesAllFormsOfIndices) {
  const Mesh mesh = read("a.obj",
                         "# comment\nmtllib x.mtl\nv 0 0 0\nv 1 0 0 1.0\nv\t1 1 0 0.5 0.5 0.5\n"
                         "v +0 1e0 .0 # up\nvt 0 0\nvn 0 0 1\ng part\ns 1\nusemtl m\n"
                         "f 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1 4/1/1\n"
                         "f -4 -3 -2 -1\nf -4/-1/-1 2 -2//-1\nf 1 2\nl 1 2\np 1\n");
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_EQ(polygons(mesh),
            (Polygons{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2, 3}, {0, 1, 2, 3}, {0, 1, 2}}));
}

TEST_F(Io, ObjContinuesLines) {
  const Mesh mesh = read("a.obj",
                         "# no continuation \\\nv 0 0 \\\n0\nv 1 0 0\r\nv 1 1 0\n"
                         "f 1 \\\r\n 2\\\n 3");
  EXPECT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(polygons(mesh), (Polygons{{0, 1, 2}}));
}

TEST_F(Io, ObjMayNameVerticesBeforeTheyCome) {
  const Mesh mesh = read("a.obj", "v 0 0 0\nf 1 2 3\nv 1 0 0\nv 0 1 0\n");
  EXPECT_EQ(polygons(mesh), (Polygons{{0, 1, 2}}));
}

TEST_F(Io, LinesMayEndInAnyWay) {
  for (const char* newline : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char* line : {"\xef\xbb\xbf# x", "v 0 0 0", "v 1 0 0", "v 0 1 0", "", "f 1 2 3"}) {
      text += line + std::string(newline);
    }
    EXPECT_EQ(polygons(read("a.obj", text)), (Polygons{{0, 1, 2}}));
    EXPECT_EQ(error_of("b.obj", text + "f 1 2 x" + newline),
              "b.obj: line 7: expected a vertex index, found \"x\"");
  }
}

TEST_F(Io, ObjNormalsOfPointsAreKept) {
  const Mesh mesh = read("a.obj", "v 0 0 0\nv 1 0 0\nvn 0 0 2\nvn 0 1 0\n");
  EXPECT_EQ(mesh.normals, (std::vector<Vec3>{{0, 0, 1}, {0, 1, 0}}));
  EXPECT_TRUE(read("b.obj", "v 0 0 0\nv 1 0 0\nvn 0 0 2\n").normals.empty());
}

/// Runs of lines that are like each other are read by several threads; what is special among them
/// is not, and means what it does in a small file.
TEST_F(Io, LargeObjIsReadAsASmallOne) {
  constexpr int count = 60000;
  std::string text = "# a comment\n";
  std::vector<Vec3> positions;
  Polygons faces;
  const auto vertex = [&](int k) {
    positions.emplace_back(static_cast<float>(k), 0.5f, -0.25f);
    return fmt::format("v {} 0.5 -0.25{}\n", k, k % 1000 == 7 ? " # here" : "");
  };
  for (int k = 0; k < count; ++k) {
    text += k % 9000 == 4000 ? "v \\\n" + vertex(k).substr(2) : vertex(k);
    if (k % 7000 == 3000) text += "vt 0 0\n\n";
  }
  for (int k = 0; k + 4 < count; ++k) {
    const auto v = static_cast<Index>(k);
    if (k % 5000 == 100) {
      text += fmt::format("f {}//1 {} {} {}\n", k + 1, k + 2, k + 3, k + 4);
      faces.push_back({v, v + 1, v + 2, v + 3});
    } else if (k % 5000 == 200) {
      text += fmt::format("f {} {} \\\n {}\n", k + 1, k - count, k + 3);
      faces.push_back({v, v, v + 2});
    } else if (k % 5000 == 300) {
      text += fmt::format("f {} {} {}\n", k + 1, count + 1, k + 3);  // comes last
      faces.push_back({v, count, v + 2});
    } else {
      text += fmt::format("f {} {}/3 {}\n", k + 1, k + 2, k + 3);
      faces.push_back({v, v + 1, v + 2});
    }
  }
  const std::string complete = text + vertex(count);
  const Mesh mesh = read("large.obj", complete);
  EXPECT_EQ(mesh.positions, positions);
  EXPECT_EQ(polygons(mesh), faces);
  const auto lines_to = [&](std::size_t at) {
    return std::count(complete.begin(), complete.begin() + static_cast<std::ptrdiff_t>(at), '\n') +
           1;
  };
  const auto expect_error = [&](const std::string& good, const std::string& bad,
                                const std::string& message) {
    std::string broken = complete;
    const std::size_t at = broken.find(good);
    ASSERT_NE(at, broken.npos);
    broken.replace(at, good.size(), bad);
    EXPECT_EQ(error_of("bad.obj", broken),
              fmt::format("bad.obj: line {}: {}", lines_to(at + 1), message));
  };
  expect_error("\nv 33333 ", "\nv x ", "expected coordinate x, found \"x\"");
  expect_error("\nf 44444 ", "\nf 4x ", "expected a vertex index, found \"4x\"");
  expect_error("\nf 55555 ", "\nf 99999 ",
               "vertex index 99999 is out of range: the file holds 60001 vertices");
}

TEST_F(Io, ObjCurvesAreNoPointClouds) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(error_of("a.obj", points + "cstype bspline\ndeg 1\ncurv 0 1 1 2\nend\n"),
            "a.obj: has free-form curves or surfaces, but no faces");
  EXPECT_EQ(read("b.obj", points + "p 1\np 2\np 3\n").positions.size(), 3u);
  EXPECT_EQ(read("c.obj", points + "cstype bspline\nf 1 2 3\n").faces.size(), 1u);
}

TEST_F(Io, ObjErrorsNameTheLine) {
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0\n"),
            "a.obj: line 2: expected coordinate z, found the end of the line");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0"),
            "a.obj: line 2: expected coordinate z, found the end of the file");
  EXPECT_EQ(error_of("a.obj", "v 0 0,5 0\n"),
            "a.obj: line 1: expected coordinate y, found \"0,5\"");
  EXPECT_EQ(error_of("a.obj", "v 0 nan 0\n"),
            "a.obj: line 1: expected coordinate y, found \"nan\", which is not finite in single "
            "precision");
  EXPECT_EQ(error_of("a.obj", "v 0 0 -1e39\n"),
            "a.obj: line 1: expected coordinate z, found \"-1e39\", which is not finite in single "
            "precision");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n"),
            "a.obj: line 3: vertex index 3 is out of range: the file holds 2 vertices");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nf 1 0 1\n"),
            "a.obj: line 2: vertex index 0 is out of range: the file holds 1 vertices");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\n\nf 1 -2 1\n"),
            "a.obj: line 3: vertex index -2 is out of range: the file holds 1 vertices");
  EXPECT_NE(error_of("a.obj", "v 0 0 0\nf 1 99999999999999999999 1\n").find("line 2: vertex index"),
            std::string::npos);
  EXPECT_NE(error_of("a.obj", "v 0 0 0\nf 1 4294967296 1\n").find("out of range"),
            std::string::npos);
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nf 1 1.5 1\n"),
            "a.obj: line 2: expected a vertex index, found \"1.5\"");
  EXPECT_EQ(error_of("a.obj", "# nothing\n"), "a.obj: the file holds no vertices");
}

// -------------------------------------------------------------------------------------- lines

using Lines = std::vector<std::vector<Index>>;

Lines lines_of(const Polylines& lines) {
  Lines all;
  for (std::size_t line = 0; line < lines.size(); ++line) {
    all.emplace_back(lines.vertices.begin() + lines.begin(line),
                     lines.vertices.begin() + lines.end(line));
  }
  return all;
}

TEST_F(Io, LinesAreJoinedWhereTwoMeet) {
  std::string text;
  for (int i = 0; i < 12; ++i) text += fmt::format("v {} 0 0\n", i);
  // A path in pieces, with one given twice and a face between; a star of three;
  // a loop.
  text +=
      "l 4 3/1\nf 1 2 3\nl 1 2 3\nl 2 1\nl -9 5 5\nl 7 6\nl 8 6\nl 9 6\nl "
      "10 11 12 10\nl 2\n";
  const Polylines lines = read_polylines(file("a.obj", text));
  EXPECT_EQ(lines_of(lines), (Lines{{0, 1, 2, 3, 4}, {5, 6}, {5, 7}, {5, 8}, {9, 10, 11, 9}}));
  ASSERT_EQ(lines.points.size(), 12u);
  EXPECT_EQ(lines.points[7], Eigen::Vector3d(7, 0, 0));
}

TEST_F(Io, LinesFarFromZeroAreWhereTheFileSays) {
  const Polylines lines =
      read_polylines(file("a.obj", "v 100000.25 0 0\nv 100000.75 1 0\nv 100001 0 0\nl 1 2 3\n"));
  EXPECT_EQ(lines.points[1], Eigen::Vector3d(100000.75, 1, 0));
}

TEST_F(Io, PlyEdgesAreLines) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement edge 2\nproperty "
      "int vertex2\nproperty uchar red\n"
      "property int vertex1\nelement vertex 3\nproperty "
      "float x\nproperty float y\n"
      "property float z\nend_header\n";
  const std::string points = "0 0 0\n1 0 0\n1 1 0\n";
  EXPECT_EQ(lines_of(read_polylines(file("a.ply", header + "0 255 2\n1 255 2\n" + points))),
            (Lines{{0, 2, 1}}));
  EXPECT_EQ(error_of("a.ply", header + "0 255 2\n3 255 2\n" + points),
            "a.ply: line 13: vertex index 3 is out of range: the file holds 3 "
            "vertices, in edge 2 of "
            "2");
  EXPECT_TRUE(read("b.ply", header + "0 255 2\n1 255 2\n" + points).marked_edges.empty());
}

TEST_F(Io, WhatHasNoLinesIsRefused) {
  const auto error_of_lines = [&](const std::string& name, const std::string& bytes) {
    try {
      read_polylines(file(name, bytes));
    } catch (const Error& error) {
      return without_folder(error);
    }
    return "no error"s;
  };
  const std::string cloud = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(error_of_lines("a.obj", cloud + "f 1 2 3\nl 1 1\n"),
            "a.obj: has no lines: OBJ has them as \"l\", PLY as the element "
            "\"edge\"");
  EXPECT_EQ(error_of_lines("a.xyz", "0 0 0\n"), "a.xyz: only OBJ and PLY files have lines");
  EXPECT_EQ(error_of_lines("a.obj", cloud + "l 1 4\n"),
            "a.obj: line 4: vertex index 4 is out of range: the file holds 3 "
            "vertices");
  EXPECT_EQ(error_of_lines("a.obj", cloud + "l 1 two\n"),
            "a.obj: line 4: expected a vertex index, found \"two\"");
  EXPECT_EQ(error_of_lines("a.obj", cloud + "l 1 -4\n"),
            "a.obj: line 4: vertex index -4 is out of range: the file holds 3 "
            "vertices");
}

/// Points with lines are a point cloud as before.
TEST_F(Io, LinesMakeNoMesh) {
  const Mesh mesh = read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n");
  EXPECT_TRUE(mesh.is_point_cloud());
  EXPECT_TRUE(mesh.marked_edges.empty());
}

// ---------------------------------------------------------------------------------------- PLY

TEST_F(Io, PlyTextInAnyOrder) {
  const Mesh mesh = read(
      "a.ply",
      "ply\nformat ascii 1.0\ncomment by hand\nelement extra 2\nproperty list uchar float junk\n"
      "property int8 one\nelement face 3\nproperty uchar red\n"
      "property list uint8 int32 vertex_index\nelement vertex 4\nproperty float64 z\n"
      "property uchar red\nproperty double y\nproperty list int int tags\nproperty float32 x\n"
      "property float quality\nend_header\n"
      "3 0.5 nan 2 1\n0 2\n"
      "255 3 0 1 2\n255 4 0 1 2 3\n255 2 0 1\n"
      "0 1 0 0 0 0.5\n0 1 0 2 7 8 1 1.5\n0 1 1 0 1 2.5 0 1 1\n0 0 3.5\n",
      {.value_name = "quality"});
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(polygons(mesh), (Polygons{{0, 1, 2}, {0, 1, 2, 3}}));
  EXPECT_EQ(mesh.values, (std::vector<float>{0.5f, 1.5f, 2.5f, 3.5f}));
}

TEST_F(Io, PlyKeepsNormalsAtUnitLength) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float nx\nproperty float ny\n"
      "property float nz\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  const Mesh mesh = read("a.ply", header + "0 0 3 1 2 3\n0 0 0 4 5 6\n");
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(mesh.normals, (std::vector<Vec3>{{0, 0, 1}, {0, 0, 0}}));
}

template <class Number>
std::string binary_ply(std::endian order, const char* type_name) {
  std::string ply = fmt::format(
      "ply\nformat binary_{}_endian 1.0\nelement vertex 4\nproperty {} x\nproperty {} y\n"
      "property short skipped\nproperty {} z\nelement face 3\nproperty list uchar int "
      "vertex_indices\nelement other 1\nproperty list ushort double d\nend_header\n",
      order == std::endian::little ? "little" : "big", type_name, type_name, type_name);
  for (int v = 0; v < 4; ++v) {
    ply += bytes_of(static_cast<Number>(v & 1), order) + bytes_of(static_cast<Number>(v), order);
    ply += bytes_of(std::int16_t{-1}, order) + bytes_of(static_cast<Number>(v >> 1), order);
  }
  for (const Polygons::value_type& face : Polygons{{0, 1, 2}, {1, 3, 2}, {0, 1, 3, 2}}) {
    ply += static_cast<char>(face.size());
    for (const Index v : face) ply += bytes_of(v, order);
  }
  return ply + bytes_of(std::uint16_t{1}, order) + bytes_of(0.5, order);
}

TEST_F(Io, PlyBinaryOfAllTypesAndOrders) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    for (const std::string& ply :
         {binary_ply<std::int8_t>(order, "char"), binary_ply<std::int8_t>(order, "int8"),
          binary_ply<std::uint8_t>(order, "uchar"), binary_ply<std::uint8_t>(order, "uint8"),
          binary_ply<std::int16_t>(order, "short"), binary_ply<std::int16_t>(order, "int16"),
          binary_ply<std::uint16_t>(order, "ushort"), binary_ply<std::uint16_t>(order, "uint16"),
          binary_ply<std::int32_t>(order, "int"), binary_ply<std::int32_t>(order, "int32"),
          binary_ply<std::uint32_t>(order, "uint"), binary_ply<std::uint32_t>(order, "uint32"),
          binary_ply<float>(order, "float"), binary_ply<float>(order, "float32"),
          binary_ply<double>(order, "double"), binary_ply<double>(order, "float64")}) {
      const Mesh mesh = read("a.ply", ply);
      EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {0, 2, 1}, {1, 3, 1}}));
      EXPECT_EQ(polygons(mesh), (Polygons{{0, 1, 2}, {1, 3, 2}, {0, 1, 3, 2}}));
    }
  }
}

constexpr const char* ply_points = "property float x\nproperty float y\nproperty float z\n";

TEST_F(Io, PlyStripsRestart) {
  const std::string text = "ply\nformat ascii 1.0\nelement vertex 6\n"s + ply_points +
                           "element tristrips 2\nproperty list int int vertex_indices\nend_header\n"
                           "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n"
                           "9 0 1 2 3 -1 2 3 4 5\n5 0 1 1 2 3\n";
  EXPECT_EQ(polygons(read("a.ply", text)),
            (Polygons{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}, {1, 2, 3}}));
  EXPECT_EQ(error_of("b.ply", replaced(text, "-1", "-2")),
            "b.ply: line 16: vertex index -2 is out of range: the file holds 6 vertices, in "
            "tristrips 1 of 2");
}

/// A grid of 4 x 3 cells; that of number 5 is empty, and the last column lies far behind.
std::string range_grid(int rows) {
  std::string vertices;
  std::string cells;
  int count = 0;
  for (int i = 0; i < 12; ++i) {
    if (i == 5) {
      cells += "0\n";
      continue;
    }
    vertices += fmt::format("{} {} {}\n", i % 4, i / 4, i % 4 == 3 ? -100 : 0);
    cells += fmt::format("1 {}\n", count++);
  }
  return fmt::format(
             "ply\nformat ascii 1.0\nobj_info num_cols 4\nobj_info num_rows {}\nobj_info echo_rgb "
             "0\nelement vertex 11\n{}element range_grid 12\nproperty list uchar int "
             "vertex_indices\nend_header\n",
             rows, ply_points) +
         vertices + cells;
}

TEST_F(Io, PlyRangeGridIsTriangulatedWithoutSteps) {
  const Mesh mesh = read("a.ply", range_grid(3));
  EXPECT_EQ(mesh.positions.size(), 11u);
  EXPECT_EQ(mesh.faces.size(), 4u);  // of each of the four cells around the hole one half
  for (const auto& face : polygons(mesh)) {
    const Vec3 a = mesh.positions[face[0]];
    const Vec3 b = mesh.positions[face[1]] - a;
    const Vec3 c = mesh.positions[face[2]] - a;
    EXPECT_EQ(b.x() * c.y() - b.y() * c.x(), 1);  // faces the scanner
    for (const Index v : face) EXPECT_EQ(mesh.positions[v].z(), 0);
  }
  EXPECT_EQ(error_of("b.ply", range_grid(4)),
            "b.ply: line 10: element range_grid has 12 cells, but obj_info num_cols and num_rows "
            "give 4 x 4");
}

TEST_F(Io, PlyErrorsNameLineOrByte) {
  const auto text = [](const std::string& elements, const std::string& data) {
    return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + data;
  };
  const std::string points = "element vertex 2\n"s + ply_points;
  const std::string faces = points + "element face 1\nproperty list uchar int vertex_indices\n";
  EXPECT_EQ(error_of("a.ply", text(points, "0 0 0\n1 2\n")),
            "a.ply: line 9: the file ends within vertex 2 of 2");
  EXPECT_EQ(error_of("a.ply", text(points, "0 0 0\n1 2 huh\n")),
            "a.ply: line 9: expected a number, found \"huh\"");
  EXPECT_EQ(error_of("a.ply", text(points, "0 0 0\n1 inf 2\n")),
            "a.ply: line 9: expected a number, found \"inf\", which is not finite in single "
            "precision");
  EXPECT_EQ(error_of("a.ply", text(faces, "0 0 0\n1 1 1\n3 0 1 2\n")),
            "a.ply: line 12: vertex index 2 is out of range: the file holds 2 vertices, in face 1 "
            "of 1");
  EXPECT_EQ(error_of("a.ply", text(faces, "0 0 0\n1 1 1\n3 0 1 0.5\n")),
            "a.ply: line 12: vertex index 0.5 is out of range: the file holds 2 vertices, in face "
            "1 of 1");
  EXPECT_EQ(error_of("a.ply", text(faces, "0 0 0\n1 1 1\n-3 0 1 1\n")),
            "a.ply: line 12: -3 is no length of a list, in face 1 of 1");
  EXPECT_EQ(error_of("a.ply", text("element vertex 2\nproperty float x\nproperty float y\n", "")),
            "a.ply: line 3: element vertex must have one number \"z\", has 0");
  EXPECT_EQ(error_of("a.ply", text("element face 0\n", "")),
            "a.ply: the header names no element \"vertex\"");
  EXPECT_EQ(error_of("a.ply", text(points + "element face 1\n", "0 0 0 1 1 1\n")),
            "a.ply: line 7: element face must have one list \"vertex_indices\"");
  EXPECT_EQ(error_of("a.ply", text("element vertex 0\n"s + ply_points, "")),
            "a.ply: the file holds no vertices");
  EXPECT_EQ(error_of("a.ply", text("element vertex 2\nproperty real x\n", "")),
            "a.ply: line 4: unknown type \"real\"");
  EXPECT_EQ(error_of("a.ply", text("element vertex two\n", "")),
            "a.ply: line 3: expected the number of elements, found \"two\"");
  EXPECT_EQ(error_of("a.ply", text("property float x\n", "")),
            "a.ply: line 3: a property must follow an element");
  EXPECT_EQ(error_of("a.ply", text(points + points, "")),
            "a.ply: line 7: there is already an element \"vertex\"");
  EXPECT_EQ(error_of("a.ply", text("", "")), "a.ply: the header names no element \"vertex\"");
  EXPECT_EQ(error_of("a.ply", "ply\nformat binary_middle_endian 1.0\n"),
            "a.ply: line 2: unknown format \"binary_middle_endian\"");
  EXPECT_EQ(error_of("a.ply", "ply\nelement vertex 1\n"),
            "a.ply: line 2: the file ends within its header: there is no \"end_header\"");
  EXPECT_EQ(error_of("a.ply", "ply\nend_header\n"), "a.ply: line 2: the header names no format");
  EXPECT_EQ(error_of("a.ply", "plx\n"),
            "a.ply: line 1: expected \"ply\" at the beginning of the file");
  EXPECT_EQ(error_of("a.ply", text(points, "0 0 0 1 1 1\n"), {.value_name = "size"}),
            "a.ply: line 3: element vertex has no number \"size\"");

  const std::string header = "ply\nformat binary_little_endian 1.0\n" + faces + "end_header\n";
  const auto vector = [](float x) { return bytes_of(x) + bytes_of(x) + bytes_of(x); };
  const std::size_t size = header.size();
  EXPECT_EQ(error_of("a.ply", header + vector(0) + bytes_of(1.0f)),
            fmt::format("a.ply: byte {}: the file ends within vertex 2 of 2", size + 16));
  EXPECT_EQ(error_of("a.ply", header + vector(0) + bytes_of(0.0f) + vector(INFINITY)),
            fmt::format("a.ply: byte {}: \"y\" is not finite in single precision, in vertex 2 of 2",
                        size + 16));
  EXPECT_EQ(error_of("a.ply", header + vector(0) + vector(1) + "\3"),
            fmt::format("a.ply: byte {}: the file ends within face 1 of 1", size + 25));
  EXPECT_EQ(error_of("a.ply", header + vector(0) + vector(1) + "\3" + bytes_of(0) + bytes_of(-1) +
                                  bytes_of(1)),
            fmt::format("a.ply: byte {}: vertex index -1 is out of range: the file holds 2 "
                        "vertices, in face 1 of 1",
                        size + 29));
}

TEST_F(Io, AbsurdCountsEndWithTheFile) {
  for (const char* count : {"4000000000", "4294967295", "18446744073709551615"}) {
    for (const char* format : {"ascii", "binary_little_endian"}) {
      const std::string start = fmt::format("ply\nformat {} 1.0\n", format);
      const std::string vertices = fmt::format("element vertex {}\n", count) + ply_points;
      const std::string list = "property list uint uint vertex_indices\n";
      EXPECT_NE(error_of("a.ply", start + vertices + "end_header\n0 0 0\n"), "no error");
      for (const char* element : {"face", "tristrips", "other"}) {
        EXPECT_NE(error_of("a.ply", start + "element vertex 1\n" + ply_points +
                                        fmt::format("element {} {}\n", element, count) + list +
                                        "end_header\n0 0 0 0 0 0\n"),
                  "no error");
      }
      // An element without properties takes no bytes, however many there are of it.
      EXPECT_EQ(read("b.ply", start + fmt::format("element none {}\n", count) +
                                  "element vertex 1\n" + ply_points + "end_header\n0 0 0 0 0 0\n")
                    .positions.size(),
                1u);
    }
    EXPECT_NE(error_of("a.off", fmt::format("OFF\n{} 1 0\n0 0 0\n", count)), "no error");
    EXPECT_NE(error_of("a.off", fmt::format("OFF\n1 {} 0\n0 0 0\n3 0 0 0\n", count)), "no error");
    EXPECT_NE(error_of("a.off", fmt::format("OFF\n1 1 0\n0 0 0\n{} 0 0 0\n", count)), "no error");
    EXPECT_NE(error_of("a.pts", fmt::format("{}\n0 0 0\n", count)), "no error");
    EXPECT_NE(error_of("a.aln", fmt::format("{}\na.off\n", count)), "no error");
  }
  EXPECT_NE(error_of("a.stl", std::string(80, '\0') + bytes_of(~0u) + std::string(60, '\0')),
            "no error");
}

// ---------------------------------------------------------------------------------------- OFF

TEST_F(Io, OffInItsVariants) {
  const Polygons expected{{0, 1, 2}, {0, 1, 2, 3}};
  for (const std::string text :
       {"OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n",
        "OFF 4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n4 0 1 2 3 0.5 0.5 0.5\n",
        "OFF4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3",
        "OFF # shape\n# counts\n4 2\n\n0 0 0 # first\n1 0 0\n1 1 0\n0 1 0\n# f\n3 0 1 2\n4 0 1 2 "
        "3\n",
        "COFF\n4 2 0\n0 0 0 255 0 0 1\n1 0 0 0 0 0 0\n1 1 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2\n"
        "4 0 1 2 3\n",
        "STOFF\n4 2 0\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n3 0 1 2\n4 0 1 2 3\n",
        "4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n"}) {
    SCOPED_TRACE(text);
    const Mesh mesh = read("a.off", text);
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(polygons(mesh), expected);
    EXPECT_TRUE(mesh.normals.empty());
  }
  const Mesh mesh = read("a.off", "NOFF\n1 0 0\n1 2 3 0 0 1\n");
  EXPECT_EQ(mesh.normals, (std::vector<Vec3>{{0, 0, 1}}));
}

std::string binary_off() {
  constexpr std::endian big = std::endian::big;
  std::string off = "CNOFF BINARY\n" + bytes_of(3, big) + bytes_of(2, big) + bytes_of(0, big);
  for (int v = 0; v < 3; ++v) {
    for (const int x : {v, v * v, 0, 0, 0, 1, 9, 9, 9, 9}) {
      off += bytes_of(static_cast<float>(x), big);
    }
  }
  for (const int x : {3, 0, 1, 2, 0, 3, 2, 1, 0, 1}) off += bytes_of(x, big);
  return off + bytes_of(0.5f, big);
}

TEST_F(Io, OffBinary) {
  const Mesh mesh = read("a.off", binary_off());
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {2, 4, 0}}));
  EXPECT_EQ(mesh.normals, (std::vector<Vec3>(3, {0, 0, 1})));
  EXPECT_EQ(polygons(mesh), (Polygons{{0, 1, 2}, {2, 1, 0}}));
  EXPECT_EQ(error_of("b.off", binary_off().substr(0, 40)),
            "b.off: byte 40: the file ends within vertex 1 of 3");
  EXPECT_EQ(
      error_of("b.off", binary_off().replace(13 + 12 + 120 + 4, 4, bytes_of(3, std::endian::big))),
      "b.off: byte 149: vertex index 3 is out of range: the file holds 3 vertices");
}

TEST_F(Io, OffErrorsNameTheLine) {
  EXPECT_EQ(error_of("a.off", "OFF\n2 1 0\n0 0 0\n"),
            "a.off: line 3: the file ends within vertex 2 of 2");
  EXPECT_EQ(error_of("a.off", "OFF\n1 2 0\n0 0 0\n3 0 0 0\n3 0 0"),
            "a.off: line 5: the file ends within face 2 of 2");
  EXPECT_EQ(error_of("a.off", "OFF\n1 1 0\n0 0 0\n3 0 1 0\n"),
            "a.off: line 4: vertex index 1 is out of range: the file holds 1 vertices");
  EXPECT_EQ(error_of("a.off", "OFF\n1 1 0\n0 0 0\n3 0 -1 0\n"),
            "a.off: line 4: expected a vertex index, found \"-1\"");
  EXPECT_EQ(error_of("a.off", "OFF\nmany 1 0\n"),
            "a.off: line 2: expected the number of vertices, found \"many\"");
  EXPECT_EQ(error_of("a.off", "4OFF\n1 0 0\n0 0 0 1\n"),
            "a.off: line 1: only points in space can be read, neither 4OFF nor nOFF");
  EXPECT_EQ(error_of("a.off", "OFF\n"),
            "a.off: line 1: expected the number of vertices, found the end of the file");
}

// ---------------------------------------------------------------------------------------- STL

constexpr const char* text_stl =
    "solid a name\n"
    " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 -0\n"
    "  endloop\n endfacet\n"
    " facet normal 0 0 1\n  outer loop\n   vertex 1 0 0\n   vertex 1 1 0\n   vertex -0 1 0\n"
    "  endloop\n endfacet\nendsolid a name\n";

TEST_F(Io, StlTextIsWelded) {
  std::string capitals = text_stl;
  for (char& c : capitals) c = static_cast<char>(std::toupper(c));
  for (const auto& [name, text] : {std::pair<const char*, std::string>{"a.stl", text_stl},
                                   {"a.STL", text_stl},
                                   {"without-extension", text_stl},
                                   {"capitals.stl", capitals}}) {
    const Mesh mesh = read(name, text);
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(polygons(mesh), (Polygons{{0, 1, 2}, {1, 3, 2}}));
  }
}

/// Vertices closer than single precision can tell from so far away.
TEST_F(Io, StlTextMayBeFarAway) {
  std::string text = " \nsolid\n";
  constexpr int count = 8;
  for (int k = 0; k < count; ++k) {
    const auto vertex = [&](double x, double y) {
      text += fmt::format("vertex {:.2f} {:.2f} 0\n", 5e6 + 0.05 * x, 5e6 + 0.05 * y);
    };
    text += "facet normal 0 0 1\nouter loop\n";
    vertex(k, 0);
    vertex(k + 1, 0);
    vertex(k, 1);
    text += "endloop\nendfacet\n";
  }
  const Mesh mesh = read("a.stl", text + "endsolid\n");
  EXPECT_EQ(mesh.positions.size(), 2u * count + 1);
  EXPECT_EQ(mesh.faces.size(), std::size_t{count});
}

TEST_F(Io, StlBinaryMayBeginWithSolid) {
  write_mesh(folder_ / "a.stl", sample());
  std::ifstream stream(folder_ / "a.stl", std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(stream), {});
  bytes.replace(0, 6, "solid ");
  EXPECT_EQ(read("b.stl", bytes).faces.size(), 4u);
  EXPECT_EQ(read("c", bytes).faces.size(), 4u);
  EXPECT_EQ(error_of("d.stl", bytes.substr(0, bytes.size() - 70)),
            "d.stl: byte 214: the file ends within triangle 3 of 4");
  EXPECT_EQ(read("e.stl", bytes + "more").faces.size(), 4u);
  bytes[80] = 3;
  EXPECT_EQ(error_of("f.stl", bytes),
            "f.stl: byte 234: the header counts 3 triangles, but 50 bytes follow these");
}

/// Programs write such of faces without an area. Positions must be finite.
TEST_F(Io, NormalsThatAreNotFiniteAreNone) {
  const std::string obj = "vn nan nan nan\nvn 0 0 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//2 3//2\n";
  EXPECT_EQ(read("a.obj", obj).faces.size(), 1u);
  EXPECT_EQ(error_of("a.obj", replaced(obj, "nan nan nan", "0 up 1")),
            "a.obj: line 1: expected normal y, found \"up\"");
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 nan nan nan\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n";
  const Mesh mesh = read("a.ply", ply);
  ASSERT_EQ(mesh.normals.size(), 3u);
  EXPECT_EQ(mesh.normals[0], Vec3::Zero());
  EXPECT_EQ(mesh.normals[1], Vec3::UnitZ());
  EXPECT_NE(error_of("a.ply", replaced(ply, "1 0 0 0 0 1", "1 nan 0 0 0 1")), "no error");
}

TEST_F(Io, StlErrorsNameThePlace) {
  const std::string text = text_stl;
  EXPECT_EQ(error_of("a.stl", text.substr(0, text.find("vertex 0 1"))),
            "a.stl: line 6: the file ends within a facet");
  EXPECT_EQ(error_of("a.stl", text.substr(0, text.find("endsolid"))),
            "a.stl: line 15: the file ends without \"endsolid\"");
  EXPECT_EQ(error_of("a.stl", replaced(text, "vertex 1 1", "Vortex 1 1")),
            "a.stl: line 12: expected \"vertex\" or \"endloop\", found \"Vortex\"");
  EXPECT_EQ(error_of("a.stl", replaced(text, "1 1 0", "1 nan")),
            "a.stl: line 12: expected coordinate y, found \"nan\", which is not finite in single "
            "precision");
  EXPECT_EQ(error_of("a.stl", "solid\nendsolid\n"), "a.stl: the file holds no triangles");
  EXPECT_EQ(error_of("a.stl", "binary"),
            "a.stl: byte 6: the file ends within its header of 84 bytes");
  const std::string one = std::string(80, 'x') + bytes_of(1) + bytes_of(0.0f) + bytes_of(0.0f) +
                          bytes_of(1.0f) + bytes_of(NAN) + std::string(34, '\0');
  EXPECT_EQ(error_of("a.stl", one),
            "a.stl: byte 96: a coordinate is not finite in triangle 1 of 1");
}

// ---------------------------------------------------------------------------- points and scans

TEST_F(Io, XyzWithAndWithoutNormals) {
  const Mesh plain = read("a.xyz", "# points\n1 2 3\n// more\n\n4 5 6 0.5 red\n");
  EXPECT_EQ(plain.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_TRUE(plain.normals.empty());
  EXPECT_EQ(read("b.xyz", "1 2 3 0 0 1\n4 5 6 0.6 0 0.8\n").normals.size(), 2u);
  EXPECT_TRUE(read("c.xyz", "1 2 3 0 0 1\n4 5 6 255 0 0\n").normals.empty());
  EXPECT_TRUE(read("d.xyz", "1 2 3 0 0 1 7\n4 5 6 0 0 1 7\n").normals.empty());
  EXPECT_EQ(error_of("e.xyz", "1 2 3\n4 5\n"),
            "e.xyz: line 2: expected coordinate z, found the end of the line");
  EXPECT_EQ(error_of("f.xyz", "x y z\n"), "f.xyz: line 1: expected coordinate x, found \"x\"");
}

TEST_F(Io, PtsWithAndWithoutCount) {
  for (const char* text : {"2\n1 2 3\n4 5 6\n", "1 2 3\n4 5 6",
                           "2\r\n1 2 3 -5 9 9 9\r\n4 5 6 1 2 3 4\r\n", "1\n1 2 3\n1\n4 5 6\n"}) {
    const Mesh mesh = read("a.pts", text);
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}}));
    EXPECT_TRUE(mesh.is_point_cloud());
  }
  EXPECT_EQ(error_of("b.pts", "3\n1 2 3\n4 5 6\n"),
            "b.pts: line 3: the file ends before point 3 of 3");
  EXPECT_EQ(error_of("c.pts", "2\n1 2 3\n1\n4 5 6\n"),
            "c.pts: line 3: the block ends before point 2 of 2");
}

std::string scan(const char* normals, const char* rows) {
  return fmt::format(
      "ply\nformat ascii 1.0\nelement vertex 3\n{}{}"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n{}",
      ply_points, normals, rows);
}

TEST_F(Io, AlnKeepsTheMarksOfScans) {
  const std::string scan =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
      "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n1 2\n";
  file("scan.ply", scan);
  const std::string at = "scan.ply\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
  const std::vector<std::array<Index, 2>> marks{{1, 2}, {4, 5}};
  EXPECT_EQ(read("a.aln", "2\n" + at + at).marked_edges, marks);
}

TEST_F(Io, AlnPutsScansTogether) {
  const char* const normals = "property float nx\nproperty float ny\nproperty float nz\n";
  const char* const rows = "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n";
  fs::create_directory(folder_ / "scans");
  file("scans/left side.ply", scan(normals, rows));
  file("right.ply", scan(normals, rows));
  const std::string list =
      "2\nscans/left side.ply\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n\n"
      "right.ply\n#\n0 -2 0 5\n2 0 0 0\n0 0 2 0\n0 0 0 1\n0\n";
  const Mesh mesh = read("a.aln", list);
  ASSERT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.positions[4], Vec3(5, 2, 0));
  EXPECT_EQ(mesh.positions[5], Vec3(3, 0, 0));
  EXPECT_EQ(mesh.normals, std::vector<Vec3>(6, Vec3(0, 0, 1)));
  EXPECT_EQ(polygons(mesh), (Polygons{{0, 1, 2}, {3, 4, 5}}));

  EXPECT_EQ(error_of("b.aln", replaced(list, "scans", "stage")),
            "b.aln: line 2: the scan \"stage/left side.ply\" does not exist");
  EXPECT_EQ(error_of("b.aln", replaced(list, "2\n", "3\n").substr(0, list.size() - 2)),
            "b.aln: line 13: the file ends before scan 3 of 3");
  EXPECT_EQ(error_of("b.aln", list.substr(0, list.size() - 12)),
            "b.aln: line 12: the file ends within scan 2 of 2");
  EXPECT_EQ(error_of("b.aln", replaced(list, "0 -2", "0 +2")),
            "b.aln: line 13: the matrix of scan 2 of 2 mirrors or flattens");
  file("right.ply", "ply\n");
  EXPECT_EQ(error_of_reading("a.aln"),
            "right.ply: line 1: the file ends within its header: there is no \"end_header\"");
}

// ---------------------------------------------------------------------- kinds of files, welding

TEST_F(Io, ContentDecidesBeforeTheName) {
  const std::string off = "OFF\n1 0 0\n1 2 3\n";
  EXPECT_EQ(read("a.obj", off).positions.size(), 1u);
  EXPECT_EQ(read("a.unknown", off).positions.size(), 1u);
  EXPECT_EQ(
      read("b", "ply\nformat ascii 1.0\nelement vertex 1\n"s + ply_points + "end_header\n1 2 3\n")
          .positions.size(),
      1u);
}

TEST_F(Io, NamesThatNoFileCanHaveAreErrorsToo) {
  const std::string name(5000, 's');
  const std::string what = error_of("a.aln", "1\n" + name + "\n0\n");
  EXPECT_TRUE(what.starts_with("a.aln: line 2: the scan \"sss")) << what;
}

TEST_F(Io, WhatCannotBeReadIsNamed) {
  EXPECT_EQ(error_of_reading("missing.obj"), "missing.obj: there is no such file");
  EXPECT_EQ(error_of("empty.obj", ""), "empty.obj: the file is empty");
  EXPECT_EQ(error_of("a.doc", "text"),
            "a.doc: the kind of file is unknown; known are .obj, .ply, .off, .stl, .aln, .xyz, "
            ".pts");
  fs::create_directory(folder_ / "folder.obj");
  EXPECT_EQ(error_of_reading("folder.obj"), "folder.obj: is a folder, not a file");
  EXPECT_EQ(error_of("a\nb.obj", "v"),
            "a?b.obj: line 1: expected coordinate x, found the end of the file");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\n", {.value_name = "size"}),
            "a.obj: only PLY files have named numbers, such as \"size\"");
}

TEST_F(Io, PaintIsRedLessTheMeanOfGreenAndBlue) {
  const std::vector<float> expected{1, -1, 0, 0, 0, 0.5f};  // red, cyan, white, grey, black, pink
  const ReadOptions paint{.value_name = {}, .paint = true};
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float "
      "z\n";
  const auto colors = [](const std::string& type) {
    std::string text;
    for (const char* name : {"red", "green", "blue"}) {
      text += "property " + type + " " + name + "\n";
    }
    return text + "end_header\n";
  };
  EXPECT_EQ(read("a.ply",
                 header + colors("float") +
                     "0 0 0 1 0 0\n1 0 0 0 1 1\n2 0 0 1 1 1\n3 0 0 .5 .5 .5\n4 0 0 0 0 0\n"
                     "5 0 0 1 .5 .5\n",
                 paint)
                .values,
            expected);
  EXPECT_EQ(read("b.ply",
                 header + colors("uchar") +
                     "0 0 0 255 0 0\n1 0 0 0 255 255\n2 0 0 255 255 255\n3 0 0 9 9 9\n4 0 0 0 0 0\n"
                     "5 0 0 255 0 255\n",
                 paint)
                .values,
            expected);
  const std::string obj =
      "v 0 0 0 1 0 0\nv 1 0 0 0 1 1\nv 2 0 0 1 1 1\nv 3 0 0 .5 .5 .5\nv 4 0 0 0 0 0\n"
      "v 5 0 0 1 .5 .5\n";
  EXPECT_EQ(read("c.obj", obj, paint).values, expected);
  EXPECT_TRUE(read("d.obj", obj).values.empty());

  EXPECT_EQ(error_of("e.obj", "v 0 0 0 1 1 1\nv 0 1 0\n", paint),
            "e.obj: line 2: expected the vertex's red, from 0 to 1, found the end of the line");
  EXPECT_EQ(error_of("f.ply", header + "end_header\n", paint),
            "f.ply: line 3: element vertex has no number \"red\"");
  EXPECT_EQ(error_of("g.off", "OFF\n1 0 0\n0 0 0\n", paint),
            "g.off: only PLY and OBJ files have colours at their vertices");
}

TEST_F(Io, WeldOnRequest) {
  const std::string text =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 4 6 5\n";
  EXPECT_EQ(read("a.obj", text).positions.size(), 6u);
  const Mesh mesh = read("a.obj", text, {.weld = true, .value_name = {}});
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
  EXPECT_EQ(polygons(mesh), (Polygons{{0, 1, 2}, {0, 3, 2}}));
}

TEST(Weld, MergesNormalsAndKeepsTheFirstValue) {
  Mesh mesh;
  mesh.positions = {{1, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {2, 0, 0}};
  mesh.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 0}, {0, 0, -1}};
  mesh.values = {1, 2, 3, 4, 5};
  mesh.faces.push_back({1, 4, 3});
  EXPECT_EQ(weld(mesh), 2u);
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{1, 0, 0}, {2, 0, 0}, {3, 0, 0}}));
  EXPECT_EQ(mesh.values, (std::vector<float>{1, 3, 4}));
  EXPECT_TRUE(mesh.normals[0].isApprox(Vec3(1, 1, 0).normalized()));
  EXPECT_EQ(mesh.normals[1], Vec3(0, 0, 1));  // opposite ones cancel: the first stays
  EXPECT_EQ(mesh.normals[2], Vec3(0, 1, 0));
  EXPECT_EQ(polygons(mesh), (Polygons{{0, 1, 2}}));
  EXPECT_EQ(weld(mesh), 0u);
}

TEST(Weld, TellsWhatIsTorn) {
  EXPECT_FALSE(is_torn(sample_shape("cube", 0.3)));
  EXPECT_FALSE(is_torn(Mesh{}));
  // Six sides without common vertices are; a sheet with two sides, or a few pieces that touch along
  // seams, are not.
  Mesh sides, sheet, tiles;
  const auto add = [](Mesh& mesh, std::array<Vec3, 4> corners) {
    const auto first = static_cast<Index>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
    mesh.faces.push_back({first, first + 1, first + 2, first + 3});
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {0.0f, 1.0f}) {
      const Vec3 u = Vec3::Unit((axis + 1) % 3), v = Vec3::Unit((axis + 2) % 3);
      const Vec3 at = side * Vec3::Unit(axis);
      add(sides, {at, at + u, at + u + v, at + v});
    }
  }
  add(sheet, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)});
  add(sheet, {Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 0)});
  for (const float x : {0.0f, 1.0f, 2.0f}) {
    add(tiles, {Vec3(x, 0, 0), Vec3(x + 1, 0, 0), Vec3(x + 1, 1, 0), Vec3(x, 1, 0)});
  }
  EXPECT_TRUE(is_torn(sides));
  EXPECT_FALSE(is_torn(sheet));
  EXPECT_FALSE(is_torn(tiles));
}

TEST(Weld, KeepsManyDistinctVertices) {
  Mesh mesh;
  for (int twice = 0; twice < 2; ++twice) {
    for (int i = 0; i < 30000; ++i) {
      mesh.positions.emplace_back(i % 31, i / 31 % 31, i / 961);
    }
  }
  EXPECT_EQ(weld(mesh), 30000u);
  EXPECT_EQ(mesh.positions[12345], Vec3(12345 % 31, 12345 / 31 % 31, 12345 / 961));
}

TEST_F(Io, ProgressIsReportedAndCancels) {
  const fs::path path = file("a.obj", "v 0 0 0\n");
  Context context(1);
  double last = -1;
  context.on_progress = [&](std::string_view, double fraction) { last = fraction; };
  read_mesh(path, {}, context);
  EXPECT_EQ(last, 1);
  context.cancel();
  EXPECT_THROW(read_mesh(path, {}, context), Cancelled);
}

// ------------------------------------------------------------------------------ failed writing

TEST_F(Io, FailedWritesLeaveNothing) {
  EXPECT_EQ(error_of_writing("a.xyz", sample()),
            "a.xyz: the name must end in one of .obj, .ply, .off, .stl");
  EXPECT_EQ(error_of_writing("a", sample()),
            "a: the name must end in one of .obj, .ply, .off, .stl");
  EXPECT_EQ(error_of_writing("a.stl", sample_points()),
            "a.stl: STL holds triangles only: write points as .ply, .obj or .off");
  EXPECT_EQ(error_of_writing("missing/a.obj", sample()),
            "missing/a.obj: the folder \"missing\" does not exist");
  EXPECT_EQ(files(), 0u);
  fs::create_directory(folder_ / "folder.obj");
  EXPECT_EQ(error_of_writing("folder.obj", sample()), "folder.obj: is a folder, not a file");
  EXPECT_EQ(files(), 1u);
}

TEST_F(Io, AFailedWriteKeepsTheOldFile) {
  const fs::path path = file("a.stl", "precious");
  EXPECT_THROW(write_mesh(path, sample_points()), Error);
  EXPECT_EQ(fs::file_size(path), 8u);
  EXPECT_EQ(files(), 1u);
}

TEST_F(Io, AWriteReplacesTheOldFile) {
  const fs::path path = file("a.obj", std::string(5000, '#'));
  write_mesh(path, sample());
  EXPECT_EQ(read_mesh(path).positions.size(), 5u);
  EXPECT_EQ(files(), 1u);
}

TEST_F(Io, AWriteGoesWhereALinkLeads) {
  const fs::path path = file("real.obj", "old"), link = folder_ / "link.obj";
  std::error_code error;
  fs::create_symlink(path, link, error);
  if (error) GTEST_SKIP() << "links cannot be made here";
  write_mesh(link, sample());
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(read_mesh(path).positions.size(), 5u);
  EXPECT_EQ(files(), 2u);
}

TEST_F(Io, LinksThatLeadInCirclesAreRefused) {
  const fs::path link = folder_ / "circle.obj";
  std::error_code error;
  fs::create_symlink(link, link, error);
  if (error) GTEST_SKIP() << "links cannot be made here";
  EXPECT_THROW(check_writable(link), Error);
  EXPECT_TRUE(
      error_of_writing("circle.obj", sample()).starts_with("circle.obj: cannot be written"));
  EXPECT_EQ(files(), 1u);
}

TEST_F(Io, DevicesAreWrittenToAndStay) {
  const fs::path device = "/dev/null";
  if (!fs::is_character_file(device)) GTEST_SKIP() << "there is no such device here";
  io::Output output(device);
  output.write("gone");
  output.commit();
  EXPECT_TRUE(fs::is_character_file(device));
}

TEST_F(Io, CheckWritableSaysWhatWritingWould) {
  EXPECT_NO_THROW(check_writable(folder_ / "a.obj"));
  EXPECT_NO_THROW(check_writable("in-the-current-folder.ply"));
  EXPECT_EQ(files(), 0u);
  EXPECT_THROW(check_writable(folder_ / "a.pts"), Error);
  EXPECT_THROW(check_writable(folder_ / "missing" / "a.obj"), Error);
}

TEST_F(Io, ReadOnlyFoldersAreRefused) {
  const fs::path locked = folder_ / "locked";
  fs::create_directory(locked);
  fs::permissions(locked, fs::perms::owner_read | fs::perms::owner_exec);
  const bool ignored = std::ofstream(locked / "probe").good();  // the administrator may do anything
  if (!ignored) {
    EXPECT_THROW(check_writable(locked / "a.obj"), Error);
    EXPECT_THROW(write_mesh(locked / "a.obj", sample()), Error);
  }
  fs::permissions(locked, fs::perms::owner_all);
  if (ignored) GTEST_SKIP() << "this user may write to read-only folders";
}

// ------------------------------------------------------------------------------- hostile files

/// Small files of every kind, by name.
std::vector<std::pair<std::string, std::string>> corpus() {
  const auto written = [](const char* extension, const Mesh& mesh) {
    const fs::path path =
        platform::temporary_beside(fs::path(testing::TempDir()) / "x").string() + extension;
    write_mesh(path, mesh);
    std::ifstream stream(path, std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(stream), {});
    stream.close();
    fs::remove(path);
    return bytes;
  };
  return {
      {"a.obj", "v 0 0 0 1\nv 1 0 0\nv 1 1e0 0\nf 1/1/1 2//2 \\\n-1\nf 1 2 3\n"},
      {"marks.obj",
       "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 -1\nvn 0 -1 0\nvn -1 0 1\nusemtl a\n"
       "f 1//1 3//1 2//1\nf 1//2 2//2 4//-1\nvn 1 1 1\nusemtl b\nf 2//4 3//3 4//-1\n"
       "f 1//3 4 3//3\nl 1 2 -1/1\n"},
      {"points.obj", written(".obj", sample_points())},
      {"a.ply", written(".ply", sample())},
      {"marks.ply", written(".ply", marked_sample())},
      {"points.ply", written(".ply", sample_points())},
      {"big.ply", binary_ply<float>(std::endian::big, "float")},
      {"grid.ply", range_grid(3)},
      {"strips.ply", "ply\nformat ascii 1.0\nelement vertex 3\n"s + ply_points +
                         "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                         "0 0 0\n1 0 0\n0 1 0\n7 0 1 2 -1 2 1 0\n"},
      {"a.off", written(".off", sample())},
      {"binary.off", binary_off()},
      {"a.stl", text_stl},
      {"binary.stl", written(".stl", sample())},
      {"a.xyz", "1 2 3 0 0 1\n# x\n4 5 6 0 1 0\n"},
      {"a.pts", "2\n1 2 3 4 5 6 7\n4 5 6 7 8 9 1\n"},
      {"a.aln", "1\nscan.ply\n0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n"},
  };
}

TEST_F(Io, DamagedFilesAreReadOrRefused) {
  file("scan.ply", scan("", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  // The variable lets a long search use the same code.
  const char* const rounds_text = std::getenv("MESHGRAIN_FUZZ_ROUNDS");
  const int rounds = rounds_text ? std::atoi(rounds_text) : 100;
  std::mt19937 random(1);
  const auto below = [&](std::size_t count) { return random() % count; };
  const auto check = [&](const std::string& name, const std::string& bytes) {
    try {
      expect_valid(read(name, bytes));
      if (name.starts_with("marks")) read_polylines(folder_ / name);
    } catch (const Error& error) {
      const std::string text = without_folder(error);
      EXPECT_TRUE(text.starts_with(name) || text.starts_with("scan.ply")) << text;
    }
  };
  for (const auto& [name, bytes] : corpus()) {
    SCOPED_TRACE(name);
    check(name, bytes);
    for (std::size_t size = 0; size < bytes.size(); ++size) check(name, bytes.substr(0, size));
    for (int round = 0; round < rounds; ++round) {
      std::string damaged = bytes;
      for (std::size_t change = 0; change <= below(4); ++change) {
        const std::size_t at = below(damaged.size());
        switch (below(4)) {
          case 0:
            damaged[at] = static_cast<char>(damaged[at] ^ 1 << below(8));
            break;
          case 1:
            damaged[at] = static_cast<char>(below(256));
            break;
          case 2:
            damaged[at] = "0123456789-+.e \n\\/#\xff"[below(20)];
            break;
          default:
            damaged.erase(at, 1 + below(8));
            break;
        }
        if (damaged.empty()) damaged.push_back(0);
      }
      check(name, damaged);
    }
  }
}

// --------------------------------------------------------------------------------- real models

TEST(IoModels, RealModelsAreSound) {
  const char* const folder = std::getenv("MESHGRAIN_MODELS");
  if (!folder || *folder == '\0')
    GTEST_SKIP() << "set MESHGRAIN_MODELS to a folder of models to read them all";
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    const std::vector<std::string> known = {".obj", ".ply", ".off", ".stl", ".aln", ".xyz", ".pts"};
    if (std::find(known.begin(), known.end(), extension) == known.end()) continue;
    SCOPED_TRACE(entry.path().string());
    expect_valid(read_mesh(entry.path()));
    ++count;
  }
  EXPECT_GT(count, 0) << "there are no models in " << folder;
}

}  // namespace
}  // namespace meshgrain
