#include "kaustik/photon/photon_map.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "kaustik/base/statistics.h"
#include "tests/photon/counted_allocations.h"
#include "tests/photon/emission_scenes.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int seed_divisor = 10;
#else
constexpr int seed_divisor = 1;
#endif

const Vec3f z_axis(0, 0, 1);

Scratch estimate_lists;  // tests run one after another

Photon photon_of(float flux, const Vec3f& side = z_axis) {
  Photon photon;
  photon.flux = Spectrum(flux, 2 * flux, 3 * flux, 0);
  photon.distance = 1;
  photon.direction = PackedDirection(side);
  photon.side = CoarseNormal(side);
  return photon;
}

/// `count` photons of flux 1/count, uniform on the unit square: irradiance 1.
PhotonMap uniform_map(size_t count, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> number;
  std::vector<Vec3f> positions;
  for (size_t i = 0; i < count; ++i) {
    const float x = number(random);
    positions.push_back({x, number(random), 0});
  }
  std::vector<Photon> photons(count, photon_of(1.0f / float(count)));
  for (size_t i = 0; i < count; ++i) photons[i].path = uint32_t(i);
  return {std::move(positions), std::move(photons)};
}

/// Light paths that leave photons in clusters, as light does that is trapped under a skin of glass:
/// 2.5 each in the mean, geometrically distributed, apart by about `spread`. Irradiance 1 on the
/// unit square. Unless `told`, the map takes every photon for a path of its own.
PhotonMap clustered_map(uint32_t paths, float spread, bool told, uint64_t seed) {
  constexpr float mean_count = 2.5f, margin = 0.1f;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<float> place(-margin, 1 + margin);
  std::geometric_distribution<int> more(1 / mean_count);
  std::normal_distribution<float> offset(0, spread);
  const float flux = sqr(1 + 2 * margin) / (mean_count * float(paths));
  std::vector<Vec3f> positions;
  std::vector<Photon> photons;
  for (uint32_t path = 0; path < paths; ++path) {
    const float x = place(random), y = place(random);
    for (int left = 1 + more(random); left > 0; --left) {
      const float dx = offset(random);
      positions.push_back({x + dx, y + offset(random), 0});
      photons.push_back(photon_of(flux));
      photons.back().path = told ? path : uint32_t(photons.size());
    }
  }
  return {std::move(positions), std::move(photons)};
}

/// What the neighbours of a query are.
enum class Sets { complete, incomplete, mixed };

struct Case {
  Kernel kernel;
  float cone_constant;
  Sets sets;
};

std::string name_of(const Case& c) {
  const std::string kernel = c.kernel == Kernel::constant ? "constant"
                             : c.kernel == Kernel::cone   ? "cone"
                                                          : "epanechnikov";
  return kernel + " k=" + std::to_string(c.cone_constant) + " sets " + std::to_string(int(c.sets));
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const Sets sets : {Sets::complete, Sets::incomplete, Sets::mixed}) {
    cases.push_back({Kernel::constant, 1, sets});
    cases.push_back({Kernel::cone, 1, sets});
    cases.push_back({Kernel::cone, 1.5f, sets});
    cases.push_back({Kernel::epanechnikov, 1, sets});
  }
  return cases;
}

constexpr size_t photons_per_map = 40'000;
constexpr int neighbors = 30;

/// Photons expected within the maximum radius.
double expected_within(Sets sets) { return sets == Sets::incomplete ? 25 : neighbors; }

EstimateSettings settings_of(const Case& c) {
  EstimateSettings settings;
  settings.kernel = c.kernel;
  settings.cone_constant = c.cone_constant;
  settings.neighbors = c.sets == Sets::incomplete ? 200 : neighbors;
  if (c.sets != Sets::complete)
    settings.maximum_radius =
        float(std::sqrt(expected_within(c.sets) / (double(photons_per_map) * double(pi))));
  return settings;
}

/// Irradiances (truth: 1) at places that share no photons.
RunningStatistics estimates(const Case& c) {
  const EstimateSettings settings = settings_of(c);
  RunningStatistics statistics;
  const int maps = std::max(2, 40 / seed_divisor);
  constexpr float spacing = 0.045f;  // more than two radii of 30 photons, with room to spare
  for (int map_index = 0; map_index < maps; ++map_index) {
    const PhotonMap map = uniform_map(photons_per_map, uint64_t(map_index) + 1);
    for (float y = 0.05f; y < 0.95f; y += spacing)
      for (float x = 0.05f; x < 0.95f; x += spacing)
        statistics.add(
            double(map.irradiance({x, y, 0}, z_axis, settings, estimate_lists).value[0]));
  }
  return statistics;
}

