#include "kaustik/material/bsdf_kinds.h"

namespace kaustik {
namespace {

/// A texture times another one, which is mostly a constant.
class ScaleTexture final : public Texture {
 public:
  ScaleTexture(std::shared_ptr<const Texture> value, std::shared_ptr<const Texture> scale)
      : value_(std::move(value)), scale_(std::move(scale)) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override {
    return value_->eval(at, wavelengths) * scale_->eval(at, wavelengths);
  }
  float maximum() const override { return value_->maximum() * scale_->maximum(); }
  float aspect() const override { return value_->aspect(); }
  Vec2i resolution() const override { return value_->resolution(); }
  bool is_constant() const override { return value_->is_constant() && scale_->is_constant(); }
  /// As if where the one is bright said nothing of the other.
  Spectrum mean() const override { return value_->mean() * scale_->mean(); }
  HeightGradient height_gradient(const TextureCoordinates& at) const override {
    const HeightGradient own = value_->height_gradient(at);
    const float scale = scale_->scalar(at);
    if (scale_->is_constant()) return {own.uv * scale, own.position * scale};
    const HeightGradient other = scale_->height_gradient(at);
    const float value = value_->scalar(at);
    return {own.uv * scale + other.uv * value, own.position * scale + other.position * value};
  }
  int size() const override {
    return 1 + value_->size() + (scale_->is_constant() ? 0 : scale_->size());
  }

 private:
  std::shared_ptr<const Texture> value_, scale_;
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
           .range(0, 1e6)
           .textured()}};
  return info;
}

std::shared_ptr<const Texture> create_scale(const TextureInputs& in) {
  std::shared_ptr<const Texture> value = in.texture("value");
  if (!value)
    throw Error(ErrorKind::input, "texture 'scale' has nothing to multiply",
                "put a texture into it, or give it a 'value'", in.arguments.place());
  return std::make_shared<ScaleTexture>(std::move(value), in.texture("scale"));
}

}  // namespace

TextureType scale_type() { return {scale_info(), create_scale}; }

}  // namespace kaustik
