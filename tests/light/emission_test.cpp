// Emitted rays: densities, power, and the parts that aimed emission is made of.

#include <gtest/gtest.h>

#include "kaustik/base/warp.h"
#include "tests/light/light_testing.h"
#include "tests/light/photometric_samples.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

struct LightCase {
  std::string name;
  std::shared_ptr<const Light> light;
};

std::vector<LightCase> every_light() {
  const Value white(2.0), colored(Rgb{1, 2, 0.5});
  const Value aimed(Transform::look_at({1, 1, 1}, {3, 2, 0}, {0, 0, 1}));
  const auto spot = [&](double cutoff, double beam, const std::string& falloff = "linear",
                        std::shared_ptr<const EmissionPattern> slide = nullptr) {
    return make_light("spot",
                      {{"intensity", white, {}},
                       {"cutoff_angle", Value(cutoff), {}},
                       {"beam_width", Value(beam), {}},
                       {"falloff", Value(falloff), {}},
                       {"to_world", aimed, {}}},
                      nullptr, test_bounds(), std::move(slide));
  };
  const Vec3f tilted = normalize(Vec3f(1, -2, 0.5f));
  std::vector<LightCase> cases;
  cases.push_back({"quad", make_light("area", {{"radiance", colored, {}}},
                                      make_quad({1, 2, 3}, {1, 1, 0}, {0, 0.3f, 1}))});
  cases.push_back(
      {"disk", make_light("area", {{"radiance", white, {}}}, make_disk({1, 1, 1}, tilted, 0.7f))});
  cases.push_back(
      {"ball", make_light("area", {{"radiance", white, {}}}, make_ball({0, 2, 4}, 0.3f))});
  const Value uneven(Transform::translate({1, 1, 1}) * Transform::rotate({1, 2, 3}, 40) *
                     Transform::scale({0.3, 0.7, 0.4}));
  for (const char* shape : {"sphere", "cylinder"})
    cases.push_back({std::string("uneven ") + shape,
                     make_light("area", {{"radiance", colored, {}}},
                                make_shape(shape, {{"to_world", uneven, {}}}))});
  cases.push_back({"point", make_light("point", {{"intensity", colored, {}}})});
  cases.push_back({"spot", spot(35, 20)});
  cases.push_back({"sharp spot", spot(25, 25)});
  cases.push_back({"soft spot", spot(60, 0)});
  cases.push_back({"wide spot", spot(150, 30)});
  cases.push_back({"narrow spot", spot(0.5, 0.2)});
  cases.push_back({"smooth spot", spot(60, 20, "smooth")});
  cases.push_back({"square spot", spot(60, 20, "square")});
  cases.push_back({"spot without falloff", spot(60, 20, "none")});
  cases.push_back({"spot with a slide", spot(40, 10, "linear", fields_pattern())});
  cases.push_back({"narrow spot with a slide", spot(1, 1, "linear", fields_pattern())});
  cases.push_back({"projector", make_light("projector", {{"irradiance", colored, {}},
                                                         {"to_world", aimed, {}}})});
  cases.push_back({"projector with a picture",
                   make_light("projector", {{"fov", Value(80.0), {}}, {"to_world", aimed, {}}},
                              nullptr, test_bounds(), fields_pattern())});
  const auto goniometric = [&](const std::string& profile) {
    return make_light(
        "goniometric",
        {{"profile", Value(profile), {}}, {"intensity", colored, {}}, {"to_world", aimed, {}}});
  };
  const auto lobes = [](double c, double v) { return 200 + c + v * (c > 100 ? 3 : 1); };
  cases.push_back(
      {"luminaire", goniometric(ies_text(even_angles(0, 90, 18), even_angles(0, 360, 12), lobes))});
  cases.push_back({"luminaire at odd angles",
                   goniometric(ies_text({0, 7.3, 31, 64.2, 125}, {0, 41, 180}, lobes))});
  cases.push_back({"uplight", goniometric(ies_text({90, 120, 180}, {0}, lobes))});
  cases.push_back(
      {"directional", make_light("directional", {{"irradiance", white, {}},
                                                 {"direction", Value(Vec3d(1, 2, -0.5)), {}}})});
  cases.push_back({"constant", make_light("constant", {{"radiance", colored, {}}})});
  cases.push_back({"distributed", make_light("distributed", {{"intensity", colored, {}},
                                                             {"radius", Value(0.3), {}}})});
  cases.push_back(
      {"distributed spot",
       make_light("distributedspot",
                  {{"radius", Value(0.3), {}},
                   {"cutoff_angle", Value(50.0), {}},
                   {"to_world", Value(Transform::look_at({1, 1, 1}, {3, 2, 0}, {0, 0, 1})), {}}})});
  const Value turned(Transform::rotate({1, 2, 3}, 50));
  cases.push_back({"envmap", make_envmap(8, 5, spotted_pixels(40), {{"to_world", turned, {}}})});
  // With a sun that is wide enough for the cells of a histogram.
  cases.push_back({"sunsky", make_light("sunsky", {{"sun_aperture", Value(50.0), {}},
                                                   {"sun_direction", Value(Vec3d(1, 0, 1)), {}}})});
  return cases;
}

