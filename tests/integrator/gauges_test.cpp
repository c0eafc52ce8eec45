// Irradiance at points and radiance along rays, each in a pixel of its own: closed forms, by every
// method that knows gauges.

#include <algorithm>

#include "kaustik/render/scene_warnings.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

using Numbers = std::vector<double>;

std::shared_ptr<const Array> rows(Numbers numbers, size_t columns = 3) {
  const size_t count = numbers.size() / columns;
  return Array::of<double>({count, columns}, std::move(numbers));
}

/// The scene as a sensor of that type measures it by two lists.
Description measured(const std::string& objects, const std::string& type,
                     const std::vector<Property>& lists) {
  Description description = description_of(objects);
  const auto sensor = std::make_shared<Object>();
  sensor->family = "sensor";
  sensor->type = type;
  sensor->properties = lists;
  description.scene->children.push_back({"", sensor});
  return description;
}
Description at_points(const std::string& objects, const Numbers& points, const Numbers& normals) {
  return measured(objects, "irradiancepoints",
                  {{"points", rows(points), {}}, {"normals", rows(normals), {}}});
}

PixelWeight of_point(size_t number) {
  return [number](int x, int y) { return y == 0 && size_t(x) == number ? 1.0 : 0.0; };
}

const std::vector<std::string> all_methods = {"path", "bdpt", "vcm", "ppm", "auto", "photonmap"};

/// The pixels show these values, as exactly as asked for.
void expect_irradiance(const std::string& what, const Description& description,
                       const Numbers& expected, double samples,
                       const std::vector<std::string>& methods = all_methods,
                       double largest_error = sharp) {
  const TestScene scene(description);
  EXPECT_EQ(scene.scene().quantity(), Quantity::irradiance);
  for (const std::string& method : methods) {
    const Passes passes = render(scene, method, "", {samples});
    for (size_t i = 0; i < expected.size(); ++i) {
      const auto of_pixel = passes.mean({""}, of_point(i));
      const std::string name = fmt::format("{} {}, point {}", method, what, i);
      if (expected[i] == 0)
        EXPECT_EQ(of_pixel.mean(), 0) << name;
      else if (of_pixel.standard_error() < 1e-6 * expected[i])
        // Those on a floor are lifted by some hundredths of a millimetre.
        EXPECT_NEAR(of_pixel.mean() / expected[i], 1, 1e-4) << name;
      else
        expect_equal_means(name, Comparison(of_pixel, expected[i]), largest_error);
    }
  }
}

const std::string black_floor = flat("rectangle", scale("4, 4, 1"), diffuse("0, 0, 0"));

// E = I cos θ / d², in the air, on a floor, with a normal that leans, and from behind.
TEST(Gauges, UnderAPointLamp) {
  const auto expected = [](double x, double y, double z, Vec3d n) {
    const Vec3d to_lamp = Vec3d(0.2, 0.1, 2) - Vec3d(x, y, z);
    return 3 * std::max(0.0, to_lamp.dot(n.normalized())) / std::pow(to_lamp.length(), 3);
  };
  expect_irradiance("under a point lamp",
                    at_points(black_floor + point_light("0.2, 0.1, 2", 3),
                              {0.5, -0.3, 0.8, 0.5, -0.3, 0, 0.5, -0.3, 0.8, 0.5, -0.3, 0.8},
                              {0, 0, 2, 0, 0, 1, 0.3, 0.4, 1, 0, 0, -1}),
                    {expected(0.5, -0.3, 0.8, {0, 0, 1}), expected(0.5, -0.3, 0, {0, 0, 1}),
                     expected(0.5, -0.3, 0.8, {0.3, 0.4, 1}), 0},
                    4);
}

TEST(Gauges, InParallelLight) {
  expect_irradiance("in parallel light",
                    at_points(black_floor + directional_light("0.6, 0, -0.8", 5),
                              {0, 0, 1, 0, 0, 0, 0, 0, 1}, {0, 0, 1, 0, 0, 1, 1, 0, 0}),
                    {4, 4, 0}, 4);
}

// E = π L, wherever the gauge looks; and what stands in the way counts. A factor of π, or of the
// cosine, would show.
TEST(Gauges, UnderAnEvenSky) {
  expect_irradiance(
      "under a sky",
      at_points(black_floor + constant_light(2), {0, 0, 1, 0, 0, 0}, {0, 0, 1, 0, 0, 1}),
      {2 * std::numbers::pi, 2 * std::numbers::pi}, 64);
}

