#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/image/image.h"

namespace kaustik {

/// Angles between the opposite sides of a perspective picture, degrees, in (0, 180).
struct FieldOfView {
  float horizontal = 50;
  float vertical = 0;  ///< 0: from the picture's aspect, with square pixels
};

/// Metadata: the film's exposure, in stops.
inline constexpr const char* film_exposure_key = "film_exposure";

/// What the image's metadata say ("horizontal_fov", "vertical_fov": numbers or text), if they do.
std::optional<FieldOfView> field_of_view(const Image& image);

/// Pixels that cannot be shown as they are.
struct BadPixels {
  size_t not_a_number = 0;  ///< a channel is NaN, or infinities of both signs: shown black
  size_t infinite = 0;      ///< shown white if positive, else black
  size_t negative = 0;      ///< luminance below zero: shown black
};
BadPixels count_bad_pixels(const RgbView& rgb);

/// One layer of an image on its way to a display.
struct Picture {
  /// Pixels that are NaN or infinite take the value of the last good one before them, so that they
  /// influence no other. Throws Error(input) if the image has no such layer or the field of view
  /// is out of its range.
  Picture(const Image& image, const std::string& layer, const FieldOfView& view);

  size_t pixel_count() const { return pixels.size(); }

  int width, height;
  /// The metadata "quantity" is "irradiance": the pixels are in W/m².
  bool is_irradiance = false;
  /// By what the light is multiplied where it is shown; what the eye adapts to does not ask.
  float exposure = 1;
  /// Colours of parts of pixels, which are shown as pixels are; what an eye or a curve adapts to
  /// are the pixels alone. Finite.
  std::vector<Vec3f> parts;
  std::vector<Vec3f> pixels;  ///< linear Rec. 709, radiance in W/(sr·m²), finite; row by row
  /// Half the picture's extent on a plane at distance 1 before the eye.
  float half_width, half_height;
};

/// A value for each cell of a grid over the picture, read between the centres of cells.
template <typename T>
struct Grid {
  int columns = 0, rows = 0;
  std::vector<T> cells;  ///< row by row

  T& at(int column, int row) { return cells[size_t(row) * size_t(columns) + size_t(column)]; }
  const T& at(int column, int row) const {
    return cells[size_t(row) * size_t(columns) + size_t(column)];
  }
  /// Bilinear; x and y in cells from the top left corner, constant beyond the outer centres.
  T interpolated(float x, float y) const {
    const auto split = [](float position, int count, int& lower, int& upper) {
      const float p = std::clamp(position - 0.5f, 0.0f, float(count - 1));
      lower = int(p);
      upper = std::min(lower + 1, count - 1);
      return p - float(lower);
    };
    int x0, x1, y0, y1;
    const float dx = split(x, columns, x0, x1), dy = split(y, rows, y0, y1);
    return (at(x0, y0) * (1 - dx) + at(x1, y0) * dx) * (1 - dy) +
           (at(x0, y1) * (1 - dx) + at(x1, y1) * dx) * dy;
  }
};

/// Mean colours of cells of about 1° × 1°, the fovea's size (at least one pixel each): what the
/// eye adapts to when it looks there. Ward Larson et al. 1997, section 4.1.
Grid<Vec3f> foveal_means(const Picture& picture);

}  // namespace kaustik
