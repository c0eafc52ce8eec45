#include "kaustik/image/picture_argument.h"

#include <fmt/format.h>

namespace kaustik {
namespace {

/// Errors of reading get the place of the file name.
Image read_at(const Arguments& arguments, const ReadOptions& options) {
  try {
    return read_image(arguments.text("filename"), options);
  } catch (const Error& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems)
      if (!problem.place.file) problem.place = arguments.place_of("filename");
    throw Error(error.kind(), std::move(problems));
  }
}

/// Its colours or its grey. Alpha is no colour, and which of other channels is meant nobody knows.
RgbView colours_of(const Image& image, const Arguments& arguments) {
  try {
    return rgb_view(image);
  } catch (const Error&) {
    throw Error(ErrorKind::input,
                fmt::format("picture '{}' has no colours: its channels are {}",
                            arguments.text("filename"), fmt::join(image.channel_names(), ", ")),
                "save it with the channels R, G and B, or with one that is called Y",
                arguments.place_of("filename"));
  }
}

void check_pixels(const Image& image, const Arguments& arguments) {
  const RgbView pixels = colours_of(image, arguments);
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    const Vec3f c = pixels[i];
    if (is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0) continue;
    throw Error(ErrorKind::input,
                "picture '" + arguments.text("filename") + "' has a value at (" +
                    std::to_string(i % size_t(image.width())) + ", " +
                    std::to_string(i / size_t(image.width())) + ") that is negative or not finite",
                "repair the picture", arguments.place_of("filename"));
  }
}

}  // namespace

Image read_picture_argument(const Arguments& arguments, const ReadOptions& options) {
  Image image = read_at(arguments, options);
  check_pixels(image, arguments);
  return image;
}

}  // namespace kaustik
