#include "meshgrain/fields_file.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "meshgrain/error.h"
#include "meshgrain/io.h"
#include "meshgrain/normals.h"
#include "meshgrain/remesh.h"
#include "meshgrain/shapes.h"
#include "util/platform.h"

namespace meshgrain {
namespace {

namespace fs = std::filesystem;

class FieldsFile : public testing::Test {
 protected:
  void SetUp() override {
    path_ = platform::temporary_beside(fs::path(testing::TempDir()) / "x");
    path_ += ".ply";
  }
  void TearDown() override { fs::remove(path_); }

  Fields round_trip(const Fields& fields) const {
    write_fields(path_, fields);
    return read_fields(path_);
  }
  std::string error_of(const std::string& text) const {
    std::ofstream(path_, std::ios::binary) << text;
    try {
      read_fields(path_);
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_TRUE(what.starts_with(path_.string() + ": ")) << what;
      EXPECT_EQ(what.find('\n'), what.npos);
      return what.substr(path_.string().size() + 2);
    }
    return "no error";
  }

  fs::path path_;
};

/// Any values will do.
Fields sample() {
  Fields fields;
  fields.surface = sample_shape("cube", 0.2);
  fields.surface.normals = vertex_normals(fields.surface);
  fields.position.edge_length = EdgeLength(1.0f / 3);
  for (std::size_t i = 0; i < fields.surface.positions.size(); ++i) {
    const Vec3 n = fields.surface.normals[i];
    fields.orientation.directions.push_back(n.unitOrthogonal());
    fields.position.points.push_back(fields.surface.positions[i] + 0.1f * n.unitOrthogonal());
  }
  return fields;
}

void expect_same(const Fields& a, const Fields& b) {
  EXPECT_EQ(a.surface.positions, b.surface.positions);
  EXPECT_EQ(a.surface.normals, b.surface.normals);
  EXPECT_EQ(a.surface.origin, b.surface.origin);
  EXPECT_TRUE(std::equal(a.surface.faces.corners().begin(), a.surface.faces.corners().end(),
                         b.surface.faces.corners().begin(), b.surface.faces.corners().end()));
  EXPECT_EQ(a.orientation.rosy, b.orientation.rosy);
  EXPECT_EQ(a.orientation.directions, b.orientation.directions);
  EXPECT_EQ(a.position.points, b.position.points);
  if (a.position.points.empty()) return;
  EXPECT_EQ(a.position.posy, b.position.posy);
  EXPECT_EQ(a.fine_lattice, b.fine_lattice);
  EXPECT_EQ(a.position.edge_length.values, b.position.edge_length.values);
}

TEST_F(FieldsFile, KeepsEveryBit) {
  Fields fields = sample();
  expect_same(round_trip(fields), fields);
  fields.orientation.rosy = 2;
  fields.position.posy = 6;
  expect_same(round_trip(fields), fields);
  fields.fine_lattice = true;
  expect_same(round_trip(fields), fields);
  fields.fine_lattice = false;
  fields.position.edge_length.values.assign(fields.surface.positions.size(), 0.1f);
  fields.position.edge_length.values[3] = 0.7f;
  expect_same(round_trip(fields), fields);
  fields.position.points.clear();
  expect_same(round_trip(fields), fields);
  fields.surface.faces.clear();
  expect_same(round_trip(fields), fields);
}

TEST_F(FieldsFile, KeepsTheOrigin) {
  Fields fields = sample();
  fields.surface.origin = {4e6, -5e5, 100};
  const Fields read = round_trip(fields);
  EXPECT_FALSE(read.surface.origin.isZero());
  for (std::size_t i = 0; i < fields.surface.positions.size(); ++i) {
    const auto world = [](const Vec3& p, const Fields& f) {
      return Eigen::Vector3d(p.cast<double>() + f.surface.origin);
    };
    EXPECT_LT(
        (world(read.position.points[i], read) - world(fields.position.points[i], fields)).norm(),
        1e-6);
    EXPECT_LT((world(read.surface.positions[i], read) - world(fields.surface.positions[i], fields))
                  .norm(),
              1e-6);
  }
}

TEST_F(FieldsFile, IsAMeshToOthers) {
  write_fields(path_, sample());
  const Mesh mesh = read_mesh(path_);
  EXPECT_EQ(mesh.positions, sample().surface.positions);
  EXPECT_EQ(mesh.normals, sample().surface.normals);
  EXPECT_EQ(mesh.faces.size(), sample().surface.faces.size());
}

const std::string vertices =
    "element vertex 4\nproperty float ox\nproperty double y\nproperty float oz\nproperty short x\n"
    "property float z\nproperty float oy\n";
const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string data = "2 0 0 0 0 0\n2 0 0 1 0 0\n1 1 0 1 0 0\n1 1 0 0 0 0\n4 0 1 2 3\n";
std::string text(const std::string& comments, const std::string& body = data) {
  return "ply\nformat ascii 1.0\n" + comments + vertices + faces + "end_header\n" + body;
}

TEST_F(FieldsFile, OthersMayWriteThem) {
  EXPECT_EQ(error_of(text("comment rosy 2\ncomment by hand # 3\n")), "no error");
  const Fields fields = read_fields(path_);
  EXPECT_EQ(fields.orientation.rosy, 2);
  EXPECT_EQ(fields.orientation.directions[0], Vec3(1, 0, 0));
  EXPECT_EQ(fields.surface.faces.size(), 2u);  // the quad's triangles
  EXPECT_EQ(fields.surface.normals[2], Vec3(0, 0, 1));
  EXPECT_TRUE(fields.position.points.empty());
}

TEST_F(FieldsFile, RefusesWhatIsWrong) {
  EXPECT_EQ(error_of(text("")), "the header has no \"comment rosy N\"");
  EXPECT_EQ(error_of(text("comment rosy 3\n")), "rosy 3 is unknown; known are 1, 2, 4, 6");
  EXPECT_EQ(error_of(text("comment rosy many\n")),
            "the header's comment \"rosy many\" is not a number");
  EXPECT_NE(error_of(text("comment meshgrain fields 2\ncomment rosy 4\n")).find("version 2"),
            std::string::npos);
  EXPECT_EQ(error_of(text("comment rosy 4\n", "0 0 0 0 0 0\n" + data)),
            "the orientation has no direction, in vertex 1 of 4");
  EXPECT_EQ(error_of(text("comment rosy 4\n", "2 0 0 0 0 0\n2 0 0")),
            "line 15: the file ends within vertex 2 of 4");
  EXPECT_EQ(error_of("v 0 0 0\n"), "is no PLY file, as files of fields are");
  EXPECT_NE(error_of("ply\nformat ascii 1.0\ncomment rosy 4\nelement vertex 1\nproperty float x\n"
                     "property float y\nproperty float z\nend_header\n0 0 0\n")
                .find("no number \"ox\""),
            std::string::npos);
  const std::string six =
      "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nproperty float ox\n"
      "property float oy\nproperty float oz\nproperty float px\nproperty float py\n";
  EXPECT_EQ(
      error_of("ply\nformat ascii 1.0\ncomment rosy 4\n" + six + "end_header\n0 0 0 1 0 0 0 0\n"),
      "has only some of the numbers \"px\", \"py\", \"pz\"");
  const std::string seven = six + "property float pz\nend_header\n0 0 0 1 0 0 0 0 0\n";
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\ncomment rosy 4\n" + seven),
            "the header has no \"comment posy N\"");
  EXPECT_NE(error_of("ply\nformat ascii 1.0\ncomment rosy 4\ncomment posy 4\n" + seven)
                .find("edge_length"),
            std::string::npos);
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\ncomment rosy 4\ncomment posy 4\ncomment edge_length "
                     "-1\n" +
                     seven),
            "the edge length -1 is not positive");
  EXPECT_EQ(error_of("ply\nformat ascii 1.0\ncomment rosy 4\ncomment posy 4\ncomment edge_length "
                     "1e300\n" +
                     seven),
            "the header's comment \"edge_length 1e300\" is not a number");
}

