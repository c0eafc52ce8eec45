#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/tile_row.h"
#include "kaustik/material/two_colours.h"
#include "kaustik/material/uv_transform.h"

namespace kaustik {
namespace {

/// Lines about the borders of each unit of uv, as Mitsuba 0.6 draws them: each reaches
/// `line_width` to either side.
class GridTexture final : public TwoColours {
 public:
  GridTexture(std::shared_ptr<const Texture> color0, std::shared_ptr<const Texture> color1,
              float half_width, const UvTransform& to_uv)
      : TwoColours(std::move(color0), std::move(color1)),
        half_width_(half_width),
        between_{1 - 2 * half_width, 1},
        to_uv_(to_uv) {}

  Spectrum mean() const override {
    const float share = between_.size * between_.size;
    return color0().mean() * share + color1().mean() * (1 - share);
  }

 private:
  float share_of_color0(const Vec2f& at, const Vec2f& extent) const override {
    const Vec2f uv = to_uv_(at), width = to_uv_.width(extent);
    return between_.coverage(uv.x - half_width_, width.x) *
           between_.coverage(uv.y - half_width_, width.y);
  }

  float half_width_;
  TileRow between_;  ///< the lines are its joints
  UvTransform to_uv_;
};

const TypeInfo& gridtexture_info() {
  static const TypeInfo info{
      "texture",
      "gridtexture",
      "Lines along the borders of each unit of uv.",
      {color_parameter("color0", 0.2, "Colour between the lines.").range(0, 1e6).textured(),
       color_parameter("color1", 0.4, "Colour of the lines.").range(0, 1e6).textured(),
       number_parameter("line_width", 0.01, "Half the width of a line, in uv.").range(0, 0.5),
       transform_parameter("to_uv", "Transform of the coordinates before the lookup.").leaving(0)}};
  return info;
}

std::shared_ptr<const Texture> create_gridtexture(const TextureInputs& in) {
  return std::make_shared<GridTexture>(in.texture("color0"), in.texture("color1"),
                                       float(in.arguments.number("line_width")),
                                       UvTransform(in.arguments.transform("to_uv")));
}

}  // namespace

TextureType gridtexture_type() { return {gridtexture_info(), create_gridtexture}; }

}  // namespace kaustik
