#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include "measure/crossings.h"
#include "meshgrain/meshgrain.h"
#include "same_topology.h"

// Real models, from the folder that the environment variable MESHGRAIN_MODELS names.

namespace meshgrain {
namespace {

namespace fs = std::filesystem;

class Models : public testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("MESHGRAIN_MODELS");
    if (folder == nullptr || *folder == '\0')
      GTEST_SKIP() << "MESHGRAIN_MODELS names no folder of models";
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".md" || extension == ".txt") continue;
      files_[entry.path().stem().string()] = entry.path();
    }
    ASSERT_FALSE(files_.empty()) << folder << " is empty";
  }

  static constexpr std::size_t usual_count = 5000;

  static Mesh remesh_to(const Mesh& mesh, OutputFaces faces, std::size_t count = usual_count) {
    RemeshOptions options;
    options.faces = faces;
    options.face_count = count;
    return remesh(mesh, options).mesh;
  }

  std::map<std::string, fs::path> files_;
};

bool is_manifold(const MeshStatistics& s) {
  return s.non_manifold_edges == 0 && s.non_manifold_vertices == 0;
}

struct Means {
  double area_sigma = 0, angle_sigma = 0, singularities = 0;
  int results = 0;
};

/// The models that the figures of the comparison are means over.
const char* const compared[] = {"fandisk",        "armadillo",  "spot",      "cheburashka",
                                "3holes",         "bumpy-cube", "nefertiti", "homer",
                                "stanford-bunny", "cow",        "suzanne"};

constexpr std::size_t counts[] = {4600, 5000, 5400};

class EveryModel : public Models {
 protected:
  /// Checks what holds for every file, and returns the means over the compared models: at several
  /// counts, as a single result may be a little better or worse by chance.
  Means check_all(OutputFaces faces) {
    Means means;
    for (const auto& [name, path] : files_) {
      SCOPED_TRACE(path.filename().string());
      Mesh input = read_mesh(path);
      clean(input);
      const bool is_compared =
          std::find(std::begin(compared), std::end(compared), name) != std::end(compared);
      for (const std::size_t count : counts) {
        if (count != usual_count && !is_compared) continue;
        SCOPED_TRACE(count);
        const Mesh result = remesh_to(input, faces, count);
        check(input, result, faces, count);
        if (!is_compared) continue;
        const MeshStatistics s = mesh_statistics(result);
        add(s, means);
        if (faces != OutputFaces::quads) continue;
        EXPECT_GE(s.jacobian_min, 0.1);
        EXPECT_GE(s.jacobian_p01, count == usual_count ? 0.7 : 0.6);
      }
    }
    for (double* sum : {&means.area_sigma, &means.angle_sigma, &means.singularities}) {
      *sum /= std::max(means.results, 1);
    }
    return means;
  }

 private:
  static void check(const Mesh& input, const Mesh& result, OutputFaces faces, std::size_t count) {
    const MeshStatistics s = mesh_statistics(result);
    // Points have no way to come nearer than the first guesses do; the pieces that a surface is cut
    // into where it is not manifold lose faces when they are joined again.
    const double tolerance = input.is_point_cloud()                ? 0.1
                             : is_manifold(mesh_statistics(input)) ? 0.0101
                                                                   : 0.02;
    const auto wanted = static_cast<double>(count);
    EXPECT_NEAR(static_cast<double>(s.faces), wanted, tolerance * wanted);
    EXPECT_EQ(s.isolated_vertices, 0u);
    for (const Vec3& p : result.positions) EXPECT_TRUE(p.allFinite());
    if (faces == OutputFaces::quads) {
      EXPECT_EQ(s.quads, s.faces);
    } else if (faces == OutputFaces::triangles) {
      EXPECT_EQ(s.triangles, s.faces);
    }
    if (input.is_point_cloud()) return;
    const MeshStatistics before = mesh_statistics(input);
    if (!is_manifold(before)) return;
    made::expect_same_topology(s, before);
    EXPECT_EQ(s.inverted_quads, 0u);
  }

