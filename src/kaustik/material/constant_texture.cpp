#include "kaustik/material/bsdf.h"

namespace kaustik {
namespace {

class ConstantTexture final : public Texture {
 public:
  explicit ConstantTexture(const SpectralValue& value)
      : value_(value), scalar_(luminance_of(value.rgb())) {}
  Spectrum eval(const TextureCoordinates&, const Wavelengths& wavelengths) const override {
    return value_.at(wavelengths);
  }
  float scalar(const TextureCoordinates&) const override { return scalar_; }
  float maximum() const override { return value_.rgb().max_lane(); }
  bool is_constant() const override { return true; }
  Spectrum mean() const override { return value_.rgb(); }
  HeightGradient height_gradient(const TextureCoordinates&) const override { return {}; }

 private:
  SpectralValue value_;
  float scalar_;
};

}  // namespace

std::shared_ptr<const Texture> make_constant_texture(const SpectralValue& value) {
  return std::make_shared<ConstantTexture>(value);
}

std::shared_ptr<const Texture> constant_texture_of(const Arguments& arguments,
                                                   std::string_view name) {
  if (!arguments.has(name)) return nullptr;
  if (arguments.info().find(name)->kind == ParameterKind::number)
    return make_constant_texture(SpectralValue(float(arguments.number(name))));
  return make_constant_texture(SpectralValue::reflectance(arguments.color(name)));
}

}  // namespace kaustik
