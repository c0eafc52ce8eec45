// Values of meters, from a film.

#include "kaustik/render/measurements.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kaustik/base/photometric_units.h"
#include "kaustik/render/session.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

Film film_of(const Description& description, const Scene& scene, uint32_t passes) {
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, scene, warnings);
  SessionSettings settings;
  settings.passes = passes;
  settings.samples_per_pixel = 16 * passes;
  Session session(scene, *integrator, settings);
  session.run();
  return session.film();
}

// Up, down and aslant between a sky of radiance 2 above and nothing below: π L, 0, and half of it.
TEST(Measurements, OfPointsComeOneByOne) {
  Description description = description_of(
      "<integrator type=\"path\"/><emitter type=\"constant\"><rgb name=\"radiance\" value=\"2\"/>"
      "</emitter><shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"10000\"/>"
      "</transform><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf></shape>"
      "<sensor type=\"irradiancepoints\" id=\"meter\"/>");
  const Object& sensor = *description.scene->children.back().object;
  const auto rows = [](std::vector<double> numbers) {
    return Array::of<double>({3, 3}, std::move(numbers));
  };
  auto& properties = const_cast<Object&>(sensor).properties;
  properties.push_back({"points", rows({0, 0, 1, 0, 0, 2, 5, 0, 1}), {}});
  properties.push_back({"normals", rows({0, 0, 1, 0, 0, -1, 1, 0, 0}), {}});
  const auto scene = build_scene(description);
  ASSERT_TRUE(is_meter(*scene));
  const std::vector<Measurement> list = measurements(*scene, film_of(description, *scene, 16));
  ASSERT_EQ(list.size(), 3u);
  const double full = lumens_per_watt_white * 2 * double(pi);
  EXPECT_EQ(list[2].position, Vec3f(5, 0, 1));
  EXPECT_NEAR(list[0].value, full, 3 * list[0].half_width);
  EXPECT_NEAR(list[1].value, 0, 1e-3 * full);
  EXPECT_NEAR(list[2].value, full / 2, 3 * list[2].half_width + 1e-3 * full);
  EXPECT_LT(list[2].half_width, 0.1 * full);
  // One pass tells nothing of the error.
  EXPECT_TRUE(std::isinf(measurements(*scene, film_of(description, *scene, 1))[2].half_width));
}

TEST(Measurements, PicturesHaveNone) {
  EXPECT_FALSE(is_meter(*build_scene(description_of("<sensor type=\"perspective\"/>"))));
}

}  // namespace
}  // namespace kaustik
