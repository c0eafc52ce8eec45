#include "kaustik/base/warp.h"
#include "kaustik/scene/filter_kinds.h"

namespace kaustik {
namespace {

class Tent final : public FilterProfile {
 public:
  explicit Tent(float radius) : radius_(radius) {}
  float density(float distance) const override { return (1.0f - distance / radius_) / radius_; }
  float sample(float u) const override { return unit_to_tent(u) * radius_; }

 private:
  float radius_;
};

const TypeInfo& tent_info() {
  static const TypeInfo info{
      "rfilter",
      "tent",
      "Linear falloff.",
      {number_parameter("radius", 1.0, "Half width.").range(0.01, 16).in("pixels")}};
  return info;
}

}  // namespace

PixelFilter tent_filter(float radius) { return {radius, std::make_shared<const Tent>(radius)}; }

FilterType tent_filter_type() {
  return {tent_info(), [](const Arguments& arguments) {
            return tent_filter(float(arguments.number("radius")));
          }};
}

}  // namespace kaustik
