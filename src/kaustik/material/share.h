#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "kaustik/material/bsdf.h"

namespace kaustik {

/// The row of what a Share reads.
inline Parameter share_parameter(const std::string& name, double usual,
                                 const std::string& sentence) {
  return number_parameter(name, usual, sentence).range(0, 1).clamped().textured();
}

/// A parameter that is one number from 0 to `largest`; a texture is asked only if it varies, and
/// what it says beyond the range is taken to its ends.
class Share {
 public:
  explicit Share(std::shared_ptr<const Texture> texture, float largest = 1)
      : texture_(std::move(texture)), largest_(largest), value_(in_range(texture_->scalar({}))) {}

  bool is_constant() const { return texture_->is_constant(); }
  bool is_zero() const { return is_constant() && value_ == 0; }
  const Texture* texture() const { return texture_.get(); }
  float at(const BsdfContext& context) const {
    return is_constant() ? value_ : in_range(context.scalar_of(*texture_));
  }
  /// Values among which the largest result is looked for.
  std::vector<float> extremes(int steps) const {
    if (is_constant()) return {value_};
    std::vector<float> values;
    for (int i = 0; i <= steps; ++i) values.push_back(largest_ * float(i) / float(steps));
    return values;
  }
  float mean() const { return in_range(luminance_of(texture_->mean())); }

 private:
  float in_range(float value) const { return std::clamp(value, 0.0f, largest_); }

  std::shared_ptr<const Texture> texture_;
  float largest_, value_;
};

}  // namespace kaustik
