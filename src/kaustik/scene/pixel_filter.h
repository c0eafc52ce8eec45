#pragma once
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// A pixel filter along one axis: an even density with integral 1, in 1/pixels over pixels.
class FilterProfile {
 public:
  virtual ~FilterProfile() = default;
  /// At a distance from the pixel's centre, from 0 to the filter's radius.
  virtual float density(float distance) const = 0;
  /// An offset with that density, made of u in [0, 1); rises with u.
  virtual float sample(float u) const = 0;
  /// Whether it stands for one with more lobes, some of them negative.
  virtual bool is_cut() const { return false; }
};

/// The pixel filter, normalised to integral 1 over the raster plane. Camera rays are drawn from it,
/// so every sample belongs to one pixel alone; splats are weighted by it.
class PixelFilter {
 public:
  /// A box of one pixel.
  PixelFilter();
  /// The product of the profile along both axes; zero beyond `radius`, pixels.
  PixelFilter(float radius, std::shared_ptr<const FilterProfile> profile)
      : radius_(radius), profile_(std::move(profile)) {}

  /// Offset from the pixel's centre, in pixels.
  Vec2f sample(const Vec2f& u) const { return {profile_->sample(u.x), profile_->sample(u.y)}; }
  /// Density of that offset; zero beyond radius().
  float eval(const Vec2f& offset) const { return eval_1d(offset.x) * eval_1d(offset.y); }
  float radius() const { return radius_; }
  bool is_cut() const { return profile_->is_cut(); }

 private:
  float eval_1d(float x) const {
    const float distance = std::fabs(x);
    return distance > radius_ ? 0 : profile_->density(distance);
  }

  float radius_;
  std::shared_ptr<const FilterProfile> profile_;
};

struct FilterType {
  const TypeInfo& info;
  PixelFilter (*create)(const Arguments&);
};
const std::vector<FilterType>& filter_types();

}  // namespace kaustik