// A corner of a rectangle a × b parallel to the gauge, at distance 1 (Howell, C-11); four of them.
TEST(Gauges, UnderARectangle) {
  const auto corner = [](double a, double b) {
    const double p = std::hypot(1, a), q = std::hypot(1, b);
    return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2 * std::numbers::pi);
  };
  const double factor = corner(0.3, 0.5) + corner(0.7, 0.5) + corner(0.3, 0.7) + corner(0.7, 0.7);
  const std::string lamp =
      flat("rectangle", scale("0.5, 0.6, 1") + rotate("1, 0, 0", 180) + translate("0.2, 0.1, 1.8"),
           diffuse("0, 0, 0") + area_light("4"));
  expect_irradiance("under a rectangle",
                    at_points(black_floor + lamp, {0, 0, 0.8, 0, 0, 0.8}, {0, 0, 1, 0, 0, -1}),
                    {4 * std::numbers::pi * factor, 0}, 64);
}

// A closed sphere that emits 1 and reflects a half: L = 2 everywhere, found by all techniques.
// Their weights would not sum to one if light paths passed gauges otherwise than weights have it.
TEST(Gauges, InAGlowingSphere) {
  const std::string glowing = sphere("0, 0, 0", 1, diffuse("0.5") + area_light("1"), true);
  expect_irradiance("in a glowing sphere",
                    at_points(glowing, {0.2, 0.1, -0.3, 0, 0.6, 0.8}, {1, 0.3, 0.2, 0, -0.6, -0.8}),
                    {2 * std::numbers::pi, 2 * std::numbers::pi}, 64, {"path", "bdpt", "vcm"},
                    0.006);
  // What photons are gathered from has a bias.
  const TestScene scene(
      at_points(glowing, {0.2, 0.1, -0.3, 0, 0.6, 0.8}, {1, 0.3, 0.2, 0, -0.6, -0.8}));
  const Passes passes = render(scene, "photonmap", set("global_photons", 20000), {64});
  for (size_t i = 0; i < 2; ++i)
    expect_near_means(fmt::format("photonmap in a glowing sphere, point {}", i),
                      Comparison(passes.mean({""}, of_point(i)), 2 * std::numbers::pi), 0.03,
                      0.015);
}

/// Of what fills the side of a shape to which its normals point, m⁻¹.
std::string filled(double sigma_t, double albedo) {
  return fmt::format(
      R"(<medium type="homogeneous" name="exterior"><float name="sigma_t" value="{}"/>
      <float name="albedo" value="{}"/></medium>)",
      sigma_t, albedo);
}

// What absorbs takes its share of a lamp's light; the gauges find out which medium they are in.
TEST(Gauges, InAnAbsorbingMedium) {
  expect_irradiance("in an absorbing medium",
                    at_points(sphere("0, 0, 0", 3, diffuse("0, 0, 0") + filled(0.5, 0), true) +
                                  point_light("0, 0, 1", 3),
                              {0, 0, -0.5}, {0, 0, 1}),
                    {3 / 2.25 * std::exp(-0.5 * 1.5)}, 4, {"path", "vcm", "auto"});
}

// The same radiance everywhere, whatever is scattered on its way.
TEST(Gauges, InAGlowingSphereOfMist) {
  const TestScene scene(
      at_points(sphere("0, 0, 0", 1, diffuse("0.5") + area_light("1") + filled(0.3, 1), true),
                {0.2, 0.1, -0.3}, {1, 0.3, 0.2}));
  for (const std::string method : {"path", "auto"})
    expect_near_means(method + " in a glowing sphere of mist",
                      Comparison(render(scene, method, "", {100}).mean({""}), 2 * std::numbers::pi),
                      0.03, 0.015);
}

/// A pane of glass between z = 1 and 1.2 and a point lamp at z = 2.
const std::string lamp_above_pane = R"(<shape type="cube"><transform name="to_world">)" +
                                    scale("20, 20, 0.1") + translate("0, 0, 1.1") + "</transform>" +
                                    glass() + "</shape>" + point_light("0, 0, 2", 3);
/// Irradiance on the axis, a depth below z = 2: the lamp looks nearer by what the pane takes off
/// its optical thickness, and farther by each time that light goes to and fro in it.
double behind_pane(double depth) {
  constexpr double thickness = 0.2, ior = 1.5, reflectance = 0.04;
  double sum = 0;
  for (int k = 0; k < 8; ++k)
    sum += std::pow(1 - reflectance, 2) * std::pow(reflectance, 2 * k) /
           std::pow(depth - thickness + (1 + 2 * k) * thickness / ior, 2);
  return 3 * sum;
}

