// The same seed makes the same bits, whatever the number of threads; other seeds and other
// replicates are independent of it.

#include <array>

#include "tests/support/forgetful.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// Something of everything: area lamp, delta, glossy and diffuse surfaces. `of_wall` stands inside
/// the shape of the wall.
TestScene small_scene(int size = 40, const std::string& of_wall = "") {
  return TestScene(
      camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, size) +
      flat("rectangle", "", phong(0.4, 0.3, 20)) +
      flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1, 1"),
           diffuse("0.5, 0.3, 0.2") + of_wall) +
      flat("rectangle", scale("0.2, 0.2, 1") + rotate("1, 0, 0", 180) + translate("0, 0.1, 1.4"),
           diffuse("0, 0, 0") + area_light("10, 9, 8")) +
      sphere("-0.45, 0.3, 0.401", 0.4, mirror()) + sphere("0.45, -0.05, 0.401", 0.4, glass()));
}

struct Method {
  std::string type, parameters;
};
std::vector<Method> methods(int photons = 5000) {
  const std::string counts =
      set("global_photons", photons) + set("caustic_photons", photons) + set("cache_samples", 32);
  return {{"path", ""},
          {"lighttracer", ""},
          {"vcm", ""},
          {"bdpt", ""},
          {"auto", ""},
          {"ppm", ""},
          {"ppm", set("indirect_cache", "always")},
          {"photonmap", counts},
          {"photonmap", counts + set("irradiance_cache", false) + set("reradiate", true)}};
}

TEST(Determinism, AnyNumberOfThreads) {
  const TestScene scene = small_scene();
  for (const Method& m : methods()) {
    const Passes one = render(scene, m.type, m.parameters, {4, 1, 2, 1});
    const Passes two = render(scene, m.type, m.parameters, {4, 1, 2, 2});
    EXPECT_TRUE(same_bits(one, two)) << m.type;
    EXPECT_GT(one.mean({""}).mean(), 0) << m.type;
  }
}

/// What the other tests leave out, small.
TEST(Determinism, AnyNumberOfThreadsOfOtherMethods) {
  const TestScene plain = small_scene(16);
  const TestScene mixed = small_scene(
      16, "<integrator type=\"localphong\"><float name=\"ambient\" value=\"0.5\"/></integrator>");
  const std::string counts =
      set("global_photons", 2000) + set("caustic_photons", 2000) + set("cache_samples", 16);
  const std::string no_cache = counts + set("irradiance_cache", false);
  const struct {
    const char* name;
    const TestScene& scene;
    Method method;
  } rows[] = {
      {"ray tracing", plain, {"raytracing", ""}},
      {"a surface's own model", mixed, {"photonmap", counts}},
      {"shadow photons", plain, {"photonmap", no_cache + set("shadow_photons", 5000)}},
      {"all lights", plain, {"photonmap", no_cache + set("light_sampling", "all")}},
      {"levels", plain, {"photonmap", no_cache + set("max_eye_level", 2)}},
      {"split sphere", plain, {"photonmap", counts + set("cache_metric", "split_sphere")}},
  };
  for (const auto& row : rows) {
    const auto& [type, parameters] = row.method;
    const Passes one = render(row.scene, type, parameters, {2, 1, 2, 1});
    EXPECT_TRUE(same_bits(one, render(row.scene, type, parameters, {2, 1, 2, 2}))) << row.name;
    EXPECT_FALSE(same_bits(one, render(plain, "photonmap", counts, {2, 1, 2, 2}))) << row.name;
  }
}

TEST(Determinism, OneIntegratorRendersAgainAndOtherPassesBefore) {
  const TestScene scene = small_scene();
  for (const Method& m : methods()) {
    const auto integrator = scene.integrator(m.type, m.parameters);
    const Passes first = render(scene, *integrator, {4, 1, 2});
    render(scene, *integrator, {4, 9, 1});
    EXPECT_TRUE(same_bits(first, render(scene, *integrator, {4, 1, 2}))) << m.type;
  }
}

TEST(Determinism, OtherSeedsDiffer) {
  const TestScene scene = small_scene();
  for (const Method& m : methods())
    EXPECT_FALSE(same_bits(render(scene, m.type, m.parameters, {4, 1, 1}),
                           render(scene, m.type, m.parameters, {4, 2, 1})))
        << m.type;
}

/// Pictures of several seeds and passes, as radiance of blocks of pixels: neighbours share photons.
class SeedsAndPasses {
 public:
  static constexpr size_t seeds = 8, passes = 8, side = 5, blocks = side * side;

  SeedsAndPasses(const TestScene& scene, const Integrator& integrator, double samples) {
    for (size_t seed = 0; seed < seeds; ++seed) {
      const Passes rendered = render(scene, integrator, {samples, seed + 1, uint32_t(passes)});
      for (size_t pass = 0; pass < passes; ++pass)
        for (size_t block = 0; block < blocks; ++block)
          at(seed, pass, block) = Passes::mean_of(rendered.images()[pass], {""}, [&](int x, int y) {
            const int width = rendered.images()[pass].width() / int(side);
            return size_t(y / width) * side + size_t(x / width) == block ? 1.0 : 0.0;
          });
    }
  }
  double& at(size_t seed, size_t pass, size_t block) {
    return values_[(seed * passes + pass) * blocks + block];
  }
  double at(size_t seed, size_t pass, size_t block) const {
    return values_[(seed * passes + pass) * blocks + block];
  }

 private:
  std::array<double, seeds * passes * blocks> values_{};
};

