#include <utility>
#include <vector>

#include "kaustik/image/picture_argument.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/mip_pyramid.h"
#include "kaustik/material/uv_transform.h"

namespace kaustik {
namespace {

/// A picture over the uv square; v = 0 is its upper edge, as in Mitsuba.
class Bitmap final : public Texture {
 public:
  Bitmap(MipPyramid pyramid, float maximum, bool nearest, const UvTransform& to_uv)
      : pyramid_(std::move(pyramid)), maximum_(maximum), nearest_(nearest), to_uv_(to_uv) {}

  Spectrum eval(const TextureCoordinates& at) const override {
    return at_uv(to_uv_(at.uv), to_uv_.width(at.uv_width));
  }
  float maximum() const override { return maximum_; }
  Spectrum mean() const override { return pyramid_.mean(); }
  /// By differences over one texel, which turn the kinks of bilinear interpolation into a gradient
  /// without steps.
  HeightGradient height_gradient(const TextureCoordinates& at) const override {
    const Vec2f uv = to_uv_(at.uv), width = to_uv_.width(at.uv_width);
    const Vec2f step = pyramid_.texel_size(width) * 0.5f;
    const auto height = [&](const Vec2f& where) {
      return luminance_of(pyramid_.filtered(where, width));
    };
    const Vec2f gradient(
        (height({uv.x + step.x, uv.y}) - height({uv.x - step.x, uv.y})) / (2 * step.x),
        (height({uv.x, uv.y + step.y}) - height({uv.x, uv.y - step.y})) / (2 * step.y));
    return {to_uv_.gradient(gradient), {0, 0, 0}};
  }

 private:
  Spectrum at_uv(const Vec2f& uv, const Vec2f& width) const {
    // Nearest texels are for those who want to see texels: only where they are larger than the
    // footprint.
    const Vec2f texel = pyramid_.texel_size({0, 0});
    const bool is_point = !(width.x > texel.x) && !(width.y > texel.y);
    return nearest_ && is_point ? pyramid_.nearest(uv) : pyramid_.filtered(uv, width);
  }

  MipPyramid pyramid_;
  float maximum_;
  bool nearest_;
  UvTransform to_uv_;
};

const TypeInfo& info() {
  static const TypeInfo info{
      "texture",
      "bitmap",
      "A picture, filtered by the footprint of the ray.",
      {file_parameter("filename", "EXR, HDR, PFM, TIFF, PNG, JPEG or PPM file."),
       choice_parameter("filter_type", "bilinear", {"bilinear", "nearest"},
                        "How values between pixels come about."),
       choice_parameter("wrap_mode", "repeat", {"repeat", "mirror", "clamp"},
                        "What is outside of the picture."),
       boolean_parameter("raw", false, "Take 8-bit values as linear ones, not as sRGB."),
       transform_parameter("to_uv", "Applied to the coordinates before the lookup."),
       ignored_parameter("format", ParameterKind::text),
       ignored_parameter("accel", ParameterKind::boolean)}};
  return info;
}

std::shared_ptr<const Texture> create(const Arguments& arguments) {
  ReadOptions options;
  options.srgb_to_linear = !arguments.boolean("raw");
  const Image image = read_picture_argument(arguments, options);
  // The pyramid takes four floats per texel and a third more for its reductions, beside the image.
  check_image_size(image.width(), image.height(), 9);
  const RgbView pixels = rgb_view(image);
  std::vector<Spectrum> texels;
  texels.reserve(image.pixel_count());
  float maximum = 0;
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    const Vec3f c = pixels[i];
    texels.push_back(spectrum_from_rgb(c.x, c.y, c.z));
    maximum = std::max(maximum, texels.back().max_lane());
  }
  const std::string& wrap = arguments.text("wrap_mode");
  return std::make_shared<Bitmap>(MipPyramid(image.width(), image.height(), std::move(texels),
                                             wrap == "clamp"    ? Wrap::clamp
                                             : wrap == "mirror" ? Wrap::mirror
                                                                : Wrap::repeat),
                                  maximum, arguments.text("filter_type") == "nearest",
                                  UvTransform(arguments.transform("to_uv")));
}

}  // namespace

TextureType bitmap_type() { return {info(), create}; }

}  // namespace kaustik