// Light of a lamp that nothing but light paths finds: they meet the gauges in the air, on a floor,
// and beside a wall, which hides nearly half of the disk of the gauge there.
TEST(Gauges, BehindAPane) {
  const std::string wall =
      flat("rectangle", rotate("0, 1, 0", 90) + translate("0.003, 0, 0"), diffuse("0, 0, 0"));
  const TestScene with_wall(at_points(lamp_above_pane + wall, {0, 0, 0.5}, {0, 0, 1}));
  const TestScene with_floor(at_points(lamp_above_pane + black_floor,
                                       {0, 0, 0.5, 0, 0, 0, 0, 0, 0.5},
                                       {0, 0, 1, 0, 0, 1, 0, 0, -1}));
  const auto expect_caustic = [](const std::string& what, const RunningStatistics& measured,
                                 double depth, double tolerance) {
    expect_near_means(what + " behind a pane", Comparison(measured, behind_pane(depth)), tolerance,
                      tolerance / 2);
  };
  const Passes open = render(with_floor, "auto", "", {64});
  expect_caustic("auto in the air,", open.mean({"caustic"}, of_point(0)), 1.5, 0.02);
  expect_caustic("auto on a floor,", open.mean({"caustic"}, of_point(1)), 2, 0.02);
  EXPECT_EQ(open.mean({""}, of_point(2)).mean(), 0);
  expect_caustic("auto beside a wall,", render(with_wall, "auto", "", {64}).mean({"caustic"}), 1.5,
                 0.04);
  const std::string photons = set("caustic_photons", 60'000) + set("caustic_radius", 0.15);
  const Passes passed = render(with_floor, "photonmap", photons, {16});
  expect_caustic("photonmap in the air,", passed.mean({"caustic"}, of_point(0)), 1.5, 0.05);
  expect_caustic("photonmap on a floor,", passed.mean({"caustic"}, of_point(1)), 2, 0.06);
  EXPECT_EQ(passed.mean({""}, of_point(2)).mean(), 0);
  expect_caustic("photonmap beside a wall,",
                 render(with_wall, "photonmap", photons, {16}).mean({"caustic"}), 1.5, 0.08);
  const Passes merged = render(with_floor, "ppm", set("light_paths", 1000.0), {8});
  expect_caustic("ppm in the air,", merged.mean({"caustic"}, of_point(0)), 1.5, 0.1);
}

// What path tracing finds of a lamp that can be met, all methods find, in the air and on a floor,
// in and beside the focus of a ball of glass.
TEST(Gauges, UnderABallOfGlassLong) {
  const std::string objects = sphere("0, 0, 1", 0.3, glass()) +
                              sphere("0, 0, 3", 0.8, diffuse("0, 0, 0") + area_light("1")) +
                              flat("rectangle", scale("2, 2, 1"), diffuse("0.5"));
  const TestScene scene(at_points(objects, {0.02, 0.01, 0.5, 0.1, 0, 0}, {0.1, 0, 1, 0, 0, 1}));
  const Passes reference = render(scene, "path", "", {8000});
  for (const std::string method : {"auto", "vcm"}) {
    const Passes passes = render(scene, method, "", {384});
    for (size_t i = 0; i < 2; ++i)
      expect_near_means(
          fmt::format("{} under a ball of glass, point {}", method, i),
          Comparison(passes.mean({""}, of_point(i)), reference.mean({""}, of_point(i))), 0.06,
          0.03);
  }
}

// Points are no neighbours of one another: a list has the bits of its points, whatever else is
// measured, where nothing is chosen for all together; and so it has for any number of threads.
TEST(Gauges, SameBits) {
  const Numbers points = {0, 0, 0.5, 0.1, 0, 0.5, 0, 0, 0}, normals = {0, 0, 1, 0, 0, 1, 0, 0, 1};
  const TestScene scene(at_points(lamp_above_pane + black_floor, points, normals));
  for (const std::string method : {"path", "vcm", "auto", "photonmap"})
    EXPECT_TRUE(same_bits(render(scene, method, "", {.samples = 16, .passes = 2, .threads = 1}),
                          render(scene, method, "", {.samples = 16, .passes = 2, .threads = 3})))
        << method;
}

// A camera's pixel, a radiancemeter and a ray of a list measure the same.
TEST(RadianceRays, OfALitFloor) {
  const std::string objects =
      flat("rectangle", scale("2, 2, 1"), diffuse("0.4")) + point_light("0, 0, 1", 3);
  const TestScene scene(
      measured(objects, "radiancerays",
               {{"origins", rows({1, 1, 1.5, 0.4, 0.5, 1, 0, 0, 3}), {}},
                {"directions", rows({-0.7, -1.2, -1.5, 0, 0, -5, 0, 0, 1}), {}}}));
  EXPECT_EQ(scene.scene().quantity(), Quantity::radiance);
  const auto radiance = [](double x, double y) {
    return 0.4 / std::numbers::pi * 3 / std::pow(x * x + y * y + 1, 1.5);
  };
  const Numbers expected = {radiance(0.3, -0.2), radiance(0.4, 0.5), 0};
  for (const std::string method : {"path", "bdpt", "vcm", "ppm", "auto", "photonmap"}) {
    const Passes passes = render(scene, method, "", {16});
    for (size_t i = 0; i < 3; ++i) {
      const auto mean = passes.mean({""}, of_point(i));
      if (expected[i] == 0)
        EXPECT_EQ(mean.mean(), 0);
      else
        expect_equal_means(method + " along a ray", Comparison(mean, expected[i]), 0.003);
    }
  }
}

// In rows of 1024, each at its place; pixels beyond the last are black.
TEST(Gauges, ManyPoints) {
  constexpr size_t count = 1500;
  Numbers points, normals;
  const auto height = [](size_t i) { return 0.1 + 0.8 * double(i) / double(count); };
  for (size_t i = 0; i < count; ++i) {
    points.insert(points.end(), {0, 0, height(i)});
    normals.insert(normals.end(), {0, 0, 1});
  }
  const TestScene scene(at_points(black_floor + point_light("0, 0, 2", 3), points, normals));
  EXPECT_EQ(scene.scene().film().size, Vec2i(1024, 2));
  const Image image = render(scene, "path", "", {.samples = 1, .passes = 1}).images()[0];
  for (size_t i = 0; i < 2048; ++i) {
    const double expected = i < count ? 3 / std::pow(2 - height(i), 2) : 0.0;
    EXPECT_NEAR(image.at(int(i % 1024), int(i / 1024), 0), expected, 1e-5 * expected) << i;
  }
}

// Without lists a meter measures where it stands, so that files of text can have one, too.
TEST(Gauges, OnePointOfText) {
  const TestScene scene(R"(<sensor type="irradiancepoints"><transform name="to_world">)" +
                        rotate("0, 1, 0", 90) + translate("-1, 0, 0") + R"(</transform></sensor>)" +
                        point_light("1, 0, 0", 3));
  EXPECT_EQ(scene.scene().film().size, Vec2i(1, 1));
  expect_mean("a point of text", render(scene, "path", "", {4}).mean({""}), 3.0 / 4);
}

TEST(Gauges, WhoKnowsNothingOfThem) {
  const TestScene scene(at_points(black_floor + point_light("0, 0, 2", 3), {0, 0, 1}, {0, 0, 1}));
  for (const char* type : {"lighttracer", "raytracing"}) {
    std::vector<std::string> warnings;
    try {
      make_integrator(description_of(fmt::format("<integrator type=\"{}\"/>", type)), scene.scene(),
                      warnings);
      ADD_FAILURE() << type;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("auto"), std::string::npos) << error.what();
    }
  }
  // Lamps that no ray meets are measured: nothing to warn of.
  EXPECT_TRUE(scene_warnings(scene.scene()).empty());
}

