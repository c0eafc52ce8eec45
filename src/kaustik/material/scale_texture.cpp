#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

/// A texture times a colour.
class ScaleTexture final : public Texture {
 public:
  ScaleTexture(std::shared_ptr<const Texture> value, const SpectralValue& scale)
      : value_(std::move(value)), scale_(scale), scalar_(luminance_of(scale.rgb())) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override {
    return value_->eval(at, wavelengths) * scale_.at(wavelengths);
  }
  float maximum() const override { return (rgb(value_->maximum()) * scale_.rgb()).max_lane(); }
  float aspect() const override { return value_->aspect(); }
  Vec2i resolution() const override { return value_->resolution(); }
  bool is_constant() const override { return value_->is_constant(); }
  Spectrum mean() const override { return value_->mean() * scale_.rgb(); }
  HeightGradient height_gradient(const TextureCoordinates& at) const override {
    const HeightGradient own = value_->height_gradient(at);
    return {own.uv * scalar_, own.position * scalar_};
  }
  int size() const override { return 1 + value_->size(); }

 private:
  static Spectrum rgb(float all) { return spectrum_from_rgb(all, all, all); }

  std::shared_ptr<const Texture> value_;
  SpectralValue scale_;
  float scalar_;
};

const TypeInfo& scale_info() {
  static const TypeInfo info{
      "texture",
      "scale",
      "A texture, or a colour, times a factor.",
      {optional(color_parameter("value", 1,
                                "Texture or colour to multiply. A texture may have any name."))
           .range(0, 1e6)
           .textured(),
       color_parameter("scale", 1, "Factor. Heights are multiplied by its luminance.")
           .range(0, 1e6)}};
  return info;
}

std::shared_ptr<const Texture> create_scale(const TextureInputs& in) {
  std::shared_ptr<const Texture> value = in.texture("value");
  if (!value)
    throw Error(ErrorKind::input, "texture 'scale' has nothing to multiply",
                "put a texture into it, or give it a 'value'", in.arguments.place());
  return std::make_shared<ScaleTexture>(std::move(value),
                                        SpectralValue::reflectance(in.arguments.color("scale")));
}

}  // namespace

TextureType scale_type() { return {scale_info(), create_scale}; }

}  // namespace kaustik
