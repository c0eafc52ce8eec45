#include <algorithm>
#include <cstdint>
#include <numbers>

#include "kaustik/base/to_integer.h"
#include "kaustik/scene/filter_kinds.h"

namespace kaustik {
namespace {

constexpr size_t table_cells = 1024;

class Gaussian final : public FilterProfile {
 public:
  Gaussian(float stddev, float radius) : radius_(radius), stddev_(stddev) {
    offset_ = std::exp(-0.5f * sqr(radius_ / stddev_));
    const float mass = stddev_ * std::sqrt(2.0f * pi) *
                           std::erf(radius_ / (stddev_ * std::numbers::sqrt2_v<float>)) -
                       2.0f * radius_ * offset_;
    norm_ = 1.0f / mass;
    // The distribution function has no closed inverse with the offset.
    float so_far = 0;
    for (size_t i = 0; i <= table_cells; ++i) {
      const float x = radius_ * (2 * float(i) / float(table_cells) - 1);
      const float gauss =
          stddev_ * std::sqrt(0.5f * pi) * std::erf(x / (stddev_ * std::numbers::sqrt2_v<float>));
      // By rounding the tails would not rise everywhere.
      so_far = std::clamp(0.5f + (gauss - x * offset_) * norm_, so_far, 1.0f);
      cdf_.push_back(so_far);
    }
    cdf_.front() = 0;
    cdf_.back() = 1;
    for (size_t i = 0, cell = 0; i < table_cells; ++i) {
      while (cdf_[cell + 1] <= float(i) / float(table_cells)) ++cell;
      guide_.push_back(uint16_t(cell));
    }
  }

  float density(float distance) const override {
    return (std::exp(-0.5f * sqr(distance / stddev_)) - offset_) * norm_;
  }

  float sample(float u) const override {
    size_t cell = guide_[to_integer(u * float(table_cells), size_t(0), table_cells - 1)];
    while (cell + 1 < table_cells && cdf_[cell + 1] <= u) ++cell;
    const float inside = (u - cdf_[cell]) / (cdf_[cell + 1] - cdf_[cell]);
    return radius_ * (2 * (float(cell) + inside) / float(table_cells) - 1);
  }

 private:
  float radius_, stddev_;
  float offset_ = 0, norm_ = 1;
  /// The distribution function at evenly spaced offsets, and for evenly spaced values of it the
  /// last of these below.
  std::vector<float> cdf_;
  std::vector<uint16_t> guide_;
};

const TypeInfo& gaussian_info() {
  static const TypeInfo info{
      "rfilter",
      "gaussian",
      "Gaussian, cut off smoothly at four standard deviations.",
      {number_parameter("stddev", 0.5, "Standard deviation.").range(0.01, 4).in("pixels")}};
  return info;
}

}  // namespace

PixelFilter gaussian_filter(float stddev, float radius) {
  return {radius, std::make_shared<const Gaussian>(stddev, radius)};
}

FilterType gaussian_filter_type() {
  return {gaussian_info(), [](const Arguments& arguments) {
            const auto stddev = float(arguments.number("stddev"));
            return gaussian_filter(stddev, 4 * stddev);
          }};
}

}  // namespace kaustik
