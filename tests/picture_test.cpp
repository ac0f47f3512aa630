#include "meshgrain/picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>

#include "meshgrain/error.h"
#include "meshgrain/shapes.h"

namespace meshgrain {
namespace {

struct Pixel {
  int r, g, b;
  bool white() const { return r == 255 && g == 255 && b == 255; }
  bool red() const { return r > 150 && g < 100 && b < 100; }
  bool blue() const { return b > 150 && r < 100; }
};

Pixel at(const Image& image, int x, int y) {
  const std::size_t i = 3 * (std::size_t(y) * image.width + x);
  return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

template <class Predicate>
int count(const Image& image, Predicate&& predicate) {
  int n = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) n += predicate(at(image, x, y));
  return n;
}

PictureOptions options(int width, int height) {
  PictureOptions o;
  o.width = width;
  o.height = height;
  o.view = {0, 0, 1};
  return o;
}

Mesh one_triangle() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.faces.push_back({0, 1, 2});
  return mesh;
}

TEST(DrawPicture, ASphereCoversItsDiscOnWhite) {
  auto o = options(400, 300);
  const Image image = draw_picture(sample_shape("sphere", 2), o);
  ASSERT_EQ(image.rgb.size(), 3u * 400 * 300);
  EXPECT_TRUE(at(image, 0, 0).white());
  EXPECT_TRUE(at(image, 399, 299).white());
  EXPECT_FALSE(at(image, 200, 150).white());
  const double radius = (300 - 2 * 15) / 2.0;  // a margin of a twentieth
  const int covered = count(image, [](Pixel p) { return !p.white(); });
  // Pixels on the outline count in full: half of them too many.
  const double expected = std::numbers::pi * (radius + 0.5) * (radius + 0.5);
  EXPECT_NEAR(covered / expected, 1, 0.01);
}

TEST(DrawPicture, ZoomScales) {
  auto o = options(400, 400);
  o.zoom = 0.5f;
  const Image image = draw_picture(sample_shape("sphere"), o);
  const int covered = count(image, [](Pixel p) { return !p.white(); });
  EXPECT_NEAR(covered / (std::numbers::pi * 90.5 * 90.5), 1, 0.015);
}

TEST(DrawPicture, DotsMarkIrregularVertices) {
  auto o = options(300, 300);
  const Mesh mesh = sample_shape("sphere", 0.3);  // twelve vertices of five neighbours
  EXPECT_GT(count(draw_picture(mesh, o), [](Pixel p) { return p.red(); }), 20);
  EXPECT_EQ(count(draw_picture(mesh, o), [](Pixel p) { return p.blue(); }), 0);
  o.irregular = false;
  EXPECT_EQ(count(draw_picture(mesh, o), [](Pixel p) { return p.red(); }), 0);
}

TEST(DrawPicture, TooManyNeighboursAreBlue) {
  Mesh fan;  // of eight triangles
  fan.positions = {{0, 0, 0}};
  for (int k = 0; k < 8; ++k) {
    const double angle = 2 * std::numbers::pi * k / 8;
    fan.positions.emplace_back(float(std::cos(angle)), float(std::sin(angle)), 0.0f);
  }
  for (Index k = 0; k < 8; ++k) fan.faces.push_back({0, 1 + k, 1 + (k + 1) % 8});
  EXPECT_TRUE(at(draw_picture(fan, options(300, 300)), 150, 150).blue());
}

TEST(DrawPicture, BordersAreRedAndBacksReddish) {
  auto o = options(300, 300);
  const Image front = draw_picture(one_triangle(), o);
  EXPECT_TRUE(at(front, 150, 284).red());  // its lower side, just above the margin
  const Pixel inner = at(front, 90, 210);
  EXPECT_LE(inner.r, inner.b);
  o.view = {0, 0, -1};
  const Image back = draw_picture(one_triangle(), o);
  const Pixel behind = at(back, 210, 210);
  EXPECT_GT(behind.r, behind.b + 40);
}

TEST(DrawPicture, TintsOddFacesOfQuadMeshes) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  mesh.faces.push_back({0, 1, 4, 3});
  mesh.faces.push_back({3, 4, 5, 6});
  mesh.faces.push_back({1, 2, 4});
  auto o = options(300, 300);
  o.edges = false;
  const Pixel quad = at(draw_picture(mesh, o), 80, 220), odd = at(draw_picture(mesh, o), 190, 240);
  EXPECT_LE(quad.r, quad.b);
  EXPECT_GT(odd.r, odd.b + 40);
  o.irregular = false;
  const Pixel plain = at(draw_picture(mesh, o), 190, 240);
  EXPECT_LE(plain.r, plain.b);
}