/// Where directions of sample_emission from `point` can lie.
DirectionGrid emission_grid(const Light& light, const SurfacePoint& point) {
  DirectionGrid grid;
  const LightBounds bounds = light.traits().bounds;
  if (light.traits().shape >= 0) {
    grid.axis = point.ng;
    grid.one_minus_cos = 1;
  } else if (!light.is_infinite()) {
    grid.axis = bounds.axis;
    grid.one_minus_cos = 1 - bounds.cos_angle;
  }
  return grid;
}

TEST(Emission, DirectionsFollowTheirDensity) {
  for (const LightCase& test : every_light()) {
    if (test.name == "directional") continue;
    SCOPED_TRACE(test.name);
    const SurfacePoint point = test.light->sample_emission({0.3f, 0.8f}, {0.5f, 0.5f}, {}).point;
    const DirectionGrid grid = emission_grid(*test.light, point);
    Random random(23);
    const auto sample = [&] {
      return test.light->sample_emission({0.3f, 0.8f}, random.next_2d(), {}).direction;
    };
    const auto pdf = [&](const Vec3f& d) {
      return double(test.light->emission_pdf_direction(point, d));
    };
    const int count = 500'000 / sample_share;
    EXPECT_GT(direction_p_value(grid, count, sample, pdf), failure_level);
    expect_twin_fails(
        [&] { return direction_p_value(grid, count, sample, with_planted_error(grid, pdf)); });
  }
}

/// A position on the light (or its disk) in coordinates of equal area in [0, 1)².
Vec2f position_coordinates(const LightCase& test, const EmissionSample& sample) {
  const Vec3f p = sample.point.position;
  if (test.name == "quad") return sample.point.uv;
  if (test.name == "ball") {
    const Vec3f n = (p - Vec3f(0, 2, 4)) * (1 / 0.3f);
    return {0.5f * (1 - n.z), std::atan2(n.y, n.x) / (2 * pi) + 0.5f};
  }
  if (test.name.starts_with("distributed")) {
    const Vec3f origin = center(test.light->traits().bounds.position);
    const Vec3f n = Frame(test.light->traits().bounds.axis).to_local((p - origin) * (1 / 0.3f));
    const float area = 1 / test.light->emission_pdf_position(sample.point);
    return {(1 - n.z) * (2 * pi * sqr(0.3f)) / area, std::atan2(n.y, n.x) / (2 * pi) + 0.5f};
  }
  const bool infinite = test.light->is_infinite();
  const Vec3f middle = infinite ? center(test_bounds()) : Vec3f(1, 1, 1);
  const Vec3f axis = infinite ? sample.direction : sample.point.ng;
  const Vec3f local = Frame(axis).to_local(p - middle);
  const float radius = std::sqrt(test.light->emission_pdf_position(sample.point) * pi);
  return disk_to_square({local.x * radius, local.y * radius});
}

TEST(Emission, PositionsAreUniform) {
  for (const LightCase& test : every_light()) {
    if (test.light->traits().is_delta && !test.light->is_infinite()) continue;
    // No map to the square keeps their areas; tests of geometry have them.
    if (test.name.starts_with("uneven")) continue;
    SCOPED_TRACE(test.name);
    const auto p_value = [&](bool planted_error) {
      Random random(29);
      return square_p_value(1'000'000 / sample_share, planted_error, [&] {
        const Vec2f u = random.next_2d();
        return position_coordinates(test, test.light->sample_emission(u, random.next_2d(), {}));
      });
    };
    EXPECT_GT(p_value(false), failure_level);
    expect_twin_fails([&] { return p_value(true); });
  }
}

