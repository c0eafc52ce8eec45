#include "kaustik/base/color.h"
#include "kaustik/material/bsdf.h"

namespace kaustik {
namespace {

class ConstantTexture final : public Texture {
 public:
  explicit ConstantTexture(const Spectrum& value) : value_(value) {}
  Spectrum eval(const TextureCoordinates&) const override { return value_; }
  float maximum() const override { return value_.max_lane(); }
  bool is_constant() const override { return true; }
  Spectrum mean() const override { return value_; }
  HeightGradient height_gradient(const TextureCoordinates&) const override { return {}; }

 private:
  Spectrum value_;
};

}  // namespace

std::shared_ptr<const Texture> make_constant_texture(const Spectrum& value) {
  return std::make_shared<ConstantTexture>(value);
}

std::shared_ptr<const Texture> constant_texture_of(const Arguments& arguments,
                                                   std::string_view name) {
  if (!arguments.has(name)) return nullptr;
  if (arguments.info().find(name)->kind == ParameterKind::number)
    return make_constant_texture(Spectrum(float(arguments.number(name))));
  return make_constant_texture(reflectance_spectrum(arguments.color(name)));
}

}  // namespace kaustik
