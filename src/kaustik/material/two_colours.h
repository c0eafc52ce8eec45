#pragma once
#include <algorithm>
#include <utility>

#include "kaustik/material/texture.h"

namespace kaustik {

/// A pattern over uv in which each of two textures has its share of every footprint.
class TwoColours : public Texture {
 public:
  TwoColours(std::shared_ptr<const Texture> color0, std::shared_ptr<const Texture> color1)
      : color0_(std::move(color0)), color1_(std::move(color1)) {}

  Spectrum eval(const TextureCoordinates& at, const Wavelengths& wavelengths) const override;
  float scalar(const TextureCoordinates& at) const override;
  float maximum() const override { return std::max(color0_->maximum(), color1_->maximum()); }
  /// The relief of the two, and a step of a hundredth of a unit of uv between them: as a relief the
  /// pattern is one of plateaus.
  HeightGradient height_gradient(const TextureCoordinates& at) const override;
  int size() const override { return 1 + color0_->size() + color1_->size(); }

 protected:
  const Texture& color0() const { return *color0_; }
  const Texture& color1() const { return *color1_; }

 private:
  /// In a rectangle of the size `extent` about `at`; the rest has color1.
  virtual float share_of_color0(const Vec2f& at, const Vec2f& extent) const = 0;

  std::shared_ptr<const Texture> color0_, color1_;
};

}  // namespace kaustik
