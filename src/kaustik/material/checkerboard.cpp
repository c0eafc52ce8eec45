#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/two_colours.h"
#include "kaustik/material/uv_transform.h"

namespace kaustik {
namespace {

/// Squares of half a unit of uv in two colours; the one at the origin has color0.
class Checkerboard final : public TwoColours {
 public:
  Checkerboard(std::shared_ptr<const Texture> color0, std::shared_ptr<const Texture> color1,
               const UvTransform& to_uv)
      : TwoColours(std::move(color0), std::move(color1)), to_uv_(to_uv) {}

  Spectrum mean() const override { return (color0().mean() + color1().mean()) * 0.5f; }

 private:
  float share_of_color0(const Vec2f& at, const Vec2f& extent) const override {
    const Vec2f uv = to_uv_(at), width = to_uv_.width(extent);
    return 0.5f + 0.5f * (square_wave(uv.x, width.x) * square_wave(uv.y, width.y));
  }
  /// 1 in the first half of every unit, −1 in the second; its mean over `width`.
  static float square_wave(float x, float width) {
    const float rest = x - std::floor(x);
    if (!(width > 1e-6f)) return rest > 0.5f ? -1.0f : 1.0f;
    // Within one period: far out, floats would lose narrow footprints.
    return (triangle_wave(rest + 0.5f * width) - triangle_wave(rest - 0.5f * width)) / width;
  }
  /// Its integral.
  static float triangle_wave(float x) { return 0.5f - std::fabs(x - std::floor(x) - 0.5f); }

  UvTransform to_uv_;
};

const TypeInfo& checkerboard_info() {
  static const TypeInfo info{
      "texture",
      "checkerboard",
      "Two colours or textures in squares.",
      {color_parameter("color0", 0.4, "Colour of the square at the origin.")
           .range(0, 1e6)
           .textured(),
       color_parameter("color1", 0.2, "Colour of its neighbours.").range(0, 1e6).textured(),
       transform_parameter("to_uv", "Transform of the coordinates before the lookup.").leaving(0)}};
  return info;
}

std::shared_ptr<const Texture> create_checkerboard(const TextureInputs& in) {
  return std::make_shared<Checkerboard>(in.texture("color0"), in.texture("color1"),
                                        UvTransform(in.arguments.transform("to_uv")));
}

}  // namespace

TextureType checkerboard_type() { return {checkerboard_info(), create_checkerboard}; }

}  // namespace kaustik