/// E[w²]/E[w]² of a kernel over its disk.
double roughness(const Case& c) {
  const double k = c.cone_constant;
  switch (c.kernel) {
    case Kernel::constant:
      return 1;
    case Kernel::cone:
      return (1 - 4 / (3 * k) + 1 / (2 * k * k)) / std::pow(1 - 2 / (3 * k), 2);
    case Kernel::epanechnikov:
      return 4.0 / 3;
  }
  return 0;
}

double family_level() { return sidak_level(0.01, int(all_cases().size())); }

TEST(DensityEstimate, HasTheRightMean) {
  for (const Case& c : all_cases()) {
    const RunningStatistics found = estimates(c);
#ifndef KAUSTIK_SLOW_BUILD
    EXPECT_LT(found.standard_error(), 0.003) << name_of(c);
    // The classic mistake (García et al. 2012).
    EXPECT_LT(z_test_p_value(found, 1.0 * (neighbors - 1) / neighbors), family_level())
        << name_of(c);
#endif
    EXPECT_GT(z_test_p_value(found, 1.0), family_level()) << name_of(c) << ": " << found.mean();
  }
}

/// Whatever the clusters' size beside the disk's. Photons taken for independent would be too
/// bright.
TEST(DensityEstimate, HasTheRightMeanWherePathsLeaveClusters) {
  constexpr uint32_t paths = 20'000;
  const EstimateSettings ten{10};
  const float radius = std::sqrt(10 * 1.44f / (pi * 2.5f * float(paths)));
  const auto estimates = [&](float spread, bool told, float maximum_radius) {
    EstimateSettings settings = ten;
    settings.maximum_radius = maximum_radius;
    RunningStatistics statistics;
    for (uint64_t seed = 1; seed <= uint64_t(std::max(2, 30 / seed_divisor)); ++seed) {
      const PhotonMap map = clustered_map(paths, spread, told, seed);
      for (float y = 0.05f; y < 0.95f; y += 0.04f)
        for (float x = 0.05f; x < 0.95f; x += 0.04f)
          statistics.add(
              double(map.irradiance({x, y, 0}, z_axis, settings, estimate_lists).value[0]));
    }
    return statistics;
  };
  const double level = sidak_level(0.01, 4);
  const auto check = [&](float spread, float maximum_radius) {
    const RunningStatistics found = estimates(spread, true, maximum_radius);
    EXPECT_GT(z_test_p_value(found, 1.0), level) << spread / radius << ": " << found.mean();
#ifndef KAUSTIK_SLOW_BUILD
    EXPECT_LT(found.standard_error(), 0.006) << spread / radius;
#endif
  };
  check(0.01f * radius, infinity);
  check(0.5f * radius, infinity);
  check(2 * radius, infinity);
  check(0.5f * radius, 1.5f * radius);  // where some disks are as large as allowed
#ifndef KAUSTIK_SLOW_BUILD
  EXPECT_LT(z_test_p_value(estimates(0.5f * radius, false, infinity), 1.0), level);
#endif
}

/// The k-th of N uniform photons takes a Beta(k, N − k + 1) share of the area, so the constant
/// kernel over complete sets has relative variance 1/(k − 2); other kernels multiply it by their
/// roughness, as they do for the Poisson number m within a fixed radius: 1/m.
TEST(DensityEstimate, HasThePredictedVariance) {
  for (const Case& c : all_cases()) {
    if (c.sets == Sets::mixed) continue;
    const RunningStatistics found = estimates(c);
    const double expected =
        roughness(c) / (c.sets == Sets::complete ? neighbors - 2 : expected_within(c.sets));
    // Of a variance over n nearly normal values; the estimates' own kurtosis adds to it.
    const double error = expected * std::sqrt(2.0 / double(found.count())) * 1.3;
    EXPECT_GT(z_test_p_value(found.variance(), error, expected), family_level())
        << name_of(c) << ": " << found.variance() << " for " << expected;
#ifndef KAUSTIK_SLOW_BUILD
    EXPECT_LT(z_test_p_value(found.variance(), error, expected * 1.1), family_level());
#endif
  }
}

