#pragma once
#include "kaustik/base/wavelengths.h"
#include "kaustik/geometry/shape.h"

namespace kaustik {

/// Radiance that varies over a surface, the same in all directions; or a factor on what a light
/// sends out (LightType::pattern_is_factor). Immutable. What it is made of (a texture) is known
/// elsewhere: this room asks for values alone.
class EmissionPattern {
 public:
  virtual ~EmissionPattern() = default;
  /// W/(sr·m²), finite, no lane negative. Does not ask for the side: `ng` may be of either sign.
  virtual Spectrum radiance(const SurfacePoint& at, const Wavelengths& wavelengths) const = 0;
  /// In RGB mode: about the mean over the part of the uv square that is `uv_width` wide about the
  /// point, or what is there.
  virtual Spectrum mean_about(const SurfacePoint& at, float uv_width) const {
    (void)uv_width;
    return radiance(at, {});
  }
  /// Upper bound of every lane in RGB mode; zero: dark everywhere.
  virtual float maximum() const = 0;
  /// Width over height of the picture that it is; 1 if it is none.
  virtual float aspect() const { return 1; }
};

/// Mean of the pattern over the shape's area in RGB mode, by 256² stratified points: for choosing
/// among lights and reports, which need no more. A spot that all of them miss still counts as one
/// of them.
Spectrum mean_radiance(const EmissionPattern& pattern, const Shape& shape);

}  // namespace kaustik
