// Beams from flat shapes: parallel light between the borders of the shape.

#include <gtest/gtest.h>

#include "tests/light/light_testing.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

const Vec3f corner_of_quad(1, 2, 3), a_of_quad(2, 0, 0), b_of_quad(0, 1, 1);

std::unique_ptr<Light> beam_of_quad(std::shared_ptr<const EmissionPattern> pattern = nullptr) {
  std::vector<Property> properties;
  if (!pattern) properties.push_back({"radiance", Value(Rgb{3, 2, 1}), {}});
  return make_light("directionalarea", properties, make_quad(corner_of_quad, a_of_quad, b_of_quad),
                    test_bounds(), std::move(pattern));
}

/// The point over x a + y b of the quad, `height` before it.
Vec3f before_quad(float x, float y, float height) {
  return corner_of_quad + a_of_quad * x + b_of_quad * y +
         normalize(cross(a_of_quad, b_of_quad)) * height;
}

TEST(DirectionalArea, LightsWhatLiesBeforeIt) {
  const auto light = beam_of_quad();
  const Vec3f normal = normalize(cross(a_of_quad, b_of_quad));
  Random random(61);
  int lit = 0;
  for (int i = 0; i < 20'000; ++i) {
    const float x = 2 * random.next() - 0.5f, y = 2 * random.next() - 0.5f;
    const float height = (i % 3 == 0 ? 1000.0f : 3.0f) * (random.next() - 0.2f);
    // Rounding tells on which side of a border a point lies.
    if (std::min({std::fabs(x), std::fabs(1 - x), std::fabs(y), std::fabs(1 - y)}) < 1e-3f ||
        std::fabs(height) < 1e-3f)
      continue;
    const LightQuery query(before_quad(x, y, height));
    const LightSample s = light->sample_toward(query, random.next_2d());
    const bool inside = x > 0 && x < 1 && y > 0 && y < 1 && height > 0;
    ASSERT_EQ(s.pdf_solid_angle > 0, inside) << x << ' ' << y << ' ' << height;
    EXPECT_TRUE(s.only_sampled);
    if (!inside) continue;
    ++lit;
    EXPECT_GT(light->expected_irradiance(query), 0);
    EXPECT_TRUE(s.delta && s.on_surface);
    EXPECT_EQ(s.pdf_solid_angle, 1);
    EXPECT_EQ(s.radiance, spectrum_from_rgb(3, 2, 1));  // at any distance
    EXPECT_NEAR(length(s.direction + normal), 0, 1e-6f);
    EXPECT_NEAR(s.distance, height, 1e-4f * height + 1e-5f);
    EXPECT_NEAR(length(s.point.position - before_quad(x, y, 0)), 0, 2e-4f + 1e-6f * height);
    EXPECT_EQ(s.point.shape, 7u);
    EXPECT_EQ(light->pdf_toward(query, s.point), 0);
  }
  EXPECT_GT(lit, 2000);
}

TEST(DirectionalArea, FacesWhatItLights) {
  const auto light = beam_of_quad();
  const Vec3f normal = normalize(cross(a_of_quad, b_of_quad)), at = before_quad(0.5f, 0.5f, 1);
  EXPECT_FLOAT_EQ(light->expected_irradiance({at}), 6);
  EXPECT_FLOAT_EQ(light->expected_irradiance({at, -normal}), 6);
  EXPECT_EQ(light->expected_irradiance({at, normal}), 0);
  const Vec3f slanted = normalize(normalize(a_of_quad) - normal);
  EXPECT_NEAR(light->expected_irradiance({at, slanted}), 6 * std::sqrt(0.5), 1e-5);
}

