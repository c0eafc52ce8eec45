#pragma once
#include <string>
#include <vector>

#include "kaustik/image/image.h"
#include "kaustik/render/film.h"
#include "tests/support/pass_of.h"

namespace kaustik::test {

inline FilmSettings film_of_size(int width, int height) {
  FilmSettings settings;
  settings.size = settings.crop_size = {width, height};
  return settings;
}

/// A pass of a film's pixels, row by row.
inline PassTiles tiled(const std::vector<PassPixel>& pixels, const Film& film) {
  return pass_of(pixels, {film.width(), film.height()});
}

inline std::vector<PassPixel> grey_pixels(float value, size_t count) {
  std::vector<PassPixel> pass(count);
  for (PassPixel& pixel : pass) pixel.radiance[0] = {value, value, value, 0};
  return pass;
}

inline float value_at(const Image& image, int x, int y, const std::string& channel) {
  return image.at(x, y, image.find_channel(channel));
}

}  // namespace kaustik::test