TEST(DensityEstimate, SaysWhatItIsMadeOf) {
  const PhotonMap map = uniform_map(1000, 5);
  EstimateSettings settings;
  settings.neighbors = 40;
  const DensityEstimate complete =
      map.irradiance({0.5f, 0.5f, 0}, z_axis, settings, estimate_lists);
  EXPECT_EQ(complete.found, 40);
  EXPECT_NEAR(complete.value[0], 39e-3f / (pi * sqr(complete.radius)), 1e-4f);
  EXPECT_NEAR(complete.value[2], 3 * complete.value[0], 1e-4f);

  settings.maximum_radius = complete.radius * 0.7f;
  const DensityEstimate incomplete =
      map.irradiance({0.5f, 0.5f, 0}, z_axis, settings, estimate_lists);
  EXPECT_LT(incomplete.found, 40);
  EXPECT_FLOAT_EQ(incomplete.radius, settings.maximum_radius);
  EXPECT_NEAR(incomplete.value[0], float(incomplete.found) * 1e-3f / (pi * sqr(incomplete.radius)),
              1e-4f);
}

TEST(DensityEstimate, NothingFromNothing) {
  EstimateSettings settings;
  EXPECT_TRUE(PhotonMap().irradiance({0, 0, 0}, z_axis, settings, estimate_lists).value.is_zero());
  EXPECT_TRUE(PhotonMap().empty());
  EXPECT_EQ(PhotonMap().mean_flux(), 0.0f);
  const PhotonMap map = uniform_map(100, 1);
  EXPECT_FLOAT_EQ(map.mean_flux(), 0.03f);  // of the largest lane
  settings.neighbors = 0;
  EXPECT_TRUE(map.irradiance({0.5f, 0.5f, 0}, z_axis, settings, estimate_lists).value.is_zero());
  // More neighbours than there are photons and no bound on the radius: no density is known.
  settings.neighbors = 101;
  EXPECT_TRUE(map.irradiance({0.5f, 0.5f, 0}, z_axis, settings, estimate_lists).value.is_zero());
  // One neighbour sets the radius of an empty disk.
  settings.neighbors = 1;
  EXPECT_TRUE(map.irradiance({0.5f, 0.5f, 0}, z_axis, settings, estimate_lists).value.is_zero());
  // All in one place: no radius.
  const PhotonMap point(std::vector<Vec3f>(50, Vec3f(0, 0, 0)), std::vector<Photon>(50));
  settings.neighbors = 10;
  EXPECT_TRUE(point.irradiance({0, 0, 0}, z_axis, settings, estimate_lists).value.is_zero());
}

// ---------------------------------------------------------------- sides

/// On a thin wall the photons of the far side neither count nor use up neighbours.
TEST(PhotonSides, ThinWall) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> number;
  std::vector<Vec3f> near, both;
  std::vector<Photon> near_photons, both_photons;
  for (int i = 0; i < 20'000; ++i) {
    const float x = number(random), y = number(random);
    const bool front = i % 4 == 0;
    Photon photon = photon_of(front ? 1.0f : 1000.0f, front ? z_axis : -z_axis);
    photon.path = uint32_t(i);
    both.push_back({x, y, front ? 1e-4f : -1e-4f});
    both_photons.push_back(photon);
    if (!front) continue;
    near.push_back(both.back());
    near_photons.push_back(photon);
  }
  const PhotonMap wall(both, both_photons), front(near, near_photons);
  EstimateSettings settings;
  for (const float radius : {infinity, 0.02f})
    for (int i = 0; i < 50; ++i) {
      settings.maximum_radius = radius;
      const float x = number(random);
      const Vec3f at(x, number(random), 1e-4f);
      const DensityEstimate with = wall.irradiance(at, z_axis, settings, estimate_lists);
      const DensityEstimate without = front.irradiance(at, z_axis, settings, estimate_lists);
      EXPECT_EQ(with.found, without.found);
      EXPECT_EQ(with.radius, without.radius);
      EXPECT_NEAR(with.value[0], without.value[0], 1e-4f * without.value[0]);
      EXPECT_GT(without.value[0], 0);
      // Seen from behind, only those of the far side.
      EXPECT_GT(wall.irradiance(at, -z_axis, settings, estimate_lists).value[0],
                100 * with.value[0]);
    }
}