TEST(DrawPicture, TheNearerFaceHidesTheOther) {
  Mesh mesh = one_triangle();
  for (const Vec3& p : one_triangle().positions) mesh.positions.push_back(p + Vec3(0, 0, 1));
  mesh.faces.push_back({3, 5, 4});  // nearer, and turned away
  const Pixel p = at(draw_picture(mesh, options(300, 300)), 90, 210);
  EXPECT_GT(p.r, p.b + 40);
}

TEST(DrawPicture, DenseMeshesDoNotTurnBlack) {
  auto o = options(200, 200);
  const Image image = draw_picture(sample_shape("plate", 8), o);
  const Pixel p = at(image, 100, 100);
  EXPECT_GT(p.g, 120);
}

TEST(DrawPicture, PointClouds) {
  Mesh cloud;
  cloud.positions = sample_shape("sphere").positions;
  const Image image = draw_picture(cloud, options(200, 200));
  EXPECT_GT(count(image, [](Pixel p) { return !p.white(); }), 20000);
  EXPECT_TRUE(at(image, 1, 1).white());
  cloud.normals = cloud.positions;  // of a unit sphere
  EXPECT_FALSE(at(draw_picture(cloud, options(200, 200)), 100, 100).white());
}

TEST(DrawPicture, NothingIsAPlainBackground) {
  const auto all_white = [](const Image& image) {
    return std::all_of(image.rgb.begin(), image.rgb.end(), [](auto x) { return x == 255; });
  };
  EXPECT_TRUE(all_white(draw_picture(Mesh(), options(50, 40))));
  Mesh lost = one_triangle();
  lost.positions[1].x() = std::nanf("");
  EXPECT_TRUE(all_white(draw_picture(lost, options(50, 40))));
}

TEST(DrawPicture, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = sample_shape("bracket");
  EXPECT_EQ(draw_picture(mesh, options(200, 200), Context(1)).rgb,
            draw_picture(mesh, options(200, 200), Context(2)).rgb);
}

TEST(DrawPicture, RefusesOptionsWithoutSense) {
  auto bad = options(0, 10);
  EXPECT_THROW(draw_picture(Mesh(), bad), Error);
  bad = options(10, 10);
  bad.view.setZero();
  EXPECT_THROW(draw_picture(Mesh(), bad), Error);
  bad = options(10, 10);
  bad.zoom = 0;
  EXPECT_THROW(draw_picture(Mesh(), bad), Error);
  auto along = options(60, 60);
  along.view = along.up;  // any direction may be up
  EXPECT_FALSE(at(draw_picture(sample_shape("cube", 0.2), along), 30, 30).white());
}

TEST(WritePng, HasSignatureAndSize) {
  const auto path = std::filesystem::temp_directory_path() / "meshgrain_picture_test.png";
  write_png(path, draw_picture(Mesh(), options(300, 20)));
  std::ifstream in(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  ASSERT_GT(bytes.size(), 33u);
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\1\x2c\0\0\0\x14", 8));
  std::filesystem::remove(path);
}

TEST(WritePng, ThrowsWhereItCannotWrite) {
  const Image image = draw_picture(Mesh(), options(4, 4));
  EXPECT_THROW(write_png("/nowhere/at/all/picture.png", image), Error);
  EXPECT_THROW(write_png("picture.png", Image{}), Error);
  EXPECT_FALSE(std::filesystem::exists("picture.png"));
}

}  // namespace
}  // namespace meshgrain
