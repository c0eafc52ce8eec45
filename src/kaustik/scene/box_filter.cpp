#include "kaustik/scene/filter_kinds.h"

namespace kaustik {
namespace {

class Box final : public FilterProfile {
 public:
  explicit Box(float radius) : radius_(radius) {}
  float density(float) const override { return 0.5f / radius_; }
  float sample(float u) const override { return (2.0f * u - 1.0f) * radius_; }

 private:
  float radius_;
};

const TypeInfo& box_info() {
  static const TypeInfo info{
      "rfilter",
      "box",
      "Each sample counts for its own pixel.",
      {number_parameter("radius", 0.5, "Half width.").range(0.01, 16).in("pixels")}};
  return info;
}

}  // namespace

PixelFilter box_filter(float radius) { return {radius, std::make_shared<const Box>(radius)}; }

FilterType box_filter_type() {
  return {box_info(),
          [](const Arguments& arguments) { return box_filter(float(arguments.number("radius"))); }};
}

}  // namespace kaustik
