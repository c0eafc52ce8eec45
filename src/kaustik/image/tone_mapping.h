#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/image/image.h"
#include "kaustik/image/picture.h"

namespace kaustik {

/// How radiance becomes what a display shows.
class ToneOperator {
 public:
  virtual ~ToneOperator() = default;
  /// Display-linear colours of the pixels, row by row, and then of the parts, 1 being the display's
  /// white; they may lie outside [0, 1].
  virtual std::vector<Vec3f> displayed(Picture picture) const = 0;
  /// Whether colours are shown as they look, so that parts of a pixel may be mixed.
  virtual bool shows_parts() const { return true; }
  /// Depends on the camera's field of view.
  virtual bool needs_view() const { return false; }
  /// What else is drawn: gets the finished picture in [0, 1] and may return a larger one.
  virtual Image decorated(Image shown, const Picture&) const { return shown; }
};

struct ToneOperatorType {
  TypeInfo info;
  std::unique_ptr<ToneOperator> (*make)(const Arguments& arguments);
};
/// All operators: the one place that names them.
const std::vector<ToneOperatorType>& tone_operator_types();
std::vector<std::string> tone_operator_names();

/// The operator of this name with parameters given as texts "name=value". Throws Error(input) for
/// what its table does not know.
std::shared_ptr<const ToneOperator> make_tone_operator(
    const std::string& name, const std::vector<std::string>& settings = {});

/// "R", "G", "B" in [0, 1] of `layer` of an image as a display shows it, linear; 1 is its white.
/// Colours that it cannot show are desaturated toward their luminance. Where the image tells which
/// part of a pixel a lamp fills ("emission.A"), lamp and rest are shown apart and then mixed: else
/// the edges of bright lamps would be stairs. A pixel with a NaN becomes
/// black, +infinity white; neither influences others. `view`: of the camera; without one, what the
/// image's metadata say, else 50° across. Keeps the metadata. An image that is a window of a
/// picture is shown as such; `in_frame`: in its place in the picture, which is black elsewhere.
/// Throws Error(input) if the image has no such layer or `view` is out of its range.
Image tone_map(const Image& image, const ToneOperator& tone, const std::string& layer = {},
               const std::optional<FieldOfView>& view = {}, bool in_frame = false);

/// `rgb` (display-linear) brought into [0, 1]³ by moving it toward its own luminance.
Vec3f into_gamut(const Vec3f& rgb);

/// Interleaved 8-bit sRGB of an image with "R", "G", "B" in [0, 1], rounded to nearest.
std::vector<uint8_t> srgb_bytes(const Image& display_linear);

}  // namespace kaustik
