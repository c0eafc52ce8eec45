// Lamps of photons, from the numbers of their light paths.
#include "kaustik/photon/photon_lamps.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <tuple>

#include "kaustik/photon/photon_parts.h"
#include "tests/photon/emission_scenes.h"

namespace kaustik {
namespace {

using namespace test;

/// Three lamps of different powers, two of which shine at the mirror.
std::shared_ptr<const Scene> three_lamps_and_mirror() {
  const auto lamp = [](const Vec3d& position, double intensity) {
    return object("emitter", "point", {{"position", position}, {"intensity", intensity}});
  };
  return make_scene(
      {lamp(Vec3d(1, 0, 2), 1), lamp(Vec3d(-1, 0.5, 2.5), 4), lamp(Vec3d(0, -1, 1.5), 0.3),
       sphere(Vec3d(0, 0, 0.6), 0.4, mirror_bsdf()),
       placed("rectangle", Transform::scale(Vec3d(3, 3, 1)),
              object("bsdf", "diffuse", {{"reflectance", Rgb{0.5, 0.6, 0.7}}})),
       placed("rectangle",
              Transform::translate(Vec3d(0, 0, 3)) * Transform::rotate(Vec3d(1, 0, 0), 180),
              object("bsdf", "diffuse"))});
}

LightPassSettings settings_for(bool reradiate) {
  LightPassSettings settings;
  settings.global_photons = 12'000;
  settings.caustic_photons = 9'000;
  settings.reradiate = reradiate;
  return settings;
}

using Key = std::tuple<float, float, float, float>;
Key key_of(const Vec3f& position, const StoredSpectrum& flux) {
  return {position.x, position.y, position.z, flux.lanes[0]};
}

// LightPass::draw() notes the lamp where a photon is made.
TEST(PhotonLamps, AreThoseThatPhotonsAreDrawnWith) {
  const auto scene = three_lamps_and_mirror();
  for (const bool reradiate : {false, true}) {
    const LightPassSettings settings = settings_for(reradiate);
    const LightPass pass(*scene, settings, 3);
    std::map<Key, uint32_t> expected;
    for (const DrawnPhoton& photon : pass.draw(3, 0, 1'000'000).photons)
      expected[key_of(photon.position, photon.flux)] = photon.light;
    PhotonMaps maps = pass.trace(3, 0);
    sort_photons(maps);
    const PhotonLamps lamps(settings, maps);
    std::vector<size_t> counts(scene->lights().size());
    for (const PhotonMap* map : {&maps.global, &maps.caustic}) {
      for (uint32_t i = 0; i < map->size(); ++i) {
        const Photon& photon = map->tree().data(i);
        const auto found = expected.find(key_of(map->tree().key(i), photon.flux));
        ASSERT_NE(found, expected.end()) << i;
        const uint32_t lamp = lamps.of_path(photon.path);
        ASSERT_EQ(lamp, found->second) << "path " << photon.path;
        ++counts[lamp];
      }
    }
    for (const size_t count : counts) EXPECT_GT(count, 100u);
  }
}

// Of numbers that no light path has, as a damaged file may hold them.
TEST(PhotonLamps, NumbersOfNoPath) {
  PhotonMaps maps;
  maps.global_report.lights.resize(2);
  maps.global_report.lights[0].emitted = 10;
  maps.global_report.lights[1].emitted = 20;
  maps.caustic_report.lights.resize(2);
  maps.caustic_report.lights[1].emitted = 5;
  LightPassSettings settings;
  settings.global_photons = 30;
  const PhotonLamps lamps(settings, maps);
  EXPECT_EQ(lamps.of_path(0), 0u);
  EXPECT_EQ(lamps.of_path(9), 0u);
  EXPECT_EQ(lamps.of_path(10), 1u);
  EXPECT_EQ(lamps.of_path(29), 1u);
  EXPECT_EQ(lamps.of_path(30), 1u);  // the first lamp began none for caustics
  EXPECT_EQ(lamps.of_path(34), 1u);
  EXPECT_EQ(lamps.of_path(35), PhotonLamps::unknown);
  EXPECT_EQ(PhotonLamps({}, {}).of_path(0), PhotonLamps::unknown);
}

}  // namespace
}  // namespace kaustik
