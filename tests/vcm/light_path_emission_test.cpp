// Light paths begin with the density that is told of them, and with the light's flux.

#include "kaustik/vcm/lessons/light_path_emission.h"

#include <gtest/gtest.h>

#include "kaustik/base/statistics.h"
#include "tests/photon/emission_scenes.h"

namespace kaustik::test {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int sample_count = 100'000;
#else
constexpr int sample_count = 200'000;
#endif

constexpr int rows = 8, columns = 16, lights = 2;
constexpr double lamp_area = 4 * 0.4 * 0.3;

/// A point light, and a lamp of another power.
std::shared_ptr<const Scene> two_lights(const std::vector<ObjectPointer>& targets) {
  std::vector<ObjectPointer> objects = {light("point"), light("rectangle")};
  objects.insert(objects.end(), targets.begin(), targets.end());
  return make_scene(objects);
}

Sampler independent(int i) { return {uint64_t(i) * 0x9e3779b97f4a7c15ull, 0}; }

/// A cell of a ray, and what its sum of 1/density makes of the cell: where rays have a density the
/// sum of cos/density over samples has the mean of the cell's measure ∫ cos dω dA, whatever the
/// density is (without the cosine and the area for the point light).
struct Place {
  size_t cell;
  double factor, measure;
};
Place place_of(int of_light, const EmittedRay& ray) {
  const Vec3f local =
      of_light == 0 ? ray.ray.direction : Frame(ray.origin.ng).to_local(ray.ray.direction);
  const double z = double(local.z);
  const double height = of_light == 0 ? (z + 1) / 2 : z * z;
  const double turn = std::atan2(double(local.y), double(local.x)) / (2 * std::numbers::pi) + 0.5;
  const auto index = [](double x, int count) { return std::clamp(int(x * count), 0, count - 1); };
  const int cell = (of_light * rows + index(height, rows)) * columns + index(turn, columns);
  const double cells = rows * columns;
  return of_light == 0 ? Place{size_t(cell), 1, 4 * std::numbers::pi / cells}
                       : Place{size_t(cell), z, std::numbers::pi * lamp_area / cells};
}

/// Of all cells, and of the total; the smaller, for two tests.
double p_value(const LightPathEmission& emission, double planted) {
  constexpr size_t cell_count = size_t(lights) * rows * columns;
  std::vector<double> sums(cell_count), squares(cell_count), measures(cell_count);
  RunningStatistics total;
  for (int i = 0; i < sample_count; ++i) {
    Sampler sampler = independent(i);
    const LightPathStart start = emission.sample(sampler, {});
    if (start.light < 0) {
      total.add(0);
      continue;
    }
    const EmissionDensity density =
        emission.pdf(start.light, start.emitted.origin, start.emitted.ray.direction);
    EXPECT_EQ(density.endpoint, start.density.endpoint);
    EXPECT_EQ(density.rest, start.density.rest);
    const Place place = place_of(start.light, start.emitted);
    const double value = place.factor / (planted * double(density.endpoint) * double(density.rest));
    sums[place.cell] += value;
    squares[place.cell] += value * value;
    measures[place.cell] = place.measure;
    total.add(value / place.measure);
  }
  double chi_square = 0;
  for (size_t i = 0; i < cell_count; ++i) {
    const double mean = sums[i] / sample_count;
    const double variance = (squares[i] / sample_count - mean * mean) / sample_count;
    chi_square += variance > 0 ? std::pow(mean - measures[i], 2) / variance : 1e6;
  }
  return 2 * std::min(chi_square_p_value(chi_square, int(cell_count)),
                      z_test_p_value(total, double(cell_count)));
}

TEST(LightPathEmission, SamplesFollowTheDensity) {
  std::vector<Targets> sets = target_sets();
  sets.push_back({"nothing", {}});
  const double level = sidak_level(0.01, int(sets.size()));
  for (const Targets& targets : sets) {
    const auto scene = two_lights(targets.objects);
    const LightPathEmission emission(*scene);
    EXPECT_GT(p_value(emission, 1), level) << targets.name;
#ifndef KAUSTIK_SLOW_BUILD
    EXPECT_LT(p_value(emission, 1.02), level) << targets.name << ": an error of 2 % goes unseen";
#endif
  }
}

/// Whatever is aimed at, light paths carry what the lights emit.
TEST(LightPathEmission, FluxIsThePowerOfTheLights) {
  for (const Targets& targets : target_sets()) {
    const auto scene = two_lights(targets.objects);
    const LightPathEmission emission(*scene);
    RunningStatistics flux;
    for (int i = 0; i < sample_count; ++i) {
      Sampler sampler = independent(i);
      const LightPathStart start = emission.sample(sampler, {});
      flux.add(start.light < 0 ? 0.0 : double(start.emitted.flux[1]));
    }
    const double power = double(scene->lights()[0]->traits().power[1]) +
                         double(scene->lights()[1]->traits().power[1]);
    EXPECT_GT(z_test_p_value(flux, power), sidak_level(0.01, 5)) << targets.name;
#ifndef KAUSTIK_SLOW_BUILD
    EXPECT_LT(z_test_p_value(flux, power * 1.02), 0.01) << targets.name;
#endif
  }
}

/// Nothing is aimed at what a lamp can't shine at: such rays would carry nothing.
TEST(LightPathEmission, NoRaysForWhatIsBehindTheLamp) {
  const auto share_with_flux = [](const Vec3d& ball) {
    const auto scene = make_scene({light("rectangle"), sphere(ball, 0.4, mirror_bsdf())});
    const LightPathEmission emission(*scene);
    int count = 0;
    for (int i = 0; i < 1000; ++i) {
      Sampler sampler = independent(i);
      count += emission.sample(sampler, {}).light >= 0 ? 1 : 0;
    }
    return count / 1000.0;
  };
  EXPECT_EQ(share_with_flux(Vec3d(0, 0, 3)), 1);
  EXPECT_GT(share_with_flux(Vec3d(0, 0, 0)), 0.95);
}

}  // namespace
}  // namespace kaustik::test
