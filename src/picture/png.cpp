#include <fmt/format.h>
#include <png.h>

#include <filesystem>
#include <vector>

#include "io/output.h"
#include "meshgrain/error.h"
#include "meshgrain/picture.h"

namespace meshgrain {
namespace {

std::vector<char> encode(const Image& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  std::vector<char> bytes;
  // The first call only asks for the size.
  for (int pass = 0; pass < 2; ++pass) {
    if (!png_image_write_to_memory(&png, pass == 0 ? nullptr : bytes.data(), &size, 0,
                                   image.rgb.data(), 0, nullptr))
      throw Error(fmt::format("cannot encode the picture: {}", png.message));
    bytes.resize(size);
  }
  return bytes;
}

}  // namespace

void write_png(const std::filesystem::path& path, const Image& image) {
  if (image.width < 1 || image.height < 1 ||
      image.rgb.size() != 3 * std::size_t(image.width) * image.height)
    throw Error("the picture has no pixels, or not as many as its width and height say");
  const std::vector<char> bytes = encode(image);
  io::Output output(path);
  output.write({bytes.data(), bytes.size()});
  output.commit();
}

}  // namespace meshgrain
