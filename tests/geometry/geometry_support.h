#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <random>

#include "kaustik/base/warp.h"
#include "kaustik/geometry/mesh_shape.h"
#include "kaustik/geometry/ray_tracer.h"

namespace kaustik::test {

#ifdef KAUSTIK_SLOW_BUILD
inline constexpr int samples_divisor = 10;
#else
inline constexpr int samples_divisor = 1;
#endif

/// Uniform numbers with a fixed seed, the same on every platform.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  float uniform() { return float(engine_() >> 40) * 0x1p-24f; }
  float uniform(float low, float high) { return low + (high - low) * uniform(); }
  Vec2f square() {
    const float x = uniform();
    return {x, uniform()};
  }
  Vec3f direction() { return square_to_sphere(square()); }
  Vec3f in_box(float half) {
    const float x = uniform(-half, half), y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
  /// 10^x with x uniform.
  float magnitude(float low_exponent, float high_exponent) {
    return std::pow(10.0f, uniform(low_exponent, high_exponent));
  }

 private:
  std::mt19937_64 engine_;
};

/// A file that lives as long as this.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& bytes) : TemporaryFile(bytes, "mesh") {}
  TemporaryFile(const std::string& bytes, const std::string& name)
      : path_(testing::TempDir() + "kaustik_" + std::to_string(::getpid()) + "_" + name) {
    std::ofstream(path_, std::ios::binary) << bytes;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline std::shared_ptr<const Shape> make_shape(const std::string& type,
                                               std::vector<Property> properties = {}) {
  for (const ShapeType& shape_type : shape_types()) {
    if (shape_type.info.name != type) continue;
    Problems problems;
    const Arguments arguments(shape_type.info, properties, place_in("test.xml", 1, 1), problems);
    problems.throw_if_any();
    return shape_type.create(arguments);
  }
  throw std::logic_error("no such shape: " + type);
}

inline std::shared_ptr<const Shape> triangle_shape(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  TriangleMesh mesh;
  mesh.positions = {a, b, c};
  mesh.triangles = {{0, 1, 2}};
  return std::make_shared<MeshShape>(std::move(mesh));
}

inline std::unique_ptr<RayTracer> tracer_of(std::vector<std::shared_ptr<const Shape>> shapes) {
  return std::make_unique<RayTracer>(Geometry{std::move(shapes), {}, {}});
}

/// A rotation and a shift, no two coordinates alike.
inline Transform placement(double scale = 1) {
  return Transform::translate({3.0, -2.0, 1.5}) * Transform::rotate({1.0, 2.0, -0.5}, 37.0) *
         Transform::scale({scale, scale, scale});
}

}  // namespace kaustik::test