TEST(DirectionalArea, EmitsAlongItsNormal) {
  const auto light = beam_of_quad();
  const Vec3f normal = normalize(cross(a_of_quad, b_of_quad));
  const double area = double(length(cross(a_of_quad, b_of_quad)));
  const LightTraits& traits = light->traits();
  EXPECT_TRUE(traits.is_delta && traits.is_beam() && light->is_infinite());
  EXPECT_EQ(traits.shape, -1);
  EXPECT_EQ(traits.surface(), 7);
  EXPECT_NEAR(traits.power[0], 3 * area, 1e-5);
  const auto p_value = [&](bool planted_error) {
    Random random(62);
    return square_p_value(1'000'000 / sample_share, planted_error, [&] {
      return light->sample_emission(random.next_2d(), {0.5f, 0.5f}, {}).point.uv;
    });
  };
  EXPECT_GT(p_value(false), failure_level);
  expect_twin_fails([&] { return p_value(true); });
  Random random(63);
  for (int i = 0; i < 1000; ++i) {
    const EmissionSample s = light->sample_emission(random.next_2d(), random.next_2d(), {});
    EXPECT_TRUE(s.on_surface);
    EXPECT_EQ(s.point.shape, 7u);
    EXPECT_NEAR(length(s.direction - normal), 0, 1e-6f);
    EXPECT_EQ(s.pdf_direction, 1);
    EXPECT_NEAR(s.pdf_position, 1 / area, 1e-5);
    EXPECT_FLOAT_EQ(s.pdf_position, light->emission_pdf_position(s.point));
    EXPECT_NEAR(s.flux[0], 3 * area, 1e-4);
    // What is sampled from a point of the ray is the ray.
    const LightSample back =
        light->sample_toward({s.point.position + s.direction * (10 * random.next())}, {});
    if (back.pdf_solid_angle > 0) {
      EXPECT_NEAR(length(back.point.position - s.point.position), 0, 1e-4f);
    }
  }
  const TravelDirection travel = light->distant().sample_travel_direction({0.1f, 0.2f});
  EXPECT_EQ(travel.direction, light->sample_emission({0.5f, 0.5f}, {}, {}).direction);
  EXPECT_TRUE(light->distant().background(-normal, {}).is_zero());
}

TEST(DirectionalArea, ShowsPatterns) {
  const auto pattern = fields_pattern();
  const auto light = beam_of_quad(pattern);
  Random random(64);
  RunningStatistics flux;
  for (int i = 0; i < 100'000; ++i) {
    const EmissionSample s = light->sample_emission(random.next_2d(), {}, {});
    flux.add(double(s.flux[1]));
    if (i >= 1000) continue;
    const float x = random.next(), y = random.next();
    const LightSample found = light->sample_toward({before_quad(x, y, 2)}, {});
    if (!(found.pdf_solid_angle > 0)) continue;
    EXPECT_NEAR(found.point.uv.x, x, 1e-4f);
    EXPECT_NEAR(found.point.uv.y, y, 1e-4f);
    EXPECT_EQ(found.radiance, pattern->radiance(found.point, {}));
  }
  EXPECT_GT(z_test_p_value(flux, double(light->traits().power[1])), failure_level);
  expect_twin_fails(z_test_p_value(flux, 1.02 * double(light->traits().power[1])));
}

TEST(DirectionalArea, OfDisksIsRound) {
  const Vec3f middle(1, 1, 1), normal = normalize(Vec3f(1, -2, 0.5f));
  const auto light = make_light("directionalarea", {{"radiance", Value(2.0), {}}},
                                make_disk(middle, normal, 0.7f));
  EXPECT_NEAR(light->traits().power[1], 2 * std::numbers::pi * 0.49, 1e-4);
  const Frame frame(normal);
  Random random(65);
  for (int i = 0; i < 5000; ++i) {
    const Vec3f local(2 * random.next() - 1, 2 * random.next() - 1, 1 + random.next());
    const float radius = std::hypot(local.x, local.y);
    if (std::fabs(radius - 0.7f) < 1e-3f) continue;
    const LightSample s = light->sample_toward({middle + frame.to_world(local)}, {});
    EXPECT_EQ(s.pdf_solid_angle > 0, radius < 0.7f);
  }
}

TEST(DirectionalArea, IsFlat) {
  const auto message = [](std::shared_ptr<const Shape> shape) -> std::string {
    try {
      make_light("directionalarea", {}, std::move(shape));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_FALSE(error.problems()[0].remedy.empty());
      return error.what();
    }
    return {};
  };
  EXPECT_NE(message(nullptr).find("outside of a shape"), std::string::npos);
  for (const char* type : {"sphere", "cube", "cylinder"})
    EXPECT_NE(message(make_shape(type, {})).find("not flat"), std::string::npos) << type;
  // Two sheets, one over the other, whose normals are the same; and one that is bent.
  const auto mesh = [](std::vector<float> positions, std::vector<int32_t> faces) {
    const size_t vertices = positions.size() / 3, triangles = faces.size() / 3;
    return make_shape(
        "mesh", {{"positions", Value(Array::of<float>({vertices, 3}, std::move(positions))), {}},
                 {"faces", Value(Array::of<int32_t>({triangles, 3}, std::move(faces))), {}}});
  };
  EXPECT_NE(
      message(mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1}, {0, 1, 2, 3, 4, 5}))
          .find("not flat"),
      std::string::npos);
  EXPECT_NE(
      message(mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.1f}, {0, 1, 2, 1, 3, 2})).find("not flat"),
      std::string::npos);
  EXPECT_EQ(
      message(mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 0, 0, 6, 0, 0, 5, 1, 0}, {0, 1, 2, 3, 4, 5})),
      "");
}

}  // namespace
}  // namespace kaustik