/// A relation of two pictures: what is added to the first one's seed and pass.
struct Relation {
  const char* name;
  size_t seed, pass;
};
constexpr Relation relations[] = {{"passes of a seed", 0, 1},
                                  {"passes of a seed, farther apart", 0, 3},
                                  {"seeds", 1, 0},
                                  {"the next seed's pass before", 1, SeedsAndPasses::passes - 1}};

/// Correlation of each picture with the one that stands in the given relation to it, in the mean
/// over blocks. Each block's own mean over all pictures is taken off, which leaves −1/(n − 1) of n
/// pictures that are independent. Blocks of one picture share photons, so it makes one value.
RunningStatistics correlation(const SeedsAndPasses& pictures, const Relation& relation) {
  constexpr size_t seeds = SeedsAndPasses::seeds, passes = SeedsAndPasses::passes;
  std::array<RunningStatistics, SeedsAndPasses::blocks> of_block;
  for (size_t block = 0; block < SeedsAndPasses::blocks; ++block)
    for (size_t seed = 0; seed < seeds; ++seed)
      for (size_t pass = 0; pass < passes; ++pass)
        of_block[block].add(pictures.at(seed, pass, block));
  constexpr double count = seeds * passes;
  RunningStatistics result;
  for (size_t seed = 0; seed < seeds; ++seed)
    for (size_t pass = 0; pass < passes; ++pass) {
      const size_t other_seed = (seed + relation.seed) % seeds,
                   other_pass = (pass + relation.pass) % passes;
      RunningStatistics over_blocks;
      for (size_t block = 0; block < SeedsAndPasses::blocks; ++block) {
        const double mean = of_block[block].mean(), variance = of_block[block].variance();
        if (!(variance > 0)) continue;  // nothing is seen there
        over_blocks.add((pictures.at(seed, pass, block) - mean) *
                        (pictures.at(other_seed, other_pass, block) - mean) /
                        (variance * (count - 1) / count));
      }
      EXPECT_GE(over_blocks.count(), 15);
      result.add(over_blocks.mean());
    }
  return result;
}
double p_value_of_independence(const SeedsAndPasses& pictures, const Relation& relation) {
  return t_test_p_value(correlation(pictures, relation),
                        -1.0 / (SeedsAndPasses::seeds * SeedsAndPasses::passes - 1));
}

/// The picture that `share` of every other one's deviations is taken from.
struct Planted {
  size_t seed_stride, pass_stride;  ///< 0: the same for all seeds or all passes
};
SeedsAndPasses planted(const SeedsAndPasses& pictures, double share, const Planted& source) {
  SeedsAndPasses result = pictures;
  for (size_t seed = 0; seed < SeedsAndPasses::seeds; ++seed)
    for (size_t pass = 0; pass < SeedsAndPasses::passes; ++pass)
      for (size_t block = 0; block < SeedsAndPasses::blocks; ++block)
        result.at(seed, pass, block) =
            (1 - share) * pictures.at(seed, pass, block) +
            share * pictures.at(seed * source.seed_stride, pass * source.pass_stride, block);
  return result;
}

/// Pictures of different seeds and passes have nothing in common. The twins have: the same picture
/// for all passes of a seed or for all seeds, and one of which half is the same.
void expect_independence(const std::string& what, const SeedsAndPasses& pictures) {
  for (const Relation& relation : relations) {
    const RunningStatistics found = correlation(pictures, relation);
    std::printf("  %s: correlation of %s %.3f ± %.3f\n", what.c_str(), relation.name, found.mean(),
                found.standard_error());
    EXPECT_GT(p_value_of_independence(pictures, relation), check_level())
        << what << ": " << relation.name;
  }
  for (const double share : {1.0, 0.5}) {
    const SeedsAndPasses same_passes = planted(pictures, share, {1, 0}),
                         same_seeds = planted(pictures, share, {0, 1});
    EXPECT_LT(p_value_of_independence(same_passes, relations[0]), check_level()) << what;
    EXPECT_LT(p_value_of_independence(same_passes, relations[1]), check_level()) << what;
    EXPECT_LT(p_value_of_independence(same_seeds, relations[2]), check_level()) << what;
  }
}

/// Small pixels: with wide disks the bias of merging, which depends on the pass, would be something
/// that seeds have in common.
TEST(Determinism, ReplicatesAreIndependentLong) {
  const TestScene scene = small_scene(40);
  for (const Method& m : methods(1000))
    expect_independence(m.type, SeedsAndPasses(scene, *scene.integrator(m.type, m.parameters), 1));
}

/// The same of so few photons that most of the noise is theirs.
TEST(Determinism, PhotonsOfReplicatesAreIndependentLong) {
  const TestScene scene = small_scene(10);
  const auto right = scene.integrator(
      "photonmap", set("components", "caustic,indirect") + set("global_photons", 300) +
                       set("caustic_photons", 300) + set("irradiance_cache", false));
  constexpr double samples = 32;
  expect_independence("photons", SeedsAndPasses(scene, *right, samples));
  const SeedsAndPasses same_passes(
      scene, ForgetfulIntegrator(*right, ForgetfulIntegrator::Forgets::index), samples),
      same_seeds(scene, ForgetfulIntegrator(*right, ForgetfulIntegrator::Forgets::seed), samples);
  EXPECT_LT(p_value_of_independence(same_passes, relations[0]), check_level());
  EXPECT_LT(p_value_of_independence(same_passes, relations[1]), check_level());
  EXPECT_LT(p_value_of_independence(same_seeds, relations[2]), check_level());
}

}  // namespace
}  // namespace kaustik
