// What the tables of lights accept and what they refuse.

#include <gtest/gtest.h>

#include "tests/light/light_testing.h"
#include "tests/support/type_rows.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

void expect_error(const std::string& type, const std::vector<Property>& properties,
                  const std::string& part, std::shared_ptr<const Shape> shape = nullptr) {
  try {
    make_light(type, properties, std::move(shape));
    ADD_FAILURE() << "no error: " << part;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

/// A shape without points to sample.
class Unsampleable final : public Shape {
 public:
  Bounds3f bounds() const override { return {{0, 0, 0}, {1, 1, 1}}; }
  float area() const override { return 1; }
  SurfacePoint surface_point(const Ray&, const Hit&) const override { return {}; }
  bool can_sample() const override { return false; }
  ShapeSample sample_area(const Vec2f&) const override { return {}; }
  TriangleMesh tessellate(int) const override { return {}; }
};

TEST(LightArguments, NamesOfAllTypes) {
  test::expect_rows_of("emitter", light_types());
  for (const LightType& type : light_types())
    EXPECT_EQ(type.needs_shape, type.info.name.ends_with("area")) << type.info.name;
}

TEST(LightArguments, ContradictionsAreErrors) {
  const Value number(1.0), place(Vec3d(1, 2, 3));
  const Value moved(Transform::translate({1, 0, 0}));
  const Value sheared(Transform::scale({1, 2, 1}));
  expect_error("area", {}, "outside of a shape");
  expect_error("area", {}, "cannot be a light", std::make_shared<Unsampleable>());
  expect_error("area", {{"to_world", moved, {}}}, "to_world", make_ball({0, 0, 0}, 1));
  expect_error("area", {{"radiance", Value(-1.0), {}}}, "radiance", make_ball({0, 0, 0}, 1));
  expect_error("area", {{"radiance", Value(3e38), {}}}, "overflows", make_ball({0, 0, 0}, 9));
  expect_error("point", {{"position", place, {}}, {"to_world", moved, {}}}, "both");
  expect_error("point", {{"intensty", number, {}}}, "intensity");
  expect_error("directional", {{"direction", place, {}}, {"to_world", moved, {}}}, "both");
  expect_error("directional", {{"direction", Value(Vec3d(0, 0, 0)), {}}}, "zero");
  expect_error("spot", {{"cutoff_angle", Value(0.0), {}}}, "dark");
  expect_error("spot", {{"cutoff_angle", Value(200.0), {}}}, "range");
  expect_error("spot", {{"cutoff_angle", Value(10.0), {}}, {"beam_width", Value(20.0), {}}},
               "more than");
  expect_error("spot", {{"to_world", sheared, {}}}, "distorts");
  expect_error("spot", {{"falloff", Value(std::string("cubic")), {}}}, "cannot be 'cubic'");
  expect_error("projector", {{"to_world", sheared, {}}}, "distorts");
  expect_error("projector", {{"focal_length", Value(std::string("50 km")), {}}}, "focal_length");
  expect_error("projector", {{"irradiance", Value(3e38), {}}, {"fov", Value(170.0), {}}},
               "overflows");
}

TEST(LightArguments, TransformsPlaceAndTurnLights) {
  const Value world(Transform::translate({1, 2, 3}) * Transform::rotate({0, 1, 0}, 90) *
                    Transform::scale({2, 2, 2}));
  const auto point = make_light("point", {{"to_world", world, {}}});
  EXPECT_EQ(point->placed().sample_origin({0, 0}).point.position, Vec3f(1, 2, 3));
  const auto sun = make_light("directional", {{"to_world", world, {}}});
  EXPECT_NEAR(length(sun->sample_toward({}, {}).direction - Vec3f(-1, 0, 0)), 0, 1e-6);
  const auto spot = make_light("spot", {{"to_world", world, {}}});
  EXPECT_EQ(spot->placed().sample_origin({0, 0}).point.position, Vec3f(1, 2, 3));
  EXPECT_NEAR(length(spot->traits().bounds.axis - Vec3f(1, 0, 0)), 0, 1e-6);
}

TEST(LightArguments, TheTransformOfTheInputsServesWhereNoneIsGiven) {
  for (const LightType& type : light_types()) {
    if (type.info.name != "point") continue;
    Problems problems;
    const Arguments arguments(type.info, {}, {}, problems);
    const Transform moved = Transform::translate({0, 5, 0});
    const auto light = type.create({arguments, moved, nullptr, -1, test_bounds()});
    EXPECT_EQ(light->placed().sample_origin({0, 0}).point.position, Vec3f(0, 5, 0));
  }
}

TEST(LightArguments, ScenesWithoutExtentGiveFiniteLights) {
  for (const Bounds3f& bounds : {Bounds3f(), Bounds3f({1, 1, 1}, {1, 1, 1})})
    for (const std::string type : {"constant", "directional"}) {
      const auto light = make_light(type, {}, nullptr, bounds);
      const EmissionSample s = light->sample_emission({0.2f, 0.9f}, {0.3f, 0.1f}, {});
      EXPECT_TRUE(is_finite(s.point.position));
      EXPECT_TRUE(std::isfinite(s.pdf_position) && s.flux.is_finite());
    }
}

}  // namespace
}  // namespace kaustik
