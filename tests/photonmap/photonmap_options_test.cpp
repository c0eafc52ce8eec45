// What the photon map integrator's parameters change, and what they must not.

#include <cstdio>

#include "kaustik/photon/photon_file.h"
#include "kaustik/render/photon_tracing.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A round room (no edges, so that photons have no borders to be missed at) with a lamp in it and,
/// if asked for, two balls.
std::string round_room(const std::string& wall, const std::string& objects = "") {
  return camera("0, -0.8, 0", "0, 1, -0.2", 75, 16) + sphere("0, 0, 0", 1, wall, true) +
         sphere("0.1, 0.1, 0.6", 0.2, diffuse("0, 0, 0") + area_light("10, 10, 10")) + objects;
}
const std::string balls =
    sphere("-0.3, 0.2, -0.3", 0.25, mirror()) + sphere("0.35, 0.1, -0.3", 0.25, glass());

std::string photons() {
  return set("global_photons", 20'000) + set("caustic_photons", 20'000) +
         set("global_neighbors", 12) + set("caustic_neighbors", 12) +
         set("cache_minimum_spacing", 0.2) + set("cache_maximum_spacing", 4.0);
}

class Options : public testing::Test {
 protected:
  Options() : room_(round_room(diffuse("0.5, 0.5, 0.5"))) {}

  RunningStatistics indirect(const std::string& parameters, double samples = 12) const {
    return render(room_, "photonmap", set("components", "indirect") + photons() + parameters,
                  {samples, 1})
        .mean({"indirect"});
  }
  const RunningStatistics& by_path() const {
    static const RunningStatistics reference =
        render(room_, "path", set("components", "indirect"), {64, 2}).mean({"indirect"});
    return reference;
  }
  TestScene room_;
};

/// A grid that directs gather rays changes only the noise, as long as it has a floor.
TEST_F(Options, ImportanceOfCells) {
  const auto check = [&](const char* weight, double floor, double samples) {
    expect_near_means(fmt::format("gather by {}, floor {}", weight, floor),
                      indirect(set("irradiance_cache", false) + set("importance_weight", weight) +
                                   set("importance_floor", floor),
                               samples),
                      by_path(), 0.005);
  };
  check("sum", 0.1, 22);
  check("average", 0.1, 14);
  check("sum", 0.5, 6);
  check("average", 0.5, 6);
  check("sum", 1, 4);  // and all weights are alike
}
TEST_F(Options, IrradianceLookedUpOrEstimated) {
  for (const int stride : {0, 1, 8})
    expect_near_means(fmt::format("precompute stride {}", stride),
                      indirect(set("irradiance_cache", false) + set("precompute_stride", stride)),
                      by_path(), 0.005);
}
TEST_F(Options, Cache) {
  expect_near_means("cache", indirect(""), by_path(), 0.01);
  expect_near_means("cache without gradients", indirect(set("cache_gradients", false)), by_path(),
                    0.01);
}
/// A pass that is stopped leaves nothing behind for those that follow.
TEST_F(Options, StoppedPassLeavesNothing) {
  SplatBuffer splats(room_.scene().film(), ComponentSet());
  const auto make = [&] {
    return room_.integrator("photonmap", photons() + set("cache_samples", 16));
  };
  const auto stopped = make();
  std::stop_source at_once, later;
  at_once.request_stop();
  stopped->prepare({1, 0, 1}, splats, at_once.get_token(), {});
  stopped->prepare({1, 0, 1}, splats, later.get_token(), [&](double) { later.request_stop(); });
  const PassReport after = stopped->prepare({1, 0, 1}, splats, {}, {})->report;
  const PassReport expected = make()->prepare({1, 0, 1}, splats, {}, {})->report;
  EXPECT_GT(after.photons, 0u);
  EXPECT_EQ(after.photons, expected.photons);
  EXPECT_EQ(after.rays, expected.rays);
}
/// It makes the cache denser, and is told where it does nothing.
TEST_F(Options, CacheByLeastDistance) {
  const std::string split = set("cache_metric", "split_sphere");
  const std::string least = set("minimum_distance", true);
  const auto report = [&](const std::string& parameters) {
    SplatBuffer splats(room_.scene().film(), ComponentSet());
    return room_.integrator("photonmap", photons() + set("cache_samples", 16) + parameters)
        ->prepare({1, 0, 1}, splats, {}, {})
        ->report;
  };
  EXPECT_GT(report(split + least).rays, report(split).rays + 1000);
  EXPECT_TRUE(report(split + least).warnings.empty());
  for (const std::string& without_effect :
       {std::string(), split + set("irradiance_cache", false)}) {
    EXPECT_EQ(report(without_effect + least).rays, report(without_effect).rays);
    const auto warnings = report(without_effect + least).warnings;
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("'minimum_distance' has no effect"), std::string::npos);
  }
  expect_near_means("cache by least distance", indirect(split + least), by_path(), 0.01);
}
TEST_F(Options, Kernels) {
  for (const char* kernel : {"cone", "epanechnikov"})
    expect_near_means(std::string("global kernel ") + kernel,
                      indirect(set("irradiance_cache", false) + set("global_kernel", kernel) +
                               set("precompute_stride", 0)),
                      by_path(), 0.005);
}

