#include <numbers>

#include "kaustik/scene/filter_kinds.h"
#include "kaustik/scene/offset_table.h"

namespace kaustik {
namespace {

/// Shifted down to reach zero at the radius.
struct WindowedGauss {
  WindowedGauss(float deviation, float cut) : stddev(deviation), radius(cut) {
    offset = std::exp(-0.5f * sqr(radius / stddev));
    const float mass =
        stddev * std::sqrt(2.0f * pi) * std::erf(radius / (stddev * std::numbers::sqrt2_v<float>)) -
        2.0f * radius * offset;
    norm = 1.0f / mass;
  }
  float density(float distance) const {
    return (std::exp(-0.5f * sqr(distance / stddev)) - offset) * norm;
  }
  float share_below(float x) const {
    const float gauss =
        stddev * std::sqrt(0.5f * pi) * std::erf(x / (stddev * std::numbers::sqrt2_v<float>));
    return 0.5f + (gauss - x * offset) * norm;
  }

  float stddev, radius;
  float offset = 0, norm = 1;
};

class Gaussian final : public FilterProfile {
 public:
  Gaussian(float stddev, float radius)
      : gauss_(stddev, radius), offsets_(radius, [&](float x) { return gauss_.share_below(x); }) {}
  float density(float distance) const override { return gauss_.density(distance); }
  float sample(float u) const override { return offsets_.sample(u); }

 private:
  WindowedGauss gauss_;
  OffsetTable offsets_;
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
