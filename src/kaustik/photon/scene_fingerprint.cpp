#include "kaustik/photon/scene_fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/sampler.h"

namespace kaustik {
namespace {

/// By how much numbers may differ. Most are about 1, floats are exact to 1e-7, and what follows
/// from them is so to some times that.
constexpr double tolerance = 2e-6;
/// For directions and logarithms that there are none of …
const Vec3f nowhere(3, 3, 3);
constexpr double zero = -1e3;
/// … and the largest number.
constexpr double most = 1e6;

class Summation {
 public:
  explicit Summation(SceneFingerprint& result) : result_(result) {}

  void add(double value) {
    if (!(std::fabs(value) < most)) value = most;
    const uint64_t signs = hash_mix(0x6b61757374696bull, result_.numbers++);
    for (size_t i = 0; i < result_.sums.size(); ++i)
      result_.sums[i] += (signs >> i & 1) != 0 ? value : -value;
  }
  void add(const Vec3f& v, double unit = 1) {
    for (int axis = 0; axis < 3; ++axis) add(double(v[axis]) / unit);
  }
  void add_logarithm(double value) { add(value > 0 ? std::log(value) : zero); }

 private:
  SceneFingerprint& result_;
};

/// How a surface scatters: its albedo, and where it sends a few directions from either side.
void add_bsdf(const Bsdf& bsdf, Summation& sums) {
  BsdfContext context;
  context.move_to({.uv = {0.5f, 0.5f}}, {});
  for (const float side : {1.0f, -1.0f}) {
    const Vec3f wo = normalize(Vec3f(0.3f, 0.2f, side));
    const Spectrum albedo = bsdf.albedo(context, wo, Lobes::all);
    sums.add({albedo[0], albedo[1], albedo[2]});
    for (const float u : {0.02f, 0.98f}) {
      const BsdfSample sample = bsdf.sample(context, wo, u, {0.4f, 0.7f}, Lobes::all);
      // What is absorbed has no direction.
      sums.add(sample.weight.is_zero() ? nowhere : sample.wi);
    }
  }
}

/// What a light sends out: its power and a few of its rays.
void add_light(const Light& light, double size, Summation& sums) {
  sums.add_logarithm(double(light.traits().power.sum()));
  for (const float u : {0.2f, 0.7f}) {
    const EmissionSample ray = light.sample_emission({u, 0.4f}, {0.6f, u}, {});
    sums.add(ray.point.position, size);
    sums.add(ray.direction);
  }
}

}  // namespace

bool SceneFingerprint::matches(const SceneFingerprint& other) const {
  if (counts != other.counts || numbers != other.numbers) return false;
  // Rounding adds up as a random walk does.
  const double most_difference = tolerance * std::sqrt(double(numbers));
  return std::equal(sums.begin(), sums.end(), other.sums.begin(),
                    [&](double a, double b) { return std::fabs(a - b) <= most_difference; });
}

SceneFingerprint fingerprint_of(const Scene& scene) {
  SceneFingerprint result;
  Summation sums(result);
  const Bounds3f& all = scene.tracer().bounds();
  const double size = std::max(1e-30, double(length(all.max - all.min)));
  size_t triangles = 0;
  for (uint32_t i = 0; i < scene.surface_count(); ++i) {
    const Shape& shape = scene.tracer().shape(i);
    if (const TriangleMesh* mesh = shape.mesh()) triangles += mesh->triangles.size();
    sums.add(shape.bounds().min, size);
    sums.add(shape.bounds().max, size);
    add_bsdf(*scene.surface(i).bsdf, sums);
  }
  for (const Instance& instance : scene.tracer().geometry().instances)
    for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(0, 0, 1)})
      sums.add(instance.world_from_group.point(p), size);
  for (const auto& light : scene.lights()) add_light(*light, size, sums);
  sums.add_logarithm(size);
  // Maps for irradiance have photons on mirrors and glass too.
  result.counts =
      fmt::format("{} shapes, {} triangles, {} lights{}", scene.surface_count(), triangles,
                  scene.lights().size(),
                  scene.film().quantity == Quantity::irradiance ? ", for irradiance" : "");
  return result;
}

}  // namespace kaustik