TEST(Gauges, WrongLists) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_refused = [&](const std::vector<Property>& lists, const std::string& name,
                                  const std::string& what) {
    try {
      build_scene(measured(black_floor, "irradiancepoints", lists));
      ADD_FAILURE() << what;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("'" + name + "'"), std::string::npos)
          << error.what();
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  const auto lists = [](Numbers points, Numbers normals) {
    return std::vector<Property>{{"points", rows(std::move(points)), {}},
                                 {"normals", rows(std::move(normals)), {}}};
  };
  expect_refused(lists({}, {}), "points", "empty");
  expect_refused(lists({0, 0, 0, 1, 1, nan}, {0, 0, 1, 0, 0, 1}), "points", "row 1 is not finite");
  expect_refused(lists({0, 0, 1e300}, {0, 0, 1}), "points", "row 0 is not finite");
  expect_refused(lists({0, 0, 0}, {0, 0, nan}), "normals", "row 0");
  expect_refused(lists({0, 0, 0}, {0, 0, 0}), "normals", "row 0 has no direction");
  expect_refused(lists({0, 0, 0}, {0, 0, 1, 0, 0, 1}), "normals", "it has 2 rows");
  expect_refused({{"points", rows({0, 0, 0}), {}}}, "points", "no 'normals'");
  expect_refused({{"points", rows({0, 0, 0, 1}, 2), {}}, {"normals", rows({0, 0, 1}), {}}},
                 "points", "extents");
  // Directions as long as numbers are.
  EXPECT_NO_THROW(build_scene(measured(black_floor, "irradiancepoints",
                                       lists({0, 0, 0, 0, 0, 0}, {0, 1e300, 0, 0, 1e-300, 0}))));
}

}  // namespace
}  // namespace kaustik