TEST(PhotonSides, VisitNearestRejectsThemToo) {
  std::vector<Vec3f> positions;
  std::vector<Photon> photons;
  for (int i = 0; i < 100; ++i) {
    positions.push_back({0.01f * float(i), 0, 0});
    photons.push_back(photon_of(1, i % 2 == 0 ? z_axis : -z_axis));
  }
  const PhotonMap map(positions, photons);
  int visited = 0;
  map.visit_nearest({0, 0, 0}, z_axis, 10, infinity, estimate_lists,
                    [&](const Photon& photon, const Vec3f& position) {
                      ++visited;
                      EXPECT_GT(photon.side.dot(z_axis), 0);
                      EXPECT_LT(position.x, 0.195f);
                    });
  EXPECT_EQ(visited, 10);
}

/// All within a radius are those that the search for the nearest finds there.
TEST(PhotonSides, WithinFindsWhatNearestFinds) {
  std::mt19937_64 random(5);
  std::normal_distribution<float> number;
  std::vector<Vec3f> positions;
  std::vector<Photon> photons;
  const auto direction = [&] {
    return normalize(Vec3f(number(random), number(random), number(random)));
  };
  for (int i = 0; i < 3000; ++i) {
    positions.push_back({number(random), number(random), number(random)});
    photons.push_back(photon_of(1, direction()));
    photons.back().on_front = i % 3 == 0;
  }
  const SidedTree<Photon> tree(positions, photons);
  for (int i = 0; i < 200; ++i) {
    const Vec3f at(number(random), number(random), number(random)), normal = direction();
    const bool both_sides = i % 2 == 0;
    SidedTree<Photon>::Neighbors nearest;
    tree.nearest(at, normal, both_sides, 3000, 0.8f, nearest);
    std::vector<uint32_t> expected, found;
    for (size_t k = 0; k < nearest.size(); ++k) expected.push_back(nearest.index(k));
    tree.within(at, normal, both_sides, 0.8f * 0.8f,
                [&](uint32_t index, float) { found.push_back(index); });
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
  }
}

// ---------------------------------------------------------------- radiance

/// The point on a floor of the given material, seen obliquely.
SurfaceVertex floor_vertex(const Scene& scene, const Vec3f& at) {
  const Vec3f from = at + Vec3f(0.6f, 0, 0.8f);
  const Ray ray{from, normalize(at - from)};
  Hit hit;
  EXPECT_TRUE(scene.intersect(ray, hit));
  return {scene, ray, hit, TransportMode::radiance};
}

std::shared_ptr<const Scene> floor_scene(const test::ObjectPointer& bsdf) {
  return test::make_scene({test::placed("rectangle", Transform(), bsdf), test::light("point")});
}

TEST(PhotonRadiance, DiffuseIsReflectedIrradiance) {
  const auto scene =
      floor_scene(test::object("bsdf", "diffuse", {{"reflectance", Rgb{0.6, 0.3, 0.1}}}));
  const PhotonMap map = uniform_map(5000, 8);
  const SurfaceVertex vertex = floor_vertex(*scene, {0.5f, 0.5f, 0});
  const EstimateSettings settings;
  const Spectrum irradiance = map.irradiance(vertex, settings, estimate_lists).value;
  const Spectrum radiance = map.radiance(vertex, Lobes::all, settings, estimate_lists).value;
  const float reflectance[] = {0.6f, 0.3f, 0.1f};
  for (int lane = 0; lane < 3; ++lane)
    EXPECT_NEAR(radiance[lane], reflectance[lane] / pi * irradiance[lane], 1e-6f);
  EXPECT_TRUE(map.radiance(vertex, Lobes::glossy, settings, estimate_lists).value.is_zero());
}

