#pragma once
#include "kaustik/light/emission_pattern.h"
#include "kaustik/material/texture.h"

namespace kaustik {

/// A texture on a lamp: its colours are light, such as radiance, W/(sr·m²), or a factor on light.
/// Looked up at points, without a footprint: lamps and those who see them have to agree on what
/// each point sends out.
class TextureEmission final : public EmissionPattern {
 public:
  explicit TextureEmission(std::shared_ptr<const Texture> texture, bool is_factor = false)
      : texture_(std::move(texture)), is_factor_(is_factor) {}

  Spectrum radiance(const SurfacePoint& at, const Wavelengths& wavelengths) const override {
    return value(at, 0, wavelengths);
  }
  Spectrum mean_about(const SurfacePoint& at, float uv_width) const override {
    return value(at, uv_width, {});
  }
  float maximum() const override { return texture_->maximum(); }
  float aspect() const override { return texture_->aspect(); }

 private:
  Spectrum value(const SurfacePoint& at, float uv_width, const Wavelengths& wavelengths) const {
    TextureCoordinates where;
    where.uv = at.uv;
    where.uv_width = {uv_width, uv_width};
    where.position = at.position;
    where.normal = at.ng;
    const Spectrum found = texture_->eval(where, wavelengths);
    // White has nothing in the lane that nothing emits into; textures of reflectances may.
    return is_factor_ ? found : found * white_light(wavelengths);
  }

  std::shared_ptr<const Texture> texture_;
  bool is_factor_;
};

}  // namespace kaustik
