#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "kaustik/material/bitmap_picture.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/mip_pyramid.h"
#include "kaustik/material/uv_transform.h"

namespace kaustik {
namespace {

/// A picture over the uv square; v = 0 is its upper edge, as in Mitsuba. It is filtered as RGB: a
/// mean of colours is one that can be uplifted.
class Bitmap final : public Texture {
 public:
  Bitmap(MipPyramid pyramid, float maximum, bool nearest, const UvTransform& to_uv)
      : pyramid_(std::move(pyramid)), maximum_(maximum), nearest_(nearest), to_uv_(to_uv) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override {
    return lanes_from_reflectance(rgb(at), wavelengths);
  }
  float scalar(const TextureCoordinates& at) const override { return luminance_of(rgb(at)); }
  float maximum() const override { return maximum_; }
  float aspect() const override {
    const Vec2f texel = pyramid_.texel_size({0, 0});
    return texel.y / texel.x;
  }
  Vec2i resolution() const override {
    const Vec2f texel = pyramid_.texel_size({0, 0});
    return {int(std::lround(1 / texel.x)), int(std::lround(1 / texel.y))};
  }
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
  Spectrum rgb(const TextureCoordinates& at) const {
    const Vec2f uv = to_uv_(at.uv), width = to_uv_.width(at.uv_width);
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

std::vector<std::string> wrap_names() { return {"repeat", "mirror", "clamp", "zero", "one"}; }

Wrap wrap_named(const std::string& name) {
  const std::vector<std::string> names = wrap_names();
  return Wrap(std::find(names.begin(), names.end(), name) - names.begin());
}

const TypeInfo& bitmap_info() {
  static const TypeInfo info{
      "texture", "bitmap", "A picture, filtered by the footprint of the ray.",
      picture_parameters(
          ".",
          {choice_parameter("filter_type", "bilinear", {"bilinear", "nearest"},
                            "Interpolation between pixels."),
           choice_parameter("wrap_mode", "repeat", wrap_names(),
                            "Values outside the picture: repeated, mirrored, those of its edge, "
                            "black (zero) or white (one)."),
           optional(choice_parameter("wrap_mode_u", "repeat", wrap_names(),
                                     "Values left and right of the picture (u), as wrap_mode.")),
           optional(choice_parameter("wrap_mode_v", "repeat", wrap_names(),
                                     "Values above and below the picture (v), as wrap_mode.")),
           text_parameter(
               "channel", "",
               "Part of the picture: one channel (r, g, b, or a for opacity), or a "
               "layer or channel of an EXR by its name; or 'number', opacity where it is "
               "not 1 everywhere, else the mean of red, green and blue. All colours if "
               "absent."),
           boolean_parameter(
               "raw", false,
               "Take stored values as linear numbers, for normals, roughness and the like."),
           gamma_parameter(),
           boolean_parameter("invert", false, "Shows 1 minus each linear value, at least 0."),
           number_parameter("power", 1, "Exponent of the linear values, after invert.")
               .range(0.01, 100),
           transform_parameter("to_uv", "Transform of the coordinates before the lookup.")
               .leaving(0),
           ignored_parameter("format", ParameterKind::text),
           ignored_parameter("accel", ParameterKind::boolean),
           ignored_parameter("cache", ParameterKind::boolean),
           ignored_parameter("max_anisotropy", ParameterKind::number)})};
  return info;
}

/// Per pixel: a texel of four floats, and a third more for the reductions.
constexpr int64_t bytes_per_pixel = 22;

struct Texels {
  int width = 0, height = 0;
  std::vector<Spectrum> values;
  float maximum = 0;
};

/// The image is gone when the pyramid is made.
Texels texels_of(const Image& image) {
  Texels texels{image.width(), image.height(), {}};
  const RgbView pixels = rgb_view(image);
  texels.values.reserve(image.pixel_count());
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    const Vec3f c = pixels[i];
    texels.values.push_back(spectrum_from_rgb(c.x, c.y, c.z));
    texels.maximum = std::max(texels.maximum, texels.values.back().max_lane());
  }
  return texels;
}

Wraps wraps_of(const Arguments& arguments) {
  const auto along = [&](const char* axis) {
    return wrap_named(arguments.text(arguments.given(axis) ? axis : "wrap_mode"));
  };
  return {along("wrap_mode_u"), along("wrap_mode_v")};
}

/// See PictureWish::gamma.
double gamma_of_texels(const Arguments& arguments) {
  const double gamma = gamma_of(arguments);
  if (!arguments.boolean("raw")) return gamma;
  if (gamma != 0 && gamma != 1)
    throw Error(ErrorKind::input, "the bitmap has 'gamma', and 'raw' says that it is linear",
                "leave out one of them", arguments.place_of("gamma"));
  return 1;
}

std::shared_ptr<const Texture> create_bitmap(const TextureInputs& in) {
  const Arguments& arguments = in.arguments;
  Texels texels = texels_of(bitmap_picture(arguments, in.pictures, bytes_per_pixel));
  const Wraps wraps = wraps_of(arguments);
  if (wraps.u == Wrap::one || wraps.v == Wrap::one) texels.maximum = std::max(texels.maximum, 1.0f);
  return std::make_shared<Bitmap>(
      MipPyramid(texels.width, texels.height, std::move(texels.values), wraps), texels.maximum,
      arguments.text("filter_type") == "nearest", UvTransform(arguments.transform("to_uv")));
}

}  // namespace

Image bitmap_picture(const Arguments& arguments, PictureReader& pictures,
                     int64_t kept_bytes_per_pixel) {
  Image picture = pictures.read(arguments, kept_bytes_per_pixel,
                                {gamma_of_texels(arguments), arguments.text("channel")});
  const bool is_inverted = arguments.boolean("invert");
  const double power = arguments.number("power");
  if (!is_inverted && power == 1) return picture;
  for (int c = 0; c < picture.channel_count(); ++c)
    for (float& value : picture.channel(c)) {
      const float shown = is_inverted ? std::max(1 - value, 0.0f) : value;
      value = float(std::pow(double(shown), power));
    }
  return picture;
}

TextureType bitmap_type() { return {bitmap_info(), create_bitmap}; }

}  // namespace kaustik