TEST(Emission, ReportsTheDensitiesThatItAnswersLater) {
  for (const LightCase& test : every_light()) {
    SCOPED_TRACE(test.name);
    const Light& light = *test.light;
    Random random(31);
    for (int i = 0; i < 1000; ++i) {
      const Vec2f u = random.next_2d();
      const EmissionSample s = light.sample_emission(u, random.next_2d(), {});
      EXPECT_NEAR(length(s.direction), 1, 1e-5);
      EXPECT_FLOAT_EQ(s.pdf_position, light.emission_pdf_position(s.point));
      const double pdf = light.emission_pdf_direction(s.point, s.direction);
      // At the rim the density vanishes, and its relative error grows.
      EXPECT_NEAR(s.pdf_direction, pdf,
                  1e-3 * pdf + 1e-4 / (1 - light.traits().bounds.cos_angle + 1e-3));
      EXPECT_EQ(s.on_surface, light.traits().shape >= 0);
      if (s.on_surface) {
        EXPECT_EQ(s.point.shape, 7u);
      } else {
        EXPECT_EQ(s.point.ng, Vec3f(0, 0, 0));
        EXPECT_EQ(s.point.error, 0);
      }
    }
  }
}

void expect_power(const RunningStatistics& flux, double power) {
  if (flux.standard_deviation() < 1e-4 * power) {  // the same for every sample, but for rounding
    EXPECT_NEAR(flux.mean(), power, 1e-5 * power);
    return;
  }
  EXPECT_GT(z_test_p_value(flux, power), failure_level)
      << flux.mean() << " ± " << flux.standard_error() << ", not " << power;
  if (!twins_can_fail) return;
  EXPECT_LT(flux.standard_error(), 0.003 * power);
  expect_twin_fails(z_test_p_value(flux, 1.02 * power));
}

TEST(Emission, MeanFluxIsThePower) {
  for (const LightCase& test : every_light()) {
    SCOPED_TRACE(test.name);
    Random random(37);
    RunningStatistics flux;
    for (int i = 0; i < 400'000 / sample_share; ++i) {
      const Vec2f u = random.next_2d();
      flux.add(test.light->sample_emission(u, random.next_2d(), {}).flux[1]);
    }
    expect_power(flux, test.light->traits().power[1]);
  }
}

TEST(Emission, PowerIsTheIntegralOfWhatLeavesThePlace) {
  for (const LightCase& test : every_light()) {
    if (test.light->is_infinite()) continue;
    SCOPED_TRACE(test.name);
    const Light& light = *test.light;
    const LightBounds bounds = light.traits().bounds;
    const float one_minus_cos = 1 - bounds.cos_angle;
    Random random(41);
    RunningStatistics flux;
    for (int i = 0; i < 1'600'000 / sample_share; ++i) {
      const EmissionSample s = light.placed().sample_origin(random.next_2d());
      const Vec3f direction =
          Frame(bounds.axis).to_world(square_to_cone(random.next_2d(), one_minus_cos));
      const double cosine = s.on_surface ? abs_dot(s.point.ng, direction) : 1.0;
      flux.add(light.emitted(s.point, direction, {})[1] * cosine /
               (double(s.pdf_position) * cone_pdf(one_minus_cos)));
    }
    expect_power(flux, light.traits().power[1]);
  }
}

TEST(Emission, PowerInClosedForm) {
  const double p = std::numbers::pi;
  const auto power = [](const std::unique_ptr<Light>& light) { return light->traits().power[0]; };
  const std::vector<Property> radiance = {{"radiance", Value(3.0), {}}};
  EXPECT_NEAR(power(make_light("area", radiance, make_ball({0, 0, 0}, 2))), 3 * p * 16 * p, 1e-3);
  EXPECT_NEAR(power(make_light("point", {{"intensity", Value(3.0), {}}})), 12 * p, 1e-4);
  const double disk = p * 12;  // the test's bounds have a diagonal of √48
  EXPECT_NEAR(power(make_light("directional", {{"irradiance", Value(3.0), {}}})), 3 * disk, 0.01);
  EXPECT_NEAR(power(make_light("constant", radiance)), 3 * 4 * p * disk, 0.1);
  // 2π I (1 − (sin c − sin b)/(c − b)), and the plain cone for c = b.
  const auto spot = [&](double cutoff, double beam) {
    return power(make_light("spot", {{"intensity", Value(3.0), {}},
                                     {"cutoff_angle", Value(cutoff), {}},
                                     {"beam_width", Value(beam), {}}}));
  };
  EXPECT_NEAR(spot(90, 0), 6 * p * (1 - 2 / p), 1e-4);
  EXPECT_NEAR(spot(60, 60), 6 * p * 0.5, 1e-5);
  EXPECT_NEAR(spot(60, 59.999) / spot(60, 60), 1, 1e-4);
}