/// Caustic photons that go on as global ones bring just what global photons would have brought
/// through the balls themselves.
TEST(PhotonMapOptions, Reradiate) {
  const TestScene scene(round_room(diffuse("0.5, 0.5, 0.5"), balls));
  const auto measured = [&](bool reradiate) {
    return render(scene, "photonmap",
                  set("components", "caustic,indirect") + photons() + set("reradiate", reradiate) +
                      set("irradiance_cache", false),
                  {8, 1});
  };
  const Passes with = measured(true), without = measured(false);
  expect_near_means("indirect, reradiated or not",
                    Comparison::same_seed(with.values({"indirect"}), without.values({"indirect"})),
                    0.005);
  EXPECT_NEAR(with.mean({"caustic"}).mean(), without.mean({"caustic"}).mean(),
              1e-4 * without.mean({"caustic"}).mean());
}

/// Light is divided between caustics, indirect and specular light by what is traced, but their sum
/// is the same: photons light the lobes that are not traced.
TEST(PhotonMapOptions, SpecularSamplingLong) {
  const TestScene scene(round_room(diffuse("0.5, 0.5, 0.5"),
                                   sphere("-0.3, 0.2, -0.3", 0.25, phong(0.2, 0.7, 8)) +
                                       sphere("0.35, 0.1, -0.3", 0.25, phong(0.2, 0.7, 20))));
  const auto measured = [&](const char* sampling) {
    return render(scene, "photonmap",
                  set("global_photons", 80'000) + set("caustic_photons", 80'000) +
                      set("global_neighbors", 12) + set("caustic_neighbors", 12) +
                      set("specular_sampling", sampling) + set("irradiance_cache", false) +
                      set("diffuse_samples", 1),
                  {32, 1});
  };
  const Passes all = measured("importance"), none = measured("none"), perfect = measured("perfect");
  // Neither mirror nor glass: the same random numbers serve for the same.
  for (const char* layer : {"direct", "caustic", "indirect", "specular"})
    EXPECT_EQ(perfect.values({layer}), none.values({layer})) << layer;
  EXPECT_EQ(none.mean({"specular"}).mean(), 0);
  EXPECT_EQ(none.mean({"caustic"}).mean(), 0);
  expect_equal_means("direct by specular sampling",
                     Comparison::same_seed(none.values({"direct"}), all.values({"direct"})));
  // The estimate at the balls themselves is blurred over their small surface.
  expect_near_means("other light by specular sampling",
                    Comparison::same_seed(none.values({"indirect"}),
                                          all.values({"caustic", "indirect", "specular"})),
                    0.01);
  EXPECT_GT(all.mean({"caustic"}).mean(), 0);
  EXPECT_GT(all.mean({"specular"}).mean(), 0);
}

