#include "kaustik/material/texture.h"

namespace kaustik {
namespace {

class ConstantTexture final : public Texture {
 public:
  explicit ConstantTexture(const Spectrum& value) : value_(value) {}
  Spectrum eval(const TextureCoordinates&) const override { return value_; }
  float maximum() const override { return value_.max_lane(); }
  bool is_constant() const override { return true; }
  Spectrum mean() const override { return value_; }

 private:
  Spectrum value_;
};

}  // namespace

std::shared_ptr<const Texture> make_constant_texture(const Spectrum& value) {
  return std::make_shared<ConstantTexture>(value);
}

}  // namespace kaustik
