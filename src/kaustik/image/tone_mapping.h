#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kaustik/image/image.h"

namespace kaustik {

enum class ToneOperator {
  srgb,      ///< radiance 1 becomes white
  linear,    ///< radiance 2^-exposure becomes white
  histogram  ///< histogram adjustment (Ward Larson, Rushmeier and Piatko 1997)
};

/// The operator called "srgb", "linear" or "histogram"; throws Error(input) for other names.
ToneOperator tone_operator_from_name(const std::string& name);

/// How radiance becomes what a display shows.
struct ToneMapping {
  ToneOperator op = ToneOperator::histogram;
  float exposure = 0;  ///< in stops; linear only
  // What follows is for histogram adjustment.
  float horizontal_fov = 50;          ///< of the camera, degrees, in (0, 180)
  float vertical_fov = 0;             ///< degrees; 0: from the image's aspect, square pixels
  float display_max_luminance = 100;  ///< cd/m² of the display's white
  float display_dynamic_range = 100;  ///< display's white over its black, above 1
};

/// Display-linear "R", "G", "B" in [0, 1] of `layer` of an image; 1 is the display's white. Colours
/// that the display cannot show are desaturated toward their luminance. A pixel with a NaN becomes
/// black, +infinity white; neither influences others. Throws Error(input) if a parameter is out of
/// its range or the image has no such layer.
Image tone_map(const Image& image, const ToneMapping& mapping, const std::string& layer = {});

/// From world luminance to display luminance (both cd/m²): the curve of histogram adjustment.
class HistogramAdjustment {
 public:
  /// `luminances` of foveal samples of 1°; those not positive and finite are left out.
  HistogramAdjustment(const std::vector<float>& luminances, const ToneMapping& mapping);
  /// Monotonic; in [display black, display white].
  float display_luminance(float world_luminance) const;
  float display_black() const { return display_black_; }
  float display_white() const { return display_white_; }
  /// The scene's range fits the display's: world luminance is merely scaled.
  bool is_linear() const { return is_linear_; }

 private:
  static constexpr int bin_count = 100;
  void adjust(const std::vector<double>& logs, double display_range);

  float display_black_, display_white_;
  double log_min_ = 0, log_max_ = 0;  ///< of the world's luminance
  bool is_linear_ = true;
  std::array<double, bin_count + 1> cumulative_ = {};  ///< at the borders of the bins, 0 to 1
};

/// Means of luminance over cells of about 1° × 1° (at least one pixel each).
std::vector<float> foveal_luminances(const RgbView& rgb, int width, int height,
                                     const ToneMapping& mapping);

/// `rgb` (display-linear) brought into [0, 1]³ by moving it toward its own luminance.
Vec3f into_gamut(const Vec3f& rgb);

/// Interleaved 8-bit sRGB of an image with "R", "G", "B" in [0, 1], rounded to nearest.
std::vector<uint8_t> srgb_bytes(const Image& display_linear);

}  // namespace kaustik
