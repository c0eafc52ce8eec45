#pragma once
#include "kaustik/light/emission_pattern.h"
#include "kaustik/material/texture.h"

namespace kaustik {

/// A texture on a lamp: its colours are radiance, W/(sr·m²). Looked up at points, without a
/// footprint: lamps and those who see them have to agree on what each point sends out.
class TextureEmission final : public EmissionPattern {
 public:
  explicit TextureEmission(std::shared_ptr<const Texture> texture) : texture_(std::move(texture)) {}

  Spectrum radiance(const SurfacePoint& at, const Wavelengths& wavelengths) const override {
    TextureCoordinates where;
    where.uv = at.uv;
    where.position = at.position;
    where.normal = at.ng;
    where.primitive = at.primitive;
    // White has nothing in the lane that nothing emits into; textures of reflectances may.
    return texture_->eval(where, wavelengths) * white_light(wavelengths);
  }
  float maximum() const override { return texture_->maximum(); }

 private:
  std::shared_ptr<const Texture> texture_;
};

}  // namespace kaustik
