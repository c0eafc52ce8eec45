#include "kaustik/photon/light_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>

#include "kaustik/base/parallel.h"
#include "kaustik/base/statistics.h"
#include "tests/photon/emission_scenes.h"

namespace kaustik {
namespace {

using test::make_scene;
using test::mirror_bsdf;
using test::object;
using test::ObjectPointer;
using test::sphere;

#ifdef KAUSTIK_SLOW_BUILD
constexpr uint32_t photon_divisor = 10;
#else
constexpr uint32_t photon_divisor = 1;
#endif

ObjectPointer diffuse_bsdf(double rho) {
  return object("bsdf", "diffuse", {{"reflectance", Rgb{rho, rho, rho}}});
}
ObjectPointer glass() { return object("bsdf", "dielectric", {{"int_ior", 1.5}, {"ext_ior", 1.0}}); }
ObjectPointer room(double rho) {
  const ObjectPointer shape = sphere(Vec3d(0, 0, 0), 2, diffuse_bsdf(rho));
  shape->properties.push_back({"flip_normals", true, {}});
  return shape;
}
ObjectPointer lamp(const Vec3d& at, double intensity = 1) {
  return object("emitter", "point",
                {{"position", at}, {"intensity", Rgb{intensity, intensity, intensity}}});
}

LightPassSettings settings_of(uint32_t global, uint32_t caustic) {
  LightPassSettings settings;
  settings.global_photons = global;
  settings.caustic_photons = caustic;
  return settings;
}

/// Flux of a map, green.
double flux_of(const PhotonMap& map) {
  double sum = 0;
  for (uint32_t i = 0; i < map.size(); ++i) sum += double(map.tree().data(i).flux.lanes[1]);
  return sum;
}

/// In a closed room the photons that were reflected n times bring Φ ρⁿ, together Φ ρ/(1 − ρ); the
/// first meeting is direct light and stores nothing.
TEST(LightPass, GlobalFluxOfAClosedRoom) {
  const auto scene = make_scene({room(0.6), lamp(Vec3d(0.3, 0.2, 0.5))});
  const LightPass pass(*scene, settings_of(40'000 / photon_divisor, 1000), 1);
  RunningStatistics flux;
  for (uint32_t i = 0; i < 12; ++i) {
    const PhotonMaps maps = pass.trace(1, i);
    flux.add(flux_of(maps.global) / (4 * std::numbers::pi));
    EXPECT_TRUE(maps.caustic.empty());
    EXPECT_TRUE(pass.warnings(maps).empty());  // nothing specular: no caustics are no surprise
    const LightCounts total = maps.global_report.total();
    EXPECT_EQ(total.emitted, 40'000u / photon_divisor);
    EXPECT_EQ(total.stored, maps.global.size());
    EXPECT_EQ(total.absorbed, total.emitted);
    EXPECT_NEAR(total.stored_flux, flux_of(maps.global), 1e-3 * total.stored_flux);
  }
  EXPECT_GT(z_test_p_value(flux, 0.6 / 0.4), 1e-3) << flux.mean();
#ifndef KAUSTIK_SLOW_BUILD
  EXPECT_LT(flux.standard_error(), 0.003 * 1.5);
  EXPECT_LT(z_test_p_value(flux, 0.6 / 0.4 * 1.02), 1e-3);
#endif
}

/// Every photon through a ball of glass about the lamp is a caustic one; none of them is lost, and
/// re-radiated they bring what global photons bring by themselves otherwise.
TEST(LightPass, GlassAroundTheLamp) {
  const auto scene =
      make_scene({room(0.5), lamp(Vec3d(0, 0, 0)), sphere(Vec3d(0, 0, 0), 0.5, glass())});
  for (const bool reradiate : {false, true}) {
    LightPassSettings settings = settings_of(20'000 / photon_divisor, 20'000 / photon_divisor);
    settings.reradiate = reradiate;
    const LightPass pass(*scene, settings, 1);
    RunningStatistics caustic, global;
    for (uint32_t i = 0; i < 8; ++i) {
      const PhotonMaps maps = pass.trace(1, i);
      caustic.add(flux_of(maps.caustic) / (4 * std::numbers::pi));
      global.add(flux_of(maps.global) / (4 * std::numbers::pi));
    }
    // Light from the centre leaves the ball at once or after reflections inside.
    EXPECT_NEAR(caustic.mean(), 1, 1e-3) << reradiate;
    EXPECT_NEAR(global.mean(), 1, 4 * global.standard_error()) << reradiate;
  }
}

TEST(LightPass, SaysWhyAMapIsEmpty) {
  const auto explained = [](const std::vector<ObjectPointer>& objects) {
    const auto scene = make_scene(objects);
    const LightPass pass(*scene, settings_of(1000, 1000), 1);
    std::string all;
    for (const std::string& warning : pass.warnings(pass.trace(1, 0))) all += warning + "\n";
    return all;
  };
  EXPECT_NE(explained({room(0.5)}).find("no light"), std::string::npos);
  // All light leaves.
  const std::string escaped =
      explained({lamp(Vec3d(0, 0, 0)), sphere(Vec3d(5, 0, 0), 0.5, mirror_bsdf())});
  EXPECT_NE(escaped.find("the global map is empty"), std::string::npos);
  EXPECT_NE(escaped.find("the caustic map is empty"), std::string::npos);
  EXPECT_NE(escaped.find("left the scene"), std::string::npos);
  EXPECT_EQ(explained({room(0.5), lamp(Vec3d(0, 0, 0))}), "");
  // In the open nothing is wrong: the ball is lit, and lights nothing else.
  EXPECT_EQ(explained({sphere(Vec3d(0, 0, 0), 1, diffuse_bsdf(0.5)), lamp(Vec3d(0, 0, 1.2))}), "");
}

/// What a lamp elsewhere emits does not take the photons of the one that makes the caustic.
TEST(LightPass, BudgetsFollowWhatArrives) {
  std::vector<ObjectPointer> objects = {sphere(Vec3d(0, 0, 0), 2, diffuse_bsdf(0.5)),
                                        lamp(Vec3d(0, 0, 4)), sphere(Vec3d(0, 0, 3), 0.3, glass())};
  // Behind the big ball, many times as bright.
  for (int i = 0; i < 50; ++i) objects.push_back(lamp(Vec3d(0.1 * (i - 25), 0, -3), 20));
  const auto scene = make_scene(objects);
  const PhotonMaps maps = LightPass(*scene, settings_of(0, 20'000), 1).trace(1, 0);
  const std::vector<LightCounts>& lights = maps.caustic_report.lights;
  EXPECT_GT(lights.at(0).emitted, 17'000u);
  for (size_t i = 1; i < 51; ++i) EXPECT_GE(lights.at(i).emitted, 1u);
}

TEST(LightPass, TellsItsProgress) {
  const auto scene =
      make_scene({room(0.5), lamp(Vec3d(0.5, 0, 0)), sphere(Vec3d(0, 0, 0), 0.4, glass())});
  LightPassSettings settings = settings_of(20'000, 20'000);
  settings.place_stride = 4;
  std::vector<double> told;
  const ProgressFunction listener = [&](double share) { told.push_back(share); };
  with_threads(1, [&] { LightPass(*scene, settings, 1).trace(1, 0, {}, listener); });
  ASSERT_GT(told.size(), 10u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_GT(told.front(), 0);
  EXPECT_DOUBLE_EQ(told.back(), 1);
}

/// Who stops a pass gets no photons and does not wait for trees.
TEST(LightPass, NothingIsKeptOnceStopped) {
  const auto scene = make_scene({room(0.5), lamp(Vec3d(0.5, 0, 0)), lamp(Vec3d(0, 0.9, 0)),
                                 sphere(Vec3d(0, 0, 0), 0.4, glass())});
  const LightPass pass(*scene, settings_of(20'000, 20'000), 7);
  std::stop_source stop;
  const ProgressFunction listener = [&](double) { stop.request_stop(); };
  const PhotonMaps maps = pass.trace(7, 3, stop.get_token(), listener);
  EXPECT_TRUE(maps.global.empty());
  EXPECT_TRUE(maps.caustic.empty());
  EXPECT_TRUE(maps.places.empty());
  EXPECT_FALSE(pass.trace(7, 3).global.empty());
}

TEST(LightPass, SameForAnyNumberOfThreads) {
  const auto scene = make_scene({room(0.5), lamp(Vec3d(0.5, 0, 0)), lamp(Vec3d(0, 0.9, 0)),
                                 sphere(Vec3d(0, 0, 0), 0.4, glass())});
  const auto maps_of = [&](int threads) {
    PhotonMaps maps;
    with_threads(threads,
                 [&] { maps = LightPass(*scene, settings_of(20'000, 20'000), 7).trace(7, 3); });
    return maps;
  };
  const PhotonMaps one = maps_of(1), two = maps_of(2);
  for (const auto map : {&PhotonMaps::global, &PhotonMaps::caustic}) {
    const PhotonMap &a = one.*map, &b = two.*map;
    ASSERT_EQ(a.size(), b.size());
    ASSERT_GT(a.size(), 0u);
    for (uint32_t i = 0; i < a.size(); ++i) {
      ASSERT_EQ(a.tree().key(i), b.tree().key(i));
      ASSERT_EQ(a.tree().data(i).flux.lanes, b.tree().data(i).flux.lanes);
    }
  }
}

/// By position and flux.
using PhotonKey = std::array<float, 4>;
std::vector<PhotonKey> sorted_keys(const PhotonMap& map) {
  std::vector<PhotonKey> keys;
  for (uint32_t i = 0; i < map.size(); ++i) {
    const Vec3f p = map.tree().key(i);
    keys.push_back({p.x, p.y, p.z, map.tree().data(i).flux.lanes[1]});
  }
  std::sort(keys.begin(), keys.end());
  return keys;
}
std::vector<PhotonKey> sorted_keys(const DrawnPhotons& drawn, DrawnPhoton::Map map) {
  std::vector<PhotonKey> keys;
  for (const DrawnPhoton& photon : drawn.photons)
    if (photon.map == map)
      keys.push_back(
          {photon.position.x, photon.position.y, photon.position.z, photon.flux.lanes[1]});
  std::sort(keys.begin(), keys.end());
  return keys;
}

std::shared_ptr<const Scene> scene_of_two_lamps() {
  return make_scene({room(0.5), lamp(Vec3d(0.5, 0, 0)), lamp(Vec3d(0, 0.9, 0)),
                     sphere(Vec3d(0, 0, 0), 0.4, glass())});
}

TEST(LightPass, DrawsThePhotonsOfItsMaps) {
  const auto scene = scene_of_two_lamps();
  const LightPass pass(*scene, settings_of(20'000 / photon_divisor, 10'000 / photon_divisor), 7);
  const PhotonMaps maps = pass.trace(7, 3);
  const DrawnPhotons drawn = pass.draw(7, 3, 1 << 30);
  ASSERT_GT(maps.caustic.size(), 0u);
  EXPECT_EQ(drawn.total, maps.global.size() + maps.caustic.size());
  EXPECT_EQ(drawn.photons.size(), drawn.total);
  EXPECT_EQ(sorted_keys(drawn, DrawnPhoton::Map::global), sorted_keys(maps.global));
  EXPECT_EQ(sorted_keys(drawn, DrawnPhoton::Map::caustic), sorted_keys(maps.caustic));
  std::array<uint64_t, 2> of_light{};
  for (const DrawnPhoton& photon : drawn.photons) {
    ASSERT_GE(photon.level, 1u);
    ++of_light.at(photon.light);
  }
  for (size_t light = 0; light < 2; ++light)
    EXPECT_EQ(of_light[light],
              maps.global_report.lights[light].stored + maps.caustic_report.lights[light].stored);
}

/// How far the share of photons of lamp 0, of caustic ones and of those after two events or more is
/// from that of all, in standard deviations of a draw without replacement: the largest of the
/// three.
double oddity(const std::vector<DrawnPhoton>& some, const std::vector<DrawnPhoton>& all) {
  double largest = 0;
  for (const auto& counts : std::vector<std::function<bool(const DrawnPhoton&)>>{
           [](const DrawnPhoton& p) { return p.light == 0; },
           [](const DrawnPhoton& p) { return p.map == DrawnPhoton::Map::caustic; },
           [](const DrawnPhoton& p) { return p.level >= 2; }}) {
    const double share = double(std::ranges::count_if(all, counts)) / double(all.size());
    const double n = double(some.size()), rest = 1 - n / double(all.size());
    const double found = double(std::ranges::count_if(some, counts));
    largest =
        std::max(largest, std::abs(found - n * share) / std::sqrt(n * share * (1 - share) * rest));
  }
  return largest;
}

TEST(LightPass, DrawsEachPhotonAsLikelyAsAnyOther) {
  const auto scene = scene_of_two_lamps();
  const LightPass pass(*scene, settings_of(20'000, 10'000), 7);
  DrawnPhotons all, some;
  with_threads(1, [&] { all = pass.draw(7, 0, 1 << 30); });
  with_threads(2, [&] { some = pass.draw(7, 0, 500); });
  ASSERT_GT(all.photons.size(), 10'000u);
  EXPECT_EQ(some.total, all.total);
  ASSERT_EQ(some.photons.size(), 500u);
  for (size_t i = 0; i < some.photons.size(); ++i) {
    ASSERT_EQ(some.photons[i].position, all.photons[i].position);
    ASSERT_EQ(some.photons[i].flux.lanes, all.photons[i].flux.lanes);
  }
  // Three tests at 1e-4 each.
  EXPECT_LT(oddity(some.photons, all.photons), 3.9);
  // The first that were traced are no such draw.
  std::vector<DrawnPhoton> ordered = all.photons;
  std::ranges::stable_sort(ordered, {}, &DrawnPhoton::light);
  ordered.resize(500);
  EXPECT_GT(oddity(ordered, all.photons), 3.9);
}

}  // namespace
}  // namespace kaustik