TEST(Emission, RaysFromInfinityStartOutsideAndCoverTheScene) {
  const Bounds3f scenes[] = {test_bounds(),
                             {{1e4f, 1e4f, -1e4f}, {1e4f + 1, 1e4f + 2, -1e4f + 1}},
                             {{0, 0, 0}, {1e-4f, 0, 0}}};
  for (const Bounds3f& bounds : scenes) {
    for (const std::string type : {"constant", "directional"}) {
      const auto light = make_light(type, {}, nullptr, bounds);
      Random random(43);
      for (int i = 0; i < 2000; ++i) {
        const Vec2f u = random.next_2d();
        const EmissionSample s = light->sample_emission(u, random.next_2d(), {});
        const float radius = std::sqrt(1 / (pi * s.pdf_position));
        for (int corner = 0; corner < 8; ++corner) {
          const Vec3f c(corner & 1 ? bounds.min.x : bounds.max.x,
                        corner & 2 ? bounds.min.y : bounds.max.y,
                        corner & 4 ? bounds.min.z : bounds.max.z);
          ASSERT_GT(dot(Vec3d(c) - Vec3d(s.point.position), Vec3d(s.direction)), 0) << type;
          ASSERT_LE(length(cross(c - center(bounds), s.direction)), radius);
        }
      }
    }
  }
}

TEST(Emission, TravelDirectionsOfInfiniteLights) {
  const auto sun = make_light("directional", {{"irradiance", Value(2.0), {}}});
  const TravelDirection from_sun = sun->distant().sample_travel_direction({0.1f, 0.2f});
  EXPECT_EQ(from_sun.direction, Vec3f(0, 0, 1));
  EXPECT_EQ(from_sun.pdf, 1);
  EXPECT_FLOAT_EQ(sun->emitted({}, {0, 0, 1}, {})[0], 2);
  const auto sky = make_light("constant", {{"radiance", Value(2.0), {}}});
  const EmissionSample s = sky->sample_emission({0.5f, 0.5f}, {0.1f, 0.2f}, {});
  const TravelDirection from_sky = sky->distant().sample_travel_direction({0.1f, 0.2f});
  EXPECT_EQ(from_sky.direction, s.direction);
  EXPECT_FLOAT_EQ(from_sky.pdf, s.pdf_direction);
  EXPECT_FLOAT_EQ(sky->emitted(s.point, s.direction, {})[0], 2);
}

TEST(Bounds, HoldWhereLightGoes) {
  for (const LightCase& test : every_light()) {
    SCOPED_TRACE(test.name);
    const LightBounds bounds = test.light->traits().bounds;
    EXPECT_EQ(bounds.infinite, test.light->is_infinite());
    EXPECT_EQ(bounds.position.isEmpty(), bounds.infinite);
    if (bounds.infinite) continue;
    EXPECT_GE(bounds.cos_spread, bounds.cos_angle);
    Random random(47);
    for (int i = 0; i < 1000; ++i) {
      const Vec2f u = random.next_2d();
      const EmissionSample s = test.light->sample_emission(u, random.next_2d(), {});
      EXPECT_GE(dot(s.direction, bounds.axis), bounds.cos_angle - 1e-5f);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GE(s.point.position[axis], bounds.position.min[axis] - 1e-5f);
        EXPECT_LE(s.point.position[axis], bounds.position.max[axis] + 1e-5f);
      }
    }
  }
  const auto flat = make_light("area", {}, make_disk({0, 0, 0}, {0, 1, 0}, 1));
  EXPECT_NEAR(flat->traits().bounds.axis.y, 1, 1e-6);
  EXPECT_NEAR(flat->traits().bounds.cos_angle, 0, 1e-2);
  const auto mesh = make_light("area", {}, make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_NEAR(mesh->traits().bounds.axis.z, 1, 1e-6);
  EXPECT_NEAR(mesh->traits().bounds.cos_angle, 0, 1e-2);
}

}  // namespace
}  // namespace kaustik