  static void add(const MeshStatistics& s, Means& means) {
    ++means.results;
    means.area_sigma += s.area_sigma;
    means.angle_sigma += s.angle_sigma;
    means.singularities += static_cast<double>(s.singularities);
  }
};

constexpr int all_results = static_cast<int>(std::size(compared) * std::size(counts));

/// What the means may be at most.
struct Bounds {
  double area_sigma, angle_sigma, singularities;
};

void expect_within(const Means& means, const Bounds& bounds) {
  if (means.results < all_results) GTEST_SKIP() << "not all of the compared models are there";
  EXPECT_LE(means.area_sigma, bounds.area_sigma);
  EXPECT_LE(means.angle_sigma, bounds.angle_sigma);
  EXPECT_LE(means.singularities, bounds.singularities);
}

TEST_F(EveryModel, AsQuads) {
  expect_within(check_all(OutputFaces::quads), {0.18, 7.5, 80});
}

TEST_F(EveryModel, AsQuadDominantMeshes) {
  expect_within(check_all(OutputFaces::quad_dominant), {0.17, 6.3, 130});
}

TEST_F(EveryModel, AsTriangles) {
  expect_within(check_all(OutputFaces::triangles), {0.13, 5.5, 130});
}

/// Where no faces of the input pass through each other, none of the result do.
TEST_F(Models, DoNotPassThroughThemselves) {
  int checked = 0;
  for (const char* name : compared) {
    if (!files_.contains(name)) continue;
    Mesh input = read_mesh(files_[name]);
    clean(input);
    if (!find_crossings(triangulate(input), Context()).empty()) continue;
    ++checked;
    EXPECT_TRUE(find_crossings(remesh_to(input, OutputFaces::quads), Context()).empty()) << name;
  }
  if (checked == 0) GTEST_SKIP() << "none of the models is there";
}

/// On a lattice twice as coarse as the quads, two of armadillo's fingers are cut off by three sides
/// of a face at these counts, and one by two sides on another where positions start as usual.
TEST_F(Models, EndsOfLimbsAreReached) {
  if (!files_.contains("armadillo")) GTEST_SKIP() << "no armadillo among the models";
  const Mesh input = read_mesh(files_["armadillo"]);
  const auto farthest = [&](const Mesh& result) {
    return surface_distance(input, result, mesh_statistics(result).edge_mean).max;
  };
  EXPECT_LT(farthest(remesh_to(input, OutputFaces::quad_dominant)), 1.5);
  for (const std::size_t count : {5000, 6000}) {
    const Mesh result = remesh_to(input, OutputFaces::quads, count);
    EXPECT_LT(farthest(result), 1.8) << count;
    // With .53 a finger was drawn to a string, from a face that was turned over.
    EXPECT_GT(mesh_statistics(result).jacobian_min, 0.4) << count;
    EXPECT_EQ(result.faces.uniform_degree(), 4u);
    EXPECT_NEAR(static_cast<double>(result.faces.size()), static_cast<double>(count),
                0.01 * static_cast<double>(count));
  }
}

/// One of homer's is lost where its rows of faces are cancelled.
TEST_F(Models, FingersAreNotLost) {
  if (!files_.contains("homer")) GTEST_SKIP() << "no homer among the models";
  const Mesh input = read_mesh(files_["homer"]);
  const Mesh result = remesh_to(input, OutputFaces::quads, 5000);
  EXPECT_LT(surface_distance(input, result, mesh_statistics(result).edge_mean).max, 1.3);
}

/// The cow's is a broad tuft at a thin end: on a lattice without the singularities where it becomes
/// wide there is a notch in it.
TEST_F(Models, TailsAreWhole) {
  if (!files_.contains("cow")) GTEST_SKIP() << "no cow among the models";
  const Mesh input = read_mesh(files_["cow"]);
  for (const std::uint64_t seed : {0, 2}) {
    SCOPED_TRACE(seed);
    RemeshOptions options;
    options.face_count = usual_count;
    options.solver.seed = seed;
    const Mesh result = remesh(input, options).mesh;
    const auto [mean, max] = surface_distance(input, result, mesh_statistics(result).edge_mean);
    EXPECT_LT(max, 1.3);
    EXPECT_LT(mean, 0.044);
  }
}