TEST(GivenFields, MustFitWhatIsAskedFor) {
  const Mesh sphere = sample_shape("sphere", 0.5);
  RemeshOptions options;
  options.face_count = 200;
  const Fields made = remesh(sphere, options).fields;
  const auto is_refused = [&](const Fields& fields, OutputFaces wanted = OutputFaces::quads) {
    options.fields = &fields;
    options.faces = wanted;
    try {
      remesh(sphere, options);
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(is_refused(made));
  EXPECT_TRUE(is_refused(made, OutputFaces::triangles));
  Fields fields = made;
  fields.orientation.rosy = 6;
  EXPECT_TRUE(is_refused(fields));
  fields.orientation.rosy = 0;
  EXPECT_TRUE(is_refused(fields));
  fields = made;
  fields.position.points.pop_back();
  EXPECT_TRUE(is_refused(fields));
  fields = made;
  fields.orientation.directions.pop_back();
  EXPECT_TRUE(is_refused(fields));
}

TEST(GivenFields, DecideHowFineTheMeshIs) {
  for (const std::size_t count : {300u, 3000u}) {  // the lattices are a fine and a coarse one
    RemeshOptions options;
    options.face_count = count;
    const RemeshResult made = remesh(sample_shape("bracket"), options);
    EXPECT_EQ(made.fields.fine_lattice, count < 1000);
    options.face_count = 0;
    options.fields = &made.fields;
    const Mesh again = remesh(sample_shape("bracket"), options).mesh;
    EXPECT_NEAR(static_cast<double>(again.faces.size()), static_cast<double>(count),
                0.05 * static_cast<double>(count));
  }
}

TEST(GivenFields, OfAnotherSurfaceAreSaidToBe) {
  RemeshOptions options;
  options.face_count = 200;
  const Fields fields = remesh(sample_shape("sphere", 1), options).fields;
  options.fields = &fields;
  const auto note = [&](const Mesh& mesh) {
    const auto notes = remesh(mesh, options).report.notes;
    return std::ranges::count_if(notes, [](const std::string& n) {
      return n.starts_with("the given fields are of another");
    });
  };
  EXPECT_EQ(note(sample_shape("sphere", 0.5)), 0);
  EXPECT_EQ(note(sample_shape("sphere", 2)), 0);  // finer or coarser makes no difference
  EXPECT_EQ(note(sample_shape("torus", 0.5)), 1);
}

TEST_F(FieldsFile, RefusesToWriteWhatDoesNotFit) {
  Fields fields = sample();
  fields.orientation.directions.pop_back();
  EXPECT_THROW(write_fields(path_, fields), Error);
  EXPECT_FALSE(fs::exists(path_));
}

}  // namespace
}  // namespace meshgrain
