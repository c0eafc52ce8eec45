#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/uv_transform.h"

namespace kaustik {
namespace {

/// Squares of half a unit of uv in two colours; the one at the origin has color0.
class Checkerboard final : public Texture {
 public:
  Checkerboard(const SpectralValue& color0, const SpectralValue& color1, const UvTransform& to_uv)
      : color0_(color0), color1_(color1), to_uv_(to_uv) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override {
    const Vec2f uv = to_uv_(at.uv), width = to_uv_.width(at.uv_width);
    const float sign = square_wave(uv.x, width.x) * square_wave(uv.y, width.y);
    return color0_.at(wavelengths) * (0.5f + 0.5f * sign) +
           color1_.at(wavelengths) * (0.5f - 0.5f * sign);
  }
  float maximum() const override {
    return std::max(color0_.rgb().max_lane(), color1_.rgb().max_lane());
  }
  Spectrum mean() const override { return (color0_.rgb() + color1_.rgb()) * 0.5f; }
  /// Of steps a hundredth of a square wide: as a relief the squares are plateaus.
  HeightGradient height_gradient(const TextureCoordinates& at) const override {
    HeightGradient gradient;
    for (int axis = 0; axis < 2; ++axis) {
      TextureCoordinates a = at, b = at;
      a.uv_width[axis] = b.uv_width[axis] = std::max(at.uv_width[axis], 0.005f);
      const float step = 0.5f * b.uv_width[axis];
      a.uv[axis] -= step;
      b.uv[axis] += step;
      gradient.uv[axis] = (scalar(b) - scalar(a)) / (2 * step);
    }
    return gradient;
  }

 private:
  /// 1 in the first half of every unit, −1 in the second; its mean over `width`.
  static float square_wave(float x, float width) {
    const float rest = x - std::floor(x);
    if (!(width > 1e-6f)) return rest > 0.5f ? -1.0f : 1.0f;
    // Within one period: far out, floats would lose narrow footprints.
    return (triangle_wave(rest + 0.5f * width) - triangle_wave(rest - 0.5f * width)) / width;
  }
  /// Its integral.
  static float triangle_wave(float x) { return 0.5f - std::fabs(x - std::floor(x) - 0.5f); }

  SpectralValue color0_, color1_;
  UvTransform to_uv_;
};

const TypeInfo& checkerboard_info() {
  static const TypeInfo info{
      "texture",
      "checkerboard",
      "Two colours in squares.",
      {color_parameter("color0", 0.4, "Colour of the square at the origin.").range(0, 1e6),
       color_parameter("color1", 0.2, "Colour of its neighbours.").range(0, 1e6),
       transform_parameter("to_uv", "Applied to the coordinates before the lookup.")}};
  return info;
}

std::shared_ptr<const Texture> create_checkerboard(const Arguments& arguments, PictureReader&) {
  return std::make_shared<Checkerboard>(SpectralValue::reflectance(arguments.color("color0")),
                                        SpectralValue::reflectance(arguments.color("color1")),
                                        UvTransform(arguments.transform("to_uv")));
}

}  // namespace

TextureType checkerboard_type() { return {checkerboard_info(), create_checkerboard}; }

}  // namespace kaustik