/// Creases, corners and ragged borders are followed without any option.
TEST_F(Models, LinesAreKept) {
  int checked = 0;
  for (const char* name : {"fandisk", "stanford-bunny", "suzanne"}) {
    if (!files_.contains(name)) continue;
    ++checked;
    SCOPED_TRACE(name);
    Mesh input = read_mesh(files_[name]);
    clean(input);
    for (const OutputFaces faces : {OutputFaces::quads, OutputFaces::quad_dominant}) {
      const KeptLines kept = kept_lines(input, remesh_to(input, faces));
      EXPECT_GE(kept.border.value_or(1), 0.97);
      if (name != std::string("fandisk")) continue;
      EXPECT_GE(kept.creases.value(), 0.99);
      EXPECT_EQ(kept.corners_kept, kept.corners);
    }
  }
  if (checked == 0) GTEST_SKIP() << "none of the models is there";
}

/// Also where faces that pass through each other are mended, who look at each other from afar.
TEST_F(Models, AnyNumberOfThreadsGivesTheSame) {
  int checked = 0;
  for (const char* name : {"cow", "suzanne"}) {
    if (!files_.contains(name)) continue;
    ++checked;
    const Mesh input = read_mesh(files_[name]);
    RemeshOptions options;
    options.face_count = usual_count;
    const Mesh one = remesh(input, options, Context(1)).mesh;
    for (const int threads : {2, 3}) {
      const Mesh many = remesh(input, options, Context(threads)).mesh;
      EXPECT_EQ(many.positions, one.positions) << name;
      EXPECT_TRUE(std::ranges::equal(many.faces.corners(), one.faces.corners())) << name;
    }
  }
  if (checked == 0) GTEST_SKIP() << "none of the models is there";
}

TEST_F(Models, FewOrientationSingularities) {
  const std::map<std::string, std::size_t> most = {
      {"fandisk", 34}, {"3holes", 38}, {"bumpy-cube", 32}};
  int checked = 0;
  for (const auto& [name, limit] : most) {
    if (!files_.contains(name)) continue;
    ++checked;
    const Mesh input = read_mesh(files_[name]);
    for (const OutputFaces faces : {OutputFaces::quads, OutputFaces::quad_dominant}) {
      RemeshOptions options;
      options.faces = faces;
      options.face_count = usual_count;
      const RemeshReport report = remesh(input, options).report;
      EXPECT_LE(report.orientation_singularities.value(), limit) << name;
    }
  }
  if (checked == 0) GTEST_SKIP() << "none of the models is there";
}

/// Points that were sampled from one closed surface come back as one closed surface, nearly as even
/// in the mean as one of its mesh.
TEST_F(Models, ACloudComesBackAsOneSurface) {
  if (!files_.contains("armadillo")) GTEST_SKIP() << "no armadillo";
  const Mesh mesh = read_mesh(files_["armadillo"]);
  Mesh cloud = mesh;
  cloud.faces.clear();
  double area[2] = {}, angle[2] = {};  // sums of deviations, of the mesh and of its points
  for (const std::size_t count : counts) {
    SCOPED_TRACE(count);
    const Mesh* inputs[2] = {&mesh, &cloud};
    for (int k = 0; k < 2; ++k) {
      const MeshStatistics s = mesh_statistics(remesh_to(*inputs[k], OutputFaces::quads, count));
      EXPECT_EQ(s.components, 1u);
      EXPECT_EQ(s.boundary_loops, 0u);
      area[k] += s.area_sigma;
      angle[k] += s.angle_sigma;
    }
  }
  EXPECT_LE(area[1], 1.1 * area[0]);
  EXPECT_LE(angle[1], 1.1 * angle[0]);
}

}  // namespace
}  // namespace meshgrain
