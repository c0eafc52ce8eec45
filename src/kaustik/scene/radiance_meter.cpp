#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// Looks along a single ray.
class RadianceMeter final : public Camera {
 public:
  explicit RadianceMeter(const CameraInputs& inputs)
      : direction_(meter_direction(inputs.arguments)) {
    const Arguments& arguments = inputs.arguments;
    if (!arguments.given("to_world") && arguments.given("origin") != arguments.given("direction"))
      throw Error(ErrorKind::input, "the ray has only one of 'origin' and 'direction'",
                  "give both, or 'to_world'",
                  arguments.place_of(arguments.given("origin") ? "origin" : "direction"));
    traits_.position = arguments.given("origin") && !arguments.given("to_world")
                           ? Vec3f(arguments.point("origin"))
                           : arguments.transform("to_world").point({0, 0, 0});
    traits_.view = "measures the radiance along a ray";
    traits_.meter_unit = "cd/m²";
    // No pixel: a cone so narrow that what is filtered by it, or merges within, hardly changes.
    constexpr float half_angle = 4e-4f;
    traits_.pixel_spread = half_angle;
    traits_.can_connect = false;
  }

  CameraRay sample_ray(const Vec2f&, const LensNumbers&) const override {
    return {{traits_.position, direction_, infinity}, 0};
  }
  CameraConnection connect(const Vec3f&, const LensNumbers&) const override {
    return no_connection(traits_.position);
  }

 private:
  Vec3f direction_;
};

const TypeInfo& radiance_meter_info() {
  static const TypeInfo info = camera_info(
      "radiancemeter",
      "Measures the radiance that arrives along a single ray. Every pixel shows the same value, so "
      "one is enough.",
      {to_world_parameter(
           "Transform from the meter's space to the world. The ray begins at 0 and goes along +z."),
       optional(point_parameter("origin", {0, 0, 0},
                                "Origin of the ray; with direction, instead of to_world.")
                    .in("m")),
       optional(point_parameter("direction", {0, 0, 1},
                                "Direction of the ray; with origin, instead of to_world."))});
  return info;
}

}  // namespace

CameraType radiance_meter_type() {
  return {radiance_meter_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<RadianceMeter>(inputs);
          }};
}

}  // namespace kaustik
