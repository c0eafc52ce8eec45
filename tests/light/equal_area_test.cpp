// Square pictures of equal areas as pictures of longitude and latitude.

#include "kaustik/light/equal_area.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kaustik/light/latlong_distribution.h"

namespace kaustik {
namespace {

/// Clarberg's map of the square from −1 to 1 to the sphere, z in the middle.
Vec3d sphere_from(double u, double v) {
  const double d = 1 - (std::fabs(u) + std::fabs(v)), r = 1 - std::fabs(d);
  const double phi = r == 0 ? 0 : std::numbers::pi / 4 * ((std::fabs(v) - std::fabs(u)) / r + 1);
  const double around = r * std::sqrt(2 - r * r);
  return {std::copysign(std::cos(phi), u) * around, std::copysign(std::sin(phi), v) * around,
          std::copysign(1 - r * r, d)};
}

/// Its pixels hold what `value` is in their direction in pbrt's space.
template <typename Function>
Image square_of(int size, const Function& value) {
  Image image(size, size, {"Y"});
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      image.at(x, y, 0) =
          float(value(sphere_from(2 * (x + .5) / size - 1, 2 * (y + .5) / size - 1)));
  return image;
}

/// In pbrt's space, of a pixel of the result, see latlong_of_equal_area().
Vec3d direction_of(const Image& image, int x, int y) {
  const double phi = 2 * std::numbers::pi * (x + .5) / image.width();
  const double theta = std::numbers::pi * y / (image.height() - 1);
  const Vec3d d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
  return {d.x, -d.z, d.y};
}

TEST(EqualArea, DirectionsKeepTheirValues) {
  const auto value = [](const Vec3d& d) { return 2 + d.x + .5 * d.y - .25 * d.z + d.x * d.y; };
  const Image latlong = latlong_of_equal_area(square_of(64, value));
  EXPECT_EQ(latlong.width(), 128);
  EXPECT_EQ(latlong.height(), 64);
  for (int y = 0; y < latlong.height(); ++y)
    for (int x = 0; x < latlong.width(); ++x)
      EXPECT_NEAR(latlong.at(x, y, 0), value(direction_of(latlong, x, y)), .12) << x << ", " << y;
}

/// Of all directions, as EnvmapLight has it between the nodes.
double mean_over_sphere(const Image& latlong) {
  std::vector<float> values(latlong.channel(0).begin(), latlong.channel(0).end());
  const LatLongDistribution between(latlong.width(), std::move(values), std::numbers::pi);
  return between.integral() / (4 * std::numbers::pi);
}

TEST(EqualArea, LightIsKept) {
  // A sun of one pixel: its share of the sphere is 1 / size².
  constexpr int size = 32;
  for (const auto& [column, row] : {std::pair(16, 16), {3, 7}, {31, 0}, {20, 31}, {8, 24}}) {
    Image square(size, size, {"Y"});
    square.at(column, row, 0) = 1000;
    EXPECT_NEAR(mean_over_sphere(latlong_of_equal_area(square)) * size * size, 1000, .1);
    // With a sky: the sun is what the sky alone lacks.
    for (float& value : square.channel(0)) value += 1;
    const Image latlong = latlong_of_equal_area(square);
    EXPECT_NEAR(mean_over_sphere(latlong), 1 + 1000. / (size * size), 1e-4);
    float sky = latlong.at(0, 0, 0);
    for (const float value : latlong.channel(0)) sky = std::min(sky, value);
    EXPECT_NEAR(sky, 1, .02) << column << ", " << row;
  }
}

}  // namespace
}  // namespace kaustik