/// With mirrors and glass alone `perfect` is all there is; `none` leaves out what they show.
TEST(PhotonMapOptions, SpecularSamplingOfMirrors) {
  const TestScene scene(round_room(diffuse("0.5, 0.5, 0.5"), balls));
  const auto measured = [&](const char* sampling) {
    return render(scene, "photonmap", photons() + set("specular_sampling", sampling), {4, 1});
  };
  const Passes all = measured("importance"), none = measured("none"), perfect = measured("perfect");
  for (const char* layer : {"emission", "direct", "caustic", "indirect", "specular"})
    EXPECT_EQ(perfect.values({layer}), all.values({layer})) << layer;  // the same random numbers
  EXPECT_EQ(none.mean({"specular"}).mean(), 0);
  EXPECT_GT(all.mean({"specular"}).mean(), 0);
  expect_equal_means("direct without specular sampling",
                     Comparison::same_seed(none.values({"direct"}), all.values({"direct"})));
}

/// The thesis's defaults: one level, no caustics, nothing specular, and bias; but a picture.
TEST(PhotonMapOptions, ThesisPreset) {
  const TestScene scene(round_room(diffuse("0.5, 0.5, 0.5"), balls));
  const Passes thesis = render(scene, "photonmap", set("preset", "thesis"), {1, 1, 2});
  const Passes ours = render(scene, "photonmap", photons(), {8, 1, 4});
  EXPECT_EQ(thesis.mean({"caustic"}).mean(), 0);
  EXPECT_EQ(thesis.mean({"specular"}).mean(), 0);
  EXPECT_NEAR(thesis.mean({"direct"}).mean() / ours.mean({"direct"}).mean(), 1, 0.05);
  // Cells without photons are left out.
  EXPECT_GT(thesis.mean({"indirect"}).mean(), 0.4 * ours.mean({"indirect"}).mean());
  EXPECT_LT(thesis.mean({"indirect"}).mean(), 1.05 * ours.mean({"indirect"}).mean());
  // What is given wins over the preset.
  const Passes with_caustics =
      render(scene, "photonmap", set("preset", "thesis") + set("caustic_neighbors", 50), {1, 1, 1});
  EXPECT_GT(with_caustics.mean({"caustic"}).mean(), 0);
}

TEST(PhotonMapOptions, TheLeastSpacingIsAtMostTheGreatest) {
  const TestScene scene(round_room(diffuse("0.5, 0.5, 0.5")));
  const auto spacings = [](double least, double greatest) {
    return set("cache_minimum_spacing", least) + set("cache_maximum_spacing", greatest);
  };
  try {
    render(scene, "photonmap", spacings(5, 4), {1, 1, 1});
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_NE(std::string(error.what()).find("'cache_minimum_spacing' is 5"), std::string::npos);
  }
  EXPECT_NO_THROW(render(scene, "photonmap", spacings(4, 4), {1, 1, 1}));
}

