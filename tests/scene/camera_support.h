#pragma once
// Cameras made without a scene, and whether how they see points agrees with where their rays go.

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "kaustik/geometry/shape.h"
#include "kaustik/scene/camera.h"

namespace kaustik::test {

inline FilmSettings film_of(int width, int height) {
  FilmSettings film;
  film.size = film.crop_size = {width, height};
  return film;
}

/// Of that type, with the arguments given.
template <typename Row, typename Create>
auto made_of(const std::vector<Row>& rows, const std::string& name,
             const std::vector<Property>& properties, const Create& create) {
  for (const Row& row : rows) {
    if (row.info.name != name) continue;
    Problems problems;
    const Arguments arguments(row.info, properties, {}, problems);
    problems.throw_if_any();
    return create(row, arguments);
  }
  throw std::runtime_error("no type " + name);
}

inline std::shared_ptr<const Shape> shape_of(const std::string& name,
                                             const std::vector<Property>& properties = {}) {
  return made_of(shape_types(), name, properties,
                 [](const ShapeType& type, const Arguments& arguments) {
                   return std::shared_ptr<const Shape>(type.create(arguments));
                 });
}

/// `shape`: that it belongs to or looks at.
inline std::unique_ptr<Camera> camera_of(const std::string& name,
                                         const std::vector<Property>& properties,
                                         const FilmSettings& film = film_of(32, 24),
                                         const std::shared_ptr<const Shape>& shape = nullptr,
                                         bool is_passed = false) {
  return made_of(
      camera_types(), name, properties, [&](const CameraType& type, const Arguments& arguments) {
        return type.create({arguments, film, shape, is_passed, {{-1, -1, -1}, {1, 1, 1}}});
      });
}

/// How far the importance is from raster area per solid angle as rays beside tell it, relatively.
/// Three metres away, around a raster that has rays on all sides.
inline double importance_error(const Camera& camera, const Vec2f& raster, const LensNumbers& lens) {
  constexpr float distance = 3, step = 0.25f;  // m, pixels
  const auto at = [&](float dx, float dy) {
    const CameraRay ray = camera.sample_ray(raster + Vec2f(dx, dy), lens);
    EXPECT_FALSE(ray.is_none());
    return Vec3d(ray.origin) + Vec3d(ray.direction) * double(distance);
  };
  const Vec3d x = (at(step, 0) - at(-step, 0)) / (2 * step);
  const Vec3d y = (at(0, step) - at(0, -step)) / (2 * step);
  const CameraConnection seen = camera.connect(Vec3f(at(0, 0)), lens);
  const double area_of_pixel = std::fabs(x.cross(y).dot(Vec3d(seen.direction)));
  return double(seen.importance) * area_of_pixel / double(distance * distance) - 1;
}

}  // namespace kaustik::test
