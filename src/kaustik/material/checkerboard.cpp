#include "kaustik/base/color.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/uv_transform.h"

namespace kaustik {
namespace {

/// Squares of half a unit of uv in two colours; the one at the origin has color0.
class Checkerboard final : public Texture {
 public:
  Checkerboard(const Spectrum& color0, const Spectrum& color1, const UvTransform& to_uv)
      : color0_(color0), color1_(color1), to_uv_(to_uv) {}

  Spectrum eval(const TextureCoordinates& at) const override {
    const Vec2f uv = to_uv_(at.uv);
    const bool right = uv.x - std::floor(uv.x) > 0.5f, upper = uv.y - std::floor(uv.y) > 0.5f;
    return right == upper ? color0_ : color1_;
  }
  float maximum() const override { return std::max(color0_.max_lane(), color1_.max_lane()); }
  Spectrum mean() const override { return (color0_ + color1_) * 0.5f; }

 private:
  Spectrum color0_, color1_;
  UvTransform to_uv_;
};

const TypeInfo& info() {
  static const TypeInfo info{
      "texture",
      "checkerboard",
      "Two colours in squares.",
      {color_parameter("color0", 0.4, "Colour of the square at the origin.").range(0, 1e6),
       color_parameter("color1", 0.2, "Colour of its neighbours.").range(0, 1e6),
       transform_parameter("to_uv", "Applied to the coordinates before the lookup.")}};
  return info;
}

std::shared_ptr<const Texture> create(const Arguments& arguments) {
  return std::make_shared<Checkerboard>(reflectance_spectrum(arguments.color("color0")),
                                        reflectance_spectrum(arguments.color("color1")),
                                        UvTransform(arguments.transform("to_uv")));
}

}  // namespace

TextureType checkerboard_type() { return {info(), create}; }

}  // namespace kaustik