TEST(PhotonMapOptions, CountsOfZeroSwitchAPartOff) {
  const TestScene scene(round_room(diffuse("0.5, 0.5, 0.5"), balls));
  const auto expect_dark = [&](const std::string& name, const std::string& dark,
                               const std::string& lit, const std::string& parameters = "") {
    const std::string photons = (name == "global_photons" ? "" : set("global_photons", 20'000)) +
                                (name == "caustic_photons" ? "" : set("caustic_photons", 20'000));
    const Passes passes =
        render(scene, "photonmap", set("cache_samples", 16) + photons + set(name, 0) + parameters,
               {2, 1, 1});
    EXPECT_EQ(passes.mean({dark}).mean(), 0) << name;
    EXPECT_GT(passes.mean({lit}).mean(), 0) << name;
  };
  for (const char* name : {"caustic_neighbors", "caustic_photons"})
    expect_dark(name, "caustic", "indirect");
  for (const char* name : {"global_neighbors", "global_photons"})
    for (const bool cache : {true, false})
      expect_dark(name, "indirect", "caustic", set("irradiance_cache", cache));
}
/// The same where maps are stored that hold such photons.
TEST(PhotonMapOptions, CountsOfZeroSwitchStoredPhotonsOff) {
  const std::string room = round_room(diffuse("0.5, 0.5, 0.5"), balls);
  const TestScene scene(room);
  const std::string file = testing::TempDir() + "kaustik_counts_of_zero.kpm";
  write_photon_file(
      file, trace_photon_maps(description_of(room + "<integrator type=\"photonmap\">" + photons() +
                                             "</integrator>"),
                              scene.scene(), 1, 0)
                .photons);
  const auto mean = [&](const char* off, const char* layer) {
    return render(scene, "photonmap",
                  set("photon_map", file.c_str()) + set("cache_samples", 16) +
                      (*off ? set(off, 0) : ""),
                  {2, 1, 1})
        .mean({layer})
        .mean();
  };
  EXPECT_GT(mean("", "caustic"), 0);
  EXPECT_GT(mean("", "indirect"), 0);
  EXPECT_EQ(mean("caustic_photons", "caustic"), 0);
  EXPECT_GT(mean("caustic_photons", "indirect"), 0);
  EXPECT_EQ(mean("global_photons", "indirect"), 0);
  std::remove(file.c_str());
}

TEST(PhotonMapOptions, StoredPhotonsOfOtherWavelengthsAreRefused) {
  const std::string room = round_room(diffuse("0.5, 0.5, 0.5"), balls);
  const TestScene scene(room);
  const std::string file = testing::TempDir() + "kaustik_wavelengths.kpm";
  StoredPhotons photons_of_room =
      trace_photon_maps(
          description_of(room + "<integrator type=\"photonmap\">" + photons() + "</integrator>"),
          scene.scene(), 1, 0)
          .photons;
  const Wavelengths four(440, 500, 580, 660);
  const auto refusal = [&](const Wavelengths& stored, const Wavelengths& rendered) -> std::string {
    photons_of_room.wavelengths = stored;
    write_photon_file(file, photons_of_room);
    const auto integrator = scene.integrator(
        "photonmap", set("photon_map", file.c_str()) + set("irradiance_cache", false));
    SplatBuffer splats(scene.scene().film(), ComponentSet());
    try {
      integrator->prepare({1, 0, 1, rendered}, splats, {}, {});
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_TRUE(error.problems().at(0).place.file);
      return error.what();
    }
    return {};
  };
  EXPECT_EQ(refusal({}, {}), "");
  EXPECT_EQ(refusal(four, four), "");
  const std::string text = refusal({}, four);
  for (const char* part : {file.c_str(), "holds photons of red, green and blue",
                           "has light of 440, 500, 580 and 660 nm", "leave out 'photon_map'"})
    EXPECT_NE(text.find(part), std::string::npos) << text;
  EXPECT_NE(refusal(four, {}), "");
  EXPECT_NE(refusal(four, {440, 500, 580, 661}), "");
  std::remove(file.c_str());
}

/// A lamp so strong and so close to the wall that the radiance there is infinite.
TEST(PhotonMapOptions, DroppedGatherRaysAreTold) {
  const TestScene scene(camera("0, -0.8, 0", "0, 1, -0.2", 75, 8) +
                        sphere("0, 0, 0", 1, diffuse("0.5, 0.5, 0.5"), true) +
                        point_light("0, 0, 0.98", 5e36));
  SplatBuffer splats(scene.scene().film(), ComponentSet());
  const auto report =
      scene.integrator("photonmap", photons())->prepare({1, 0, 1}, splats, {}, {})->report;
  ASSERT_FALSE(report.warnings.empty());
  EXPECT_NE(report.warnings.back().find("not finite"), std::string::npos);
}

}  // namespace
}  // namespace kaustik
