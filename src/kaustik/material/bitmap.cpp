#include <array>
#include <utility>
#include <vector>

#include "kaustik/image/picture_argument.h"
#include "kaustik/material/bsdf_kinds.h"
#include "kaustik/material/uv_transform.h"

namespace kaustik {
namespace {

enum class Wrap { repeat, mirror, clamp };

/// Texel index inside [0, count) for any integer.
int wrapped(int i, int count, Wrap wrap) {
  if (wrap == Wrap::clamp) return std::clamp(i, 0, count - 1);
  const int period = wrap == Wrap::mirror ? 2 * count : count;
  int rest = i % period;
  if (rest < 0) rest += period;
  return rest < count ? rest : period - 1 - rest;
}

/// A picture over the uv square; v = 0 is its upper edge, as in Mitsuba.
class Bitmap final : public Texture {
 public:
  Bitmap(const Image& image, bool nearest, Wrap wrap, const UvTransform& to_uv)
      : width_(image.width()),
        height_(image.height()),
        nearest_(nearest),
        wrap_(wrap),
        to_uv_(to_uv) {
    const RgbView pixels = rgb_view(image);
    texels_.reserve(image.pixel_count());
    std::array<double, 3> sum{};
    for (size_t i = 0; i < image.pixel_count(); ++i) {
      const Vec3f c = pixels[i];
      texels_.push_back(spectrum_from_rgb(c.x, c.y, c.z));
      maximum_ = std::max(maximum_, texels_.back().max_lane());
      for (int lane = 0; lane < 3; ++lane) sum[size_t(lane)] += c[lane];
    }
    const double count = double(image.pixel_count());
    mean_ = spectrum_from_rgb(float(sum[0] / count), float(sum[1] / count), float(sum[2] / count));
  }

  Spectrum eval(const TextureCoordinates& at) const override {
    const Vec2f uv = to_uv_(at.uv);
    // Far away the coordinates have lost the fraction anyway; this keeps them in the range of int.
    const float x = in_period(uv.x) * float(width_), y = in_period(uv.y) * float(height_);
    if (nearest_) return texel(int(std::floor(x)), int(std::floor(y)));
    const float left = std::floor(x - 0.5f), upper = std::floor(y - 0.5f);
    const float fx = x - 0.5f - left, fy = y - 0.5f - upper;
    const int ix = int(left), iy = int(upper);
    const Spectrum a = texel(ix, iy) * (1 - fx) + texel(ix + 1, iy) * fx;
    const Spectrum b = texel(ix, iy + 1) * (1 - fx) + texel(ix + 1, iy + 1) * fx;
    return a * (1 - fy) + b * fy;
  }
  float maximum() const override { return maximum_; }
  Spectrum mean() const override { return mean_; }

 private:
  float in_period(float x) const {
    if (wrap_ == Wrap::clamp) return std::clamp(x, -1.0f, 2.0f);
    return x - 2 * std::floor(0.5f * x);
  }
  const Spectrum& texel(int x, int y) const {
    return texels_[size_t(wrapped(y, height_, wrap_)) * size_t(width_) +
                   size_t(wrapped(x, width_, wrap_))];
  }

  int width_, height_;
  bool nearest_;
  Wrap wrap_;
  UvTransform to_uv_;
  std::vector<Spectrum> texels_;
  float maximum_ = 0;
  Spectrum mean_;
};

const TypeInfo& info() {
  static const TypeInfo info{
      "texture",
      "bitmap",
      "A picture.",
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
  const std::string& wrap = arguments.text("wrap_mode");
  return std::make_shared<Bitmap>(image, arguments.text("filter_type") == "nearest",
                                  wrap == "clamp"    ? Wrap::clamp
                                  : wrap == "mirror" ? Wrap::mirror
                                                     : Wrap::repeat,
                                  UvTransform(arguments.transform("to_uv")));
}

}  // namespace

TextureType bitmap_type() { return {info(), create}; }

}  // namespace kaustik