/// Every photon by the direction from the query to where it came from, not as it was stored.
TEST(PhotonRadiance, GlossyByIncidentDirections) {
  const auto scene = floor_scene(test::object("bsdf", "phong",
                                              {{"diffuse_reflectance", Rgb{0.3, 0.3, 0.3}},
                                               {"specular_reflectance", Rgb{0.5, 0.5, 0.5}},
                                               {"exponent", 40.0}}));
  const Vec3f lamp(-0.2f, 0.5f, 0.9f), at(0.5f, 0.5f, 0);
  PhotonMap map = uniform_map(5000, 8);
  std::vector<Vec3f> positions;
  std::vector<Photon> photons;
  for (uint32_t i = 0; i < map.size(); ++i) {
    positions.push_back(map.tree().key(i));
    Photon photon = map.tree().data(i);
    photon.distance = length(lamp - positions.back());
    photon.direction = PackedDirection(normalize(lamp - positions.back()));
    photons.push_back(photon);
  }
  const PhotonMap lit(positions, photons);
  const SurfaceVertex vertex = floor_vertex(*scene, at);
  EstimateSettings settings;
  settings.maximum_radius = 0.1f;
  settings.neighbors = 5000;
  const Spectrum irradiance = lit.irradiance(vertex, settings, estimate_lists).value;
  for (const Lobes lobes : {Lobes::all, Lobes::glossy}) {
    const Spectrum expected = vertex.eval(normalize(lamp - at), lobes) * irradiance;
    const Spectrum found = lit.radiance(vertex, lobes, settings, estimate_lists).value;
    EXPECT_NEAR(found[0], expected[0], 2e-3f * expected[0]);
    EXPECT_GT(found[0], 0);
  }
}

/// The first estimate makes the lists, which serve for all that follow.
TEST(PhotonRadiance, EstimatesDoNotAllocate) {
  const auto scene = floor_scene(test::object(
      "bsdf", "phong",
      {{"diffuse_reflectance", Rgb{0.3, 0.3, 0.3}}, {"specular_reflectance", Rgb{0.5, 0.5, 0.5}}}));
  const PhotonMap map = uniform_map(5000, 8);
  const SurfaceVertex vertex = floor_vertex(*scene, {0.5f, 0.5f, 0});
  Scratch scratch;
  const auto estimate = [&] {
    map.irradiance(vertex, {}, scratch);
    return map.radiance(vertex, Lobes::all, {}, scratch).value;
  };
  EXPECT_FALSE(estimate().is_zero());
  const int64_t before = test::allocation_count();
  for (int i = 0; i < 10; ++i) estimate();
  EXPECT_EQ(test::allocation_count() - before, 0);
}

// ---------------------------------------------------------------- radii

/// Moments of the distances against those of the kernel, sums over rings of the disk.
TEST(KernelDistance, IsDistributedAsTheKernelsWeight) {
  for (const Kernel kernel : {Kernel::constant, Kernel::cone, Kernel::epanechnikov})
    for (const float k : {1.0f, 1.5f, 4.0f}) {
      EstimateSettings settings;
      settings.kernel = kernel;
      settings.cone_constant = k;
      const auto density = [&](double d) {
        return kernel == Kernel::constant ? 2 * d
               : kernel == Kernel::cone   ? 2 * d * (1 - d / double(k)) / (1 - 2 / (3 * double(k)))
                                          : 4 * d * (1 - d * d);
      };
      constexpr int n = 10'000;
      for (const int power : {1, 2, 6}) {
        double expected = 0, found = 0;
        for (int i = 0; i < n; ++i) {
          const double x = (i + 0.5) / n;
          expected += density(x) * std::pow(x, power) / n;
          found += std::pow(double(kernel_distance(settings, float(x))), power) / n;
        }
        EXPECT_NEAR(found, expected, 1e-4);
      }
    }
}

TEST(PassRadius, FollowsTheRecurrence) {
  constexpr double alpha = 2.0 / 3.0;
  double radius_sq = 0.25;  // pass 0, which Knaus and Zwicker call 1
  for (uint32_t index = 0; index < 2000; ++index) {
    EXPECT_NEAR(pass_radius(0.5f, index), std::sqrt(radius_sq), 1e-5 * std::sqrt(radius_sq));
    const double i = index + 1;
    radius_sq *= (i + alpha) / (i + 1);
  }
  // r² falls like i^(α − 1).
  EXPECT_NEAR(pass_radius(1, 8'000'000) / pass_radius(1, 1'000'000), std::pow(8.0, -1.0 / 6), 1e-4);
  EXPECT_EQ(pass_radius(infinity, 3), infinity);
}

/// Where that many photons of mean flux lie within the radius, they make just the least radiance
/// as a sum over the disk.
TEST(RadiusOfLeastRadiance, IsTheThesisFormula) {
  EXPECT_EQ(radius_of_least_radiance(50, 1, 0), infinity);
  const float radius = radius_of_least_radiance(50, 1e-3f, 0.004f);
  EXPECT_NEAR(radius, 1.9947f, 1e-3f);
  EXPECT_NEAR(50 * 1e-3f / (pi * sqr(radius)), 0.004f, 1e-6f);
}

}  // namespace
}  // namespace kaustik
